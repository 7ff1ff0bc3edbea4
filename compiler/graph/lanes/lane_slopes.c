/*
 * lane_slopes.c: how fast the result of a lane tape changes within a box, in intervals.
 *
 * Values come from a run of lane_ranges.c over the same box.  The chain rule makes ranges of the
 * derivatives from them, by the columns of ops.def.  Where a value has a corner its derivatives are
 * the hull of those around it, so that the mean value theorem holds across it.  What may jump can
 * have any derivative.  Choices and `cell` count as their pieces do: distances do not jump, since their
 * slopes have bounds, so shapes join these pieces.
 */
#include <math.h>
#include <string.h>

#include "compiler/graph/bounds/rules.h"
#include "compiler/graph/lanes/lane_call.h"
#include "compiler/graph/lanes/lane_cuts.h"
#include "compiler/graph/lanes/lane_outlines.h"
#include "compiler/graph/lanes/lane_segments.h"
#include "compiler/graph/texture.h"

static const LaneSlope NO_SLOPE  = {{{0, 0}, {0, 0}, {0, 0}}};
static const LaneSlope ANY_SLOPE = {
    {{-HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, HUGE_VAL}}};

/* A run over a tape, and the step that it is at. */
typedef struct Run {
    const LaneTape   *tape;
    const LaneRanges *ranges;
    LaneSlope        *slopes;
    size_t            at;
    const LaneStep   *step;
} Run;

LaneSlope *lane_slopes_new(const LaneTape *tape, Arena *arena)
{
    return arena_new_array(arena, LaneSlope, LANE_INPUTS + lane_max_steps(tape));
}

/* ---- operands ---- */

static Range range_at(const Run *run, uint32_t operand)
{
    if (operand & LANE_SCALAR)
        return range_of(run->tape->scalars[operand & ~LANE_SCALAR]);
    return run->ranges->ranges[operand];
}

static LaneSlope slope_at(const Run *run, uint32_t operand)
{
    return operand & LANE_SCALAR ? NO_SLOPE : run->slopes[operand];
}

static Range     range_in(const Run *run, int k) { return range_at(run, run->step->operands[k]); }
static LaneSlope slope_in(const Run *run, int k) { return slope_at(run, run->step->operands[k]); }
static Range     result(const Run *run) { return run->ranges->ranges[LANE_INPUTS + run->at]; }

static bool is_constant(const LaneSlope *slope)
{
    return range_is_zero(slope->by[0]) && range_is_zero(slope->by[1]) &&
           range_is_zero(slope->by[2]);
}

static LaneSlope either(LaneSlope a, LaneSlope b)
{
    for (int j = 0; j < 3; j++)
        a.by[j] = range_hull(a.by[j], b.by[j]);
    return a;
}

static void add_times(LaneSlope *sum, Range factor, LaneSlope slope)
{
    if (range_is_zero(factor))
        return;
    for (int j = 0; j < 3; j++)
        if (!range_is_zero(slope.by[j]))
            sum->by[j] = range_add(sum->by[j], range_mul(factor, slope.by[j]));
}

/* ---- MAP rows ---- */

static LaneSlope slope_by_partials(const Run *run, const Range partials[3], int count, Norm norm)
{
    int       averaged = norm == NORM_MIX ? 2 : norm == NORM_CONVEX ? count : 0;
    LaneSlope sum      = NO_SLOPE,
              hull     = {{{HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}}};
    bool mean          = averaged > 0 && partials[0].low >= 0 && partials[1].low >= 0;
    for (int k = 0; k < count; k++) {
        LaneSlope slope = slope_in(run, k);
        if (mean && k == averaged)
            for (int j = 0; j < 3; j++)
                sum.by[j] = range_intersect(sum.by[j], hull.by[j]);
        add_times(&sum, partials[k], slope);
        if (k < averaged && !range_is_zero(partials[k]))
            hull = either(hull, slope);
    }
    for (int j = 0; mean && averaged == count && j < 3; j++)
        sum.by[j] = range_intersect(sum.by[j], hull.by[j]);
    return sum;
}

static bool is_map(uint16_t op)
{
    switch (op) {
#define MAP(name, ...) case OP_##name:
#include "compiler/graph/ops.def"
        return true;
    default: return false;
    }
}

