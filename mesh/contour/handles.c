/*
 * handles.c: the Euler number of what is near to a vertex.
 *
 * Of F triangles that hang together by I inner edges and C vertices that have all their triangles among them, it is F - I + C,
 * if a vertex that they touch from several sides counts once for each.  It is 1 of a disc, and less where there is a ring.
 */
#include "mesh/contour/handles.h"

#include <string.h>

#include "compiler/base/vec.h"
#include "mesh/common/crossing.h"

typedef struct Handles {
    const Contour *contour;
    TriangleEdges  edges;
    uint32_t      *taken;   /* of triangles, the last place that has them */
    uint32_t      *place;   /* of vertices, the last place whose corners were counted, */
    uint32_t      *corners; /* and these */
    bool          *done;    /* of vertices that are near to a place */
    struct {
        uint32_t *items;
        size_t    count, capacity;
    } patch;
    double radius;
} Handles;

static bool is_within(const Handles *h, uint32_t triangle, const double center[3])
{
    const uint32_t *corners = h->contour->triangles.items[triangle];
    for (int c = 0; c < 3; c++)
        if (distance3(h->contour->vertices.items[corners[c]], center) > h->radius)
            return false;
    return true;
}

static void take(Handles *h, uint32_t triangle, uint32_t place)
{
    h->taken[triangle] = place;
    array_push_large(h->contour->arena, &h->patch, triangle);
}

static uint32_t triangle_beyond(const Handles *h, uint32_t triangle, int edge)
{
    const uint32_t     *corners = h->contour->triangles.items[triangle];
    const TriangleEdge *other   = find_edge(&h->edges, corners[(edge + 1) % 3], corners[edge]);
    return other ? other->triangle : triangle;
}

/* From one triangle at the vertex over edges. */
static void find_patch(Handles *h, uint32_t vertex, uint32_t place)
{
    const double *center = h->contour->vertices.items[vertex];
    h->patch.count       = 0;
    for (uint32_t i = h->edges.begins[vertex]; i < h->edges.begins[vertex + 1]; i++)
        if (h->patch.count == 0 && is_within(h, h->edges.items[i].triangle, center))
            take(h, h->edges.items[i].triangle, place);
    for (size_t i = 0; i < h->patch.count; i++)
        for (int edge = 0; edge < 3; edge++) {
            uint32_t beyond = triangle_beyond(h, h->patch.items[i], edge);
            if (h->taken[beyond] != place && is_within(h, beyond, center))
                take(h, beyond, place);
        }
}

static long euler_number(Handles *h, uint32_t place)
{
    long inner = 0, closed = 0; /* inner edges count twice */
    for (size_t i = 0; i < h->patch.count; i++)
        for (int c = 0; c < 3; c++) {
            uint32_t vertex = h->contour->triangles.items[h->patch.items[i]][c];
            if (h->place[vertex] != place) {
                h->place[vertex]   = place;
                h->corners[vertex] = 0;
            }
            h->corners[vertex]++;
            closed += h->corners[vertex] == h->edges.begins[vertex + 1] - h->edges.begins[vertex];
            inner += h->taken[triangle_beyond(h, h->patch.items[i], c)] == place;
        }
    return (long)h->patch.count - inner / 2 + closed;
}

/* Vertices that are nearer than half of the radius need not be looked at. */
static void mark_done(Handles *h, uint32_t vertex)
{
    const double *center = h->contour->vertices.items[vertex];
    h->done[vertex]      = true;
    for (size_t i = 0; i < h->patch.count; i++)
        for (int c = 0; c < 3; c++) {
            uint32_t other = h->contour->triangles.items[h->patch.items[i]][c];
            if (distance3(h->contour->vertices.items[other], center) < 0.5 * h->radius)
                h->done[other] = true;
        }
}

size_t handles_count(const Contour *contour, double radius, double at[3])
{
    Arena    *arena    = contour->arena;
    size_t    vertices = contour->vertices.count, triangles = contour->triangles.count, found = 0;
    ArenaMark mark = arena_mark(arena);
    Handles   h    = {.contour = contour, .radius = radius};
    h.edges        = sort_edges((const uint32_t(*)[3])contour->triangles.items, triangles, arena);
    h.taken        = arena_new_array(arena, uint32_t, triangles + 1);
    h.place        = arena_new_array(arena, uint32_t, vertices + 1);
    h.corners      = arena_new_array(arena, uint32_t, vertices + 1);
    h.done         = arena_new_array(arena, bool, vertices + 1);
    for (uint32_t i = 0; i < vertices && i < h.edges.vertex_count; i++) {
        if (h.done[i])
            continue;
        find_patch(&h, i, i + 1);
        if (h.patch.count > 0 && euler_number(&h, i + 1) < 1 && found++ == 0)
            memcpy(at, contour->vertices.items[i], 3 * sizeof *at);
        mark_done(&h, i);
    }
    arena_rewind(arena, mark);
    return found;
}
