/*
 * lane_ranges.c: a lane tape over a box, in intervals.
 *
 * Ranges hold every value that lanes find in the box, as far as it is a number.  Where it is one in every
 * point the value is sure; pruning needs that, since a minimum with what is not a number is the other
 * operand.
 */
#include <assert.h>
#include <math.h>

#include "compiler/graph/bounds/rules.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/lanes/lane_call.h"
#include "compiler/graph/lanes/lane_steps.h"
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

/* Tells whether it is surely a number.  What is none may act as any, unless the result needs it to be one. */
static bool operand_for(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand,
                        bool needed, Range *range)
{
    bool sure = lane_is_sure(tape, ranges, operand);
    *range    = sure || (needed && !(operand & LANE_SCALAR)) ? lane_range_at(tape, ranges, operand)
                                                             : ANYTHING;
    return sure;
}

/* ---- steps ---- */

/* The length of three numbers is that of a pair, of which one is a length of a pair, or nearly so. */
static Range range_length(const LaneRanges *ranges, const Range *o, uint32_t size)
{
    Range sum = range_square(o[0]);
    for (uint32_t i = 1; i < size; i++)
        sum = range_add(sum, range_square(o[i]));
    Range length = sum.high == 0 ? range_of(0) : range_sqrt(sum);
    if (ranges->stretch > 1 && size > 1) {
        double by = size > 2 ? ranges->longest : ranges->stretch;
        length    = (Range){length.low / by, length.high * by};
    }
    return length;
}

/* ---- by the rules of facts ---- */

static Fact fact_in(Range range)
{
    Fact fact     = fact_unknown(1);
    fact.value[0] = range;
    return fact;
}

static Range range_by_rule(uint16_t op, const Range *o, uint32_t count)
{
    Fact      facts[MAX_OPERANDS];
    GraphType types[MAX_OPERANDS];
    for (uint32_t k = 0; k < count; k++) {
        facts[k] = fact_in(o[k]);
        types[k] = TYPE_FLOAT;
    }
    return op_fact((Op)op, TYPE_FLOAT, 0, types, facts, NULL).value[0];
}

/* Tells whether an operand is the same everywhere: some rules know values only then. */
static bool is_scalar(const LaneCall *call, uint32_t operand, GraphType type)
{
    uint32_t scalars = 0;
    for (uint32_t c = 0; c < components(type); c++)
        scalars += (call->operands[operand][c] & LANE_SCALAR) != 0;
    return scalars == components(type);
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
        facts[k] = is_scalar(call, k, types[k]) ? (Fact){0} : fact_unknown(components(types[k]));
        for (uint32_t c = 0; c < components(types[k]); c++) {
            sure = operand_for(tape, ranges, call->operands[k][c], false, &facts[k].value[c]) &&
                   sure && is_finite(facts[k].value[c]);
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

static Range range_of_step(const LaneRanges *ranges, const LaneStep *step, const Range *o)
{
    const NumberRow *row = lane_row(step);
    if (step->op == OP_length)
        return range_length(ranges, o, step->operand_count);
    Range range = row->arity ? row->range(o) : range_by_rule(step->op, o, step->operand_count);
    /* Pruning leaves differences of a number and what is clamped of it, and such quotients. */
    return row->itself && step->operands[0] == step->operands[1] ? row->itself(o[0], range) : range;
}

/* Tells whether it is a number wherever its operands are. */
static bool is_defined(const LaneStep *step, const Range *o)
{
    const NumberRow *row    = lane_row(step);
    bool             finite = true;
    for (uint32_t k = 0; k < step->operand_count; k++)
        finite = finite && is_finite(o[k]);
    return row->defined ? row->defined(o, finite)
                        : finite && op_has_traits((Op)step->op, STAYS_FINITE);
}

/* The ball around a box, and the largest coordinate in it. */
typedef struct Ball {
    double radius, size;
} Ball;

/* Returns the range around a value in the middle, as far as its steepness and the box permit.
   Rounding is far below these parts of the numbers around. */
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
    Range           o[MAX_OPERANDS] = {0};
    bool            sure            = true;
    for (uint32_t k = 0; k < step->operand_count; k++)
        sure = operand_for(tape, ranges, step->operands[k], lane_row(step)->needs, &o[k]) && sure;
    Range range = range_of_step(ranges, step, o);
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
    Range range;
    operand_for(tape, ranges, tape->outputs[output], true, &range);
    return range;
}