static LaneSlope slope_of_map(const Run *run)
{
    uint32_t count = run->step->operand_count;
    Range    a = range_in(run, 0), r = result(run);
    Range    b = count > 1 ? range_in(run, 1) : range_of(0);
    Range    c = count > 2 ? range_in(run, 2) : range_of(0);
    (void)a, (void)b, (void)c, (void)r;
    switch (run->step->op) {
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning) \
    case OP_##name:                                                             \
        return slope_by_partials(run, (const Range[3]){(da), (db), (dc)}, (arity), norm);
#include "compiler/graph/ops.def"
    default: return ANY_SLOPE;
    }
}

/* ---- other steps ---- */

static LaneSlope slope_of_lesser(const Run *run, int sign)
{
    Range a = range_in(run, 0), b = range_in(run, 1);
    if (sign > 0 ? a.high <= b.low : a.low >= b.high)
        return slope_in(run, 0);
    if (sign > 0 ? b.high <= a.low : b.low >= a.high)
        return slope_in(run, 1);
    return either(slope_in(run, 0), slope_in(run, 1));
}

static LaneSlope slope_of_select(const Run *run)
{
    Range condition = range_in(run, 0);
    if (condition.low > 0)
        return slope_in(run, 1);
    return condition.high <= 0 ? slope_in(run, 2) : either(slope_in(run, 1), slope_in(run, 2));
}

static LaneSlope slope_of_guard(const Run *run)
{
    switch (lane_guard_decides(range_in(run, 0), range_in(run, 1), range_in(run, 3))) {
    case LANE_ALWAYS: return slope_of_lesser(run, 1);
    case LANE_NEVER: return slope_in(run, 2);
    default: return either(slope_of_lesser(run, 1), slope_in(run, 2));
    }
}

/* A component of the unit vector along a vector of this length. */
static Range unit_part(Range component, Range length)
{
    Range sides = {component.low < 0 ? -1 : 0, component.high > 0 ? 1 : 0};
    return length.low > 0 ? range_intersect(range_div(component, length), sides) : sides;
}

/* The operand of a length that alone is not 0 all over the box, if its sign is known: the length is that number, or its
   complement.  -1: there is none. */
static int only_component(const Run *run)
{
    int only = -1;
    for (uint32_t k = 0; k < run->step->operand_count; k++) {
        Range range = range_in(run, (int)k);
        if (range_is_zero(range))
            continue;
        if (only >= 0 || (range.low < 0 && range.high > 0))
            return -1;
        only = (int)k;
    }
    return only;
}

/* The slope of a length: no more than the derivative of the vector. */
static LaneSlope slope_of_length(const Run *run)
{
    int only = only_component(run);
    if (only >= 0) {
        LaneSlope slope = NO_SLOPE;
        add_times(&slope, range_of(range_in(run, only).high > 0 ? 1 : -1), slope_in(run, only));
        return slope;
    }
    double    longest[3] = {0, 0, 0};
    LaneSlope sum        = NO_SLOPE;
    uint32_t  from[MAX_OPERANDS];
    bool      segment = lane_from_segment(run->tape, run->step, from);
    for (uint32_t k = 0; k < run->step->operand_count; k++) {
        LaneSlope slope = slope_in(run, (int)k);
        add_times(&sum, unit_part(range_in(run, (int)k), result(run)),
                  segment ? slope_at(run, from[k]) : slope);
        for (int j = 0; j < 3; j++)
            longest[j] = hypot_upward(longest[j], range_largest(slope.by[j]));
    }
    for (int j = 0; j < 3; j++)
        sum.by[j] = range_intersect(sum.by[j], (Range){-longest[j], longest[j]});
    return sum;
}

/* A component over the length. */
static LaneSlope slope_of_normalize(const Run *run)
{
    Range     length = range_in(run, 1);
    LaneSlope sum    = NO_SLOPE;
    if (!(length.low > 0))
        return ANY_SLOPE;
    Range inverse = range_div(range_of(1), length);
    add_times(&sum, inverse, slope_in(run, 0));
    add_times(&sum, range_neg(range_mul(result(run), inverse)), slope_in(run, 1));
    return sum;
}

