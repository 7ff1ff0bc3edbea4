/* copies.c: the copies of parts, one behind the other. */
#include "cli/mesh/copies.h"

#include <string.h>

#include "compiler/base/vec.h"

typedef struct Visit {
    const MeshParts *parts;
    const MeshBody  *body;
    VisitMeshCopy   *visit;
    void            *user;
} Visit;

static bool visit_item(void *user, const KrsItem *item, const double matrix[3][4])
{
    const Visit *visit  = user;
    size_t       number = (size_t)(item - visit->body->assembly->items);
    MeshCopy     copy   = {&visit->parts->parts[visit->body->part_of[number]], matrix,
                           mesh_is_reflection(matrix)};
    return visit->visit(visit->user, &copy);
}

bool mesh_body_visit(const MeshParts *parts, size_t number, VisitMeshCopy *visit, void *user)
{
    const MeshBody *body  = &parts->bodies[number];
    Visit           each  = {parts, body, visit, user};
    MeshCopy        whole = {.part = &parts->parts[body->first_part]};
    return body->assembly ? krs_assembly_visit(body->assembly, visit_item, &each)
                          : visit(user, &whole);
}

void mesh_copy_vertex(const MeshParts *parts, const MeshCopy *copy, size_t number, double at[3])
{
    const double *vertex = parts->vertices[copy->part->first_vertex + number];
    for (int i = 0; i < 3; i++)
        at[i] = copy->matrix ? dot3(copy->matrix[i], vertex) + copy->matrix[i][3] : vertex[i];
}

/* Reverses the order of mirrored triangles, so that they face outwards again. */
static int corner_of(const MeshCopy *copy, int k) { return copy->mirrored && k > 0 ? 3 - k : k; }

void mesh_copy_triangle(const MeshParts *parts, const MeshCopy *copy, size_t number, size_t base,
                        uint32_t triangle[3])
{
    const uint32_t *from = parts->triangles[copy->part->first_triangle + number];
    for (int k = 0; k < 3; k++)
        triangle[k] = (uint32_t)(from[corner_of(copy, k)] - copy->part->first_vertex + base);
}

void mesh_copy_colors(const MeshParts *parts, const MeshCopy *copy, size_t number,
                      unsigned char colors[3][3])
{
    for (int k = 0; k < 3; k++)
        memcpy(colors[k],
               parts->corner_colors[copy->part->first_triangle + number][corner_of(copy, k)],
               sizeof colors[k]);
}

void mesh_copy_places(const MeshParts *parts, const MeshCopy *copy, size_t number,
                      double places[3][2])
{
    for (int k = 0; k < 3; k++)
        memcpy(places[k],
               parts->corner_places[copy->part->first_triangle + number][corner_of(copy, k)],
               sizeof places[k]);
}

/* A similarity rotates directions, and makes them longer by its scale. */
static void rotate(const double (*matrix)[4], float direction[3])
{
    const double from[3] = {direction[0], direction[1], direction[2]};
    const double scale   = length3(matrix[0]);
    for (int i = 0; i < 3; i++)
        direction[i] = (float)(dot3(matrix[i], from) / scale);
}

void mesh_copy_frames(const MeshParts *parts, const MeshCopy *copy, size_t number,
                      MeshFrame frames[3])
{
    for (int k = 0; k < 3; k++) {
        frames[k] = parts->corner_frames[copy->part->first_triangle + number][corner_of(copy, k)];
        if (copy->matrix) {
            rotate(copy->matrix, frames[k].normal);
            rotate(copy->matrix, frames[k].tangent);
        }
    }
}
