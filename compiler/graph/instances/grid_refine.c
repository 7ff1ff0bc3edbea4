/*
 * grid_refine.c: lists of those instances that change a blend in small cells.
 *
 * A cell is halved along each axis, and each half again, with the instances that the first has left.
 */
#include "compiler/graph/instances/grid_refine.h"

#include <math.h>
#include <string.h>

#include "compiler/base/bits.h"
#include "compiler/base/far.h"
#include "compiler/base/parallel.h"
#include "compiler/graph/instances/grid_build.h"
#include "compiler/graph/instances/grid_halve.h"
#include "compiler/graph/instances/grid_tails.h"

/* Lists are empty where results are at least so many sides of a refined cell, beyond the margin.  Half and
   twice as many are no faster. */
#define EMPTY_IN_CELLS 1.0

/* The parts that the two halvings may leave out of what all may. */
static const double shares[2] = {0.25, 0.5};

/* The memory of one processor, with an element for each instance of the list at hand. */
typedef struct Desk {
    HalvingDesk halving;
    uint8_t    *needs[2]; /* which parts need it, of a cell and of one of its parts */
    uint32_t   *places;   /* in the list of the cell, of what a part needs */
} Desk;

typedef struct Refiner {
    Grid       *to;
    const Grid *from;
    Halver      halver;
    double      empty; /* from which results on */
    uint64_t   *masks; /* of each entry of a coarse list, the refined cells that need it */
    size_t      offsets[GRID_REFINED]; /* of refined cells from the first in a coarse one */
    Desk        desks[MAX_PARTS];
} Refiner;

static size_t first_refined(const Refiner *r, const uint32_t *cell)
{
    return GRID_REFINED_ALONG * grid_cell_number(r->to, cell);
}

static void set_clearance(const Refiner *r, const uint32_t *cell, int number, double clearance)
{
    r->to->clearance[first_refined(r, cell) + r->offsets[number]] = (float)clearance;
}

/* Refines the cells in a part of a cell, which is `whole`. */
static void refine_part(const Refiner *r, const Desk *desk, const uint32_t *cell,
                        const Halving *whole, int part, uint64_t *masks)
{
    Halving   h     = {.size      = 0.5 * whole->size,
                       .instances = whole->instances,
                       .places    = desk->places,
                       .share     = shares[1],
                       .clearance = whole->clearance};
    uint32_t *first = r->to->first + first_refined(r, cell);
    for (int k = 0; k < 3; k++)
        h.low[k] = whole->low[k] + (part >> k & 1) * h.size;
    for (uint32_t i = 0; i < whole->count; i++)
        if (desk->needs[0][i] >> part & 1)
            desk->places[h.count++] = i;
    grid_halve(&r->halver, &desk->halving, desk->needs[1], &h);
    for (int small = 0; small < GRID_PARTS; small++) {
        const int number = GRID_PARTS * part + small;
        bool      empty  = h.least[small] >= r->empty;
        set_clearance(r, cell, number, empty ? halving_emptied(&h, small) : h.clearance);
        for (uint32_t i = 0; i < h.count && !empty; i++)
            if (desk->needs[1][i] >> small & 1) {
                masks[h.places[i]] |= (uint64_t)1 << number;
                first[r->offsets[number]]++;
            }
    }
}

/* The places of a cell's list are those of all its instances. */
static void refine_cell(const Refiner *r, const Desk *desk, const uint32_t *cell,
                        const uint32_t *all)
{
    const Grid     *from   = r->from;
    size_t          number = grid_cell_number(from, cell);
    const uint32_t *first  = &from->first[number];
    Halving         h      = {.size      = from->size,
                              .instances = from->instances + first[0],
                              .places    = all,
                              .share     = shares[0],
                              .count     = first[1] - first[0],
                              .clearance = (double)from->clearance[number]};
    for (int k = 0; k < 3; k++)
        h.low[k] = from->low[k] + cell[k] * from->size;
    grid_halve(&r->halver, &desk->halving, desk->needs[0], &h);
    for (int part = 0; part < GRID_PARTS; part++)
        if (h.least[part] < r->empty)
            refine_part(r, desk, cell, &h, part, r->masks + first[0]);
        else
            for (int small = 0; small < GRID_PARTS; small++)
                set_clearance(r, cell, GRID_PARTS * part + small, halving_emptied(&h, part));
}

/* ---- all cells ---- */

typedef struct Cells {
    Refiner        *refiner;
    const uint32_t *all; /* 0, 1, 2, .. */
    bool            fill;
} Cells;

