/*
 * grid_refine.c: which members of a list change a blend in a part of its cell.
 *
 * Distances of the members are evaluated in the middle of each part.  Elsewhere in it they differ by no more
 * than their slope permits.  Members are joined in the order of the list, and what they make, the running
 * value, has the same slope.  So a member changes nothing in a part
 * - if it is nowhere less than `acts` above the running value before it; or
 * - if it is nowhere less than the reach above the result, or above the clearance of the cell.
 * Where results are large, no member is needed: the least of them is the clearance.
 *
 * A cell is halved along each axis, and each half again, with the members that the first has left.
 */
#include "compiler/graph/grid_refine.h"

#include <math.h>
#include <string.h>

#include "compiler/base/bits.h"
#include "compiler/base/far.h"
#include "compiler/base/parallel.h"
#include "compiler/graph/grid_builder.h"
#include "compiler/graph/op_values.h"

/* Parts of a cell: bit k of a part's number is its place along axis k. */
enum { PARTS = 8 };

/* Lists are empty where results are at least so many sides of a refined cell, beyond the margin.  Half and
   twice as many are no faster. */
#define EMPTY_IN_CELLS 1.0

/* What one processor works with: for each member of the list at hand */
typedef struct Desk {
    void *rows; /* of lanes */
    double (*distances)[PARTS];
    uint8_t  *needs[2]; /* which parts need it, of a cell and of one of its parts */
    uint32_t *places;   /* in the list of the cell, of what a part needs */
} Desk;

typedef struct Refiner {
    Grid            *to;
    const Grid      *from;
    const GridBlend *blend;
    double           pad;
    double           empty; /* from which results on */
    uint64_t        *masks; /* of each entry of a coarse list, the refined cells that need it */
    size_t           offsets[GRID_REFINED]; /* of refined cells from the first in a coarse one */
    Desk             desks[MOST_PARTS];
} Refiner;

/* A cell that is halved. */
typedef struct Halving {
    double          low[3], size;
    const uint32_t *members, *places; /* members[places[i]], count of them */
    uint32_t        count;
    double          clearance;    /* of the coarse cell */
    double          least[PARTS]; /* no result in a part is less */
} Halving;

/* Running values after one more member, in the middle of each part. */
static void join_member(const GridBlend *blend, double *running, const double *distances)
{
    const double k = blend->width, n = 1;
    (void)n;
    switch (blend->op) {
#define BLEND(name, signature, slope, bulge, most, reach, acts, cost, facts, glsl, value, ...) \
    case OP_smin_##name:                                                                       \
        for (int i = 0; i < PARTS; i++) {                                                      \
            const double a = running[i], b = distances[i], t = fabs(a - b) / k;                \
            const double h = fmax(1 - t, 0);                                                   \
            (void)t, (void)h;                                                                  \
            running[i] = (value);                                                              \
        }                                                                                      \
        return;
#include "compiler/graph/blends.def"
    default: return;
    }
}

/* Joins all members; those that never act are not needed. */
static void join_all(const Refiner *r, const Desk *desk, uint8_t *needs, const Halving *h,
                     double away, double *running)
{
    const GridBlend *blend = r->blend;
    LaneTape         tape  = *blend->tape;
    LaneWork         work  = lane_work_in(desk->rows, NULL);
    double           points[PARTS][3];
    for (int part = 0; part < PARTS; part++) {
        running[part] = NOWHERE;
        for (int k = 0; k < 3; k++)
            points[part][k] = h->low[k] + ((part >> k & 1) + 0.5) * 0.5 * h->size;
    }
    LanePoints middles = {.points = (const double(*)[3])points, .count = PARTS};
    for (uint32_t i = 0; i < h->count; i++) {
        double  *distances = desk->distances[i];
        uint32_t needed    = 0;
        size_t   member    = h->members[h->places[i]];
        tape.scalars       = blend->scalars + member * tape.scalar_count;
        lane_run(&tape, &work, LANE_DOUBLE, middles, 0, 1, distances);
        for (int part = 0; part < PARTS; part++)
            needed |= (uint32_t)(distances[part] < running[part] + blend->acts + 2 * away) << part;
        needs[i] = (uint8_t)needed;
        join_member(blend, running, distances);
    }
}

