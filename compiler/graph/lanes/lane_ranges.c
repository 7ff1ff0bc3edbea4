/*
 * lane_ranges.c: a lane tape over a box, in intervals.
 *
 * Ranges hold every value that lanes find in the box, as far as it is a number.  Where it is one in every
 * point the value is sure; pruning needs that, since a minimum with what is not a number is the other
 * operand.
 */
#include <assert.h>
#include <math.h>

#include "compiler/graph/bounds/facts.h"
#include "compiler/graph/bounds/rules.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/lanes/lane_call.h"
#include "compiler/graph/lanes/lane_waves.h"
#include "compiler/graph/op_values.h"
#include "compiler/graph/texture.h"

LaneRanges lane_ranges_new(const LaneTape *tape, Arena *arena)
{
    return (LaneRanges){.ranges = arena_new_array(arena, Range, LANE_INPUTS + lane_max_steps(tape)),
                        .sure   = arena_new_array(arena, bool, LANE_INPUTS + lane_max_steps(tape)),
                        .middle = arena_new_array(arena, Range, LANE_INPUTS + lane_max_steps(tape)),
                        .stretch = 1,
                        .longest = 1};
}

/* ---- operands ---- */

typedef struct Operand {
    Range range;
    bool  sure;
} Operand;

static Operand operand_of(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand)
{
    if (!(operand & LANE_SCALAR))
        return (Operand){ranges->ranges[operand], ranges->sure[operand]};
    double scalar = tape->scalars[operand & ~LANE_SCALAR];
    return isnan(scalar) ? (Operand){ANYTHING, false} : (Operand){range_of(scalar), true};
}

/* Tells whether the result is a number only if all operands are.  A minimum is not like that. */
static bool needs_numbers(uint16_t op)
{
    enum { TAKES = false, NEEDS = true };
    switch (op) {
#define LANES1(name, takes, ...) \
    case OP_##name:              \
        return takes;
#define LANES2 LANES1
#define LANES3 LANES1
#include "compiler/graph/ops.def"
    case OP_normalize:
    case OP_select: return true; /* the one that is selected; conditions are numbers */
    default: return false;
    }
}

/* What is not a number may then act as any. */
static Operand operand_for(const LaneTape *tape, const LaneRanges *ranges, uint16_t op,
                           uint32_t operand)
{
    Operand found = operand_of(tape, ranges, operand);
    if (!found.sure && !needs_numbers(op))
        found.range = ANYTHING;
    return found;
}

static bool is_finite(Range a) { return isfinite(a.low) && isfinite(a.high); }

static const Range TRUTHS = {0, 1};

/* ---- steps that are no MAP rows ---- */

static Range range_select(const Operand *o)
{
    if (o[0].range.low > 0)
        return o[1].range;
    return o[0].range.high <= 0 ? o[2].range : range_hull(o[1].range, o[2].range);
}

/* guard_decides: everywhere, nowhere, or neither. */
LaneTruth lane_guard_decides(Range bound, Range least, Range far)
{
    Range nearer = range_min(least, far), inside = range_min(far, range_of(0));
    if (bound.low >= nearer.high && bound.low > inside.high)
        return LANE_ALWAYS;
    return bound.high < nearer.low || bound.high <= inside.low ? LANE_NEVER : LANE_SOMETIMES;
}

static Range range_guard(const Operand *o)
{
    Range     out     = range_min(o[0].range, o[1].range);
    LaneTruth decides = lane_guard_decides(o[0].range, o[1].range, o[3].range);
    return decides == LANE_ALWAYS  ? out
           : decides == LANE_NEVER ? o[2].range
                                   : range_hull(out, o[2].range);
}

/* That of three numbers is the length of a pair of which one is the length of a pair, or nearly so. */
static Range range_length(const LaneRanges *ranges, const Operand *o, uint32_t size)
{
    Range sum = range_square(o[0].range);
    for (uint32_t i = 1; i < size; i++)
        sum = range_add(sum, range_square(o[i].range));
    Range length = sum.high == 0 ? range_of(0) : range_sqrt(sum);
    if (ranges->stretch > 1 && size > 1) {
        double by = size > 2 ? ranges->longest : ranges->stretch;
        length    = (Range){length.low / by, length.high * by};
    }
    return length;
}

