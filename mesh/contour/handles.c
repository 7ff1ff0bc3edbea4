/*
 * handles.c: counts handles by the Euler number of the region around a vertex.
 *
 * A region of F triangles has the Euler number F - I + C, where I are its inner edges, and C the
 * vertices all of whose triangles are in it, if a vertex that it touches from several sides counts
 * once for each.  The number is 1 of a disc, and less of a ring.
 */
#include "mesh/contour/handles.h"

#include <string.h>

#include "compiler/base/vec.h"
#include "mesh/common/crossing.h"

typedef struct Handles {
    const Contour *contour;
    TriangleEdges  edges;
    uint32_t      *taken;   /* of triangles, the last region that has them */
    uint32_t      *counted; /* of vertices, the last region whose corners were counted, */
    uint32_t      *corners; /* and these */
    bool          *done;    /* of vertices that are near to one that was searched */
    uint32_t      *walked;  /* of edges of triangles, the last region on whose border they are */
    struct {
        uint32_t *items;
        size_t    count, capacity;
    } patch, beyond;
    uint32_t last_region;
    double   radius;
} Handles;

static bool is_within(const Handles *h, uint32_t triangle, const double center[3])
{
    const uint32_t *corners = h->contour->triangles.items[triangle];
    for (int c = 0; c < 3; c++)
        if (distance3(h->contour->vertices.items[corners[c]], center) > h->radius)
            return false;
    return true;
}

static void take(Handles *h, uint32_t triangle, uint32_t region)
{
    h->taken[triangle] = region;
    array_push_large(h->contour->arena, &h->patch, triangle);
}

static uint32_t triangle_beyond(const Handles *h, uint32_t triangle, int edge)
{
    const uint32_t     *corners = h->contour->triangles.items[triangle];
    const TriangleEdge *other   = find_edge(&h->edges, corners[(edge + 1) % 3], corners[edge]);
    return other ? other->triangle : triangle;
}

/* Finds the region of a vertex, from one triangle to the next over edges. */
static void find_patch(Handles *h, uint32_t vertex, uint32_t region)
{
    const double *center = h->contour->vertices.items[vertex];
    h->patch.count       = 0;
    for (uint32_t i = h->edges.begins[vertex]; i < h->edges.begins[vertex + 1]; i++)
        if (h->patch.count == 0 && is_within(h, h->edges.items[i].triangle, center))
            take(h, h->edges.items[i].triangle, region);
    for (size_t i = 0; i < h->patch.count; i++)
        for (int edge = 0; edge < 3; edge++) {
            uint32_t beyond = triangle_beyond(h, h->patch.items[i], edge);
            if (h->taken[beyond] != region && is_within(h, beyond, center))
                take(h, beyond, region);
        }
}

static long euler_number(Handles *h, const uint32_t *patch, size_t count, uint32_t region)
{
    long inner = 0, closed = 0; /* inner edges count twice */
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) {
            uint32_t vertex = h->contour->triangles.items[patch[i]][c];
            if (h->counted[vertex] != region) {
                h->counted[vertex] = region;
                h->corners[vertex] = 0;
            }
            h->corners[vertex]++;
            closed += h->corners[vertex] == h->edges.begins[vertex + 1] - h->edges.begins[vertex];
            inner += h->taken[triangle_beyond(h, patch[i], c)] == region;
        }
    return (long)count - inner / 2 + closed;
}

/* Goes from an edge of the border to the next one, around the vertex where it ends. */
static void go_along_border(const Handles *h, uint32_t region, uint32_t *triangle, int *edge)
{
    uint32_t vertex = h->contour->triangles.items[*triangle][(*edge + 1) % 3];
    *edge           = (*edge + 1) % 3;
    for (uint32_t beyond = triangle_beyond(h, *triangle, *edge); h->taken[beyond] == region;
         beyond          = triangle_beyond(h, *triangle, *edge)) {
        *triangle = beyond;
        *edge     = 0;
        while (h->contour->triangles.items[beyond][*edge] != vertex)
            (*edge)++;
    }
}

/* Returns the first edge of the border that was not walked along, as 3 times its triangle and the
   edge; the number of all if there is none. */
static size_t next_border(const Handles *h, uint32_t region, size_t from)
{
    size_t count = 3 * h->patch.count;
    while (from < count) {
        uint32_t triangle = h->patch.items[from / 3];
        if (h->taken[triangle_beyond(h, triangle, (int)(from % 3))] != region &&
            h->walked[3 * triangle + from % 3] != region)
            return from;
        from++;
    }
    return count;
}

static void walk_border(Handles *h, uint32_t region, size_t from)
{
    uint32_t triangle = h->patch.items[from / 3];
    int      edge     = (int)(from % 3);
    while (h->walked[3 * triangle + (uint32_t)edge] != region) {
        h->walked[3 * triangle + (uint32_t)edge] = region;
        go_along_border(h, region, &triangle, &edge);
    }
}

/* ---- beyond the border ---- */

static double area_of(const Handles *h, uint32_t triangle)
{
    const uint32_t *corners = h->contour->triangles.items[triangle];
    double          edges[2][3], cross[3];
    for (int i = 0; i < 2; i++)
        add_scaled3(edges[i], h->contour->vertices.items[corners[i + 1]], -1,
                    h->contour->vertices.items[corners[0]]);
    cross3(edges[0], edges[1], cross);
    return 0.5 * length3(cross);
}