/* Returns the place of a refined cell in a coarse one, along an axis. */
static size_t refined_along(uint32_t number, int axis)
{
    return 2 * (number >> (3 + axis) & 1) + (number >> axis & 1);
}

/* Finds the middles of the cells that a cell becomes. */
static void find_middles(const Refiner *r, const uint32_t *cell, double (*middles)[3])
{
    for (uint32_t number = 0; number < GRID_REFINED; number++)
        for (int k = 0; k < 3; k++)
            middles[number][k] = r->from->low[k] + cell[k] * r->from->size +
                                 ((double)refined_along(number, k) + 0.5) * r->to->size;
}

/* Fills the lists of the cells that a cell becomes; where there are to be tails, distances in their
   place. */
static void fill_cell(const Refiner *r, const Desk *desk, const uint32_t *cell)
{
    double middles[GRID_REFINED][3], distances[GRID_REFINED];
    find_middles(r, cell, middles);
    const uint32_t *list  = &r->from->first[grid_cell_number(r->from, cell)];
    uint32_t       *first = r->to->first + first_refined(r, cell);
    for (uint32_t i = list[0]; i < list[1]; i++) {
        uint32_t instance = r->from->instances[i];
        if (r->to->tails && r->masks[i])
            halving_distances(&r->halver, &desk->halving, instance, (const double(*)[3])middles,
                              GRID_REFINED, distances);
        for (uint64_t bits = r->masks[i]; bits; bits &= bits - 1) {
            uint32_t number = lowest_bit(bits), at = first[r->offsets[number]]++;
            r->to->instances[at] = instance;
            if (r->to->tails)
                r->to->tails[at] = (float)distances[number];
        }
    }
}

/* Visits rows of cells along x, which are dealt out to the processors. */
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
                fill_cell(r, &r->desks[part], cell);
            else
                refine_cell(r, &r->desks[part], cell, cells->all);
    }
}

static void find_offsets(Refiner *r)
{
    for (uint32_t number = 0; number < GRID_REFINED; number++) {
        size_t at[3];
        for (int k = 0; k < 3; k++)
            at[k] = refined_along(number, k);
        r->offsets[number] = (at[2] * r->to->cells[1] + at[1]) * r->to->cells[0] + at[0];
    }
}

static Desk desk_for(const Refiner *r, Arena *scratch)
{
    size_t most = r->from->max_listed + (size_t)1;
    return (Desk){
        .halving = halving_desk_new(r->halver.blend, r->from->max_listed, scratch),
        .needs = {arena_new_array(scratch, uint8_t, most), arena_new_array(scratch, uint8_t, most)},
        .places = arena_new_array(scratch, uint32_t, most)};
}

double grid_empty_from(const GridBlend *blend, const Grid *coarse)
{
    return blend->margin + EMPTY_IN_CELLS * coarse->size / GRID_REFINED_ALONG;
}

void grid_refine(Grid *refined, const Grid *coarse, const GridBlend *blend, Arena *arena,
                 Arena *scratch)
{
    Refiner   r     = {.to = refined, .from = coarse, .halver = {blend, halving_pad(coarse)}};
    size_t    cells = grid_cell_count(coarse) * GRID_REFINED;
    uint32_t *all   = arena_new_array(scratch, uint32_t, coarse->max_listed + (size_t)1);
    *refined        = *coarse;
    refined->size   = coarse->size / GRID_REFINED_ALONG;
    for (int k = 0; k < 3; k++)
        refined->cells[k] = GRID_REFINED_ALONG * coarse->cells[k];
    for (uint32_t i = 0; i < coarse->max_listed; i++)
        all[i] = i;
    find_offsets(&r);
    r.empty            = grid_empty_from(blend, coarse);
    refined->first     = arena_new_array(arena, uint32_t, cells + 1);
    refined->clearance = arena_new_array(arena, float, cells);
    r.masks            = arena_new_array(scratch, uint64_t,
                                         coarse->first[grid_cell_count(coarse)] + (size_t)1);
    for (size_t i = 0; i < parallel_parts(); i++)
        r.desks[i] = desk_for(&r, scratch);

    Cells visit = {.refiner = &r, .all = all};
    run_in_parallel(visit_rows, &visit);
    grid_begin_lists(refined, arena);
    if (blend->sifted && blend->fades && grid_may_have_tails(blend, refined->size))
        refined->tails = arena_new_array(
            arena, float, refined->first[cells - 1] + (size_t)refined->max_listed + 1);
    visit.fill = true;
    run_in_parallel(visit_rows, &visit);
    grid_end_lists(refined);
    if (refined->tails)
        grid_find_tails(refined, blend, r.halver.pad, arena, scratch);
}
