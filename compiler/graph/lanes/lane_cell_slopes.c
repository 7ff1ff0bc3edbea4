/*
 * lane_cell_slopes.c: how fast steps of a cell tape change in a ball.
 *
 * What repeats space, and what is made of that, jumps somewhere.  In a ball where it does not, derivatives are those of
 * rows of ops.def, by ranges of the operands, which come from values in the middle and slopes again.
 */
#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/bounds/rules.h"
#include "compiler/graph/lanes/lane_cell_work.h"
#include "compiler/graph/op_values.h"

float cell_steepest(const Ball *ball, uint32_t row)
{
    const CellTape *tape = ball->tape;
    const CellStep *step = step_of(tape, row);
    if (is_constant(tape, row) || (step && step->op == LANE_NUMBER))
        return 0;
    if (!step)
        return row < tape->inputs + LANE_POINT + 3 ? 1 : HUGE_VALF;
    const float steepest = ball->steepest ? ball->steepest[step - tape->steps] : step->steepest;
    return steepest > 0 ? steepest : HUGE_VALF;
}

/* Returns the range of a row that has no slope. */
static Range known_range(const Ball *ball, uint32_t row)
{
    const CellStep *step = step_of(ball->tape, row);
    return step && ball->ranges ? ball->ranges[step - ball->tape->steps] : ANYTHING;
}

float reach_of(const Ball *ball, uint32_t row)
{
    const float steepest = cell_steepest(ball, row);
    if (isfinite(steepest))
        return steepest * (ball->radius + ball->margin);
    const Range range = known_range(ball, row);
    if (!is_finite(range))
        return HUGE_VALF;
    const double value = (double)value_of(ball, row),
                 reach = fmax(range.high - value, value - range.low) + (double)ball->margin;
    return value == value ? (float)(reach * (1 + 1e-6)) : HUGE_VALF;
}

Range cell_range(const Ball *ball, uint32_t row)
{
    const float steepest = cell_steepest(ball, row);
    if (!isfinite(steepest))
        return known_range(ball, row);
    const double value = (double)value_of(ball, row),
                 reach = (double)steepest * ((double)ball->radius + (double)ball->margin);
    return isfinite(value) && isfinite(reach) ? (Range){value - reach, value + reach} : ANYTHING;
}

/* ---- steps ---- */

/* Operands in the ball. */
typedef struct Operands {
    Range  o[MAX_OPERANDS];
    double steepest[MAX_OPERANDS];
} Operands;

static double length_of(const double *steepest, uint32_t count)
{
    double square = 0;
    for (uint32_t k = 0; k < count; k++)
        square += steepest[k] * steepest[k];
    return sqrt(square);
}

/* Fills a fact of one component with what of an operand is known. */
static void put_in_fact(Fact *fact, uint32_t component, Range range, double steepest)
{
    fact->value[component] = range;
    for (int j = 0; j < 3; j++)
        fact->gradient[component][j] = (Range){-steepest, steepest};
    fact->slope = component == 0 ? steepest : real_hypot(fact->slope, steepest);
}

/* The slope of a step in the ball, or else its range. */
typedef struct Found {
    double steepest;
    Range  range;
} Found;

static Found find_by_rule(const CellStep *step, const Operands *x)
{
    Fact      facts[MAX_OPERANDS] = {0};
    GraphType types[MAX_OPERANDS];
    for (uint32_t k = 0; k < step->operand_count; k++) {
        put_in_fact(&facts[k], 0, x->o[k], x->steepest[k]);
        types[k] = TYPE_FLOAT;
    }
    const Fact fact = op_fact((Op)step->op, TYPE_FLOAT, 0, types, facts, NULL);
    return (Found){op_has_traits((Op)step->op, STEADY) ? fact.slope : HUGE_VAL, fact.value[0]};
}

/* Returns the slope of an operation that is one of its operands. */
static double slope_of_choice(const NumberRow *row, const CellStep *step, const Operands *x)
{
    const unsigned chosen = row->chooses ? row->chooses(x->o) : 0;
    for (uint32_t k = 0; k < step->operand_count; k++)
        if (chosen == 1u << k && is_finite(x->o[k]))
            return x->steepest[k];
    return HUGE_VAL;
}

