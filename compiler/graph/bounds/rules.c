/*
 * rules.c: the fact of one operation from the facts of its operands, as its row in ops.def says.
 *
 * Each operation makes the fact of its result from those of its operands: intervals of the
 * value and of the gradient by the chain rule, and a slope by a calculus of norms.  The slope
 * also follows from the gradients, so the smaller one counts, and in turn bounds them.
 *
 * A slope of 0 means that a value is the same all over the box.  What jumps has an infinite
 * slope wherever the jump may lie in the box, as boxes are closed; `cell` and `cell_polar` are
 * exceptions, whose slope holds between jumps: the shapes that use them join the pieces.
 */
#include <assert.h>
#include <math.h>

#include "compiler/graph/bounds/rules.h"

/* ---- OP rows: vectors ---- */

static Fact fact_splat(const RuleInput *input)
{
    Fact fact = {.slope = input->operands[0].slope};
    for (uint32_t i = 0; i < input->size; i++) {
        fact_set(&fact, i, jet_of(&input->operands[0], 0));
        if (i > 0)
            fact.slope = hypot_upward(fact.slope, input->operands[0].slope);
    }
    return fact;
}

static Fact fact_vector(const RuleInput *input)
{
    Fact fact = {0};
    for (uint32_t i = 0; i < input->size; i++) {
        fact_set(&fact, i, jet_of(&input->operands[i], 0));
        fact.slope = hypot_upward(fact.slope, input->operands[i].slope);
    }
    return fact;
}

/* Bounds the slope of a product: |(u . v)'| and |(u x v)'| are at most |u| |v'| + |v| |u'|, and so
   is |(s v)'|. */
static double slope_product(const RuleInput *input)
{
    const Fact *u = &input->operands[0], *v = &input->operands[1];
    double      left  = product_upward(length_range(u->value, components(input->types[0])).high,
                                       v->slope);
    double      right = product_upward(length_range(v->value, components(input->types[1])).high,
                                       u->slope);
    return sum_upward(left, right);
}

static Fact fact_dot(const RuleInput *input)
{
    Fact fact = {.slope = slope_product(input)};
    fact_set(&fact, 0, jet_dot(&input->operands[0], &input->operands[1], input->size));
    return fact;
}

static Fact fact_cross(const RuleInput *input)
{
    const Fact *u = &input->operands[0], *v = &input->operands[1];
    Fact        fact = {.slope = slope_product(input)};
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t y = (i + 1) % 3, z = (i + 2) % 3;
        Jet      left  = jet_mul(jet_of(u, y), jet_of(v, z));
        Jet      right = jet_mul(jet_of(u, z), jet_of(v, y));
        fact_set(&fact, i, jet_sub(left, right));
    }
    return fact;
}

static Fact fact_scale(const RuleInput *input)
{
    Fact fact = {.slope = slope_product(input)};
    for (uint32_t i = 0; i < input->size; i++)
        fact_set(&fact, i, jet_mul(jet_of(&input->operands[0], i), jet_of(&input->operands[1], 0)));
    return fact;
}

/* The derivative is that of v seen along the unit vector, so it is no longer than that of v:
   nothing is divided by a length that may be 0. */
static Fact fact_length(const RuleInput *input)
{
    const Fact *v     = &input->operands[0];
    Range       whole = length_range(v->value, input->size);
    Jet         jet   = {.value = whole};
    for (int j = 0; j < 3; j++) {
        double longest = 0;
        for (uint32_t i = 0; i < input->size; i++) {
            Range unit      = unit_component(v->value[i], whole);
            jet.gradient[j] = range_add(jet.gradient[j], range_mul(unit, v->gradient[i][j]));
            longest         = hypot_upward(longest, range_largest(v->gradient[i][j]));
        }
        jet.gradient[j] = range_intersect(jet.gradient[j], (Range){-longest, longest});
    }
    Fact fact = {.slope = v->slope};
    fact_set(&fact, 0, jet);
    return fact;
}

/* Returns the derivative of v, less its part along v, over the length of v. */
static Fact fact_normalize(const RuleInput *input)
{
    const Fact *v        = &input->operands[0];
    Range       whole    = length_range(v->value, input->size);
    Fact        fact     = fact_unknown(input->size);
    double      steepest = whole.low > 0 ? 1 / whole.low * (1 + 0x1p-50) : HUGE_VAL;
    fact.slope           = product_upward(v->slope, steepest);
    for (uint32_t i = 0; i < input->size; i++)
        fact.value[i] = loosened(unit_component(v->value[i], whole), 1);
    for (uint32_t i = 0; whole.low > 0 && i < input->size; i++)
        for (int j = 0; j < 3; j++) {
            Range along = range_of(0);
            for (uint32_t k = 0; k < input->size; k++)
                along = range_add(along, range_mul(fact.value[k], v->gradient[k][j]));
            Range across        = range_sub(v->gradient[i][j], range_mul(fact.value[i], along));
            fact.gradient[i][j] = range_div(across, whole);
        }
    return fact;
}

static Fact fact_component(const RuleInput *input)
{
    Fact fact = {.slope = input->operands[0].slope};
    fact_set(&fact, 0, jet_of(&input->operands[0], input->index));
    return fact;
}

/* ---- OP rows: truth and choice ---- */

