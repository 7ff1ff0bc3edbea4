/* flat_separate.c: pairs each edge with one that goes back along it, and splits vertices by the
   triangles around them. */
#include "mesh/flat/flat_separate.h"

#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "mesh/common/numbering.h"

/* Edges of triangles: edge 3 t + k is from corner k of triangle t to the next. */
typedef struct Edges {
    Arena              *arena;
    const FlatVertices *vertices;
    const Triangles    *triangles;
    Numbering           numbers; /* the first edge from one vertex to another */
    uint32_t           *next;    /* edges between the same vertices; NO_NUMBER ends them */
    uint32_t           *back;    /* the edge that goes back; NO_NUMBER: it has not been found */
    uint32_t           *one; /* union-find of corners that share a vertex: another one, or itself */
} Edges;

static uint32_t corner_of(const Edges *e, uint32_t edge, uint32_t behind)
{
    return e->triangles->items[edge / 3][(edge % 3 + behind) % 3];
}

static uint32_t first_edge(const Edges *e, uint32_t from, uint32_t to)
{
    return numbering_find(&e->numbers, (NumberKey){from, to});
}

static void list_edges(Edges *e)
{
    e->numbers = (Numbering){.arena = e->arena};
    for (uint32_t i = 0; i < 3 * e->triangles->count; i++) {
        NumberKey key   = {corner_of(e, i, 0), corner_of(e, i, 1)};
        uint32_t  first = numbering_take(&e->numbers, key, i);
        e->next[i]      = NO_NUMBER;
        if (first != i) {
            e->next[i]     = e->next[first];
            e->next[first] = i;
        }
    }
}

/* Finds the direction of an edge, and the direction across it into its triangle. */
static void frame_of(const Edges *e, uint32_t edge, double along[3], double into[3])
{
    const double(*at)[3] = (const double(*)[3])e->vertices->items;
    const double *from = at[corner_of(e, edge, 0)], *to = at[corner_of(e, edge, 1)];
    add_scaled3(along, to, -1, from);
    normalize3(along);
    add_scaled3(into, at[corner_of(e, edge, 2)], -1, from);
    add_scaled3(into, into, -dot3(into, along), along);
    normalize3(into);
}

/* Returns the angle through the solid from a triangle to another one with the same edge. */
static double angle_through(const Edges *e, uint32_t edge, uint32_t other)
{
    static const double NONE = 1e-9;
    double              along[3], into[3], other_along[3], other_into[3], outwards[3];
    frame_of(e, edge, along, into);
    frame_of(e, other, other_along, other_into);
    cross3(along, into, outwards);
    double angle = real_atan2(-dot3(other_into, outwards), dot3(other_into, into));
    return angle > NONE ? angle : angle + 2 * M_PI;
}

static bool find_back(Edges *e, uint32_t edge)
{
    double   least = HUGE_VAL;
    uint32_t other = first_edge(e, corner_of(e, edge, 1), corner_of(e, edge, 0)), best = other;
    bool     single = other != NO_NUMBER && e->next[other] == NO_NUMBER &&
                  e->next[first_edge(e, corner_of(e, edge, 0), corner_of(e, edge, 1))] == NO_NUMBER;
    for (; other != NO_NUMBER && !single; other = e->next[other]) {
        double angle = angle_through(e, edge, other);
        if (e->back[other] == NO_NUMBER && angle < least) {
            least = angle;
            best  = other;
        }
    }
    if (best == NO_NUMBER || e->back[best] != NO_NUMBER)
        return false;
    e->back[edge] = best;
    e->back[best] = edge;
    return true;
}

static uint32_t one_of(Edges *e, uint32_t corner)
{
    while (e->one[corner] != corner)
        corner = e->one[corner] = e->one[e->one[corner]];
    return corner;
}

static void share(Edges *e, uint32_t first, uint32_t second)
{
    uint32_t a = one_of(e, first), b = one_of(e, second);
    e->one[a < b ? b : a] = a < b ? a : b;
}

static uint32_t next_corner(uint32_t corner) { return corner - corner % 3 + (corner % 3 + 1) % 3; }

/* Gives a new vertex to each further group of triangles around a vertex; the first group keeps
   it. */
