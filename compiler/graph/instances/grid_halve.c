/*
 * grid_halve.c: which instances of a list change a blend in a part of its cell.
 *
 * Distances of the instances are evaluated in the middle of each part.  Elsewhere in it they, and the result, differ
 * by no more than their slope permits.  So an instance changes nothing in a part if it is nowhere less than
 * - `acts` above the least of all; or
 * - the reach above the result, or above the clearance of the cell.
 * Of a blend that fades, those are left out that make the least of the sum.  Where results are large, no
 * instance is needed: the least of them is the clearance.
 */
#include "compiler/graph/instances/grid_halve.h"

#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/far.h"
#include "compiler/graph/blend_shares.h"
#include "compiler/graph/instances/grid_build.h"
#include "compiler/graph/op_values.h"

/* The part of the sum of a fading blend that may be left out: so many widths a result is wrong. */
#define MAX_LEFT_OUT 1e-4

/* e^-37 is 2^-53. */
#define WIDTHS_OF_DOUBLES 37

HalvingDesk halving_desk_new(const GridBlend *blend, uint32_t most, Arena *scratch)
{
    HalvingDesk desk;
    desk.rows      = arena_alloc(scratch, lane_work_bytes(blend->tape), 1);
    desk.distances = arena_alloc(scratch, most + (size_t)1, sizeof *desk.distances);
    return desk;
}

double halving_pad(const Grid *grid)
{
    double pad = 0;
    for (int k = 0; k < 3; k++) {
        Range side = grid->inner.axis[k];
        pad += FLOAT_MISSES * (range_largest(side) + side.high - side.low);
    }
    return pad;
}

double halving_emptied(const Halving *h, int part)
{
    return fmin(h->least[part] * ROUNDED_DOWN, h->clearance);
}

void halving_distances(const Halver *halver, const HalvingDesk *desk, size_t instance,
                       const double (*points)[3], size_t count, double *distances)
{
    LaneTape tape = *halver->blend->tape;
    LaneWork work = lane_work_in(desk->rows, NULL);
    tape.scalars  = halver->blend->scalars + instance * tape.scalar_count;
    lane_run(&tape, &work, LANE_DOUBLE, (LanePoints){.points = points, .count = count}, 0, 1,
             distances);
}

/* The nearest instances in the middle of a part, in ascending order. */
typedef struct Nearest {
    double   distances[MAX_SHARERS];
    uint32_t count;
} Nearest;

static void add_distance(Nearest *nearest, double distance)
{
    uint32_t at = nearest->count < MAX_SHARERS ? nearest->count++ : MAX_SHARERS;
    for (; at > 0 && nearest->distances[at - 1] > distance; at--)
        if (at < MAX_SHARERS)
            nearest->distances[at] = nearest->distances[at - 1];
    if (at < MAX_SHARERS)
        nearest->distances[at] = distance;
}

/* Returns what the instances make, of which these are the nearest. */
static double join_nearest(const GridBlend *blend, const Nearest *nearest)
{
    static const GraphType types[][MAX_OPERANDS] = {
        {TYPE_FLOAT, TYPE_FLOAT, TYPE_FLOAT, TYPE_FLOAT}, {TYPE_VEC4, TYPE_VEC4, TYPE_FLOAT}};
    NodeValue operands[MAX_OPERANDS] = {{{0}}};
    double    all[MAX_SHARERS];
    if (nearest->count == 0)
        return NOWHERE;
    for (uint32_t i = 0; i < MAX_SHARERS; i++)
        all[i] = i < nearest->count ? nearest->distances[i] : NOWHERE;
    if (blend->shares) {
        memcpy(operands[0].v, all, sizeof operands[0].v);
        memcpy(operands[1].v, all + 4, sizeof operands[1].v);
    } else {
        operands[0].v[0] = all[0];
        operands[1].v[0] = all[1];
    }
    operands[2].v[0] = blend->width;
    operands[3].v[0] = blend->steps;
    return op_evaluate(blend->op, TYPE_FLOAT, 0, types[blend->shares], operands).v[0];
}

/* Results of a blend that makes a sum of powers.  Those that are no part of the sum in double precision are left
   out. */
static void sum_powers(const GridBlend *blend, const HalvingDesk *desk, uint32_t count,
                       double *results)
{
    double sums[GRID_PARTS] = {0};
    for (uint32_t i = 0; i < count; i++)
        for (int part = 0; part < GRID_PARTS; part++) {
            double above = (desk->distances[i][part] - results[part]) / blend->width;
            if (above < WIDTHS_OF_DOUBLES)
                sums[part] += real_exp(-above);
        }
    for (int part = 0; part < GRID_PARTS; part++)
        if (sums[part] > 0)
            results[part] -= blend->width * real_log(sums[part]);
}

