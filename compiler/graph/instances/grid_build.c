/*
 * grid_build.c: a grid of cubic cells over boxes, in time that is linear in boxes, cells and list entries.
 * Each processor fills a slab of cells along z; lists do not depend on how many there are.
 *
 * Cells are as small as their number and the length of all lists together allow.  The distance from
 * a cell to the nearest box that it does not list is measured for boxes around the corner.  Farther
 * ones are bounded by a distance transform of the cells that have boxes.
 *
 * Shaders find the cell of a point in single precision, and may find a neighbour of it.  So boxes are
 * taken to be larger by what single precision can miss: the pad.
 */
#include "compiler/graph/instances/grid_build.h"

#include <assert.h>
#include <float.h>
#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/base/far.h"
#include "compiler/base/parallel.h"
#include "compiler/graph/instances/squares.h"

/* Most cells and entries: few instances may have more cells each, so that they may form a curve, and
   more entries, so that blends that reach far have short lists.  A loop over a list is most of a
   frame, so they are as short as memory allows. */
enum {
    CELLS_PER_INSTANCE   = 4,
    CELLS_OF_FEW         = 16, /* for each of few instances */
    MANY_CELLS           = 1 << 20,
    SPARE_CELLS          = 8192,
    MAX_OF_AN_INSTANCE   = 64, /* cells, even so */
    ENTRIES_PER_INSTANCE = 8,
    SPARE_ENTRIES        = 4096,
    MANY_TEXELS          = 1 << 23, /* of all entries of few instances: 128 MB */
    ENTRIES_OF_FEW       = 1024,    /* for each of few instances */
    MANY_REFINED         = 1 << 17, /* cells of a refined grid */
    MIN_REFINED          = 8,       /* of these for each instance */
    MANY_TO_REFINE       = 1 << 20, /* entries of a coarse one, whose instances are evaluated */
    OF_FRAME       = 8, /* cells and entries of each instance, if a grid is built each frame */
    SPARE_OF_FRAME = 4096
};

#define MARGIN_IN_CELLS 0.25  /* beyond what the caller gives */
#define RING_IN_CELLS   0.5   /* how far beyond the margin boxes are measured */
#define GROWTH          1.08  /* of the side: a quarter more volume */
#define FLAT_IN_CELLS   1.75  /* how far away what decides in a cell of a flat grid may be */
#define SMALLEST_SIDE   1e-12 /* of a cell */

/* Tells whether a box is bounded, which it is not if a coordinate is not a number. */
static bool box_is_bounded(const Box *box)
{
    for (int k = 0; k < 3; k++)
        if (!(box->axis[k].low > -FAR_SIDE && box->axis[k].high < FAR_SIDE))
            return false;
    return true;
}

typedef struct Builder {
    Grid         *grid;
    const Box    *boxes;
    uint32_t      count, present; /* boxes; those that are not empty */
    double        reach, margin;
    double        given_margin;
    uint32_t      texels;      /* of an entry */
    bool          coarse, few; /* it will be refined; with half the cells, since lists are long */
    GridLimits    most;        /* 0: as for all frames */
    double        pad[3];
    double        listed, seen; /* boxes up to this distance are in the list, or are measured */
    float        *nearest; /* of each cell: the square of the distance to the nearest box that is
                                seen and not listed */
    GridInstances flat;    /* of a flat grid */
    double        half;    /* and half the diagonal of its cells, */
    float *centers;   /* and of each cell the distance from its center to the nearest instance */
    bool   measuring; /* these distances */
    Arena *scratch;
} Builder;

/* Cells from first to last along each axis. */
typedef struct Cover {
    uint32_t first[3], last[3];
} Cover;

/* Cells [low, high) along an axis, of which one processor fills the lists. */
typedef struct Slab {
    int      axis; /* z, or y in a flat grid */
    uint32_t low, high;
} Slab;

/* ---- Cells around boxes ---- */

bool grid_box_is_empty(const Box *box)
{
    for (int k = 0; k < 3; k++)
        if (box->axis[k].low > box->axis[k].high)
            return true;
    return false;
}

/* Returns the cells that are up to `distance` away from a box along each axis. */
static Cover cover_box(const Builder *b, const Box *box, double distance)
{
    Cover cover;
    for (int k = 0; k < 3; k++) {
        double grown   = distance + b->pad[k];
        cover.first[k] = grid_cell_along(b->grid, k, box->axis[k].low - grown);
        cover.last[k]  = grid_cell_along(b->grid, k, box->axis[k].high + grown);
    }
    return cover;
}