static void number_corners(Edges *e, FlatVertices *vertices, Triangles *triangles, Arena *arena)
{
    size_t    count = vertices->count;
    uint32_t *keeps = arena_new_array(arena, uint32_t, count + 1); /* the corners, plus 1 */
    uint32_t *takes = arena_new_array(arena, uint32_t, 3 * triangles->count + 1);
    memset(keeps, 0, count * sizeof *keeps);
    for (uint32_t i = 0; i < 3 * triangles->count; i++) {
        uint32_t vertex = triangles->items[i / 3][i % 3], corners = one_of(e, i);
        if (corners == i && keeps[vertex] != 0) {
            array_reserve_large(arena, vertices);
            memcpy(vertices->items[vertices->count], vertices->items[vertex],
                   sizeof vertices->items[0]);
            takes[i] = (uint32_t)vertices->count++;
        } else if (corners == i) {
            keeps[vertex] = i + 1;
            takes[i]      = vertex;
        }
    }
    for (uint32_t i = 0; i < 3 * triangles->count; i++)
        triangles->items[i / 3][i % 3] = takes[one_of(e, i)];
}

/* Splits one triangle at the middle of an edge. */
static void split_triangle(Triangles *triangles, uint32_t edge, uint32_t middle, Arena *arena)
{
    array_reserve_large(arena, triangles);
    uint32_t *own = triangles->items[edge / 3], *fresh = triangles->items[triangles->count++];
    uint32_t  from = edge % 3, to = (edge % 3 + 1) % 3;
    memcpy(fresh, own, sizeof triangles->items[0]);
    own[to]     = middle;
    fresh[from] = middle;
}

/* Splits an edge in its middle for one of two pairs of triangles that still share it, since all are
   around the same vertices.  Splits each triangle once at most; returns whether any was split. */
static bool split_edges(Edges *e, FlatVertices *vertices, Triangles *triangles, Arena *arena)
{
    uint32_t count   = (uint32_t)(3 * triangles->count);
    bool    *touched = arena_new_array(arena, bool, triangles->count + 1), any = false;
    memset(touched, 0, triangles->count);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t back  = e->back[i];
        uint32_t first = first_edge(e, corner_of(e, i, 0), corner_of(e, i, 1));
        if (first == i || i > back || touched[i / 3] || touched[back / 3] ||
            back == first_edge(e, corner_of(e, i, 1), corner_of(e, i, 0)))
            continue;
        const double(*at)[3] = (const double(*)[3])vertices->items;
        const double *from = at[corner_of(e, i, 0)], *to = at[corner_of(e, i, 1)];
        double        middle[3];
        for (int k = 0; k < 3; k++)
            middle[k] = 0.5 * (from[k] + to[k]);
        array_reserve_large(arena, vertices);
        memcpy(vertices->items[vertices->count], middle, sizeof middle);
        split_triangle(triangles, i, (uint32_t)vertices->count, arena);
        split_triangle(triangles, back, (uint32_t)vertices->count, arena);
        vertices->count++;
        touched[i / 3] = touched[back / 3] = any = true;
    }
    return any;
}

/* Pairs edges, and gives each group of triangles its vertex; returns false if the triangles are not
   closed. */
static bool pair_edges(Edges *e, FlatVertices *vertices, Triangles *triangles, Arena *arena)
{
    size_t count = 3 * triangles->count;
    *e           = (Edges){.arena     = arena,
                           .vertices  = vertices,
                           .triangles = triangles,
                           .next      = arena_new_array(arena, uint32_t, count + 1),
                           .back      = arena_new_array(arena, uint32_t, count + 1),
                           .one       = arena_new_array(arena, uint32_t, count + 1)};
    for (uint32_t i = 0; i < count; i++) {
        e->back[i] = NO_NUMBER;
        e->one[i]  = i;
    }
    list_edges(e);
    for (uint32_t i = 0; i < count; i++)
        if (e->back[i] == NO_NUMBER && !find_back(e, i))
            return false;
    for (uint32_t i = 0; i < count; i++) {
        share(e, i, next_corner(e->back[i]));
        share(e, next_corner(i), e->back[i]);
    }
    number_corners(e, vertices, triangles, arena);
    return true;
}

bool flat_separate(FlatVertices *vertices, Triangles *triangles, Arena *arena)
{
    enum { ROUNDS = 8 };
    Edges e;
    for (int i = 0; i < ROUNDS; i++) {
        if (!pair_edges(&e, vertices, triangles, arena))
            return false;
        list_edges(&e);
        if (!split_edges(&e, vertices, triangles, arena))
            return true;
    }
    return false;
}