static void add_to_box(const Handles *h, uint32_t triangle, double low[3], double high[3])
{
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++) {
            double at = h->contour->vertices.items[h->contour->triangles.items[triangle][c]][k];
            low[k]    = min2(low[k], at);
            high[k]   = max2(high[k], at);
        }
}

/* Tells whether what is beyond an edge of the border ends as a thin spike or flap, so that a loop
   around it can be drawn off. */
static bool is_thin_end(Handles *h, uint32_t region, uint32_t start)
{
    /* Areas over the squared radius, and over the radius times the diagonal of the box. */
    static const double LARGEST = 60, WIDEST = 2.4;
    double              area   = 0, low[3], high[3];
    uint32_t            number = ++h->last_region;
    for (int k = 0; k < 3; k++) {
        low[k]  = INFINITY;
        high[k] = -INFINITY;
    }
    h->beyond.count = 0;
    h->taken[start] = number;
    array_push_large(h->contour->arena, &h->beyond, start);
    for (size_t i = 0; i < h->beyond.count; i++) {
        uint32_t triangle = h->beyond.items[i];
        area += area_of(h, triangle);
        add_to_box(h, triangle, low, high);
        if (area > LARGEST * h->radius * h->radius)
            return false;
        for (int edge = 0; edge < 3; edge++) {
            uint32_t next = triangle_beyond(h, triangle, edge);
            if (h->taken[next] != number && h->taken[next] != region) {
                h->taken[next] = number;
                array_push_large(h->contour->arena, &h->beyond, next);
            }
        }
    }
    return area <= WIDEST * h->radius * distance3(low, high) &&
           euler_number(h, h->beyond.items, h->beyond.count, number) == 1;
}

/* Tells whether a region is a whole component of the mesh, or has a handle, or goes around a rod or
   through a hole that continues at two borders or more. */
static bool goes_around(Handles *h, uint32_t region)
{
    long   euler = euler_number(h, h->patch.items, h->patch.count, region), borders = 0, going = 0;
    size_t count = 3 * h->patch.count;
    if (euler == 1)
        return false;
    for (size_t at = next_border(h, region, 0); at < count; at = next_border(h, region, at)) {
        borders++;
        walk_border(h, region, at);
        going += !is_thin_end(h, region, triangle_beyond(h, h->patch.items[at / 3], (int)(at % 3)));
    }
    return borders == 0 || euler + borders < 2 || going > 1;
}

/* Tells whether a region has a handle, or no border: the Euler number of a connected surface is 2,
   less its borders, and less 2 for each handle. */
static bool has_handle(Handles *h, uint32_t region)
{
    long   euler = euler_number(h, h->patch.items, h->patch.count, region), borders = 0;
    size_t count = 3 * h->patch.count;
    for (size_t at = next_border(h, region, 0); at < count; at = next_border(h, region, at)) {
        borders++;
        walk_border(h, region, at);
    }
    return borders == 0 || euler + borders < 2;
}

/* Marks the vertices that are nearer than half of the radius: they need no region of their own. */
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

static Handles start(const Contour *contour, double radius)
{
    Arena  *arena    = contour->arena;
    size_t  vertices = contour->vertices.count, triangles = contour->triangles.count;
    Handles h     = {.contour = contour, .radius = radius};
    h.edges       = sort_edges((const uint32_t(*)[3])contour->triangles.items, triangles, arena);
    h.taken       = arena_new_array(arena, uint32_t, triangles + 1);
    h.counted     = arena_new_array(arena, uint32_t, vertices + 1);
    h.corners     = arena_new_array(arena, uint32_t, vertices + 1);
    h.done        = arena_new_array(arena, bool, vertices + 1);
    h.walked      = arena_new_array(arena, uint32_t, 3 * triangles + 1);
    h.last_region = (uint32_t)vertices;
    return h;
}

size_t handles_count(const Contour *contour, double radius, double at[3])
{
    size_t    found = 0;
    ArenaMark mark  = arena_mark(contour->arena);
    Handles   h     = start(contour, radius);
    for (uint32_t i = 0; i < contour->vertices.count && i < h.edges.vertex_count; i++) {
        if (h.done[i])
            continue;
        find_patch(&h, i, i + 1);
        if (h.patch.count > 0 && goes_around(&h, i + 1) && found++ == 0)
            memcpy(at, contour->vertices.items[i], 3 * sizeof *at);
        mark_done(&h, i);
    }
    arena_rewind(contour->arena, mark);
    return found;
}

size_t handles_find(const Contour *contour, double radius, double (*locations)[3], size_t most)
{
    size_t    found = 0;
    ArenaMark mark  = arena_mark(contour->arena);
    Handles   h     = start(contour, radius);
    for (uint32_t i = 0; i < contour->vertices.count && i < h.edges.vertex_count; i++) {
        if (h.done[i] || found == most)
            continue;
        find_patch(&h, i, i + 1);
        if (h.patch.count > 0 && has_handle(&h, i + 1))
            memcpy(locations[found++], contour->vertices.items[i], sizeof *locations);
        mark_done(&h, i);
    }
    arena_rewind(contour->arena, mark);
    return found;
}