static Range range_normalized(Range a, Range length)
{
    const Range unit = {-1 - 0x1p-48, 1 + 0x1p-48};
    if (length.low > 0)
        return range_intersect(range_div(a, length), unit);
    return range_intersect((Range){a.low < 0 ? unit.low : 0, a.high > 0 ? unit.high : 0}, unit);
}

/* Where the period is above 0, whole periods are taken off; behind the first and the last cell no more
   than there. */
static Range range_of_cell(Range a, Range period, Range first, Range last)
{
    Range  cell  = range_min(range_max(range_round(range_div(a, period)), first), last);
    Range  moved = range_sub(a, range_mul(period, cell));
    double slack = 0x1p-48 * (range_largest(a) + period.high), half = period.high / 2 + slack;
    Range  before = range_sub(range_of(a.low), range_mul(period, first));
    Range  behind = range_sub(range_of(a.high), range_mul(period, last));
    Range  folded = {min2(-half, before.low - slack), max2(half, behind.high + slack)};
    return range_is_single(cell) || !is_finite(folded) ? moved : range_intersect(moved, folded);
}

static Range range_cell(const Operand *o)
{
    Range a = o[0].range, period = o[1].range;
    if (period.high <= 0)
        return a;
    if (period.low <= 0 || !is_finite(a) || !is_finite(period))
        return ANYTHING;
    return range_of_cell(a, period, o[2].range, o[3].range);
}

static Range range_blend_weight(const Operand *o)
{
    Range a = o[0].range, b = o[1].range, width = o[2].range;
    if (!(width.low > 0) || !o[0].sure || !o[1].sure || !is_finite(a) || !is_finite(b))
        return TRUTHS;
    Range share = range_div(range_mul(range_of(0.5), range_sub(b, a)), width);
    return range_max(range_min(range_add(range_of(0.5), share), range_of(1)), range_of(0));
}

/* ---- by the rules of facts ---- */

static Fact fact_in(Range range)
{
    Fact fact     = fact_unknown(1);
    fact.value[0] = range;
    return fact;
}

static Range range_by_rule(uint16_t op, const Operand *o, uint32_t count)
{
    Fact      facts[MAX_OPERANDS];
    GraphType types[MAX_OPERANDS];
    for (uint32_t k = 0; k < count; k++) {
        facts[k] = fact_in(o[k].range);
        types[k] = TYPE_FLOAT;
    }
    return op_fact((Op)op, TYPE_FLOAT, 0, types, facts, NULL).value[0];
}

/* Tells whether an operand is the same everywhere: some rules know values only then. */
static bool is_scalar(const LaneCall *call, uint32_t operand, GraphType type)
{
    uint32_t scalars = 0;
    for (uint32_t c = 0; c < type_size(type); c++)
        scalars += (call->operands[operand][c] & LANE_SCALAR) != 0;
    return scalars == type_size(type);
}

/* Tells how much farther an instance group may be if lengths are longer. */
static double stretch_of_instances(const LaneTape *tape, const LaneRanges *ranges,
                                   const LaneCall *call, double value, double radius)
{
    if (ranges->stretch == 1)
        return 0;
    if (!call->body)
        return INFINITY;
    const InstanceTable *table = &tape->tape->graph->instances->tables.items[call->body->table];
    return table->bounds ? (ranges->longest - 1) * (fabs(value) + radius + 0.5 * table->widest)
                         : INFINITY;
}

/* The distance to an instance group changes no faster than the point moves, times its slope.  The table of an outline has single
   precision, and the nearest place on a curve is found by some steps only.  False: there is no bound, as where squares are
   too large for that precision: no instance is near then. */
static bool range_of_instances(const LaneTape *tape, const LaneRanges *ranges, const LaneCall *call,
                               const Fact *facts, Range *range)
{
    static const double UNCERTAIN_OUTLINE = 1e-5, UNCERTAIN = 1e-9, FARTHEST = 1e15;
    const Graph        *graph = tape->tape->graph;
    const Expr         *e     = &graph->items[call->node];
    NodeValue           operands[2];
    double              radius = 0, size = 0;
    if (e->op != OP_instance_distance || !ranges->values || tape->tape->by_cells)
        return false;
    operands[0].v[0]                 = graph->items[e->operands[0]].number[0];
    const InstanceFunction *function = &graph->instances->functions.items[(size_t)operands[0].v[0]];
    if (!(function->slope > 0))
        return false;
    for (int k = 0; k < 3; k++) {
        Range at         = facts[1].value[k];
        operands[1].v[k] = 0.5 * (at.low + at.high);
        radius = hypot_upward(radius, max2(at.high - operands[1].v[k], operands[1].v[k] - at.low));
        size   = max2(size, range_largest(at));
    }
    if (!(radius + size < FARTHEST))
        return false;
    double value = lane_call(tape->tape, ranges->values, call->node, operands).v[0];
    radius *= function->slope;
    radius += (function->either ? UNCERTAIN_OUTLINE : UNCERTAIN) * (radius + size + fabs(value));
    if (function->either)
        radius += ranges->chords;
    else
        radius += stretch_of_instances(tape, ranges, call, value, radius);
    *range = (Range){value - radius, value + radius};
    return isfinite(value) && isfinite(radius);
}

