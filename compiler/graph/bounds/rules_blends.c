/*
 * rules_blends.c: facts of smooth minima of a and b over a width k, and of the weight of each.
 */
#include <math.h>

#include "compiler/graph/bounds/rules.h"

static double smooth_corner(const RuleInput *input, double a, double b, double k, double n)
{
    static const GraphType types[]    = {TYPE_FLOAT, TYPE_FLOAT, TYPE_FLOAT, TYPE_FLOAT};
    NodeValue              operands[] = {{{a}}, {{b}}, {{k}}, {{n}}};
    return op_evaluate(input->op, TYPE_FLOAT, 0, types, operands).v[0];
}

/* Returns the range of a blend, which grows with a and b and shrinks with k. */
static Range smooth_range(const RuleInput *input, double n)
{
    Range  a = input->operands[0].value[0], b = input->operands[1].value[0];
    Range  k     = input->operands[2].value[0];
    double low   = smooth_corner(input, a.low, b.low, k.high, n);
    double high  = smooth_corner(input, a.high, b.high, k.low, n);
    Range  range = {isnan(low) ? -HUGE_VAL : low, isnan(high) ? HUGE_VAL : high};
    double scale = fmin(range_largest(a) + range_largest(b), 1e300) + fmin(fabs(k.high), 1e300);
    return loosened(range, scale);
}

/* A width (or number of steps) that moves with the point would need a rule of its own. */
static Fact fact_smooth_of(const RuleInput *input, uint32_t first, uint32_t count, Range value,
                           double slope, Jet jet)
{
    Fact fact = fact_unknown(1);
    if (operands_constant(input, first, count)) {
        fact_set(&fact, 0, jet);
        fact.slope = slope;
    }
    fact.value[0] = value;
    return fact;
}

static Fact fact_smooth(const RuleInput *input, uint32_t count, Range value, double slope, Jet jet)
{
    return fact_smooth_of(input, 2, count, value, slope, jet);
}

/* The derivatives by a and b are at least 0 and sum to 1. */
static Fact smooth_mean(const RuleInput *input, uint32_t count, Range value)
{
    const Fact *a = &input->operands[0], *b = &input->operands[1];
    Jet         either = jet_hull(jet_of(a, 0), jet_of(b, 0));
    return fact_smooth(input, count, value, fmax(a->slope, b->slope), either);
}

/* Returns the same where one of them is 1 further apart than the width. */
static Fact smooth_mean_within(const RuleInput *input, uint32_t count, Range value)
{
    const Fact *a = &input->operands[0], *b = &input->operands[1];
    double      width = fmax(input->operands[2].value[0].high, 0);
    if (a->value[0].high + width <= b->value[0].low)
        return fact_smooth(input, count, value, a->slope, jet_of(a, 0));
    if (b->value[0].high + width <= a->value[0].low)
        return fact_smooth(input, count, value, b->slope, jet_of(b, 0));
    return smooth_mean(input, count, value);
}

Fact fact_smin(const RuleInput *input)
{
    return smooth_mean_within(input, 3, smooth_range(input, 0));
}
Fact fact_smin_endless(const RuleInput *input)
{
    return smooth_mean(input, 3, smooth_range(input, 0));
}

/* Along the arc the derivatives by a and b are the sides of a unit vector: |a'| and |b'| add as
   the sides of a right triangle, at most sqrt 2 times the larger. */
Fact fact_smin_circular(const RuleInput *input)
{
    const Fact *a = &input->operands[0], *b = &input->operands[1];
    Jet         left = jet_of(a, 0), right = jet_of(b, 0);
    double      width = input->operands[2].value[0].high;
    Range       value = smooth_range(input, 0), weight = {0, 1};
    if (left.value.low >= fmax(width, right.value.high))
        return fact_smooth(input, 3, value, b->slope, right);
    if (right.value.low >= fmax(width, left.value.high))
        return fact_smooth(input, 3, value, a->slope, left);
    Jet sum = jet_add(jet_times(left, weight), jet_times(right, weight));
    return fact_smooth(input, 3, value, hypot_upward(a->slope, b->slope), sum);
}

/* The third candidate, (a + b - k) / sqrt 2, is as steep as sqrt 1/2 of both together. */
Fact fact_smin_chamfer(const RuleInput *input)
{
    const Fact *a = &input->operands[0], *b = &input->operands[1];
    Jet         candidates[3] = {jet_of(a, 0), jet_of(b, 0)};
    double      both = product_upward(sqrt(0.5) * (1 + 0x1p-50), sum_upward(a->slope, b->slope));
    double      slopes[3] = {a->slope, b->slope, both}, slope = 0;
    Range       root = {sqrt(0.5) * (1 - 0x1p-50), sqrt(0.5) * (1 + 0x1p-50)};
    Jet         sum  = jet_add(candidates[0], candidates[1]);
    sum.value        = range_sub(sum.value, range_above(input->operands[2].value[0], 0));
    candidates[2]    = jet_times(sum, root);
    double least     = fmin(candidates[0].value.high, candidates[1].value.high);
    Jet hull = {.gradient = {{HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}}};
    for (int i = 0; i < 3; i++)
        if (candidates[i].value.low <= least) {
            hull  = jet_hull(hull, candidates[i]);
            slope = fmax(slope, slopes[i]);
        }
    return fact_smooth(input, 3, smooth_range(input, 0), slope, hull);
}