static void halve(const Refiner *r, const Desk *desk, uint8_t *needs, Halving *h)
{
    double away = r->blend->slope * (0.25 * sqrt(3) * h->size + r->pad), results[PARTS];
    join_all(r, desk, needs, h, away, results);
    for (int part = 0; part < PARTS; part++)
        h->least[part] = results[part] - away;
    for (uint32_t i = 0; i < h->count; i++)
        for (int part = 0; part < PARTS; part++) {
            double changes = desk->distances[i][part] - away - r->blend->reach;
            if (changes >= fmin(results[part] + away, h->clearance))
                needs[i] &= (uint8_t) ~(1u << part);
        }
}

static size_t coarse_cell(const Refiner *r, const uint32_t *cell)
{
    return ((size_t)cell[2] * r->from->cells[1] + cell[1]) * r->from->cells[0] + cell[0];
}

static size_t first_refined(const Refiner *r, const uint32_t *cell)
{
    return GRID_REFINED_ALONG *
           (((size_t)cell[2] * r->to->cells[1] + cell[1]) * r->to->cells[0] + cell[0]);
}

static void set_clearance(const Refiner *r, const uint32_t *cell, int number, double clearance)
{
    r->to->clearance[first_refined(r, cell) + r->offsets[number]] = (float)clearance;
}

/* That of a part without members. */
static double emptied(const Halving *h, int part)
{
    return fmin(h->least[part] * ROUNDED_DOWN, h->clearance);
}

/* The cells in a part of a cell, which is `whole`. */
static void refine_part(const Refiner *r, const Desk *desk, const uint32_t *cell,
                        const Halving *whole, int part, uint64_t *masks)
{
    Halving   h     = {.size      = 0.5 * whole->size,
                       .members   = whole->members,
                       .places    = desk->places,
                       .clearance = whole->clearance};
    uint32_t *first = r->to->first + first_refined(r, cell);
    for (int k = 0; k < 3; k++)
        h.low[k] = whole->low[k] + (part >> k & 1) * h.size;
    for (uint32_t i = 0; i < whole->count; i++)
        if (desk->needs[0][i] >> part & 1)
            desk->places[h.count++] = i;
    halve(r, desk, desk->needs[1], &h);
    for (int small = 0; small < PARTS; small++) {
        const int number = PARTS * part + small;
        bool      empty  = h.least[small] >= r->empty;
        set_clearance(r, cell, number, empty ? emptied(&h, small) : h.clearance);
        for (uint32_t i = 0; i < h.count && !empty; i++)
            if (desk->needs[1][i] >> small & 1) {
                masks[h.places[i]] |= (uint64_t)1 << number;
                first[r->offsets[number]]++;
            }
    }
}

/* The places of a cell's list are those of all its members. */
static void refine_cell(const Refiner *r, const Desk *desk, const uint32_t *cell,
                        const uint32_t *all)
{
    const Grid     *from   = r->from;
    size_t          number = coarse_cell(r, cell);
    const uint32_t *first  = &from->first[number];
    Halving         h      = {.size      = from->size,
                              .members   = from->members + first[0],
                              .places    = all,
                              .count     = first[1] - first[0],
                              .clearance = (double)from->clearance[number]};
    for (int k = 0; k < 3; k++)
        h.low[k] = from->low[k] + cell[k] * from->size;
    halve(r, desk, desk->needs[0], &h);
    for (int part = 0; part < PARTS; part++)
        if (h.least[part] < r->empty)
            refine_part(r, desk, cell, &h, part, r->masks + first[0]);
        else
            for (int small = 0; small < PARTS; small++)
                set_clearance(r, cell, PARTS * part + small, emptied(&h, part));
}

/* ---- all cells ---- */

