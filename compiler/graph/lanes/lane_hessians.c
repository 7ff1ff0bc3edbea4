/*
 * lane_hessians.c: how fast the derivatives of the result of a lane tape change within a box, in intervals.
 *
 * Values and derivatives come from runs of lane_ranges.c and lane_slopes.c over the same box.  The chain rule of
 * second order makes ranges of the second derivatives from them.  They hold almost everywhere, and the
 * first derivatives do not jump: so Taylor's theorem holds in the box with any values within
 * the ranges.  What may have a corner in the box, a minimum or a jump, has none.
 */
#include <math.h>
#include <string.h>

#include "compiler/graph/blend_shares.h"
#include "compiler/graph/lanes/lane_cuts.h"
#include "compiler/graph/lanes/lane_outlines.h"
#include "compiler/graph/lanes/lane_segments.h"
#include "compiler/graph/lanes/lane_steps.h"

/* A run over a tape, and the step that it is at. */
typedef struct Run {
    const LaneTape   *tape;
    const LaneRanges *ranges;
    const LaneSlope  *slopes;
    LaneHessian      *hessians;
    size_t            at;
    const LaneStep   *step;
} Run;

static const LaneHessian NO_BEND      = {.known = true, .flat = true};
static const LaneHessian UNKNOWN_BEND = {.known = false};
static const int         ROW[6] = {0, 1, 2, 1, 0, 0}, COLUMN[6] = {0, 1, 2, 2, 2, 1};

LaneHessian *lane_hessians_new(const LaneTape *tape, Arena *arena)
{
    return arena_new_array(arena, LaneHessian, LANE_INPUTS + lane_max_steps(tape));
}

/* ---- operands ---- */

static Range range_at(const Run *run, uint32_t operand)
{
    return lane_range_at(run->tape, run->ranges, operand);
}

static Range range_in(const Run *run, int k) { return range_at(run, run->step->operands[k]); }
static Range result(const Run *run) { return run->ranges->ranges[LANE_INPUTS + run->at]; }

/* Returns the slope of an operand; NULL: it is the same everywhere. */
static const LaneSlope *slope_at(const Run *run, uint32_t operand)
{
    return operand & LANE_SCALAR ? NULL : &run->slopes[operand];
}

static const LaneHessian *hessian_at(const Run *run, uint32_t operand)
{
    return operand & LANE_SCALAR ? &NO_BEND : &run->hessians[operand];
}

static bool slope_is_zero(const LaneSlope *slope)
{
    return !slope || (range_is_zero(slope->by[0]) && range_is_zero(slope->by[1]) &&
                      range_is_zero(slope->by[2]));
}

static bool operand_is_constant(const Run *run, int k)
{
    const LaneHessian *hessian = hessian_at(run, run->step->operands[k]);
    return slope_is_zero(slope_at(run, run->step->operands[k])) && hessian->known && hessian->flat;
}

/* ---- sums ---- */

/* Computes sum += factor h. */
static void add_hessian(LaneHessian *sum, Range factor, const LaneHessian *h)
{
    if (range_is_zero(factor) || (h->known && h->flat))
        return;
    sum->known = sum->known && h->known && is_finite(factor);
    sum->flat  = false;
    for (int i = 0; sum->known && i < 6; i++)
        sum->by[i] = plus(sum->by[i], times(factor, h->by[i]));
}

/* Computes sum += factor a a^T. */
static void add_square(LaneHessian *sum, Range factor, const LaneSlope *a)
{
    if (range_is_zero(factor) || slope_is_zero(a))
        return;
    sum->known = sum->known && is_finite(factor);
    sum->flat  = false;
    for (int i = 0; sum->known && i < 6; i++) {
        Range product = i < 3 ? squared(a->by[i]) : times(a->by[ROW[i]], a->by[COLUMN[i]]);
        sum->by[i]    = plus(sum->by[i], times(factor, product));
    }
}

/* Computes sum += factor (a b^T + b a^T). */
static void add_product(LaneHessian *sum, Range factor, const LaneSlope *a, const LaneSlope *b)
{
    if (range_is_zero(factor) || slope_is_zero(a) || slope_is_zero(b))
        return;
    sum->known = sum->known && is_finite(factor);
    sum->flat  = false;
    for (int i = 0; sum->known && i < 6; i++) {
        Range product = plus(times(a->by[ROW[i]], b->by[COLUMN[i]]),
                             times(b->by[ROW[i]], a->by[COLUMN[i]]));
        sum->by[i]    = plus(sum->by[i], times(factor, product));
    }
}

