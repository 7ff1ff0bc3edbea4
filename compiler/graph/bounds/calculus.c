/*
 * calculus.c: what rules are made of: gradients by the chain rule, slopes by norms, and how the two
 * meet.
 */
#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/bounds/rules.h"

/* ---- one component with its gradient ---- */

Fact fact_unknown(uint32_t size)
{
    Fact fact = {.slope = HUGE_VAL};
    for (uint32_t i = 0; i < size; i++) {
        fact.value[i] = ANYTHING;
        for (int j = 0; j < 3; j++)
            fact.gradient[i][j] = ANYTHING;
    }
    return fact;
}

bool operands_constant(const RuleInput *input, uint32_t first, uint32_t count)
{
    for (uint32_t i = first; i < count; i++)
        if (input->operands[i].slope != 0)
            return false;
    return true;
}

Jet jet_of(const Fact *fact, uint32_t i)
{
    return (Jet){fact->value[i],
                 {fact->gradient[i][0], fact->gradient[i][1], fact->gradient[i][2]}};
}

void fact_set(Fact *fact, uint32_t i, Jet jet)
{
    fact->value[i] = jet.value;
    for (int j = 0; j < 3; j++)
        fact->gradient[i][j] = jet.gradient[j];
}

Jet jet_add(Jet a, Jet b)
{
    Jet sum = {.value = range_add(a.value, b.value)};
    for (int j = 0; j < 3; j++)
        sum.gradient[j] = range_add(a.gradient[j], b.gradient[j]);
    return sum;
}

Jet jet_times(Jet a, Range factor)
{
    a.value = range_mul(a.value, factor);
    for (int j = 0; j < 3; j++)
        a.gradient[j] = range_mul(a.gradient[j], factor);
    return a;
}

Jet jet_sub(Jet a, Jet b) { return jet_add(a, jet_times(b, range_of(-1))); }

Jet jet_mul(Jet a, Jet b)
{
    Jet product = {.value = range_mul(a.value, b.value)};
    for (int j = 0; j < 3; j++)
        product.gradient[j] = range_add(range_mul(a.value, b.gradient[j]),
                                        range_mul(b.value, a.gradient[j]));
    return product;
}

Jet jet_hull(Jet a, Jet b)
{
    a.value = range_hull(a.value, b.value);
    for (int j = 0; j < 3; j++)
        a.gradient[j] = range_hull(a.gradient[j], b.gradient[j]);
    return a;
}

Jet jet_dot(const Fact *a, const Fact *b, uint32_t size)
{
    Jet sum = jet_mul(jet_of(a, 0), jet_of(b, 0));
    for (uint32_t i = 1; i < size; i++)
        sum = jet_add(sum, jet_mul(jet_of(a, i), jet_of(b, i)));
    return sum;
}

/* Limits the size of every derivative to `most`. */
static void jet_limit(Jet *jet, double most)
{
    for (int j = 0; j < 3; j++)
        jet->gradient[j] = range_intersect(jet->gradient[j], (Range){-most, most});
}

Range loosened(Range range, double scale)
{
    double slack = isfinite(scale) ? scale * 1e-14 : 0;
    return (Range){range.low - slack, range.high + slack};
}

Range length_range(const Range *sides, uint32_t size)
{
    double least = 0, largest = 0;
    for (uint32_t i = 0; i < size; i++) {
        least   = real_hypot(least, range_least(sides[i]));
        largest = hypot_upward(largest, range_largest(sides[i]));
    }
    return (Range){size > 1 && isfinite(least) ? least - least * 0x1p-50 : least, largest};
}

Fact fact_of_truth(const RuleInput *input, uint32_t count, Range value)
{
    Fact fact     = fact_unknown(1);
    bool constant = range_is_single(value) || operands_constant(input, 0, count);
    fact.value[0] = value;
    fact.slope    = constant ? 0 : HUGE_VAL;
    return fact;
}

/* ---- slopes from gradients ---- */

/* Returns the largest singular value of the size x 3 matrix m: the root of the largest eigenvalue
   of m^T m, by the trigonometric formula, plus more than it can lose. */
static double largest_singular_value(double m[4][3], uint32_t size)
{
    double a[3][3], deviation = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            a[i][j] = 0;
            for (uint32_t k = 0; k < size; k++)
                a[i][j] += m[k][i] * m[k][j];
        }
    double mean = (a[0][0] + a[1][1] + a[2][2]) / 3;
    for (int i = 0; i < 3; i++)
        a[i][i] -= mean;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            deviation += a[i][j] * a[i][j] / 6;
    deviation          = sqrt(deviation);
    double determinant = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
                         a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
                         a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    double cubed  = 2 * deviation * deviation * deviation;
    double cosine = cubed > 0 ? fmin(fmax(determinant / cubed, -1), 1) : 1;
    return sqrt(mean + 2 * deviation * real_cos(real_acos(cosine) / 3)) * (1 + 1e-7);
}