typedef struct Cells {
    Refiner        *refiner;
    const uint32_t *all; /* 0, 1, 2, .. */
    bool            fill;
} Cells;

/* The lists of the cells that a cell becomes. */
static void fill_cell(const Refiner *r, const uint32_t *cell)
{
    const uint32_t *list  = &r->from->first[coarse_cell(r, cell)];
    uint32_t       *first = r->to->first + first_refined(r, cell);
    for (uint32_t i = list[0]; i < list[1]; i++)
        for (uint64_t bits = r->masks[i]; bits; bits &= bits - 1)
            r->to->members[first[r->offsets[lowest_bit(bits)]]++] = r->from->members[i];
}

/* Rows of cells along x are dealt out to the processors. */
static void visit_rows(void *task, size_t part, size_t parts)
{
    const Cells    *cells   = task;
    const Refiner  *r       = cells->refiner;
    const uint32_t *count   = r->from->cells;
    uint32_t        cell[3] = {0};
    for (size_t row = part; row < (size_t)count[1] * count[2]; row += parts) {
        cell[1] = (uint32_t)(row % count[1]);
        cell[2] = (uint32_t)(row / count[1]);
        for (cell[0] = 0; cell[0] < count[0]; cell[0]++)
            if (cells->fill)
                fill_cell(r, cell);
            else
                refine_cell(r, &r->desks[part], cell, cells->all);
    }
}

static void find_offsets(Refiner *r)
{
    for (uint32_t number = 0; number < GRID_REFINED; number++) {
        size_t at[3];
        for (int k = 0; k < 3; k++)
            at[k] = 2 * (number >> (3 + k) & 1) + (number >> k & 1);
        r->offsets[number] = (at[2] * r->to->cells[1] + at[1]) * r->to->cells[0] + at[0];
    }
}

static Desk desk_for(const Refiner *r, Arena *scratch)
{
    size_t most = r->from->most_listed + (size_t)1;
    return (Desk){
        .rows      = arena_alloc(scratch, lane_work_bytes(r->blend->tape), 1),
        .distances = arena_alloc(scratch, most, sizeof *r->desks[0].distances),
        .needs = {arena_new_array(scratch, uint8_t, most), arena_new_array(scratch, uint8_t, most)},
        .places = arena_new_array(scratch, uint32_t, most)};
}

void grid_refine(Grid *refined, const Grid *coarse, const GridBlend *blend, Arena *arena,
                 Arena *scratch)
{
    Refiner   r     = {.to = refined, .from = coarse, .blend = blend};
    size_t    cells = grid_cell_count(coarse) * GRID_REFINED;
    uint32_t *all   = arena_new_array(scratch, uint32_t, coarse->most_listed + (size_t)1);
    *refined        = *coarse;
    refined->size   = coarse->size / GRID_REFINED_ALONG;
    for (int k = 0; k < 3; k++) {
        Range side        = coarse->inner.axis[k];
        refined->cells[k] = GRID_REFINED_ALONG * coarse->cells[k];
        r.pad += FLOAT_MISSES * (range_largest(side) + side.high - side.low);
    }
    for (uint32_t i = 0; i < coarse->most_listed; i++)
        all[i] = i;
    find_offsets(&r);
    r.empty            = blend->margin + EMPTY_IN_CELLS * refined->size;
    refined->first     = arena_new_array(arena, uint32_t, cells + 1);
    refined->clearance = arena_new_array(arena, float, cells);
    r.masks            = arena_new_array(scratch, uint64_t,
                                         coarse->first[grid_cell_count(coarse)] + (size_t)1);
    for (size_t i = 0; i < parallel_parts(); i++)
        r.desks[i] = desk_for(&r, scratch);

    Cells visit = {.refiner = &r, .all = all};
    run_in_parallel(visit_rows, &visit);
    grid_begin_lists(refined, arena);
    visit.fill = true;
    run_in_parallel(visit_rows, &visit);
    grid_end_lists(refined);
}
