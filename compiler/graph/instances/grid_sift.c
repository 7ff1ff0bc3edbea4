/*
 * grid_sift.c: the lists of coarse cells for a blend, found from above.
 *
 * A cube around all cells is halved along each axis, with all instances, and so are its parts with the instances
 * that change something in them (grid_halve.h), down to the cells.  Upper cubes need nearly all instances, but
 * there are few of them.
 */
#include "compiler/graph/instances/grid_sift.h"

#include <math.h>
#include <string.h>

#include "compiler/base/far.h"
#include "compiler/base/parallel.h"
#include "compiler/graph/instances/grid_build.h"
#include "compiler/graph/instances/grid_halve.h"
#include "compiler/graph/instances/grid_refine.h"

/* Levels of cubes; the entries of lists, and the distances of instances in eight points, of a processor. */
enum { MAX_LEVELS = 16, MAX_ENTRIES = 1 << 21, MAX_EVALUATED = 1 << 22 };

/* All processors find all of the first levels, so that they can share the cubes below. */
enum { SHARED_LEVELS = 2 };

/* The part that all levels together may leave out of what all halvings may; those of grid_refine.c
   have the rest. */
#define SHARE_OF_LEVELS 0.25

/* The memory of one processor, and its results. */
typedef struct Sieve {
    HalvingDesk desk;
    /* Of the cube of each level that is at hand: its list, and which parts need each instance. */
    uint32_t *lists[MAX_LEVELS];
    uint8_t  *needs[MAX_LEVELS];
    uint32_t *entries; /* of cells, one after the other */
    size_t    count, evaluated;
    uint32_t  dealt; /* cubes below the shared levels, so far */
    bool      full;  /* it would take too long */
} Sieve;

typedef struct Sifter {
    Grid            *grid;
    Halver           halver;
    double           empty;
    int              levels, shared; /* cubes of this level are dealt out to the processors */
    const uint32_t  *all;            /* 0, 1, 2, .. */
    const uint32_t  *instances;      /* whose boxes are not empty */
    uint32_t         present;
    const uint32_t **lists; /* of each cell */
    Sieve            sieves[MAX_PARTS];
} Sifter;

/* The sieve that a processor uses. */
typedef struct Hand {
    const Sifter *sifter;
    Sieve        *sieve;
    size_t        part, parts;
} Hand;

typedef struct Cube {
    uint32_t cell[3]; /* its first */
    int      level;   /* it has 2^level cells along each axis */
    uint32_t count;   /* of its list */
} Cube;

static bool is_outside(const Grid *grid, const Cube *cube)
{
    for (int k = 0; k < 3; k++)
        if (cube->cell[k] >= grid->cells[k])
            return true;
    return false;
}

static void set_list(const Sifter *s, Sieve *sieve, const Cube *cube)
{
    size_t cell = grid_cell_number(s->grid, cube->cell);
    if (sieve->count + cube->count > MAX_ENTRIES) {
        sieve->full = true;
        return;
    }
    uint32_t *list = sieve->entries + sieve->count;
    memcpy(list, sieve->lists[0], cube->count * sizeof *list);
    sieve->count += cube->count;
    s->lists[cell]           = list;
    s->grid->first[cell]     = cube->count;
    s->grid->clearance[cell] = (float)NOWHERE;
}

/* Empties a cube in which no result is less than the clearance. */
static void empty_cube(const Sifter *s, const Cube *cube, double clearance)
{
    uint32_t end[3], cell[3];
    for (int k = 0; k < 3; k++) {
        uint32_t high = cube->cell[k] + (1u << cube->level);
        end[k]        = high < s->grid->cells[k] ? high : s->grid->cells[k];
    }
    for (cell[2] = cube->cell[2]; cell[2] < end[2]; cell[2]++)
        for (cell[1] = cube->cell[1]; cell[1] < end[1]; cell[1]++)
            for (cell[0] = cube->cell[0]; cell[0] < end[0]; cell[0]++)
                s->grid->clearance[grid_cell_number(s->grid, cell)] = (float)clearance;
}

/* Returns a part of a cube, and its list. */
static Cube part_of(const Sieve *sieve, const Cube *cube, int part)
{
    Cube            half  = {.level = cube->level - 1};
    const uint32_t *list  = sieve->lists[cube->level];
    const uint8_t  *needs = sieve->needs[cube->level];
    uint32_t       *to    = sieve->lists[half.level];
    for (int k = 0; k < 3; k++)
        half.cell[k] = cube->cell[k] + ((uint32_t)(part >> k & 1) << half.level);
    for (uint32_t i = 0; i < cube->count; i++)
        if (needs[i] >> part & 1)
            to[half.count++] = list[i];
    return half;
}

/* Tells whether a processor looks at a cube of the levels below. */
static bool is_dealt(Hand hand, const Cube *cube)
{
    return cube->level != hand.sifter->shared || hand.sieve->dealt++ % hand.parts == hand.part;
}