static LaneHessian hessian_by_partials(const Run *run, const NumberRow *row, const Range *o)
{
    LaneHessian sum = NO_BEND;
    Range       by[MAX_OPERANDS], second[3][3] = {0};
    uint32_t    pairs = row->arity < 3 ? row->arity : 3;
    row->first(o, result(run), by);
    if (!row->second || !row->second(o, result(run), by, second))
        return UNKNOWN_BEND;
    for (uint32_t k = 0; k < row->arity; k++)
        add_hessian(&sum, by[k], hessian_at(run, run->step->operands[k]));
    for (uint32_t k = 0; k < pairs; k++) {
        const LaneSlope *slope = slope_at(run, run->step->operands[k]);
        add_square(&sum, second[k][k], slope);
        for (uint32_t l = k + 1; l < pairs; l++)
            add_product(&sum, second[k][l], slope, slope_at(run, run->step->operands[l]));
    }
    return sum;
}

/* ---- length ---- */

/* Returns what is squared, so that corners at 0 do not count: of abs(a) and max(a, 0) it is a. */
static uint32_t without_corner(const Run *run, uint32_t operand)
{
    const LaneStep *step = lane_step_of(run->tape, operand);
    if (!step)
        return operand;
    bool greater = step->op == OP_max || step->op == LANE_GREATER;
    for (int k = 0; greater && k < 2; k++)
        if (range_is_zero(range_at(run, step->operands[1 - k])) &&
            (step->operands[1 - k] & LANE_SCALAR))
            return step->operands[k];
    return step->op == OP_abs ? step->operands[0] : operand;
}

/* Tells whether a square of its derivatives is not that of what is squared: abs(a) grows as fast as a or -a. */
static bool sign_counts(const Run *run, uint32_t operand)
{
    const LaneStep *step = lane_step_of(run->tape, operand);
    return !step || step->op != OP_abs;
}

/* Returns a component over the length; of abs(a) the sign is that of a, which is not known. */
static Range unit_part(const Run *run, uint32_t operand, Range length)
{
    const LaneStep *step = lane_step_of(run->tape, operand);
    Range unit   = range_intersect(range_div(range_at(run, operand), length), (Range){-1, 1});
    bool  corner = step && step->op == OP_abs && range_at(run, step->operands[0]).low < 0;
    return corner ? range_hull(unit, minus(unit)) : unit;
}

/* Finds the length of a vector of which one number alone is not 0, and its sign is known: it is
   that number or its negative. */
static bool length_of_one(const Run *run, LaneHessian *hessian)
{
    uint32_t only = lane_only_operand(run->tape, run->ranges, run->step);
    if (only == NODE_NONE || !hessian_at(run, only)->known)
        return false;
    Range range = range_at(run, only);
    if (range.low < 0 && range.high > 0)
        return false;
    *hessian = NO_BEND;
    add_hessian(hessian, range_of(range.high > 0 ? 1 : -1), hessian_at(run, only));
    return true;
}

/* Returns the Hessian of a length: (sum of a_k^2) - l^2, a_k the derivatives of the components and
   l those of the length, is at least 0 in all directions (Cauchy). */
static LaneHessian hessian_of_length(const Run *run)
{
    Range       length = result(run);
    LaneHessian bend = {.known = length.low > 0 && isfinite(length.high)}, sum = NO_BEND;
    if (length_of_one(run, &sum))
        return sum;
    if (!bend.known)
        return UNKNOWN_BEND;
    uint32_t from[MAX_OPERANDS];
    bool     segment = lane_from_segment(run->tape, run->step, from);
    for (uint32_t k = 0; k < run->step->operand_count; k++) {
        uint32_t operand = run->step->operands[k], inner = without_corner(run, operand);
        add_hessian(&sum, unit_part(run, operand, length),
                    hessian_at(run, segment ? from[k] : inner));
        add_square(&bend, range_of(1), slope_at(run, sign_counts(run, operand) ? operand : inner));
    }
    add_square(&bend, range_of(-1), &run->slopes[LANE_INPUTS + run->at]);
    for (int i = 0; bend.known && i < 3; i++)
        bend.by[i] = (Range){max2(bend.by[i].low, 0), max2(bend.by[i].high, 0)};
    add_hessian(&sum, range_div(range_of(1), length), &bend);
    return sum;
}