/* Finds what the row says of the numbers that are operands. */
static void value_ranges(const RuleInput *input, Range *ranges)
{
    for (uint32_t k = 0; k < MAX_OPERANDS; k++)
        ranges[k] = k < number_rows[input->op].arity ? input->operands[k].value[0] : ZERO;
}

/* Returns the fact of a condition: where it is neither always true nor never, its value may jump. */
static Fact fact_truth(const RuleInput *input)
{
    const NumberRow *row = &number_rows[input->op];
    Range            ranges[MAX_OPERANDS];
    value_ranges(input, ranges);
    return fact_of_truth(input, row->arity, row->range(ranges));
}

/* Returns the fact of a choice: where the condition changes within the box, the value may jump. */
static Fact fact_select(const RuleInput *input)
{
    const Fact *truth = &input->operands[0], *yes = &input->operands[1], *no = &input->operands[2];
    if (truth->value[0].low > 0)
        return *yes;
    if (truth->value[0].high == 0)
        return *no;
    Fact fact = fact_unknown(input->size);
    for (uint32_t i = 0; i < input->size; i++) {
        Jet either = jet_hull(jet_of(yes, i), jet_of(no, i));
        if (truth->slope == 0)
            fact_set(&fact, i, either);
        fact.value[i] = either.value;
    }
    if (truth->slope == 0)
        fact.slope = fmax(yes->slope, no->slope);
    return fact;
}

/* Returns the fact of a guard: where it goes from one case to the other, its value jumps. */
static Fact fact_guard(const RuleInput *input)
{
    const NumberRow *row = &number_rows[OP_guard];
    Range            ranges[MAX_OPERANDS];
    value_ranges(input, ranges);
    const unsigned chosen = row->chooses(ranges);
    if (chosen == CHOOSES_C)
        return input->operands[2];
    Fact fact     = fact_unknown(1);
    fact.value[0] = row->range(ranges);
    if (!(chosen & CHOOSES_C))
        fact.slope = fmax(input->operands[0].slope, input->operands[1].slope);
    return fact;
}

/* ---- values alone ---- */

void range_scale(uint32_t size, Range *const *o, Range *result)
{
    for (uint32_t i = 0; i < size; i++)
        result[i] = range_mul(o[0][i], o[1][0]);
}

void range_cross(uint32_t size, Range *const *o, Range *result)
{
    const Range *u = o[0], *v = o[1];
    for (uint32_t i = 0; i < size; i++) {
        const uint32_t y = (i + 1) % 3, z = (i + 2) % 3;
        result[i] = range_add(range_mul(u[y], v[z]), range_mul(range_mul(u[z], v[y]), MINUS_ONE));
    }
}

void range_normalize(uint32_t size, Range *const *o, Range *result)
{
    const Range whole = length_range(o[0], size);
    for (uint32_t i = 0; i < size; i++)
        result[i] = loosened(unit_component(o[0][i], whole), 1);
}

RangeRule *range_rule(Op op)
{
    static RangeRule *const rules[OP_COUNT] = {
#define RANGES(name, function) [OP_##name] = (function),
#include "compiler/graph/ops.def"
    };
    return rules[op];
}

/* ---- one operation ---- */

static Fact fact_constant(const RuleInput *input, const double *constant)
{
    Fact fact = {0};
    for (uint32_t i = 0; i < input->size; i++)
        fact.value[i] = range_of(constant[i]);
    return fact;
}

/* Returns a MAP row. */
static Fact fact_of_numbers(const RuleInput *input)
{
    const NumberRow *row = &number_rows[input->op];
    Partials         rows[4];
    assert(row->map);
    for (uint32_t i = 0; i < input->size; i++) {
        Range o[MAX_OPERANDS] = {0};
        for (uint32_t k = 0; k < row->arity; k++)
            o[k] = input->operands[k].value[i];
        rows[i].value = row->range(o);
        row->first(o, rows[i].value, rows[i].by);
    }
    return fact_map((Norm)row->norm, row->arity, input->operands, rows, input->size);
}

static Rule *const rules[OP_COUNT] = {
    [OP_COMPONENT] = fact_component,
#define OP(name, signature, glsl, evaluate, facts, meaning) [OP_##name] = facts,
#include "compiler/graph/ops.def"
};

/* Of quotients of 0, too: their derivatives make the slope seem to be 0. */
bool divides_by_zero(const Range *divisor, uint32_t size)
{
    for (uint32_t i = 0; i < size; i++)
        if (range_is_zero(divisor[i]))
            return true;
    return false;
}

Fact op_fact(Op op, GraphType type, uint32_t index, const GraphType *types, const Fact *operands,
             const double *constant)
{
    RuleInput input = {
        .op = op, .type = type, .index = index, .types = types, .operands = operands};
    input.size = components(type);
    if (op != OP_CONSTANT && op != OP_COMPONENT && components(types[0]) > input.size)
        input.size = components(types[0]);
    const bool nowhere = op == OP_div && divides_by_zero(operands[1].value, input.size);
    Fact       fact    = op == OP_CONSTANT ? fact_constant(&input, constant)
                         : nowhere         ? fact_unknown(input.size)
                         : rules[op]       ? rules[op](&input)
                                           : fact_of_numbers(&input);
    return fact_agreed(fact, components(type));
}