static void sift_cube(Hand hand, Cube cube)
{
    const Sifter *s     = hand.sifter;
    Sieve        *sieve = hand.sieve;
    if (sieve->full || is_outside(s->grid, &cube) || !is_dealt(hand, &cube))
        return;
    if (cube.level == 0) {
        set_list(s, sieve, &cube);
        return;
    }
    Halving h = {.size      = ldexp(s->grid->size, cube.level),
                 .instances = sieve->lists[cube.level],
                 .places    = s->all,
                 .count     = cube.count,
                 .clearance = NOWHERE,
                 .share     = SHARE_OF_LEVELS / s->levels};
    for (int k = 0; k < 3; k++)
        h.low[k] = s->grid->low[k] + cube.cell[k] * s->grid->size;
    grid_halve(&s->halver, &sieve->desk, sieve->needs[cube.level], &h);
    sieve->evaluated += cube.count;
    sieve->full = sieve->full || sieve->evaluated > MAX_EVALUATED;
    for (int part = 0; part < GRID_PARTS; part++) {
        Cube half = part_of(sieve, &cube, part);
        if (h.least[part] < s->empty)
            sift_cube(hand, half);
        else if (!is_outside(s->grid, &half) && (cube.level <= s->shared || hand.part == 0))
            empty_cube(s, &half, halving_emptied(&h, part));
    }
}

static void sift_part(void *task, size_t part, size_t parts)
{
    Sifter *s    = task;
    Hand    hand = {s, &s->sieves[part], part, parts};
    Cube    all  = {.level = s->levels, .count = s->present};
    memcpy(hand.sieve->lists[s->levels], s->instances, s->present * sizeof *s->instances);
    sift_cube(hand, all);
}

/* ---- all ---- */

static Sieve sieve_new(const Sifter *s, uint32_t count, Arena *scratch)
{
    Sieve sieve = {.desk    = halving_desk_new(s->halver.blend, count, scratch),
                   .entries = arena_new_array(scratch, uint32_t, MAX_ENTRIES)};
    for (int level = 0; level <= s->levels; level++) {
        sieve.needs[level] = arena_new_array(scratch, uint8_t, count);
        sieve.lists[level] = arena_new_array(scratch, uint32_t, count);
    }
    return sieve;
}

static int levels_around(const Grid *grid)
{
    int levels = 0;
    for (int k = 0; k < 3; k++)
        while (1u << levels < grid->cells[k])
            levels++;
    return levels;
}

/* Gathers the lists that processors have found into those of the grid. */
static void gather_lists(const Sifter *s, Arena *scratch)
{
    Grid     *grid    = s->grid;
    size_t    cells   = grid_cell_count(grid);
    uint32_t *lengths = arena_new_array(scratch, uint32_t, cells);
    memcpy(lengths, grid->first, cells * sizeof *lengths);
    grid_begin_lists(grid, scratch);
    for (size_t c = 0; c < cells; c++) {
        uint32_t length = lengths[c];
        if (length > 0)
            memcpy(grid->instances + grid->first[c], s->lists[c], length * sizeof *grid->instances);
        grid->first[c] += length;
    }
    grid_end_lists(grid);
}

bool grid_sift(Grid *coarse, const Box *boxes, uint32_t count, const GridBlend *blend,
               Arena *scratch)
{
    if (!grid_place_coarse(coarse, boxes, count, blend->swell, blend->margin, blend->fades,
                           scratch))
        return false;
    size_t    cells     = grid_cell_count(coarse);
    Sifter    s         = {.grid   = coarse,
                           .halver = {blend, halving_pad(coarse)},
                           .empty  = grid_empty_from(blend, coarse),
                           .levels = levels_around(coarse),
                           .lists  = arena_new_array(scratch, const uint32_t *, cells)};
    uint32_t *all       = arena_new_array(scratch, uint32_t, count);
    uint32_t *instances = arena_new_array(scratch, uint32_t, count);
    if (s.levels >= MAX_LEVELS)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        all[i] = i;
        if (!grid_box_is_empty(&boxes[i]))
            instances[s.present++] = i;
    }
    s.shared    = s.levels > SHARED_LEVELS ? s.levels - SHARED_LEVELS : 0;
    s.all       = all;
    s.instances = instances;
    for (size_t i = 0; i < parallel_parts(); i++)
        s.sieves[i] = sieve_new(&s, count, scratch);
    coarse->first     = arena_new_array(scratch, uint32_t, cells + 1);
    coarse->clearance = arena_new_array(scratch, float, cells);
    run_in_parallel(sift_part, &s);
    for (size_t i = 0; i < parallel_parts(); i++)
        if (s.sieves[i].full)
            return false;
    gather_lists(&s, scratch);
    return true;
}