static LaneSlope slope_of_cell(const Run *run)
{
    for (int k = 1; k < 4; k++) {
        LaneSlope slope = slope_in(run, k);
        if (!is_constant(&slope))
            return ANY_SLOPE;
    }
    return slope_in(run, 0);
}

/* ---- by the rules of facts ---- */

static void put_in_fact(const Run *run, Fact *fact, uint32_t component, uint32_t operand)
{
    LaneSlope slope        = slope_at(run, operand);
    double    length       = 0;
    fact->value[component] = range_at(run, operand);
    for (int j = 0; j < 3; j++) {
        fact->gradient[component][j] = slope.by[j];
        length                       = hypot_upward(length, range_largest(slope.by[j]));
    }
    fact->slope = hypot_upward(fact->slope, length);
}

static LaneSlope slope_of_fact(const Fact *fact, uint32_t component)
{
    LaneSlope slope;
    memcpy(slope.by, fact->gradient[component], sizeof slope.by);
    return slope;
}

static LaneSlope slope_by_rule(const Run *run)
{
    Fact      facts[MAX_OPERANDS] = {0};
    GraphType types[MAX_OPERANDS];
    for (uint32_t k = 0; k < run->step->operand_count; k++) {
        put_in_fact(run, &facts[k], 0, run->step->operands[k]);
        types[k] = TYPE_FLOAT;
    }
    Fact fact = op_fact((Op)run->step->op, TYPE_FLOAT, 0, types, facts, NULL);
    return slope_of_fact(&fact, 0);
}

/* False: it is no outline, or its derivatives are not known. */
static bool run_outline(Run *run, const LaneCall *call)
{
    const OutlinePartials p     = lane_outline_partials(run->tape, run->ranges, run->at);
    LaneSlope             slope = NO_SLOPE;
    if (!p.known)
        return false;
    for (int k = 0; k < 2; k++)
        add_times(&slope, p.first[k], slope_at(run, call->operands[1][k]));
    run->slopes[LANE_INPUTS + run->at] = slope;
    return true;
}

static void run_call(Run *run)
{
    const LaneCall *call                = &run->tape->calls[run->step->operands[0]];
    const Graph    *graph               = run->tape->tape->graph;
    const Expr     *e                   = &graph->items[call->node];
    Fact            facts[MAX_OPERANDS] = {0};
    GraphType       types[MAX_OPERANDS];
    if (run_outline(run, call))
        return;
    for (uint32_t k = 0; k < e->operand_count; k++) {
        types[k] = graph->items[e->operands[k]].type;
        for (uint32_t c = 0; c < type_size(types[k]); c++)
            put_in_fact(run, &facts[k], c, call->operands[k][c]);
    }
    Fact fact = is_texture((Op)e->op)
                    ? texture_fact_of(graph, e, facts)
                    : op_fact((Op)e->op, (GraphType)e->type, e->index, types, facts, NULL);
    for (uint32_t c = 0; c < call->parts; c++)
        run->slopes[LANE_INPUTS + run->at + c] = slope_of_fact(&fact, c);
}

/* ---- runs ---- */

static LaneSlope slope_of_step(const Run *run)
{
    uint32_t whole = lane_sum_of_cuts(run->tape, run->ranges, run->step);
    if (whole != NODE_NONE)
        return slope_at(run, whole);
    switch (run->step->op) {
    case OP_min:
    case LANE_LESSER: return slope_of_lesser(run, 1);
    case OP_max:
    case LANE_GREATER: return slope_of_lesser(run, -1);
    case OP_select: return slope_of_select(run);
    case OP_guard: return slope_of_guard(run);
    case OP_length: return slope_of_length(run);
    case OP_normalize: return slope_of_normalize(run);
    case OP_cell: return slope_of_cell(run);
    default: return is_map(run->step->op) ? slope_of_map(run) : slope_by_rule(run);
    }
}