/* Returns the slab of a processor. */
static Slab slab_of_part(const Builder *b, size_t part, size_t parts)
{
    int      axis  = b->flat.distance ? 1 : 2;
    uint32_t cells = b->grid->cells[axis];
    return (Slab){axis, (uint32_t)part_begin(cells, part, parts),
                  (uint32_t)part_begin(cells, part + 1, parts)};
}

static Cover cover_in_slab(Cover cover, Slab slab)
{
    uint32_t *first = &cover.first[slab.axis], *last = &cover.last[slab.axis];
    *first = *first > slab.low ? *first : slab.low;
    *last  = *last < slab.high ? *last : slab.high - 1;
    return cover;
}

/* ---- One cell for all of space ---- */

static bool all_are_bounded(const Builder *b)
{
    for (uint32_t i = 0; i < b->count; i++)
        if (!grid_box_is_empty(&b->boxes[i]) && !box_is_bounded(&b->boxes[i]))
            return false;
    return b->given_margin < FAR_SIDE && b->reach < FAR_SIDE;
}

static void one_cell(Builder *b, Arena *arena)
{
    Grid *grid = b->grid;
    *grid      = (Grid){.inner      = {{ANYTHING, ANYTHING, ANYTHING}},
                        .size       = HUGE_VAL,
                        .cells      = {1, 1, 1},
                        .first      = arena_new_array(arena, uint32_t, 2),
                        .clearance  = arena_new(arena, float),
                        .instances  = arena_new_array(arena, uint32_t, b->count),
                        .max_listed = b->present};

    for (uint32_t i = 0; i < b->count; i++)
        if (!grid_box_is_empty(&b->boxes[i]))
            grid->instances[grid->first[1]++] = i;
    grid->clearance[0] = (float)NOWHERE;
}

/* ---- Size of the cells ---- */

static void find_inner(Builder *b)
{
    Box *inner = &b->grid->inner;
    for (int k = 0; k < 3; k++)
        inner->axis[k] = (Range){HUGE_VAL, -HUGE_VAL};
    for (uint32_t i = 0; i < b->count; i++)
        for (int k = 0; k < 3 && !grid_box_is_empty(&b->boxes[i]); k++) {
            inner->axis[k].low  = fmin(inner->axis[k].low, b->boxes[i].axis[k].low);
            inner->axis[k].high = fmax(inner->axis[k].high, b->boxes[i].axis[k].high);
        }
    for (int k = 0; k < 3; k++) {
        Range *axis = &inner->axis[k];
        *axis       = (Range){axis->low - b->reach, axis->high + b->reach};
        b->pad[k]   = FLOAT_MISSES * (range_largest(*axis) + axis->high - axis->low);
    }
}

/* Places one layer of cells around the plane. */
static void place_flat(Builder *b)
{
    Grid *grid     = b->grid;
    grid->low[2]   = (float)(-0.5 * grid->size);
    grid->cells[2] = 1;
    b->half        = M_SQRT1_2 * grid->size + b->pad[0] + b->pad[1];
    b->seen        = fmax(b->seen, FLAT_IN_CELLS * grid->size + b->pad[0] + b->pad[1]);
}

/* Places cells of this side around `inner` and a margin.  Corners are single precision numbers, and
   so is 1 / side, as shaders have them. */
static void place_cells(Builder *b, double side)
{
    Grid *grid = b->grid;
    grid->size = 1 / (double)(float)(1 / side);
    /* Rounding a clearance down leaves the margin. */
    b->margin = (b->given_margin + MARGIN_IN_CELLS * grid->size) * (1 + 8 * FLOAT_MISSES);
    b->listed = b->margin + b->reach;
    b->seen   = b->listed + RING_IN_CELLS * grid->size;
    for (int k = 0; k < 3; k++) {
        Range  axis    = grid->inner.axis[k];
        double edge    = b->margin + 2 * b->pad[k];
        grid->low[k]   = nextafterf((float)(axis.low - edge), -HUGE_VALF);
        double along   = ceil((axis.high + edge - grid->low[k]) / grid->size);
        grid->cells[k] = (uint32_t)fmin(fmax(along, 1), UINT32_MAX);
    }
    if (b->flat.distance)
        place_flat(b);
}

static double placed_cells(const Grid *grid)
{
    return (double)grid->cells[0] * grid->cells[1] * grid->cells[2];
}