/* Returns the Hessian of a a, or a^2. */
static LaneHessian hessian_of_square(const Run *run)
{
    uint32_t         operand = run->step->operands[0], inner = without_corner(run, operand);
    const LaneSlope *slope = slope_at(run, operand);
    LaneHessian      sum   = NO_BEND;
    Range            value = range_at(run, operand);
    if (inner != operand && lane_step_of(run->tape, operand)->op == OP_abs)
        value = range_at(run, inner);
    add_hessian(&sum, scaled(2, value), hessian_at(run, inner));
    add_square(&sum, range_of(2), slope);
    return sum;
}

/* ---- smooth minima ---- */

/* Returns the derivatives of a - b. */
static LaneSlope slope_of_difference(const Run *run, uint32_t a, uint32_t b)
{
    const LaneSlope *slopes[2]  = {slope_at(run, a), slope_at(run, b)};
    LaneSlope        difference = {{{0, 0}, {0, 0}, {0, 0}}};
    for (int j = 0; j < 3; j++) {
        if (slopes[0])
            difference.by[j] = slopes[0]->by[j];
        if (slopes[1])
            difference.by[j] = plus(difference.by[j], minus(slopes[1]->by[j]));
    }
    return difference;
}

/* Weights of the operands, which sum to 1, and what their changes add: for each pair no more than where there are
   only two. */
static LaneHessian hessian_of_mean(const Run *run, Op op, const uint32_t *operands, uint32_t count,
                                   Range width)
{
    LaneHessian sum  = {.known = width.low > 0 && count > 0};
    Range       bend = {-number_rows[op].bend / width.low * (1 + 0x1p-50), 0};
    for (uint32_t k = 0; k < count; k++)
        sum.known = sum.known && hessian_at(run, operands[k])->known &&
                    is_finite(range_at(run, operands[k]));
    if (!sum.known)
        return UNKNOWN_BEND;
    for (int i = 0; i < 6; i++) {
        sum.by[i] = hessian_at(run, operands[0])->by[i];
        for (uint32_t k = 1; k < count; k++)
            sum.by[i] = range_hull(sum.by[i], hessian_at(run, operands[k])->by[i]);
    }
    for (uint32_t k = 0; k < count; k++)
        for (uint32_t l = k + 1; l < count; l++) {
            LaneSlope difference = slope_of_difference(run, operands[k], operands[l]);
            add_square(&sum, bend, &difference);
        }
    return sum;
}

static LaneHessian hessian_of_blend(const Run *run)
{
    return operand_is_constant(run, 2)
               ? hessian_of_mean(run, (Op)run->step->op, run->step->operands, 2, range_in(run, 2))
               : UNKNOWN_BEND;
}

/* Adds what the operands contribute that may have a share in the box. */
static LaneHessian hessian_of_shares(const Run *run, const LaneCall *call, const Expr *e)
{
    const uint32_t vectors = e->operand_count - 1u, width = call->operands[vectors][0];
    uint32_t       sharers[MAX_SHARERS], count            = 0;
    double         least = HUGE_VAL;
    if (!(width & LANE_SCALAR))
        return UNKNOWN_BEND;
    const double known = run->tape->scalars[width & ~LANE_SCALAR];
    for (uint32_t i = 0; i < 4 * vectors; i++)
        least = min2(least, range_at(run, call->operands[i / 4][i % 4]).high);
    for (uint32_t i = 0; i < 4 * vectors; i++) {
        const uint32_t operand = call->operands[i / 4][i % 4];
        if (!((range_at(run, operand).low - least) * (1 - 0x1p-50) > known))
            sharers[count++] = operand;
    }
    return hessian_of_mean(run, sharing_op((Op)e->op).of_two, sharers, count, range_of(known));
}

/* ---- runs ---- */

/* Takes the Hessian of one of these operands; where there are several there may be a corner. */
static LaneHessian hessian_of_chosen(const Run *run, unsigned chosen)
{
    uint32_t only = lane_only_of(run->step, chosen);
    return only == NODE_NONE ? UNKNOWN_BEND : *hessian_at(run, only);
}

