/*
 * grid_halve.c: which members of a list change a blend in a part of its cell.
 *
 * Distances of the members are evaluated in the middle of each part.  Elsewhere in it they differ by no more
 * than their slope permits.  Members are joined in the order of the list, and what they make, the running
 * value, has the same slope.  So a member changes nothing in a part
 * - if it is nowhere less than `acts` above the running value before it; or
 * - if the running value before a later member is nowhere less than `acts` above that one, which then makes
 *   the result as if it were the first; or
 * - if it is nowhere less than the reach above the result, or above the clearance of the cell.
 * Of a blend that fades, those are left out that make the least of the sum.  Where results are large, no
 * member is needed: the least of them is the clearance.
 */
#include "compiler/graph/grid_halve.h"

#include <math.h>

#include "compiler/base/far.h"
#include "compiler/graph/grid_builder.h"
#include "compiler/graph/op_values.h"

/* How much of the sum of a blend that fades may be left out: so many widths a result is wrong. */
#define MOST_LEFT_OUT 1e-4

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

void halving_distances(const Halver *halver, const HalvingDesk *desk, size_t member,
                       const double (*points)[3], size_t count, double *distances)
{
    LaneTape tape = *halver->blend->tape;
    LaneWork work = lane_work_in(desk->rows, NULL);
    tape.scalars  = halver->blend->scalars + member * tape.scalar_count;
    lane_run(&tape, &work, LANE_DOUBLE, (LanePoints){.points = points, .count = count}, 0, 1,
             distances);
}

/* Running values after one more member, in the middle of each part. */
static void join_member(const GridBlend *blend, double *running, const double *distances)
{
    const double k = blend->width, n = blend->steps;
    (void)n;
    switch (blend->op) {
#define BLEND(name, signature, slope, bulge, most, reach, acts, fades, cost, facts, glsl, value, \
              ...)                                                                               \
    case OP_smin_##name:                                                                         \
        for (int i = 0; i < GRID_PARTS; i++) {                                                   \
            const double a = running[i], b = distances[i], t = fabs(a - b) / k;                  \
            const double h = fmax(1 - t, 0);                                                     \
            (void)t, (void)h;                                                                    \
            running[i] = (value);                                                                \
        }                                                                                        \
        return;
#include "compiler/graph/blends.def"
    default: return;
    }
}

/* Results of a blend that fades, which is right in any order.  Powers that are no part of the sum in double precision are left
   out. */
static void sum_powers(const GridBlend *blend, const HalvingDesk *desk, uint32_t count,
                       double *results)
{
    double sums[GRID_PARTS] = {0};
    for (uint32_t i = 0; i < count; i++)
        for (int part = 0; part < GRID_PARTS; part++) {
            double above = (desk->distances[i][part] - results[part]) / blend->width;
            if (above < WIDTHS_OF_DOUBLES)
                sums[part] += exp(-above);
        }
    for (int part = 0; part < GRID_PARTS; part++)
        if (sums[part] > 0)
            results[part] -= blend->width * log(sums[part]);
}

/* Joins all members.  Those that never act, and those before one that begins anew, are not needed. */
static void join_all(const Halver *halver, const HalvingDesk *desk, uint8_t *needs,
                     const Halving *h, double away, double *running)
{
    const GridBlend *blend = halver->blend;
    LaneTape         tape  = *blend->tape;
    LaneWork         work  = lane_work_in(desk->rows, NULL);
    double           points[GRID_PARTS][3];
    uint32_t         begins[GRID_PARTS] = {0};
    for (int part = 0; part < GRID_PARTS; part++) {
        running[part] = NOWHERE;
        for (int k = 0; k < 3; k++)
            points[part][k] = h->low[k] + ((part >> k & 1) + 0.5) * 0.5 * h->size;
    }
    LanePoints middles = {.points = (const double(*)[3])points, .count = GRID_PARTS};
    for (uint32_t i = 0; i < h->count; i++) {
        double  *distances = desk->distances[i];
        uint32_t needed    = 0;
        size_t   member    = h->members[h->places[i]];
        tape.scalars       = blend->scalars + member * tape.scalar_count;
        lane_run(&tape, &work, LANE_DOUBLE, middles, 0, 1, distances);
        for (int part = 0; part < GRID_PARTS; part++) {
            double above = distances[part] - running[part];
            needed |= (uint32_t)(above < blend->acts + 2 * away) << part;
            begins[part] = -above >= blend->acts + 2 * away ? i : begins[part];
        }
        needs[i] = (uint8_t)needed;
        for (int part = 0; part < GRID_PARTS && blend->fades; part++)
            running[part] = fmin(running[part], distances[part]);
        if (!blend->fades)
            join_member(blend, running, distances);
    }
    if (blend->fades) {
        sum_powers(blend, desk, h->count, running);
        return;
    }
    for (int part = 0; part < GRID_PARTS; part++)
        for (uint32_t i = 0; i < begins[part]; i++)
            needs[i] &= (uint8_t) ~(1u << part);
}

/* ---- blends that fade ---- */

enum { PER_WIDTH = 4, STEPS = 32 * PER_WIDTH };

/* How far a member is at least above all results that must be right, in parts of a width. */
static double steps_above(const Halver *halver, const Halving *h, double distance, double result,
                          double away)
{
    double highest = fmin(result + away, h->clearance);
    return (distance - away - highest) * (PER_WIDTH / halver->blend->width);
}

/* Leaves out the farthest members of a part, as long as what they make of the sum is small enough. */
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
        sum += counts[step - 1] * exp(-(step - 1) / (double)PER_WIDTH);
        if (sum > MOST_LEFT_OUT * h->share)
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