static double max_cells(const Builder *b)
{
    if (b->most.cells > 0)
        return b->most.cells;
    if (b->coarse)
        return fmin((double)MAX_OF_AN_INSTANCE * b->present,
                    b->few ? MANY_REFINED / 2 : MANY_REFINED) /
               GRID_REFINED;
    double few = fmin((double)CELLS_OF_FEW * b->present, MANY_CELLS);
    return fmin(fmax((double)CELLS_PER_INSTANCE * b->present, few) + SPARE_CELLS,
                (double)MAX_OF_AN_INSTANCE * b->present);
}

static double max_entries(const Builder *b)
{
    if (b->most.entries > 0)
        return b->most.entries;
    double few = fmin((double)ENTRIES_OF_FEW * b->present, (double)MANY_TEXELS / b->texels);
    return fmax((double)ENTRIES_PER_INSTANCE * b->present, few) + SPARE_ENTRIES;
}

/* Returns the least side with few enough cells. */
static double min_side(Builder *b)
{
    double most    = max_cells(b);
    double longest = 0;
    for (int k = 0; k < 3; k++) {
        Range axis = b->grid->inner.axis[k];
        longest    = fmax(longest, axis.high - axis.low + 4 * b->pad[k] + 2 * b->given_margin);
    }
    longest     = fmax(longest, SMALLEST_SIDE);
    double low  = fmax(longest / (2 * most), SMALLEST_SIDE);
    double high = 4 * longest;
    for (int i = 0; i < 40 && high > 1.01 * low; i++) {
        double side = sqrt(low * high);
        place_cells(b, side);
        *(placed_cells(b->grid) > most ? &low : &high) = side;
    }
    return high;
}

/* Returns no fewer than the entries of all lists. */
static double count_entries(const Builder *b)
{
    double entries = 0;
    for (uint32_t i = 0; i < b->count; i++) {
        if (grid_box_is_empty(&b->boxes[i]))
            continue;
        double far   = b->flat.distance ? fmax(b->listed, b->grid->size) : b->listed;
        Cover  cover = cover_box(b, &b->boxes[i], far);
        double cells = 1;
        for (int k = 0; k < 3; k++)
            cells *= (double)(cover.last[k] - cover.first[k]) + 1;
        entries += cells;
    }
    return entries;
}

/* Chooses the size of cells.  In the end there is one cell, which has as many entries as there are
   boxes. */
static void choose_cells(Builder *b)
{
    double side = min_side(b);
    for (place_cells(b, side); count_entries(b) > max_entries(b); place_cells(b, side))
        side *= GROWTH;
}

/* ---- Lists ---- */

/* Returns the gap between a box and a cell along an axis; 0 where they overlap. */
static double gap_along(const Builder *b, const Box *box, int axis, uint32_t cell)
{
    double low   = b->grid->low[axis] + cell * b->grid->size;
    double above = box->axis[axis].low - b->pad[axis] - (low + b->grid->size);
    double below = low - box->axis[axis].high - b->pad[axis];
    double gap   = above > below ? above : below;
    return gap > 0 ? gap : 0;
}

/* Adds an instance to the list of a cell, or counts it. */
static void put_in_list(Grid *grid, size_t cell, uint32_t instance)
{
    if (grid->instances)
        grid->instances[grid->first[cell]++] = instance;
    else
        grid->first[cell]++;
}

/* Replaces the lengths of lists by where they begin. */
void grid_begin_lists(Grid *grid, Arena *arena)
{
    size_t   cells   = grid_cell_count(grid);
    uint32_t entries = 0;
    grid->max_listed = 0;
    for (size_t c = 0; c < cells; c++) {
        uint32_t length = grid->first[c];
        if (length > grid->max_listed)
            grid->max_listed = length;
        grid->first[c] = entries;
        entries += length;
    }
    grid->instances = arena_new_array(arena, uint32_t, entries + 1);
}

/* Ends the lists: each first[] is where the next list begins. */
void grid_end_lists(Grid *grid)
{
    for (size_t c = grid_cell_count(grid); c > 0; c--)
        grid->first[c] = grid->first[c - 1];
    grid->first[0] = 0;
}

/* Visits cells of a slab around a box.  First their lists are counted, in first[]; when there are
   instances, they are filled, and first[] moves on. */