static Found find_by_partials(const NumberRow *row, const CellStep *step, const Operands *x)
{
    Range       by[MAX_OPERANDS], second[3][3];
    const Range r   = row->range(x->o);
    double      sum = 0, most = 0;
    row->first(x->o, r, by);
    /* Rows that are no MAP have derivatives of their pieces. */
    if (!row->map && row->norm != NORM_NONE && !(row->second && row->second(x->o, r, by, second)))
        return (Found){HUGE_VAL, r};
    for (uint32_t k = 0; k < step->operand_count; k++) {
        const double largest = range_largest(by[k]);
        if (largest == 0 || x->steepest[k] == 0)
            continue;
        sum += largest * x->steepest[k];
        most = fmax(most, x->steepest[k]);
    }
    return (Found){row->norm == NORM_CONVEX ? most : sum, r};
}

static Found find_of_step(const Ball *ball, const CellStep *step)
{
    const NumberRow *row = row_of_op(step->op);
    Operands         x   = {.o = {{0, 0}, {0, 0}, {0, 0}, {0, 0}}};
    for (uint32_t k = 0; k < step->operand_count; k++) {
        x.o[k]        = cell_range(ball, step->from[k]);
        x.steepest[k] = (double)cell_steepest(ball, step->from[k]);
    }
    if (step->op == OP_length)
        return (Found){length_of(x.steepest, step->operand_count),
                       length_range(x.o, step->operand_count)};
    const double chosen = slope_of_choice(row, step, &x);
    return isfinite(chosen)  ? (Found){chosen, ANYTHING}
           : row->arity == 0 ? find_by_rule(step, &x)
                             : find_by_partials(row, step, &x);
}

/* ---- calls ---- */

/* Tells whether a point lies within one sector, in which it is rotated. */
static bool is_in_one_sector(const Fact *point, const Fact *count)
{
    const Range sector = range_div(range_of(2 * M_PI), count->value[0]);
    return count->slope == 0 && count->value[0].low >= 1 &&
           range_is_single(
               range_round(range_div(range_atan2(point->value[2], point->value[0]), sector)));
}

static double slope_of_instances(const Ball *ball, const CellCall *call)
{
    double by[3];
    for (uint32_t c = 0; c < 3; c++)
        by[c] = (double)cell_steepest(ball, call->from[1][c]);
    const double slope = call->body->function->slope;
    return slope > 0 ? slope * cell_call_moves(call, by, 1) : HUGE_VAL;
}

static Found find_of_call(const Ball *ball, const CellCall *call)
{
    const Graph *graph               = ball->tape->whole->tape->graph;
    const Expr  *e                   = &graph->items[call->call->node];
    Fact         facts[MAX_OPERANDS] = {0};
    GraphType    types[MAX_OPERANDS];
    if (call->body)
        return (Found){slope_of_instances(ball, call), ANYTHING};
    if (op_has_traits((Op)e->op, READS_TABLES))
        return (Found){HUGE_VAL, ANYTHING};
    for (uint32_t k = 0; k < e->operand_count; k++) {
        types[k] = graph->items[e->operands[k]].type;
        for (uint32_t c = 0; c < 4 && call->from[k][c] != NODE_NONE; c++)
            put_in_fact(&facts[k], c, cell_range(ball, call->from[k][c]),
                        (double)cell_steepest(ball, call->from[k][c]));
    }
    if (e->op == OP_cell_polar)
        return (Found){is_in_one_sector(&facts[0], &facts[1]) ? facts[0].slope : HUGE_VAL,
                       ANYTHING};
    const Fact fact = op_fact((Op)e->op, (GraphType)e->type, e->index, types, facts, NULL);
    return (Found){fact.slope, call->call->parts == 1 ? fact.value[0] : ANYTHING};
}

void cell_find_slopes(const Ball *ball, float *steepest, Range *ranges)
{
    const CellTape *tape = ball->tape;
    for (uint32_t i = 0; i < tape->count; i++) {
        const CellStep *step = &tape->steps[i];
        steepest[i]          = step->steepest;
        if (step->steepest > 0 || step->op == LANE_NUMBER)
            continue;
        if (step->op == LANE_PART) {
            steepest[i] = steepest[i - 1];
            ranges[i]   = ANYTHING;
            continue;
        }
        const Found found = step->op == LANE_CALL ? find_of_call(ball, &tape->calls[step->from[0]])
                                                  : find_of_step(ball, step);
        /* A step that does not change has a slope, too. */
        steepest[i] = !(found.steepest < 1e30) ? 0
                      : found.steepest > 1e-30 ? (float)(found.steepest * (1 + 1e-6))
                                               : 1e-30f;
        ranges[i]   = found.range;
    }
}
