/*
 * grid_tails.c: lists from the nearest instances on, with sums of all that is behind each place.
 *
 * The sums are right in any order, so instances are sorted by steps of a part of a width, in linear time.
 */
#include "compiler/graph/instances/grid_tails.h"

#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/parallel.h"

enum { STEPS_OF_WIDTH = 8, STEPS = 256 };

/* Widths from the middle of a cell to a corner; e^60 is a number of single precision. */
#define MAX_WIDTHS 20.0

/* Sums of single precision, each with some hundred roundings, and shaders' powers. */
#define ROUNDED_UP (1 + 1e-4)

bool grid_may_have_tails(const GridBlend *blend, double size)
{
    return blend->slope * 0.5 * sqrt(3) * size <= MAX_WIDTHS * blend->width;
}

/* The memory of one processor: the list of a cell. */
typedef struct Sorting {
    uint32_t *instances;
    float    *distances;
} Sorting;

typedef struct Tails {
    Grid   *grid;
    double  width, factor;
    Sorting sortings[MAX_PARTS];
} Tails;

static uint32_t step_of(const Tails *t, double distance, double least)
{
    double steps = (distance - least) * (STEPS_OF_WIDTH / t->width);
    return steps < STEPS ? (uint32_t)steps : STEPS - 1;
}

static void sort_list(const Tails *t, const Sorting *to, const uint32_t *instances,
                      const float *distances, uint32_t count, double least)
{
    uint32_t places[STEPS + 1] = {0};
    for (uint32_t i = 0; i < count; i++)
        places[step_of(t, (double)distances[i], least) + 1]++;
    for (uint32_t s = 1; s <= STEPS; s++)
        places[s] += places[s - 1];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t place       = places[step_of(t, (double)distances[i], least)]++;
        to->instances[place] = instances[i];
        to->distances[place] = distances[i];
    }
}

static void find_tails(const Tails *t, const Sorting *sorting, size_t cell)
{
    const uint32_t first = t->grid->first[cell], count = t->grid->first[cell + 1] - first;
    float         *tails = t->grid->tails + first;
    double         least = HUGE_VAL, sum = 0;
    for (uint32_t i = 0; i < count; i++)
        least = fmin(least, (double)tails[i]);
    sort_list(t, sorting, t->grid->instances + first, tails, count, least);
    memcpy(t->grid->instances + first, sorting->instances, count * sizeof *sorting->instances);
    for (uint32_t i = count; i-- > 0;) {
        sum += real_exp((least - (double)sorting->distances[i]) / t->width);
        tails[i] = (float)sum;
    }
    for (uint32_t i = 0; i < count; i++)
        tails[i] = (float)((double)tails[i] * t->factor / sum);
    t->grid->middles[cell] = (float)(least - t->width * real_log(sum));
}

/* Slabs of cells are dealt out to the processors. */
static void visit_cells(void *task, size_t part, size_t parts)
{
    const Tails *t     = task;
    const size_t cells = grid_cell_count(t->grid);
    for (size_t cell = cells * part / parts; cell < cells * (part + 1) / parts; cell++)
        if (t->grid->first[cell] < t->grid->first[cell + 1])
            find_tails(t, &t->sortings[part], cell);
}

void grid_find_tails(Grid *refined, const GridBlend *blend, double pad, Arena *arena,
                     Arena *scratch)
{
    Tails  t         = {.grid   = refined,
                        .width  = blend->width,
                        .factor = ROUNDED_UP * real_exp(2 * blend->slope * pad / blend->width)};
    size_t most      = refined->max_listed + (size_t)1;
    refined->middles = arena_new_array(arena, float, grid_cell_count(refined));
    for (size_t i = 0; i < parallel_parts(); i++)
        t.sortings[i] = (Sorting){arena_new_array(scratch, uint32_t, most),
                                  arena_new_array(scratch, float, most)};
    run_in_parallel(visit_cells, &t);
}