static void visit_cells(const Builder *b, uint32_t instance, Slab slab)
{
    const Grid *grid   = b->grid;
    const Box  *box    = &b->boxes[instance];
    double      listed = b->listed * b->listed;
    Cover       cover  = cover_box(b, box, grid->instances ? b->listed : b->seen);
    cover              = cover_in_slab(cover, slab);
    for (uint32_t z = cover.first[2]; z <= cover.last[2]; z++) {
        double gap_z = gap_along(b, box, 2, z);
        for (uint32_t y = cover.first[1]; y <= cover.last[1]; y++) {
            double gap_y = gap_along(b, box, 1, y), square = gap_y * gap_y + gap_z * gap_z;
            size_t row = ((size_t)z * grid->cells[1] + y) * grid->cells[0];
            for (uint32_t x = cover.first[0]; x <= cover.last[0]; x++) {
                double gap = gap_along(b, box, 0, x), apart = square + gap * gap;
                if (apart > listed) {
                    if (apart < b->nearest[row + x])
                        b->nearest[row + x] = (float)apart;
                } else
                    put_in_list(b->grid, row + x, instance);
            }
        }
    }
}

/* Visits a flat cell.  What is true of its center is true of all of it but for half of the
   diagonal. */
static void visit_flat_cell(const Builder *b, uint32_t instance, size_t cell,
                            const double center[2], double gap)
{
    float *nearest = &b->centers[cell];
    double away    = b->flat.distance(b->flat.instances, instance, center);
    double least   = fmax(away - b->half, gap);
    if (b->measuring)
        *nearest = fminf(*nearest, (float)(away * (1 - FLOAT_MISSES)));
    else if (least <= b->listed ||
             (*nearest <= b->half &&
              away <= (double)*nearest * (1 + 4 * FLOAT_MISSES) + 2 * b->half))
        put_in_list(b->grid, cell, instance);
    else
        b->nearest[cell] = fminf(b->nearest[cell], (float)(least * least));
}

static void visit_flat_cells(const Builder *b, uint32_t instance, Slab slab)
{
    const Grid *grid  = b->grid;
    const Box  *box   = &b->boxes[instance];
    Cover       cover = cover_in_slab(cover_box(b, box, b->seen), slab);
    for (uint32_t y = cover.first[1]; y <= cover.last[1]; y++) {
        double gap_y = gap_along(b, box, 1, y);
        for (uint32_t x = cover.first[0]; x <= cover.last[0]; x++) {
            double center[2] = {grid->low[0] + (x + 0.5) * grid->size,
                                grid->low[1] + (y + 0.5) * grid->size};
            visit_flat_cell(b, instance, (size_t)y * grid->cells[0] + x, center,
                            real_hypot(gap_along(b, box, 0, x), gap_y));
        }
    }
}

/* Visits the lists of a slab. */
static void visit_all(void *task, size_t part, size_t parts)
{
    const Builder *b    = task;
    Slab           slab = slab_of_part(b, part, parts);
    for (uint32_t i = 0; i < b->count && slab.low < slab.high; i++)
        if (grid_box_is_empty(&b->boxes[i]))
            continue;
        else if (b->flat.distance)
            visit_flat_cells(b, i, slab);
        else
            visit_cells(b, i, slab);
}

/* Returns a distance for each cell, to be found. */
static float *endless_distances(const Builder *b)
{
    const size_t cells     = grid_cell_count(b->grid);
    float       *distances = arena_new_array(b->scratch, float, cells);
    for (size_t c = 0; c < cells; c++)
        distances[c] = HUGE_VALF;
    return distances;
}

static void measure_centers(Builder *b)
{
    b->centers   = endless_distances(b);
    b->measuring = true;
    run_in_parallel(visit_all, b);
    b->measuring = false;
}

static void fill_lists(Builder *b, Arena *arena)
{
    Grid *grid  = b->grid;
    grid->first = arena_new_array(arena, uint32_t, grid_cell_count(grid) + 1);
    b->nearest  = endless_distances(b);
    if (b->flat.distance)
        measure_centers(b);
    run_in_parallel(visit_all, b);

    grid_begin_lists(grid, arena);
    run_in_parallel(visit_all, b);
    grid_end_lists(grid);
}

/* ---- Distances in cells to the nearest cell with a box ---- */

