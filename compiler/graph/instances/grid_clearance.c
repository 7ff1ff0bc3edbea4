/*
 * grid_clearance.c: how far all is that the list of a cell does not have.
 */
#include <float.h>
#include <math.h>

#include "compiler/base/far.h"
#include "compiler/base/parallel.h"
#include "compiler/graph/instances/grid_builder.h"
#include "compiler/graph/instances/squares.h"

/* ---- Cells around boxes ---- */

bool grid_box_is_empty(const Box *box)
{
    for (int k = 0; k < 3; k++)
        if (box->axis[k].low > box->axis[k].high)
            return true;
    return false;
}

Cover grid_cover_box(const Builder *b, const Box *box, double distance)
{
    Cover cover;
    for (int k = 0; k < 3; k++) {
        double grown   = distance + b->pad[k];
        cover.first[k] = grid_cell_along(b->grid, k, box->axis[k].low - grown);
        cover.last[k]  = grid_cell_along(b->grid, k, box->axis[k].high + grown);
    }
    return cover;
}

Slab grid_slab_of_part(const Builder *b, size_t part, size_t parts)
{
    int      axis  = b->flat.distance ? 1 : 2;
    uint32_t cells = b->grid->cells[axis];
    return (Slab){axis, (uint32_t)part_begin(cells, part, parts),
                  (uint32_t)part_begin(cells, part + 1, parts)};
}

Cover grid_cover_in_slab(Cover cover, Slab slab)
{
    uint32_t *first = &cover.first[slab.axis], *last = &cover.last[slab.axis];
    *first = *first > slab.low ? *first : slab.low;
    *last  = *last < slab.high ? *last : slab.high - 1;
    return cover;
}

/* ---- Distances in cells to the nearest cell with a box ---- */

/* 0 in cells that touch a cell with a part of this box. */
static void mark_box(const Builder *b, const Box *box, double *squares, Slab slab)
{
    const Grid *grid  = b->grid;
    Cover       cover = grid_cover_box(b, box, 0);
    for (int k = 0; k < 3; k++) {
        cover.first[k] -= cover.first[k] > 0;
        cover.last[k] += cover.last[k] + 1 < grid->cells[k];
    }
    cover = grid_cover_in_slab(cover, slab);
    for (uint32_t z = cover.first[2]; z <= cover.last[2]; z++)
        for (uint32_t y = cover.first[1]; y <= cover.last[1]; y++)
            for (uint32_t x = cover.first[0]; x <= cover.last[0]; x++)
                squares[((size_t)z * grid->cells[1] + y) * grid->cells[0] + x] = 0;
}

/* Of all boxes. */
typedef struct Marking {
    const Builder *builder;
    double        *squares;
} Marking;

static void mark_all(void *task, size_t part, size_t parts)
{
    const Marking *marking = task;
    const Builder *b       = marking->builder;
    Slab           slab    = grid_slab_of_part(b, part, parts);
    for (uint32_t i = 0; i < b->count && slab.low < slab.high; i++)
        if (!grid_box_is_empty(&b->boxes[i]))
            mark_box(b, &b->boxes[i], marking->squares, slab);
}

/* Squares of lower bounds on the distance between a cell and the nearest box, in cells.  The walls
   of cells i and k are |i - k| - 1 cells apart: as far as centers when one of them touches. */
static double *cells_to_boxes(const Builder *b)
{
    size_t  cells   = grid_cell_count(b->grid);
    Marking marking = {b, arena_new_array(b->scratch, double, cells)};
    for (size_t c = 0; c < cells; c++)
        marking.squares[c] = HUGE_VAL;
    run_in_parallel(mark_all, &marking);
    squares_transform(b->grid->cells, marking.squares, b->scratch);
    return marking.squares;
}

/* ---- Clearance ---- */

static float rounded_down(double number) { return (float)fmax(number * ROUNDED_DOWN, FLT_MIN); }

void grid_find_clearances(const Builder *b, Arena *arena)
{
    Grid         *grid    = b->grid;
    size_t        cells   = grid_cell_count(grid);
    const double *squares = cells_to_boxes(b);
    grid->clearance       = arena_new_array(arena, float, cells);
    for (size_t c = 0; c < cells; c++) {
        double seen = fmin(sqrt((double)b->nearest[c]) * ROUNDED_DOWN, b->seen);
        double far  = fmax(seen, sqrt(squares[c]) * grid->size);
        bool   all  = grid->first[c + 1] - grid->first[c] == b->present ||
                   (b->flat.distance && (double)b->centers[c] <= b->half);

        grid->clearance[c] = all ? (float)NOWHERE : rounded_down(fmax(far - b->reach, b->margin));
    }
}
