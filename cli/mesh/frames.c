/*
 * frames.c: normals and tangents of corners, where a material has highlights that are drawn out.
 *
 * On an edge each side has its own, so a corner asks a little towards the middle of its triangle.
 */
#include <math.h>
#include <string.h>

#include "cli/mesh/meshing.h"
#include "compiler/base/vec.h"

/* Parts of the way from a corner to the middle; and of a tangent's length, which must lie across the normal. */
static const double STEP = 1e-3, MIN_ACROSS = 1e-3;

static void take_across(const double normal[3], double tangent[3])
{
    add_scaled3(tangent, tangent, -dot3(normal, tangent), normal);
}

/* Does the same in the space of a part, of which `matrix` makes a copy; NULL: it is where it is. */
static void bring_back(const double (*matrix)[4], const double direction[3], double back[3])
{
    for (int k = 0; k < 3; k++)
        back[k] = !matrix ? direction[k]
                          : matrix[0][k] * direction[0] + matrix[1][k] * direction[1] +
                                matrix[2][k] * direction[2];
}

/* A tangent along the normal, or none, is any. */
static void set_frame(const double (*matrix)[4], const KrsHit *hit, const double face[3],
                      MeshFrame *frame)
{
    double normal[3], tangent[3], axis[3] = {0, 0, 0};
    bring_back(matrix, hit->normal, normal);
    if (!normalize3(normal))
        memcpy(normal, face, sizeof normal);
    bring_back(matrix, hit->tangent, tangent);
    const double length = length3(tangent);
    take_across(normal, tangent);
    if (!(length3(tangent) > MIN_ACROSS * length) || !normalize3(tangent)) {
        axis[fabs(normal[0]) < 0.7 ? 0 : 1] = 1;
        memcpy(tangent, axis, sizeof tangent);
        take_across(normal, tangent);
        normalize3(tangent);
    }
    for (int k = 0; k < 3; k++) {
        frame->normal[k]  = (float)normal[k];
        frame->tangent[k] = (float)tangent[k];
    }
}

static void face_normal(const MeshParts *parts, const uint32_t triangle[3], double normal[3])
{
    double along[3], across[3];
    add_scaled3(along, parts->vertices[triangle[1]], -1, parts->vertices[triangle[0]]);
    add_scaled3(across, parts->vertices[triangle[2]], -1, parts->vertices[triangle[0]]);
    cross3(along, across, normal);
    if (!normalize3(normal))
        normal[2] = 1;
}

static void frame_triangle(const Meshing *meshing, const MeshParts *parts, const MeshPart *part,
                           size_t number, MeshFrame frames[3])
{
    const uint32_t *triangle = parts->triangles[number];
    double          points[3][3], face[3];
    KrsHit          hits[3];
    face_normal(parts, triangle, face);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            double middle = 0;
            for (int n = 0; n < 3; n++)
                middle += parts->in_scene[triangle[n]][k] / 3;
            double corner = parts->in_scene[triangle[i]][k];
            points[i][k]  = corner + STEP * (middle - corner);
        }
    krs_probe(meshing->state, (const double(*)[3])points, 3, hits);
    for (int i = 0; i < 3; i++)
        set_frame(part->first_copy, &hits[i], face, &frames[i]);
}

bool mesh_needs_frames(const MeshMaterial *material)
{
    return material->look.specular_roughness_anisotropy > 0;
}

void find_frames(const Meshing *meshing, MeshParts *parts)
{
    MeshFrame(*frames)[3] = NULL;
    for (size_t i = 0; i < parts->part_count; i++) {
        const MeshPart *part = &parts->parts[i];
        for (size_t t = part->first_triangle; t < part->first_triangle + part->triangle_count;
             t++) {
            if (!mesh_needs_frames(&parts->materials[parts->material_of[t]]))
                continue;
            if (!frames)
                frames = arena_alloc(meshing->options->arena, parts_triangle_count(parts),
                                     sizeof *frames);
            frame_triangle(meshing, parts, part, t, frames[t]);
        }
    }
    parts->corner_frames = (const MeshFrame(*)[3])frames;
}