/* A matrix of intervals is a centre and a rest: sigma(centre + rest) <= sigma(centre) + |rest|. */
static double gradient_slope(const Fact *fact, uint32_t size)
{
    double centre[4][3], rest = 0, whole = 0;
    for (uint32_t i = 0; i < size; i++)
        for (int j = 0; j < 3; j++) {
            Range  g      = fact->gradient[i][j];
            double middle = g.low / 2 + g.high / 2;
            double radius = fmax(sum_upward(g.high, -middle), sum_upward(middle, -g.low));
            centre[i][j]  = middle;
            rest          = hypot_upward(rest, radius);
            whole         = hypot_upward(whole, range_largest(g));
        }
    if (size == 1 || !(rest < HUGE_VAL))
        return whole;
    double split = largest_singular_value(centre, size) + rest;
    return split < whole ? split * (1 + 0x1p-50) : whole;
}

Fact fact_agreed(Fact fact, uint32_t size)
{
    bool same = true;
    for (uint32_t i = 0; i < size; i++) {
        if (!(fact.value[i].low <= fact.value[i].high))
            fact.value[i] = ANYTHING;
        same = same && range_is_single(fact.value[i]);
    }
    fact.slope = same ? 0 : fmin(fact.slope, gradient_slope(&fact, size));
    for (uint32_t i = 0; i < size; i++) {
        Jet jet = jet_of(&fact, i);
        jet_limit(&jet, fact.slope);
        fact_set(&fact, i, jet);
    }
    return fact;
}

/* ---- means, sums and products ---- */

/* Tells whether the first two are weights whose sum is not above 1. */
static bool mixes(Norm norm, const Partials *rows, uint32_t size)
{
    for (uint32_t i = 0; i < size; i++)
        if (rows[i].by[0].low < 0 || rows[i].by[1].low < 0)
            return false;
    return norm == NORM_MIX || norm == NORM_CONVEX;
}

/* A weighted mean has its gradient in the hull of the gradients. */
static Jet map_jet(Norm norm, int arity, const Fact *operands, const Partials *row, uint32_t i)
{
    Jet  jet      = {.value = row->value};
    bool convex   = mixes(norm, row, 1);
    int  averaged = norm == NORM_MIX ? 2 : arity;
    for (int j = 0; j < 3; j++) {
        Range sum = range_of(0), hull = {HUGE_VAL, -HUGE_VAL};
        for (int k = 0; k < averaged; k++) {
            Range g = operands[k].gradient[i][j];
            sum     = range_add(sum, range_mul(row->by[k], g));
            if (!range_is_zero(row->by[k]))
                hull = range_hull(hull, g);
        }
        if (convex && hull.low <= hull.high)
            sum = range_intersect(sum, hull);
        for (int k = averaged; k < arity; k++)
            sum = range_add(sum, range_mul(row->by[k], operands[k].gradient[i][j]));
        jet.gradient[j] = sum;
    }
    return jet;
}

static double largest_partial(const Partials *rows, uint32_t size, int k)
{
    double largest = 0;
    for (uint32_t i = 0; i < size; i++)
        largest = fmax(largest, range_largest(rows[i].by[k]));
    return largest;
}

static double slope_sum(int first, int arity, const Fact *operands, const Partials *rows,
                        uint32_t size)
{
    double slope = 0;
    for (int k = first; k < arity; k++) {
        double partial = largest_partial(rows, size, k);
        slope          = sum_upward(slope, product_upward(partial, operands[k].slope));
    }
    return slope;
}

/* The mean of slopes is at most the largest, for numbers.  Components of vectors may take their terms from
   different operands: |w|^2 <= |u|^2 + |v|^2. */
static double slope_convex(int arity, const Fact *operands, const Partials *rows, uint32_t size)
{
    double slope = 0;
    for (int k = 0; k < arity; k++)
        if (largest_partial(rows, size, k) > 0)
            slope = size == 1 ? fmax(slope, operands[k].slope)
                              : hypot_upward(slope, operands[k].slope);
    return slope;
}

Fact fact_map(Norm norm, int arity, const Fact *operands, const Partials *rows, uint32_t size)
{
    Fact fact = {.slope = slope_sum(0, arity, operands, rows, size)};
    if (mixes(norm, rows, size)) {
        int    averaged = norm == NORM_MIX ? 2 : arity;
        double mean     = slope_convex(averaged, operands, rows, size);
        double rest     = slope_sum(averaged, arity, operands, rows, size);
        fact.slope      = fmin(fact.slope, sum_upward(mean, rest));
    }
    for (uint32_t i = 0; i < size; i++)
        fact_set(&fact, i, map_jet(norm, arity, operands, &rows[i], i));
    return fact;
}