/* Joins all instances.  Those that never act are not needed. */
static void join_all(const Halver *halver, const HalvingDesk *desk, uint8_t *needs,
                     const Halving *h, double away, double *results)
{
    const GridBlend *blend = halver->blend;
    LaneTape         tape  = *blend->tape;
    LaneWork         work  = lane_work_in(desk->rows, NULL);
    double           points[GRID_PARTS][3];
    Nearest          nearest[GRID_PARTS];
    for (int part = 0; part < GRID_PARTS; part++) {
        nearest[part].count = 0;
        for (int k = 0; k < 3; k++)
            points[part][k] = h->low[k] + ((part >> k & 1) + 0.5) * 0.5 * h->size;
    }
    LanePoints middles = {.points = (const double(*)[3])points, .count = GRID_PARTS};
    for (uint32_t i = 0; i < h->count; i++) {
        double *distances = desk->distances[i];
        size_t  instance  = h->instances[h->places[i]];
        tape.scalars      = blend->scalars + instance * tape.scalar_count;
        lane_run(&tape, &work, LANE_DOUBLE, middles, 0, 1, distances);
        for (int part = 0; part < GRID_PARTS; part++)
            add_distance(&nearest[part], distances[part]);
    }
    for (int part = 0; part < GRID_PARTS; part++)
        results[part] = nearest[part].count ? nearest[part].distances[0] : NOWHERE;
    for (uint32_t i = 0; i < h->count; i++) {
        uint32_t needed = 0;
        for (int part = 0; part < GRID_PARTS; part++) {
            double above = desk->distances[i][part] - results[part];
            needed |= (uint32_t)(above < blend->acts + 2 * away) << part;
        }
        needs[i] = (uint8_t)needed;
    }
    for (int part = 0; part < GRID_PARTS && !blend->sums; part++)
        results[part] = join_nearest(blend, &nearest[part]);
    if (blend->sums)
        sum_powers(blend, desk, h->count, results);
}

/* ---- blends that fade ---- */

enum { PER_WIDTH = 4, STEPS = 32 * PER_WIDTH };

/* Tells how far an instance is at least above all results that must be right, in parts of a width. */
static double steps_above(const Halver *halver, const Halving *h, double distance, double result,
                          double away)
{
    double highest = fmin(result + away, h->clearance);
    return (distance - away - highest) * (PER_WIDTH / halver->blend->width);
}

/* Leaves out the farthest instances of a part, as long as what they make of the sum is small enough. */
static void leave_out(const Halver *halver, const HalvingDesk *desk, uint8_t *needs,
                      const Halving *h, int part, double result, double away)
{
    uint32_t counts[STEPS] = {0};
    double   sum           = 0;
    int      step          = STEPS;
    for (uint32_t i = 0; i < h->count; i++) {
        double above = steps_above(halver, h, desk->distances[i][part], result, away);
        if (above >= 0)
            counts[above < STEPS ? (int)above : STEPS - 1]++;
    }
    while (step > 0) {
        sum += counts[step - 1] * real_exp(-(step - 1) / (double)PER_WIDTH);
        if (sum > MAX_LEFT_OUT * h->share)
            break;
        step--;
    }
    for (uint32_t i = 0; i < h->count; i++)
        if (steps_above(halver, h, desk->distances[i][part], result, away) >= step)
            needs[i] &= (uint8_t) ~(1u << part);
}

void grid_halve(const Halver *halver, const HalvingDesk *desk, uint8_t *needs, Halving *h)
{
    const GridBlend *blend = halver->blend;
    double away = blend->slope * (0.25 * sqrt(3) * h->size + halver->pad), results[GRID_PARTS];
    join_all(halver, desk, needs, h, away, results);
    for (int part = 0; part < GRID_PARTS; part++) {
        h->least[part] = results[part] - away;
        if (blend->fades)
            leave_out(halver, desk, needs, h, part, results[part], away);
    }
    for (uint32_t i = 0; i < h->count; i++)
        for (int part = 0; part < GRID_PARTS; part++) {
            double changes = desk->distances[i][part] - away - blend->reach;
            if (changes >= fmin(results[part] + away, h->clearance))
                needs[i] &= (uint8_t) ~(1u << part);
        }
}