/* Marks cells that touch a cell with a part of this box by 0. */
static void mark_box(const Builder *b, const Box *box, double *squares, Slab slab)
{
    const Grid *grid  = b->grid;
    Cover       cover = cover_box(b, box, 0);
    for (int k = 0; k < 3; k++) {
        cover.first[k] -= cover.first[k] > 0;
        cover.last[k] += cover.last[k] + 1 < grid->cells[k];
    }
    cover = cover_in_slab(cover, slab);
    for (uint32_t z = cover.first[2]; z <= cover.last[2]; z++)
        for (uint32_t y = cover.first[1]; y <= cover.last[1]; y++)
            for (uint32_t x = cover.first[0]; x <= cover.last[0]; x++)
                squares[((size_t)z * grid->cells[1] + y) * grid->cells[0] + x] = 0;
}

/* The task of marking all boxes. */
typedef struct Marking {
    const Builder *builder;
    double        *squares;
} Marking;

static void mark_all(void *task, size_t part, size_t parts)
{
    const Marking *marking = task;
    const Builder *b       = marking->builder;
    Slab           slab    = slab_of_part(b, part, parts);
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

/* Finds the clearances when all lists are filled. */
static void find_clearances(const Builder *b, Arena *arena)
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

/* ---- All ---- */

/* Begins to build; false: nothing has an end, or there is nothing. */
static bool begin(Builder *b)
{
    *b->grid = (Grid){0};
    for (uint32_t i = 0; i < b->count; i++)
        b->present += !grid_box_is_empty(&b->boxes[i]);
    if (b->present == 0 || !all_are_bounded(b))
        return false;
    find_inner(b);
    return true;
}

static void fill(Builder *b, Arena *arena)
{
    fill_lists(b, arena);
    find_clearances(b, arena);
}

static void build(Builder *b, Arena *arena)
{
    if (!begin(b)) {
        one_cell(b, arena);
        return;
    }
    choose_cells(b);
    fill(b, arena);
}

static Builder builder_new(Grid *grid, const Box *boxes, uint32_t count, double reach,
                           double margin, Arena *scratch)
{
    assert(count > 0);
    return (Builder){.grid         = grid,
                     .boxes        = boxes,
                     .count        = count,
                     .reach        = reach,
                     .given_margin = margin,
                     .texels       = 1,
                     .scratch      = scratch};
}

void grid_build(Grid *grid, const Box *boxes, uint32_t count, double reach, double margin,
                uint32_t texels, Arena *arena, Arena *scratch)
{
    Builder b = builder_new(grid, boxes, count, reach, margin, scratch);
    assert(texels > 0);
    b.texels = texels;
    build(&b, arena);
}

/* Returns the limits of few and large cells, of which an instance is in 8 at most. */
GridLimits grid_limits_of_frame(uint32_t count)
{
    const double most = (double)OF_FRAME * count + SPARE_OF_FRAME;
    return (GridLimits){most, most};
}

void grid_build_within(Grid *grid, const Box *boxes, uint32_t count, double reach, double margin,
                       GridLimits most, Arena *arena, Arena *scratch)
{
    Builder b = builder_new(grid, boxes, count, reach, margin, scratch);
    assert(most.cells >= 8 && most.entries >= 8 * (double)count);
    b.most = most;
    build(&b, arena);
}

/* Places large cells, if there are few enough boxes. */
static bool place_coarse(Builder *b)
{
    b->coarse = true;
    if (!begin(b) || (double)MIN_REFINED * b->present > MANY_REFINED)
        return false;
    place_cells(b, min_side(b));
    return true;
}

bool grid_place_coarse(Grid *grid, const Box *boxes, uint32_t count, double reach, double margin,
                       bool few, Arena *scratch)
{
    Builder b = builder_new(grid, boxes, count, reach, margin, scratch);
    b.few     = few;
    return place_coarse(&b);
}

bool grid_build_coarse(Grid *grid, const Box *boxes, uint32_t count, double reach, double margin,
                       Arena *arena, Arena *scratch)
{
    Builder b = builder_new(grid, boxes, count, reach, margin, scratch);
    if (!place_coarse(&b))
        return false;
    if (count_entries(&b) > MANY_TO_REFINE)
        return false;
    fill(&b, arena);
    return true;
}

void grid_build_flat(Grid *grid, const Box *boxes, uint32_t count, double margin, uint32_t texels,
                     GridInstances instances, Arena *arena, Arena *scratch)
{
    Builder b = builder_new(grid, boxes, count, 0, margin, scratch);
    assert(texels > 0);
    b.texels = texels;
    b.flat   = instances;
    build(&b, arena);
}