static void run_call(const LaneTape *tape, const LaneRanges *ranges, size_t step)
{
    const LaneCall *call  = &tape->calls[tape->steps[step].operands[0]];
    const Graph    *graph = tape->tape->graph;
    const Expr     *e     = &graph->items[call->node];
    Fact            facts[MAX_OPERANDS];
    GraphType       types[MAX_OPERANDS];
    bool            sure = op_has_traits((Op)e->op, STAYS_FINITE);
    for (uint32_t k = 0; k < e->operand_count; k++) {
        types[k] = graph->items[e->operands[k]].type;
        facts[k] = is_scalar(call, k, types[k]) ? (Fact){0} : fact_unknown(type_size(types[k]));
        for (uint32_t c = 0; c < type_size(types[k]); c++) {
            Operand o         = operand_for(tape, ranges, LANE_CALL, call->operands[k][c]);
            facts[k].value[c] = o.range;
            sure              = sure && o.sure && is_finite(o.range);
        }
    }
    Fact fact = is_texture((Op)e->op)
                    ? texture_fact_of(graph, e, facts)
                    : op_fact((Op)e->op, (GraphType)e->type, e->index, types, facts, NULL);
    if (range_of_instances(tape, ranges, call, facts, &fact.value[0]))
        sure = true;
    for (uint32_t c = 0; c < call->parts; c++) {
        ranges->ranges[LANE_INPUTS + step + c] = fact.value[c];
        ranges->sure[LANE_INPUTS + step + c]   = sure;
    }
}

/* The `range` column of MAP rows; else the rule. */
static Range range_by_row(uint16_t op, const Operand *o, uint32_t count)
{
    Range a = o[0].range, b = o[1].range, c = o[2].range;
    switch (op) {
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning) \
    case OP_##name: {                                                           \
        return (range);                                                         \
    }
#include "compiler/graph/ops.def"
    default: return range_by_rule(op, o, count);
    }
}

/* ---- steps ---- */

/* Pruning leaves differences of a number and what is clamped of it, and such quotients. */
static bool is_with_itself(const LaneStep *step, Range a)
{
    return step->operands[0] == step->operands[1] && is_finite(a);
}

/* A quotient by 0 is infinite, of either sign. */
static Range range_quotient(const LaneStep *step, Range a, Range b)
{
    if (b.low <= 0 && b.high >= 0)
        return ANYTHING;
    return is_with_itself(step, a) ? range_of(1) : range_div(a, b);
}

static Range range_of_step(const LaneRanges *ranges, const LaneStep *step, const Operand *o)
{
    Range a = o[0].range, b = o[1].range;
    switch (step->op) {
    case OP_div: return range_quotient(step, a, b);
    case OP_sub: return is_with_itself(step, a) ? range_of(0) : range_sub(a, b);
    case OP_smoothstep: /* infinite / infinite counts as 0 */
        return is_finite(a) && is_finite(b) && is_finite(o[2].range)
                   ? range_by_row(OP_smoothstep, o, 3)
                   : TRUTHS;
#define TRUTH(name, ...)                           \
    case OP_##name: {                              \
        return range_of_truth((Op)step->op, a, b); \
    }
#include "compiler/graph/ops.def"
    case OP_select: return range_select(o);
    case OP_guard: return range_guard(o);
    case OP_length: return range_length(ranges, o, step->operand_count);
    case OP_normalize: return range_normalized(a, b);
    case OP_cell: return range_cell(o);
    case OP_blend_weight: return range_blend_weight(o);
    case LANE_LESSER: return range_min(a, b);
    case LANE_GREATER: return range_max(a, b);
    default: return range_by_row(step->op, o, step->operand_count);
    }
}