static void run_step(Run *run)
{
    LaneSlope slope = slope_of_step(run);
    for (int j = 0; j < 3; j++)
        if (!(slope.by[j].low <= slope.by[j].high))
            slope = ANY_SLOPE;
    bool same = range_is_single(result(run)) && run->ranges->sure[LANE_INPUTS + run->at];
    run->slopes[LANE_INPUTS + run->at] = same ? NO_SLOPE : slope;
}

/* Normals and footprints may change in any way. */
static void start_inputs(Run *run)
{
    for (uint32_t k = 0; k < LANE_INPUTS; k++)
        run->slopes[k] = k < LANE_NORMAL ? NO_SLOPE : ANY_SLOPE;
    for (int k = 0; k < 3; k++)
        run->slopes[LANE_POINT + k].by[k] = range_of(1);
}

bool lane_slopes_run(const LaneTape *tape, const LaneRanges *ranges, LaneSlope *slopes,
                     LaneSlope *slope)
{
    Run run = {.tape = tape, .ranges = ranges, .slopes = slopes};
    start_inputs(&run);
    for (run.at = 0; run.at < tape->count; run.at++) {
        run.step = &tape->steps[run.at];
        if (run.step->op == LANE_CALL)
            run_call(&run);
        else if (run.step->op != LANE_PART)
            run_step(&run);
    }
    uint32_t output = tape->outputs[0];
    bool     sure   = output & LANE_SCALAR ? !isnan(tape->scalars[output & ~LANE_SCALAR])
                                           : ranges->sure[output];
    *slope          = slope_at(&run, output);
    for (int j = 0; j < 3; j++)
        sure = sure && isfinite(slope->by[j].low) && isfinite(slope->by[j].high);
    return sure;
}

/* ---- what has no bounds ---- */

/* A search through the steps before one; DAGs have many ways, so only so many steps are visited. */
typedef struct Boundless {
    Run run;
    int visits;
} Boundless;

static bool is_boundless(Boundless *b, uint32_t operand);

/* One of two, unless it is clear which. */
static bool lesser_is_boundless(Boundless *b, const LaneStep *step, int sign)
{
    Range first  = range_at(&b->run, step->operands[0]),
          second = range_at(&b->run, step->operands[1]);
    if (sign > 0 ? first.high <= second.low : first.low >= second.high)
        return is_boundless(b, step->operands[0]);
    if (sign > 0 ? second.high <= first.low : second.low >= first.high)
        return is_boundless(b, step->operands[1]);
    return is_boundless(b, step->operands[0]) || is_boundless(b, step->operands[1]);
}

static bool factor_is_boundless(Boundless *b, const LaneStep *step)
{
    for (int k = 0; k < 2; k++)
        if (!range_is_zero(range_at(&b->run, step->operands[1 - k])) &&
            is_boundless(b, step->operands[k]))
            return true;
    return false;
}

static bool step_is_boundless(Boundless *b, const LaneStep *step, Range result)
{
    Range first = range_at(&b->run, step->operands[0]);
    switch (step->op) {
    case OP_sign: return true;
    case OP_sqrt: return result.low <= 0 && !range_is_single(first);
    case OP_neg: return is_boundless(b, step->operands[0]);
    case OP_add:
    case OP_sub: return is_boundless(b, step->operands[0]) || is_boundless(b, step->operands[1]);
    case OP_mul: return factor_is_boundless(b, step);
    case OP_min:
    case LANE_LESSER: return lesser_is_boundless(b, step, 1);
    case OP_max:
    case LANE_GREATER: return lesser_is_boundless(b, step, -1);
    case OP_select:
        return first.low <= 0 && first.high > 0 &&
               (is_boundless(b, step->operands[1]) || is_boundless(b, step->operands[2]));
    default: return false;
    }
}

static bool is_boundless(Boundless *b, uint32_t operand)
{
    if ((operand & LANE_SCALAR) || operand < LANE_INPUTS ||
        range_is_single(range_at(&b->run, operand)) || b->visits-- == 0)
        return false;
    return step_is_boundless(b, &b->run.tape->steps[operand - LANE_INPUTS],
                             range_at(&b->run, operand));
}

bool lane_is_boundless(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand)
{
    enum { MAX_VISITS = 64 };
    Boundless b = {{.tape = tape, .ranges = ranges}, MAX_VISITS};
    return is_boundless(&b, operand);
}
