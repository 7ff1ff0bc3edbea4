/*
 * crossings.c: all pairs of triangles whose boxes meet, by a sweep along x.
 */
#include "tests/unit/crossings.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/vec.h"

typedef struct Extent {
    double          low[3], high[3], corners[3][3];
    const uint32_t *vertices;
} Extent;

static Extent extent_of(const KrsMesh *mesh, size_t triangle)
{
    Extent e = {.vertices = mesh->triangles[triangle]};
    for (int i = 0; i < 3; i++)
        memcpy(e.corners[i], mesh->vertices[e.vertices[i]], sizeof e.corners[i]);
    for (int k = 0; k < 3; k++) {
        e.low[k]  = fmin(e.corners[0][k], fmin(e.corners[1][k], e.corners[2][k]));
        e.high[k] = fmax(e.corners[0][k], fmax(e.corners[1][k], e.corners[2][k]));
    }
    return e;
}

static int compare_lows(const void *a, const void *b)
{
    const Extent *first = a, *second = b;
    return (first->low[0] > second->low[0]) - (first->low[0] < second->low[0]);
}

static bool extents_meet(const Extent *a, const Extent *b)
{
    return a->low[1] <= b->high[1] && b->low[1] <= a->high[1] && a->low[2] <= b->high[2] &&
           b->low[2] <= a->high[2];
}

static bool has_vertex(const Extent *e, uint32_t vertex)
{
    return vertex == e->vertices[0] || vertex == e->vertices[1] || vertex == e->vertices[2];
}

/* Tells whether a segment goes through a triangle. */
static bool goes_through(const double a[3], const double b[3], const double corners[3][3])
{
    double edges[2][3], along[3], offset[3], cross[3], turn[3];
    add_scaled3(edges[0], corners[1], -1, corners[0]);
    add_scaled3(edges[1], corners[2], -1, corners[0]);
    add_scaled3(along, b, -1, a);
    add_scaled3(offset, a, -1, corners[0]);
    cross3(along, edges[1], cross);
    double size = dot3(edges[0], cross);
    if (fabs(size) < 1e-15)
        return false;
    double first = dot3(offset, cross) / size;
    cross3(offset, edges[0], turn);
    double second = dot3(along, turn) / size, t = dot3(edges[1], turn) / size;
    return first > 1e-9 && second > 1e-9 && first + second < 1 - 1e-9 && t > 1e-9 && t < 1 - 1e-9;
}

static bool has_edge_through(const Extent *own, const Extent *other)
{
    bool through = false;
    for (int k = 0; k < 3; k++) {
        int next = (k + 1) % 3;
        through  = through || (!has_vertex(own, other->vertices[k]) &&
                              !has_vertex(own, other->vertices[next]) &&
                              goes_through(other->corners[k], other->corners[next],
                                            (const double(*)[3])own->corners));
    }
    return through;
}

bool crosses_itself(const KrsMesh *mesh)
{
    bool    crosses = false;
    size_t  count   = mesh->triangle_count;
    Extent *extents = malloc((count + 1) * sizeof *extents);
    for (size_t i = 0; i < count; i++)
        extents[i] = extent_of(mesh, i);
    qsort(extents, count, sizeof *extents, compare_lows);
    for (size_t i = 0; i < count; i++)
        for (size_t j = i + 1; j < count && extents[j].low[0] <= extents[i].high[0]; j++)
            crosses = crosses || (extents_meet(&extents[i], &extents[j]) &&
                                  (has_edge_through(&extents[i], &extents[j]) ||
                                   has_edge_through(&extents[j], &extents[i])));
    free(extents);
    return crosses;
}
