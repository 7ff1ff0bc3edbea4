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
#include "compiler/graph/lanes/lane_cuts.h"
#include "compiler/graph/lanes/lane_outlines.h"
#include "compiler/graph/lanes/lane_segments.h"
#include "compiler/graph/lanes/lane_steps.h"
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
    return lane_range_at(run->tape, run->ranges, operand);
}

static LaneSlope slope_at(const Run *run, uint32_t operand)
{
    return operand & LANE_SCALAR ? NO_SLOPE : run->slopes[operand];
}

static Range     range_in(const Run *run, int k) { return range_at(run, run->step->operands[k]); }
static LaneSlope slope_in(const Run *run, int k) { return slope_at(run, run->step->operands[k]); }
static Range     result(const Run *run) { return run->ranges->ranges[LANE_INPUTS + run->at]; }

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

/* Holds the slopes of each of these operands. */
static LaneSlope slope_of_any(const Run *run, unsigned operands)
{
    LaneSlope hull = {{{HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}}};
    for (int k = 0; operands >> k; k++)
        if (operands >> k & 1)
            hull = either(hull, slope_in(run, k));
    return hull;
}

/* ---- by the rows ---- */

static LaneSlope slope_by_partials(const Run *run, const NumberRow *row, const Range *by)
{
    bool      mean = row->norm == NORM_MIX && by[0].low >= 0 && by[1].low >= 0;
    LaneSlope sum  = NO_SLOPE;
    for (int k = 0; k < row->arity; k++) {
        add_times(&sum, by[k], slope_in(run, k));
        if (mean && k == 1) {
            unsigned  counted = (range_is_zero(by[0]) ? 0 : 1) + (range_is_zero(by[1]) ? 0 : 2);
            LaneSlope hull    = slope_of_any(run, counted);
            for (int j = 0; j < 3; j++)
                sum.by[j] = range_intersect(sum.by[j], hull.by[j]);
        }
    }
    return sum;
}

/* ---- lengths ---- */

/* Returns the slope of a length: no more than the derivative of the vector. */
static LaneSlope slope_of_length(const Run *run)
{
    uint32_t only = lane_only_operand(run->tape, run->ranges, run->step);
    Range    part = only == NODE_NONE ? ANYTHING : range_at(run, only);
    if (part.low >= 0 || part.high <= 0) { /* it is that number, or its complement */
        LaneSlope slope = NO_SLOPE;
        add_times(&slope, range_of(part.high > 0 ? 1 : -1), slope_at(run, only));
        return slope;
    }
    double    longest[3] = {0, 0, 0};
    LaneSlope sum        = NO_SLOPE;
    uint32_t  from[MAX_OPERANDS];
    bool      segment = lane_from_segment(run->tape, run->step, from);
    for (uint32_t k = 0; k < run->step->operand_count; k++) {
        LaneSlope slope = slope_in(run, (int)k);
        add_times(&sum, unit_component(range_in(run, (int)k), result(run)),
                  segment ? slope_at(run, from[k]) : slope);
        for (int j = 0; j < 3; j++)
            longest[j] = hypot_upward(longest[j], range_largest(slope.by[j]));
    }
    for (int j = 0; j < 3; j++)
        sum.by[j] = range_intersect(sum.by[j], (Range){-longest[j], longest[j]});
    return sum;
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

/* Finds the slopes of an outline; false: it is none, or its derivatives are not known. */
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
        for (uint32_t c = 0; c < components(types[k]); c++)
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
    const NumberRow *row = lane_row(run->step);
    Range            o[MAX_OPERANDS], by[MAX_OPERANDS];
    lane_operands(run->tape, run->ranges, run->step, o);
    unsigned chosen = row->chooses ? row->chooses(o) : 0;
    if (chosen)
        return slope_of_any(run, chosen);
    if (run->step->op == OP_length)
        return slope_of_length(run);
    if (row->arity == 0)
        return slope_by_rule(run);
    row->first(o, result(run), by);
    return slope_by_partials(run, row, by);
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

/* Sets the slopes of inputs.  Normals and footprints may change in any way. */
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
    bool     sure   = lane_is_sure(tape, ranges, output);
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

/* Tells by a step's row whether its own derivatives have no bound or, if it may be one of its
   operands somewhere or is linear, those of an operand that counts. */
static bool step_is_boundless(Boundless *b, const LaneStep *step, Range result)
{
    const NumberRow *row = lane_row(step);
    Range            o[MAX_OPERANDS], by[MAX_OPERANDS] = {ZERO};
    lane_operands(b->run.tape, b->run.ranges, step, o);
    unsigned chosen = row->chooses ? row->chooses(o) : 0;
    if (!chosen && row->arity)
        row->first(o, result, by);
    for (uint32_t k = 0; k < row->arity; k++) {
        if (range_is_single(o[k]) || (chosen ? !(chosen >> k & 1) : range_is_zero(by[k])))
            continue;
        if (!is_finite(by[k]) ||
            ((row->chooses || range_is_single(by[k])) && is_boundless(b, step->operands[k])))
            return true;
    }
    return false;
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
