/* slivers.c: flips edges of triangles without area, which come of straight edges that are
   simplified. */
#include "mesh/simplify/slivers.h"

#include <string.h>

#include "compiler/base/vec.h"

enum { MAX_ROUNDS = 12 };
/* The height over the longest edge below which a triangle is a sliver. */
static const double THIN = 1e-6;

typedef struct Flipping {
    const double (*vertices)[3];
    uint32_t (*triangles)[3];
    TriangleEdges edges;
    bool         *changed; /* triangles that the edges no longer know */
} Flipping;

/* Returns the corner from which the longest edge of a sliver begins; -1 if it is none. */
static int longest_of_sliver(const Flipping *f, uint32_t triangle)
{
    const uint32_t *corners = f->triangles[triangle];
    double          edges[3][3], cross[3], most = 0;
    int             longest = 0;
    for (int c = 0; c < 3; c++) {
        add_scaled3(edges[c], f->vertices[corners[(c + 1) % 3]], -1, f->vertices[corners[c]]);
        double length = length3(edges[c]);
        if (length > most) {
            most    = length;
            longest = c;
        }
    }
    cross3(edges[0], edges[1], cross);
    return length3(cross) < THIN * most * most ? longest : -1;
}

static bool flip(Flipping *f, uint32_t sliver, int longest)
{
    uint32_t *own = f->triangles[sliver], a = own[longest], b = own[(longest + 1) % 3],
             c = own[(longest + 2) % 3], d = 0;
    const TriangleEdge *back = find_edge(&f->edges, b, a);
    if (!back || f->changed[sliver] || f->changed[back->triangle])
        return false;
    uint32_t *other = f->triangles[back->triangle];
    for (int k = 0; k < 3; k++)
        if (other[k] != a && other[k] != b)
            d = other[k];
    if (c == d || find_edge(&f->edges, c, d) || find_edge(&f->edges, d, c))
        return false;
    f->changed[sliver] = f->changed[back->triangle] = true;
    memcpy(own, (const uint32_t[3]){a, d, c}, sizeof f->triangles[0]);
    memcpy(other, (const uint32_t[3]){d, b, c}, sizeof f->triangles[0]);
    return true;
}

void flip_slivers(const double (*vertices)[3], uint32_t (*triangles)[3], size_t count, Arena *arena)
{
    Flipping f   = {.vertices = vertices, .triangles = triangles};
    bool     any = true;
    for (int round = 0; round < MAX_ROUNDS && any; round++) {
        ArenaMark mark = arena_mark(arena);
        f.edges        = sort_edges((const uint32_t(*)[3])triangles, count, arena);
        f.changed      = arena_new_array(arena, bool, count + 1);
        any            = false;
        for (uint32_t i = 0; i < count; i++) {
            int longest = longest_of_sliver(&f, i);
            if (longest >= 0 && flip(&f, i, longest))
                any = true;
        }
        arena_rewind(arena, mark);
    }
}