static LaneHessian hessian_of_step(const Run *run)
{
    const LaneStep  *step = run->step;
    const NumberRow *row  = lane_row(step);
    uint32_t         whole;
    Range            o[MAX_OPERANDS];
    if (step->op == OP_length)
        return hessian_of_length(run);
    if (step->op == OP_square || (step->op == OP_mul && step->operands[0] == step->operands[1]))
        return hessian_of_square(run);
    if ((whole = lane_sum_of_cuts(run->tape, run->ranges, step)) != NODE_NONE)
        return *hessian_at(run, whole);
    lane_operands(run->tape, run->ranges, step, o);
    if (row->bend > 0)
        return hessian_of_blend(run);
    unsigned chosen = row->chooses ? row->chooses(o) : 0;
    if (chosen)
        return hessian_of_chosen(run, chosen);
    return row->arity ? hessian_by_partials(run, row, o) : UNKNOWN_BEND;
}

/* Finds the Hessian of the distance to an outline. */
static LaneHessian hessian_of_call(const Run *run)
{
    LaneHessian sum = NO_BEND;
    if (run->step->op != LANE_CALL)
        return UNKNOWN_BEND;
    const LaneCall *call = &run->tape->calls[run->step->operands[0]];
    const Expr     *e    = &run->tape->tape->graph->items[call->node];
    if (sharing_op((Op)e->op).find)
        return hessian_of_shares(run, call, e);
    const uint32_t       *point = call->operands[1];
    const OutlinePartials p     = lane_outline_partials(run->tape, run->ranges, run->at);
    if (!p.known)
        return UNKNOWN_BEND;
    for (int k = 0; k < 2; k++) {
        add_hessian(&sum, p.first[k], hessian_at(run, point[k]));
        add_square(&sum, p.second[k][k], slope_at(run, point[k]));
    }
    add_product(&sum, p.second[0][1], slope_at(run, point[0]), slope_at(run, point[1]));
    return sum;
}

static bool all_constant(const Run *run)
{
    for (uint32_t k = 0; k < run->step->operand_count; k++)
        if (!operand_is_constant(run, (int)k))
            return false;
    return true;
}

static void run_step(Run *run)
{
    size_t       value   = LANE_INPUTS + run->at;
    LaneHessian *hessian = &run->hessians[value];
    bool         call    = run->step->op == LANE_CALL || run->step->op == LANE_PART;
    bool         same    = range_is_single(result(run)) && run->ranges->sure[value];
    if (same || (!call && all_constant(run))) {
        *hessian = NO_BEND;
        return;
    }
    *hessian = call ? hessian_of_call(run) : hessian_of_step(run);
    for (int i = 0; hessian->known && i < 6; i++)
        hessian->known = is_finite(hessian->by[i]);
}

bool lane_hessians_run(const LaneTape *tape, const LaneRanges *ranges, const LaneSlope *slopes,
                       LaneHessian *hessians, LaneHessian *hessian)
{
    Run run = {.tape = tape, .ranges = ranges, .slopes = slopes, .hessians = hessians};
    for (uint32_t k = 0; k < LANE_INPUTS; k++)
        hessians[k] = k < LANE_NORMAL ? NO_BEND : UNKNOWN_BEND;
    for (run.at = 0; run.at < tape->count; run.at++) {
        run.step = &tape->steps[run.at];
        run_step(&run);
    }
    uint32_t output = tape->outputs[0];
    *hessian        = *hessian_at(&run, output);
    return hessian->known && ((output & LANE_SCALAR) || ranges->sure[output]);
}

/* Returns the operand of a negation, or of a sum or product with a scalar; NODE_NONE: it is none. */
static uint32_t without_scalar(const LaneStep *step)
{
    if (step->op == OP_neg)
        return step->operands[0];
    if (step->op != OP_add && step->op != OP_sub && step->op != OP_mul)
        return NODE_NONE;
    for (int k = 0; k < 2; k++)
        if (step->operands[k] & LANE_SCALAR)
            return step->operands[1 - k];
    return NODE_NONE;
}

bool lane_is_undecided(const LaneTape *tape, const LaneRanges *ranges)
{
    const LaneStep *step;
    for (uint32_t at = tape->outputs[0]; (step = lane_step_of(tape, at));) {
        unsigned chosen = lane_chooses(tape, ranges, step);
        if (chosen & (chosen - 1))
            return !range_is_single(lane_range_at(tape, ranges, at));
        at = chosen ? lane_only_of(step, chosen) : without_scalar(step);
    }
    return false;
}
