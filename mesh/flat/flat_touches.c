/* flat_touches.c: searches vertices in a hashed grid, and edges in a tree of boxes. */
#include "mesh/flat/flat_touches.h"

#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/field/bvh.h"
#include "mesh/common/numbering.h"

/* ---- vertices that coincide ---- */

static NumberKey key_of_cell(const int64_t cell[3])
{
    uint64_t mixed = (uint64_t)cell[1] * 0x9e3779b97f4a7c15u;
    return (NumberKey){(uint64_t)cell[0] ^ mixed, (uint64_t)cell[2] + (mixed >> 32)};
}

/* Returns a vertex near a point, or NO_NUMBER. Cells are twice as wide as `near`, so that at most
   eight are near. */
static uint32_t find_first(const FlatVertices *vertices, const Numbering *cells, double near,
                           const double at[3])
{
    for (int i = 0; i < 8; i++) {
        int64_t cell[3];
        for (int k = 0; k < 3; k++)
            cell[k] = (int64_t)floor((at[k] + (i >> k & 1 ? near : -near)) / (2 * near));
        uint32_t found = numbering_find(cells, key_of_cell(cell));
        if (found != NO_NUMBER && distance3(vertices->items[found], at) <= near)
            return found;
    }
    return NO_NUMBER;
}

void flat_join_vertices(const FlatVertices *vertices, double near, uint32_t *first, Arena *arena)
{
    Numbering cells = {.arena = arena};
    for (uint32_t i = 0; i < vertices->count; i++) {
        const double *at    = vertices->items[i];
        uint32_t      found = find_first(vertices, &cells, near, at);
        first[i]            = found == NO_NUMBER ? i : found;
        if (found == NO_NUMBER) {
            int64_t cell[3];
            for (int k = 0; k < 3; k++)
                cell[k] = (int64_t)floor(at[k] / (2 * near));
            numbering_take(&cells, key_of_cell(cell), i);
        }
    }
}

/* ---- vertices on edges ---- */

typedef struct Search {
    const FlatVertices *vertices;
    double              near;
    uint32_t            vertex;
    FlatTouches        *touches;
    Arena              *arena;
} Search;

static bool note_touch(void *user, uint32_t edge, const double corners[3][3])
{
    Search       *search = user;
    const double *at     = search->vertices->items[search->vertex];
    double        nearest[3];
    triangle_nearest(corners, at, nearest);
    if (distance3(at, nearest) <= search->near && distance3(at, corners[0]) > search->near &&
        distance3(at, corners[1]) > search->near) {
        FlatTouch touch = {edge, search->vertex};
        array_push_large(search->arena, search->touches, touch);
    }
    return true;
}

void flat_find_touches(const FlatVertices *vertices, const uint32_t (*ends)[2], size_t count,
                       const uint32_t *first, double near, FlatTouches *touches, Arena *arena)
{
    uint32_t(*lines)[3] = (uint32_t(*)[3])arena_new_array(arena, uint32_t, 3 * count + 1);
    Bvh bvh;
    for (size_t i = 0; i < count; i++) {
        lines[i][0] = ends[i][0];
        lines[i][1] = lines[i][2] = ends[i][1];
    }
    bvh_new(&bvh, (const double(*)[3])vertices->items, (const uint32_t(*)[3])lines, count, arena);
    Search search = {.vertices = vertices, .near = near, .touches = touches, .arena = arena};
    for (uint32_t i = 0; i < vertices->count; i++)
        if (first[i] == i) {
            double low[3], high[3];
            search.vertex = i;
            for (int k = 0; k < 3; k++) {
                low[k]  = vertices->items[i][k] - near;
                high[k] = vertices->items[i][k] + near;
            }
            bvh_visit_box(&bvh, low, high, note_touch, &search);
        }
    bvh_free(&bvh, count, arena);
}