/* Returns the fact of stairs: on each step one of a and b has the derivative 1 and the other 0
   (op_values.c). */
Fact fact_smin_stairs(const RuleInput *input)
{
    Range  a = input->operands[0].value[0], b = input->operands[1].value[0];
    Range  k = input->operands[2].value[0], n = input->operands[3].value[0];
    Range  value  = range_min(a, b);
    double lowest = sum_upward(sum_upward(-a.low, -b.low), fmax(k.high, 0)) / -2;
    value.low     = fmin(value.low, lowest);
    if (range_is_single(k) && range_is_single(n))
        value = range_intersect(value, smooth_range(input, n.low));
    double scale = range_largest(a) + range_largest(b) + range_largest(k);
    return smooth_mean_within(input, 4, loosened(value, scale));
}

/* ---- of several numbers that share the result ---- */

/* Returns the value at all components of the vectors at their least, or at their greatest. */
static double shares_corner(const RuleInput *input, uint32_t vectors, bool high, double width)
{
    NodeValue operands[MAX_OPERANDS] = {{{0}}};
    for (uint32_t k = 0; k < vectors; k++)
        for (int i = 0; i < 4; i++) {
            Range component  = input->operands[k].value[i];
            operands[k].v[i] = high ? component.high : component.low;
        }
    operands[vectors].v[0] = width;
    return op_evaluate(input->op, TYPE_FLOAT, 0, input->types, operands).v[0];
}

/* Returns the range of a blend; `grows`: with the width, too.  A result shrinks with it. */
static Range shares_range(const RuleInput *input, uint32_t vectors, bool grows)
{
    Range  k     = input->operands[vectors].value[0];
    double low   = shares_corner(input, vectors, false, grows ? k.low : k.high);
    double high  = shares_corner(input, vectors, true, grows ? k.high : k.low);
    Range  range = {isnan(low) ? -HUGE_VAL : low, isnan(high) ? HUGE_VAL : high};
    double scale = fmin(fmax(fabs(low), fabs(high)), 1e300) + fmin(range_largest(k), 1e300);
    return loosened(range, scale);
}

/* Shares are at least 0, and their sum is 1.  What is a width above another has none. */
static Fact mean_of_shares(const RuleInput *input, bool grows)
{
    const uint32_t vectors = input->types[1] == TYPE_VEC4 ? 2 : 1;
    const double   width   = fmax(input->operands[vectors].value[0].high, 0);
    double         least = HUGE_VAL, slope = 0;
    Jet hull = {.gradient = {{HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL}}};
    for (uint32_t k = 0; k < vectors; k++)
        for (uint32_t i = 0; i < 4; i++)
            least = fmin(least, input->operands[k].value[i].high);
    for (uint32_t k = 0; k < vectors; k++) {
        for (uint32_t i = 0; i < 4; i++)
            if (!(input->operands[k].value[i].low > least + width))
                hull = jet_hull(hull, jet_of(&input->operands[k], i));
        slope = fmax(slope, input->operands[k].slope);
    }
    return fact_smooth_of(input, vectors, vectors + 1, shares_range(input, vectors, grows), slope,
                          hull);
}

Fact fact_smin_shares(const RuleInput *input) { return mean_of_shares(input, false); }
Fact fact_blend_threshold(const RuleInput *input) { return mean_of_shares(input, true); }

Fact fact_blend_weight(const RuleInput *input)
{
    const Fact *a = &input->operands[0], *b = &input->operands[1];
    Range       k = input->operands[2].value[0], value = {1, 0};
    double      ks[2] = {k.low, k.high};
    for (int i = 0; i < 2; i++) {
        double low  = smooth_corner(input, a->value[0].high, b->value[0].low, ks[i], 0);
        double high = smooth_corner(input, a->value[0].low, b->value[0].high, ks[i], 0);
        value       = range_hull(value, (Range){low, high});
    }
    double steepest   = k.low > 0 ? 0.5 / k.low * (1 + 0x1p-50) : HUGE_VAL;
    double slope      = product_upward(steepest, sum_upward(a->slope, b->slope));
    Jet    difference = jet_sub(jet_of(b, 0), jet_of(a, 0));
    Jet    jet        = jet_times(difference, (Range){0, steepest});
    bool   flat       = range_is_single(value);
    return fact_smooth(input, 3, flat ? value : loosened(value, 1), slope, jet);
}