/* Tells whether it is a number wherever its operands are. */
static bool is_defined(const LaneStep *step, const Operand *o)
{
    Range a = o[0].range, b = o[1].range;
    bool  finite = true;
    for (uint32_t k = 0; k < step->operand_count; k++)
        finite = finite && is_finite(o[k].range);
    switch (step->op) {
#define LANES1(name, takes, defined, ...) \
    case OP_##name:                       \
        return (defined);
#define LANES2 LANES1
#define LANES3 LANES1
#include "compiler/graph/ops.def"
    case OP_select:
    case OP_guard:
    case LANE_LESSER:
    case LANE_GREATER: return true;
    default: return finite && op_has_traits((Op)step->op, STAYS_FINITE);
    }
}

/* The ball around a box, and the largest coordinate in it. */
typedef struct Ball {
    double radius, size;
} Ball;

/* What changes no faster than that is as far from the value in the middle as that and the box permit.  Rounding is far
   below these parts of the numbers around. */
static Range range_around(Range middle, double steepest, double stretch, const Ball *ball)
{
    static const double UNCERTAIN = 1e-9, CANCELLED = 16;
    double              reach = steepest * stretch * ball->radius, value = range_largest(middle);
    reach += UNCERTAIN * (reach + steepest * ball->size + value);
    if (stretch == 1)
        reach += CANCELLED * (middle.high - middle.low);
    return (Range){middle.low - reach, middle.high + reach};
}

static void run_step(const LaneTape *tape, const LaneRanges *ranges, const Ball *ball, size_t i)
{
    const LaneStep *step            = &tape->steps[i];
    Operand         o[MAX_OPERANDS] = {0};
    bool            sure            = true;
    for (uint32_t k = 0; k < step->operand_count; k++) {
        o[k] = operand_for(tape, ranges, step->op, step->operands[k]);
        sure = sure && o[k].sure;
    }
    bool  square = step->op == OP_mul && step->operands[0] == step->operands[1];
    Range range  = square ? range_square(o[0].range) : range_of_step(ranges, step, o);
    if (!(range.low <= range.high))
        range = ANYTHING; /* it is a number nowhere, or a rule gave up */
    if (step->op == OP_abs)
        range = range_intersect(range, lane_wave_range(tape, ranges, step));
    sure = sure && is_defined(step, o);
    if (ball && sure && step->steepest > 0)
        range = range_intersect(range, range_around(ranges->middle[LANE_INPUTS + i], step->steepest,
                                                    ranges->longest, ball));
    ranges->ranges[LANE_INPUTS + i] = range;
    ranges->sure[LANE_INPUTS + i]   = sure;
}

static Range run(const LaneTape *tape, const LaneRanges *ranges, Box box, const Ball *ball)
{
    assert(tape->scalars);
    for (uint32_t k = 0; k < LANE_INPUTS; k++) {
        bool place        = k < LANE_NORMAL;
        ranges->ranges[k] = place ? box.axis[k] : ANYTHING;
        ranges->sure[k]   = place;
    }
    for (size_t i = 0; i < tape->count; i++)
        if (tape->steps[i].op == LANE_CALL)
            run_call(tape, ranges, i);
        else if (tape->steps[i].op != LANE_PART)
            run_step(tape, ranges, ball, i);
    return lane_ranges_output(tape, ranges, 0);
}

Range lane_ranges_run(const LaneTape *tape, const LaneRanges *ranges, Box box)
{
    return run(tape, ranges, box, NULL);
}

Range lane_ranges_run_closer(const LaneTape *tape, const LaneRanges *ranges, Box box)
{
    LaneRanges middle = *ranges;
    Ball       ball   = {0, 0};
    Box        point;
    middle.ranges = ranges->middle;
    for (int k = 0; k < 3; k++) {
        Range  axis   = box.axis[k];
        double at     = 0.5 * (axis.low + axis.high);
        point.axis[k] = range_of(at);
        ball.radius   = hypot_upward(ball.radius, max2(axis.high - at, at - axis.low));
        ball.size     = max2(ball.size, range_largest(axis));
    }
    if (!isfinite(ball.radius))
        return run(tape, ranges, box, NULL);
    run(tape, &middle, point, NULL);
    return run(tape, ranges, box, &ball);
}

Range lane_ranges_output(const LaneTape *tape, const LaneRanges *ranges, size_t output)
{
    return operand_of(tape, ranges, tape->outputs[output]).range;
}
