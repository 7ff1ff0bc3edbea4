/*
 * uvs.c: where triangles are in textures.
 *
 * Coordinates of surfaces jump, as an angle does where it has gone around.  A triangle across such a seam must not
 * have both ends of the picture.  So each triangle has its own at its corners: its middle's, continued up to them.
 * Whole numbers are added where that jumps by them, since pictures repeat; else it goes on as it went before.
 */
#include <math.h>
#include <string.h>

#include "cli/mesh/meshing.h"
#include "compiler/base/vec.h"

enum { PROBES = 256, STEPS = 16 };
/* A part of the picture: no step is expected to differ from the one before by more. */
static const double JUMP = 0.5;

typedef struct Triangle {
    double corners[3][3], middle[3];
    double own[3][2];    /* places of the corners, as they are there */
    double around[3][2]; /* of the middle, and a step from it along two edges */
} Triangle;

/* Steps from the middle, in parts of edges. */
static const double STEP = 1e-3;

static void point_between(const double a[3], const double b[3], double share, double point[3])
{
    for (int k = 0; k < 3; k++)
        point[k] = a[k] + share * (b[k] - a[k]);
}

/* Takes the jump out of a step, which is not expected. */
static double without_jump(double step, double expected)
{
    double excess = step - expected, whole = round(excess);
    if (fabs(excess) <= JUMP)
        return step;
    return fabs(excess - whole) < 0.5 * JUMP ? step - whole : expected;
}

/* Walks from the middle to a corner in small steps. */
static bool walk(const Meshing *meshing, const Triangle *triangle, int corner,
                 const double first[2], double place[2])
{
    double points[STEPS][3], found[STEPS][2], step[2] = {first[0] / STEPS, first[1] / STEPS};
    for (int i = 0; i < STEPS; i++)
        point_between(triangle->middle, triangle->corners[corner], (i + 1.0) / STEPS, points[i]);
    if (krs_texture_uvs(meshing->state, (const double(*)[3])points, STEPS, found) != KRS_OK)
        return false;
    memcpy(place, triangle->around[0], 2 * sizeof *place);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < STEPS; i++) {
            double before = i > 0 ? found[i - 1][k] : triangle->around[0][k];
            double now    = isnan(found[i][k]) || isnan(before)
                                ? step[k]
                                : without_jump(found[i][k] - before, step[k]);
            place[k] += now;
            step[k] = now;
        }
    return true;
}

/* Tells how a place changes along the two edges of the first corner. */
static void find_slopes(const Triangle *triangle, double slopes[2][2])
{
    for (int edge = 0; edge < 2; edge++)
        for (int k = 0; k < 2; k++) {
            double step     = triangle->around[1 + edge][k] - triangle->around[0][k];
            slopes[edge][k] = fabs(step) < JUMP ? step / STEP : 0; /* else a seam is there */
        }
}

/* Continues the places of a triangle from its middle: by their slopes, unless a seam lies between. */
static bool continue_places(const Meshing *meshing, const Triangle *triangle, double places[3][2])
{
    static const double ALONG[3][2] = {{-1. / 3, -1. / 3}, {2. / 3, -1. / 3}, {-1. / 3, 2. / 3}};
    double              slopes[2][2];
    find_slopes(triangle, slopes);
    for (int i = 0; i < 3; i++) {
        double way[2];
        bool   seam = false;
        for (int k = 0; k < 2; k++) {
            way[k] = ALONG[i][0] * slopes[0][k] + ALONG[i][1] * slopes[1][k];
            seam   = seam ||
                   !(fabs(triangle->own[i][k] - triangle->around[0][k] - way[k]) < 0.5 * JUMP);
        }
        memcpy(places[i], triangle->own[i], sizeof places[i]);
        if (seam && !walk(meshing, triangle, i, way, places[i]))
            return false;
    }
    return true;
}

/* Finds the places of all points, some at once. */
static KrsStatus find_all(const Meshing *meshing, const double (*points)[3], size_t count,
                          double (*places)[2])
{
    KrsStatus status = KRS_OK;
    for (size_t i = 0, now; i < count && status == KRS_OK; i += now) {
        now    = count - i < PROBES ? count - i : PROBES;
        status = krs_texture_uvs(meshing->state, points + i, now, places + i);
    }
    return status;
}

static bool place_triangle(const Meshing *meshing, const MeshParts *parts, size_t number,
                           const double (*of_vertices)[2], double places[3][2])
{
    Triangle triangle = {.middle = {0, 0, 0}};
    double   around[3][3];
    for (int i = 0; i < 3; i++) {
        uint32_t vertex = parts->triangles[number][i];
        memcpy(triangle.corners[i], parts->in_scene[vertex], sizeof triangle.corners[i]);
        memcpy(triangle.own[i], of_vertices[vertex], sizeof triangle.own[i]);
        add_scaled3(triangle.middle, triangle.middle, 1.0 / 3, triangle.corners[i]);
    }
    for (int i = 0; i < 3; i++) {
        memcpy(around[i], triangle.middle, sizeof around[i]);
        for (int k = 0; i > 0 && k < 3; k++)
            around[i][k] += STEP * (triangle.corners[i][k] - triangle.corners[0][k]);
    }
    memset(places, 0, 3 * sizeof *places);
    if (krs_texture_uvs(meshing->state, (const double(*)[3])around, 3, triangle.around) != KRS_OK)
        return false;
    return isnan(triangle.around[0][0]) || continue_places(meshing, &triangle, places);
}

static bool any_number(const double (*places)[2], size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isnan(places[i][0]))
            return true;
    return false;
}

KrsStatus find_uvs(const Meshing *meshing, MeshParts *parts)
{
    Arena *arena    = meshing->options->arena;
    size_t vertices = parts_vertex_count(parts), triangles = parts_triangle_count(parts);
    double(*of_vertices)[2] = arena_alloc(arena, vertices, sizeof *of_vertices);
    KrsStatus status        = find_all(meshing, parts->in_scene, vertices, of_vertices);
    if (status != KRS_OK || !any_number((const double(*)[2])of_vertices, vertices))
        return status;
    double(*places)[3][2] = arena_alloc(arena, triangles, sizeof *places);
    for (size_t i = 0; i < triangles; i++)
        if (!place_triangle(meshing, parts, i, (const double(*)[2])of_vertices, places[i]))
            return KRS_OUT_OF_MEMORY;
    parts->corner_places = (const double(*)[3][2])places;
    return KRS_OK;
}
