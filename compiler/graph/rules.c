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
#include "compiler/graph/facts.h"

#include <assert.h>
#include <math.h>

#include "compiler/graph/evaluate.h"
#include "compiler/graph/fractal.h"
#include "compiler/graph/range.h"

/* An operation and the facts of its operands. */
typedef struct Call {
    Op               op;
    GraphType        type;
    const GraphType *types;
    const Fact      *operands;
    uint32_t         size; /* components of the result or the first operand, whichever has more */
} Call;

static uint32_t components(GraphType type) { return type <= TYPE_VEC4 ? (uint32_t)type : 1; }

/* Nothing is known of `size` components; rules put in what they can say. */
static Fact fact_unknown(uint32_t size)
{
    Fact fact = {.slope = HUGE_VAL};
    for (uint32_t i = 0; i < size; i++) {
        fact.value[i] = ANYTHING;
        for (int j = 0; j < 3; j++)
            fact.gradient[i][j] = ANYTHING;
    }
    return fact;
}

static bool operands_constant(const Call *call, uint32_t first, uint32_t count)
{
    for (uint32_t i = first; i < count; i++)
        if (call->operands[i].slope != 0)
            return false;
    return true;
}

/* ---- jets: one component with its gradient ---- */

typedef struct Jet {
    Range value, gradient[3];
} Jet;

static Jet jet_of(const Fact *fact, uint32_t i)
{
    return (Jet){fact->value[i],
                 {fact->gradient[i][0], fact->gradient[i][1], fact->gradient[i][2]}};
}

static void fact_set(Fact *fact, uint32_t i, Jet jet)
{
    fact->value[i] = jet.value;
    for (int j = 0; j < 3; j++)
        fact->gradient[i][j] = jet.gradient[j];
}

static Jet jet_add(Jet a, Jet b)
{
    Jet sum = {.value = range_add(a.value, b.value)};
    for (int j = 0; j < 3; j++)
        sum.gradient[j] = range_add(a.gradient[j], b.gradient[j]);
    return sum;
}

/* The jet times a factor that is the same all over the box. */
static Jet jet_times(Jet a, Range factor)
{
    a.value = range_mul(a.value, factor);
    for (int j = 0; j < 3; j++)
        a.gradient[j] = range_mul(a.gradient[j], factor);
    return a;
}

static Jet jet_sub(Jet a, Jet b) { return jet_add(a, jet_times(b, range_of(-1))); }

static Jet jet_mul(Jet a, Jet b)
{
    Jet product = {.value = range_mul(a.value, b.value)};
    for (int j = 0; j < 3; j++)
        product.gradient[j] = range_add(range_mul(a.value, b.gradient[j]),
                                        range_mul(b.value, a.gradient[j]));
    return product;
}

static Jet jet_hull(Jet a, Jet b)
{
    a.value = range_hull(a.value, b.value);
    for (int j = 0; j < 3; j++)
        a.gradient[j] = range_hull(a.gradient[j], b.gradient[j]);
    return a;
}

static Jet jet_dot(const Fact *a, const Fact *b, uint32_t size)
{
    Jet sum = jet_mul(jet_of(a, 0), jet_of(b, 0));
    for (uint32_t i = 1; i < size; i++)
        sum = jet_add(sum, jet_mul(jet_of(a, i), jet_of(b, i)));
    return sum;
}

/* Every derivative is at most `most` in size. */
static void jet_limit(Jet *jet, double most)
{
    for (int j = 0; j < 3; j++)
        jet->gradient[j] = range_intersect(jet->gradient[j], (Range){-most, most});
}

/* Room for the rounding of a computation with numbers of this size. */
static Range loosened(Range range, double scale)
{
    double slack = isfinite(scale) ? scale * 1e-14 : 0;
    return (Range){range.low - slack, range.high + slack};
}

/* Range of the Euclidean length of a vector. */
static Range fact_size(const Fact *fact, uint32_t size)
{
    double least = 0, largest = 0;
    for (uint32_t i = 0; i < size; i++) {
        least   = hypot(least, range_least(fact->value[i]));
        largest = hypot_upward(largest, range_largest(fact->value[i]));
    }
    return (Range){size > 1 && isfinite(least) ? least - least * 0x1p-50 : least, largest};
}

/* ---- slopes from gradients ---- */

/* Largest singular value of the size x 3 matrix m: root of the largest eigenvalue of m^T m, by
   the trigonometric formula, plus more than it can lose. */
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
    deviation = sqrt(deviation);
    double determinant = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
                         a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
                         a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    double cubed  = 2 * deviation * deviation * deviation;
    double cosine = cubed > 0 ? fmin(fmax(determinant / cubed, -1), 1) : 1;
    return sqrt(mean + 2 * deviation * cos(acos(cosine) / 3)) * (1 + 1e-7);
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

/* Both engines meet: the smaller slope counts, and no derivative is larger.  Ends out of order
   come from operands that are defined nowhere in the box. */
static Fact fact_agreed(Fact fact, uint32_t size)
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

/* ---- MAP rows ---- */

typedef enum Norm { NORM_SUM, NORM_CONVEX, NORM_MIX, NORM_NONE } Norm;

/* Value and partial derivatives of one component. */
typedef struct Partials {
    Range value, by[3];
} Partials;

/* Whether the first two weights are shares of one, whose sum is not above 1. */
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

/* Of numbers the mean of slopes is at most the largest.  Components of vectors may take their
   shares from different operands: |w|^2 <= |u|^2 + |v|^2. */
static double slope_convex(int arity, const Fact *operands, const Partials *rows, uint32_t size)
{
    double slope = 0;
    for (int k = 0; k < arity; k++)
        if (largest_partial(rows, size, k) > 0)
            slope = size == 1 ? fmax(slope, operands[k].slope)
                              : hypot_upward(slope, operands[k].slope);
    return slope;
}

static Fact fact_map(Norm norm, int arity, const Fact *operands, const Partials *rows,
                     uint32_t size)
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

/* ---- OP rows: vectors ---- */

static Fact fact_splat(const Call *call)
{
    Fact fact = {.slope = call->operands[0].slope};
    for (uint32_t i = 0; i < call->size; i++) {
        fact_set(&fact, i, jet_of(&call->operands[0], 0));
        if (i > 0)
            fact.slope = hypot_upward(fact.slope, call->operands[0].slope);
    }
    return fact;
}

static Fact fact_vector(const Call *call)
{
    Fact fact = {0};
    for (uint32_t i = 0; i < call->size; i++) {
        fact_set(&fact, i, jet_of(&call->operands[i], 0));
        fact.slope = hypot_upward(fact.slope, call->operands[i].slope);
    }
    return fact;
}

/* |(u . v)'| and |(u x v)'| are at most |u| |v'| + |v| |u'|, and so is |(s v)'|. */
static double slope_product(const Call *call)
{
    const Fact *u = &call->operands[0], *v = &call->operands[1];
    double left  = product_upward(fact_size(u, components(call->types[0])).high, v->slope);
    double right = product_upward(fact_size(v, components(call->types[1])).high, u->slope);
    return sum_upward(left, right);
}

static Fact fact_dot(const Call *call)
{
    Fact fact = {.slope = slope_product(call)};
    fact_set(&fact, 0, jet_dot(&call->operands[0], &call->operands[1], call->size));
    return fact;
}

static Fact fact_cross(const Call *call)
{
    const Fact *u = &call->operands[0], *v = &call->operands[1];
    Fact        fact = {.slope = slope_product(call)};
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t y = (i + 1) % 3, z = (i + 2) % 3;
        Jet      left  = jet_mul(jet_of(u, y), jet_of(v, z));
        Jet      right = jet_mul(jet_of(u, z), jet_of(v, y));
        fact_set(&fact, i, jet_sub(left, right));
    }
    return fact;
}

static Fact fact_scale(const Call *call)
{
    Fact fact = {.slope = slope_product(call)};
    for (uint32_t i = 0; i < call->size; i++)
        fact_set(&fact, i, jet_mul(jet_of(&call->operands[0], i), jet_of(&call->operands[1], 0)));
    return fact;
}

/* Component i of the unit vector along v, whose length is in `whole`. */
static Range unit_component(const Fact *v, uint32_t i, Range whole)
{
    Range sides = {v->value[i].low < 0 ? -1 : 0, v->value[i].high > 0 ? 1 : 0};
    return whole.low > 0 ? range_intersect(range_div(v->value[i], whole), sides) : sides;
}

/* The derivative is that of v seen along the unit vector, so it is no longer than that of v:
   nothing is divided by a length that may be 0. */
static Fact fact_length(const Call *call)
{
    const Fact *v     = &call->operands[0];
    Range       whole = fact_size(v, call->size);
    Jet         jet   = {.value = whole};
    for (int j = 0; j < 3; j++) {
        double longest = 0;
        for (uint32_t i = 0; i < call->size; i++) {
            Range unit = unit_component(v, i, whole);
            jet.gradient[j] = range_add(jet.gradient[j], range_mul(unit, v->gradient[i][j]));
            longest = hypot_upward(longest, range_largest(v->gradient[i][j]));
        }
        jet.gradient[j] = range_intersect(jet.gradient[j], (Range){-longest, longest});
    }
    Fact fact = {.slope = v->slope};
    fact_set(&fact, 0, jet);
    return fact;
}

/* The derivative of v, less its part along v, over the length of v. */
static Fact fact_normalize(const Call *call)
{
    const Fact *v     = &call->operands[0];
    Range       whole = fact_size(v, call->size);
    Fact        fact  = fact_unknown(call->size);
    double      steepest = whole.low > 0 ? 1 / whole.low * (1 + 0x1p-50) : HUGE_VAL;
    fact.slope = product_upward(v->slope, steepest);
    for (uint32_t i = 0; i < call->size; i++)
        fact.value[i] = loosened(unit_component(v, i, whole), 1);
    for (uint32_t i = 0; whole.low > 0 && i < call->size; i++)
        for (int j = 0; j < 3; j++) {
            Range along = range_of(0);
            for (uint32_t k = 0; k < call->size; k++)
                along = range_add(along, range_mul(fact.value[k], v->gradient[k][j]));
            Range across = range_sub(v->gradient[i][j], range_mul(fact.value[i], along));
            fact.gradient[i][j] = range_div(across, whole);
        }
    return fact;
}

static Fact fact_component(const Fact *vector, uint32_t index)
{
    Fact fact = {.slope = vector->slope};
    fact_set(&fact, 0, jet_of(vector, index));
    return fact;
}

/* ---- OP rows: truth and choice ---- */

static Fact fact_truth(const Call *call, uint32_t count, bool always, bool never)
{
    Fact fact     = fact_unknown(1);
    fact.value[0] = (Range){always, !never};
    fact.slope    = always || never || operands_constant(call, 0, count) ? 0 : HUGE_VAL;
    return fact;
}

static Fact fact_less(const Call *call)
{
    Range a = call->operands[0].value[0], b = call->operands[1].value[0];
    return fact_truth(call, 2, a.high < b.low, a.low >= b.high);
}

static Fact fact_less_equal(const Call *call)
{
    Range a = call->operands[0].value[0], b = call->operands[1].value[0];
    return fact_truth(call, 2, a.high <= b.low, a.low > b.high);
}

static bool always_equal(Range a, Range b)
{
    return range_is_single(a) && range_is_single(b) && a.low == b.low;
}

static bool never_equal(Range a, Range b) { return a.high < b.low || b.high < a.low; }

static Fact fact_equal(const Call *call)
{
    Range a = call->operands[0].value[0], b = call->operands[1].value[0];
    return fact_truth(call, 2, always_equal(a, b), never_equal(a, b));
}

static Fact fact_not_equal(const Call *call)
{
    Range a = call->operands[0].value[0], b = call->operands[1].value[0];
    return fact_truth(call, 2, never_equal(a, b), always_equal(a, b));
}

static Fact fact_and(const Call *call)
{
    Range a = call->operands[0].value[0], b = call->operands[1].value[0];
    return fact_truth(call, 2, a.low > 0 && b.low > 0, a.high == 0 || b.high == 0);
}

static Fact fact_or(const Call *call)
{
    Range a = call->operands[0].value[0], b = call->operands[1].value[0];
    return fact_truth(call, 2, a.low > 0 || b.low > 0, a.high == 0 && b.high == 0);
}

static Fact fact_not(const Call *call)
{
    Range a = call->operands[0].value[0];
    return fact_truth(call, 1, a.high == 0, a.low > 0);
}

/* Where the condition changes within the box, the value may jump. */
static Fact fact_select(const Call *call)
{
    const Fact *truth = &call->operands[0], *yes = &call->operands[1], *no = &call->operands[2];
    if (truth->value[0].low > 0)
        return *yes;
    if (truth->value[0].high == 0)
        return *no;
    Fact fact = fact_unknown(call->size);
    for (uint32_t i = 0; i < call->size; i++) {
        Jet either = jet_hull(jet_of(yes, i), jet_of(no, i));
        if (truth->slope == 0)
            fact_set(&fact, i, either);
        fact.value[i] = either.value;
    }
    if (truth->slope == 0)
        fact.slope = fmax(yes->slope, no->slope);
    return fact;
}

/* Where it goes from one case to the other, the value jumps. */
static Fact fact_guard(const Call *call)
{
    Range a = call->operands[0].value[0], b = call->operands[1].value[0];
    Range far = call->operands[3].value[0], limit = range_min(b, far);
    if (a.high < limit.low || a.high <= fmin(far.low, 0))
        return call->operands[2];
    Fact fact     = fact_unknown(1);
    fact.value[0] = range_min(a, b);
    if (a.low < limit.high || a.low <= fmin(far.high, 0))
        fact.value[0] = range_hull(fact.value[0], call->operands[2].value[0]);
    else
        fact.slope = fmax(call->operands[0].slope, call->operands[1].slope);
    return fact;
}

/* ---- OP rows: maps of space ---- */

/* The rows are orthonormal by construction, so lengths and slopes stay as they are. */
static Fact fact_turn(const Call *call)
{
    const Fact *p    = &call->operands[0];
    double      size = fact_size(p, 3).high, rows = 0;
    Fact        fact = {0};
    for (uint32_t i = 0; i < 3; i++) {
        Jet jet   = jet_dot(&call->operands[i + 1], p, 3);
        jet.value = range_intersect(jet.value, loosened((Range){-size, size}, size));
        fact_set(&fact, i, jet);
        rows = hypot_upward(rows, call->operands[i + 1].slope);
    }
    fact.slope = sum_upward(p->slope, product_upward(size, rows));
    return fact;
}

/* dot(u, p) - w, the height above a mirror. */
static Jet mirror_height(const Call *call)
{
    Jet along = jet_dot(&call->operands[1], &call->operands[0], 3);
    return jet_sub(along, jet_of(&call->operands[2], 0));
}

/* A fold about a fixed mirror brings no two points further apart. */
static Fact fact_fold(const Call *call)
{
    Jet depth = mirror_height(call), none = {0};
    if (depth.value.high <= 0)
        depth = none;
    else if (depth.value.low < 0) {
        depth       = jet_hull(depth, none);
        depth.value = range_above(depth.value, 0);
    }
    Fact fact  = {.slope = HUGE_VAL};
    Jet  twice = jet_times(depth, range_of(2));
    for (uint32_t i = 0; i < 3; i++) {
        Jet back = jet_mul(twice, jet_of(&call->operands[1], i));
        fact_set(&fact, i, jet_sub(jet_of(&call->operands[0], i), back));
    }
    if (operands_constant(call, 1, 3))
        fact.slope = call->operands[0].slope;
    return fact;
}

static Fact fact_front(const Call *call)
{
    Range height = mirror_height(call).value;
    return fact_truth(call, 3, height.low > 0, height.high <= 0);
}

/* Of p - period * k for the cell k in [low, high] that is nearest. */
static Range cell_range(Range p, Range period, Range low, Range high)
{
    Range cell    = range_min(range_max(range_round(range_div(p, period)), low), high);
    Range moved   = range_sub(p, range_mul(period, cell));
    Range first   = range_sub(p, range_mul(period, low));
    Range last    = range_sub(p, range_mul(period, high));
    Range within  = {fmin(-period.high / 2, first.low), fmax(period.high / 2, last.high)};
    double scale  = range_largest(p);
    return range_intersect(moved, loosened(within, isfinite(scale) ? scale : period.high));
}

/* Within a cell it is a translation. */
static Fact fact_cell(const Call *call)
{
    const Fact *o    = call->operands;
    Fact        fact = o[0];
    for (uint32_t i = 0; i < 3; i++) {
        Range p = o[0].value[i], period = o[1].value[i];
        if (period.high > 0)
            fact.value[i] = cell_range(p, range_above(period, 0), o[2].value[i], o[3].value[i]);
        if (period.high > 0 && period.low <= 0)
            fact.value[i] = range_hull(fact.value[i], p);
    }
    if (operands_constant(call, 1, 4))
        return fact;
    Fact unknown = fact_unknown(3);
    for (uint32_t i = 0; i < 3; i++)
        unknown.value[i] = fact.value[i];
    return unknown;
}

/* The turned pair (x, z) has lengths in `radius`; so have its derivatives in x', z'. */
static void sector_bounds(const Fact *p, Range count, Fact *fact)
{
    Fact   plane = {.value = {p->value[0], p->value[2]}};
    Range  radius = fact_size(&plane, 2);
    double half   = acos(-1) / count.low;
    bool   narrow = count.low >= 2;
    Range  x = {narrow ? radius.low * cos(half) : -radius.high, radius.high};
    double z = narrow ? radius.high * sin(half) : radius.high;
    fact->value[0] = loosened(x, radius.high);
    fact->value[2] = loosened((Range){-z, z}, radius.high);
    for (int j = 0; j < 3; j++) {
        double most = hypot_upward(range_largest(p->gradient[0][j]),
                                   range_largest(p->gradient[2][j]));
        fact->gradient[0][j] = fact->gradient[2][j] = (Range){-most, most};
    }
}

/* Within a sector it is a turn, and a known one when the box lies in one sector. */
static Fact fact_cell_polar(const Call *call)
{
    const Fact *p = &call->operands[0];
    Range count = call->operands[1].value[0];
    if (count.high < 1 || call->operands[1].slope != 0)
        return count.high < 1 ? *p : fact_unknown(3);
    Fact fact = *p;
    sector_bounds(p, range_above(count, 1), &fact);
    Range sector = range_div(range_of(2 * acos(-1)), count);
    Range turns  = range_round(range_div(range_atan2(p->value[2], p->value[0]), sector));
    if (range_is_single(count) && range_is_single(turns)) {
        Range angle = range_mul(turns, sector), c = range_cos(angle), s = range_sin(angle);
        Jet   x = jet_add(jet_times(jet_of(p, 0), c), jet_times(jet_of(p, 2), s));
        Jet   z = jet_sub(jet_times(jet_of(p, 2), c), jet_times(jet_of(p, 0), s));
        x.value = range_intersect(fact.value[0], x.value);
        z.value = range_intersect(fact.value[2], z.value);
        fact_set(&fact, 0, x);
        fact_set(&fact, 2, z);
    }
    for (uint32_t i = 0; i < 3 && count.low < 1; i++)
        fact_set(&fact, i, jet_hull(jet_of(&fact, i), jet_of(p, i)));
    return fact;
}

/* ---- OP rows: noise ---- */

/*
 * No value is above 1 in size and no derivative above `steepest`, along the axes as in any other
 * direction: proven by tests/property/noise.c for all directions of all gradients.  Over a small
 * part of space the value is near that in the middle.
 */
static Fact fact_noise(const Call *call, double steepest)
{
    const Fact *p      = &call->operands[0];
    NodeValue   middle = {0};
    double      reach  = 0;
    Fact        fact   = {.slope = product_upward(steepest, p->slope)};
    Jet         jet    = {.value = {-1, 1}};
    for (uint32_t i = 0; i < call->size; i++) {
        Range side   = p->value[i];
        middle.v[i]  = side.low / 2 + side.high / 2;
        reach        = hypot_upward(reach, fmax(side.high - middle.v[i], middle.v[i] - side.low));
        for (int j = 0; j < 3; j++) {
            Range part      = range_mul((Range){-steepest, steepest}, p->gradient[i][j]);
            jet.gradient[j] = range_add(jet.gradient[j], part);
        }
    }
    if (reach < 1) {
        double value = op_evaluate(call->op, TYPE_FLOAT, 0, call->types, &middle).v[0];
        double rise  = reach > 0 ? steepest * reach + 1e-12 : 0;
        jet.value    = range_intersect((Range){value - rise, value + rise}, jet.value);
    }
    fact_set(&fact, 0, jet);
    return fact;
}

static Fact fact_noise2(const Call *call) { return fact_noise(call, 2.84); }
static Fact fact_noise3(const Call *call) { return fact_noise(call, 3.64); }

/* ---- OP rows: identities ---- */

static Fact fact_steps(const Call *call, uint32_t count, double most)
{
    Fact fact     = fact_unknown(1);
    fact.value[0] = (Range){0, most};
    fact.slope    = operands_constant(call, 0, count) ? 0 : HUGE_VAL;
    return fact;
}

static Fact fact_identity(const Call *call) { return fact_steps(call, 2, UINT32_MAX); }
static Fact fact_id_unit(const Call *call) { return fact_steps(call, 1, 1); }

/* ---- OP rows: fractals ---- */

/* The value in the middle of the point's range, and how far from there the point can be; false
   where other operands move. */
static bool fractal_middle(const Call *call, uint32_t others, double *middle, double *reach)
{
    NodeValue operands[MAX_OPERANDS] = {0};
    *reach = 0;
    for (uint32_t i = 0; i < 3; i++) {
        Range at         = call->operands[0].value[i];
        operands[0].v[i] = at.low / 2 + at.high / 2;
        *reach = hypot_upward(*reach, fmax(sum_upward(at.high, -operands[0].v[i]),
                                           sum_upward(operands[0].v[i], -at.low)));
    }
    for (uint32_t i = 1; i <= others; i++)
        for (uint32_t k = 0; k < components(call->types[i]); k++) {
            if (!range_is_single(call->operands[i].value[k]))
                return false;
            operands[i].v[k] = call->operands[i].value[k].low;
        }
    *middle = op_evaluate(call->op, TYPE_FLOAT, 0, call->types, operands).v[0];
    return isfinite(*middle) && isfinite(*reach);
}

/* 1-Lipschitz in the point (fractal.c), between |q| - R and |q| + R. */
static Fact fact_julia(const Call *call)
{
    Fact        fact  = fact_unknown(1);
    const Fact *point = &call->operands[0];
    Range  size = fact_size(point, 3), radius = call->operands[3].value[1];
    double middle, reach;
    fact.value[0] = (Range){size.low - radius.high, sum_upward(size.high, radius.high)};
    if (fractal_middle(call, 3, &middle, &reach)) {
        Range near    = {middle - reach, middle + reach};
        fact.value[0] = range_intersect(fact.value[0], loosened(near, fabs(middle) + reach));
    }
    if (operands_constant(call, 1, 4))
        fact.slope = point->slope;
    return fact;
}

/* Outside of a ball the distance to a smaller one, inside nothing but an estimate. */
static Fact fact_mandelbulb(const Call *call)
{
    Fact        fact  = fact_unknown(1);
    const Fact *point = &call->operands[0];
    Range  size = fact_size(point, 3), radius = call->operands[2].value[1];
    Range  power = call->operands[1].value[0];
    if (!range_is_single(power) || !(power.low >= 2) || !(radius.low > 0))
        return fact; /* what no scene can write */
    double core  = mandelbulb_core(power.low);
    Range  value = {size.low - radius.high, fmax(size.high - core, 0)};
    bool   far   = size.low > MANDELBULB_NEAR * radius.high;
    if (far)
        value.high = sum_upward(size.high, -radius.low);
    fact.value[0] = loosened(value, size.high);
    if (operands_constant(call, 1, 3) && (far || point->slope == 0))
        fact.slope = point->slope;
    return fact;
}

static Fact fact_trap(const Call *call)
{
    Fact fact     = fact_unknown(2);
    fact.value[0] = fact.value[1] = (Range){0, 1};
    if (operands_constant(call, 0, call->op == OP_julia_trap ? 4 : 3))
        fact.slope = 0;
    return fact;
}

/* ---- OP rows: smooth minima of a and b over a width k ---- */

static double smooth_corner(const Call *call, double a, double b, double k, double n)
{
    static const GraphType types[] = {TYPE_FLOAT, TYPE_FLOAT, TYPE_FLOAT, TYPE_FLOAT};
    NodeValue operands[] = {{{a}}, {{b}}, {{k}}, {{n}}};
    return op_evaluate(call->op, TYPE_FLOAT, 0, types, operands).v[0];
}

/* All grow with a and b and shrink with k. */
static Range smooth_range(const Call *call, double n)
{
    Range  a = call->operands[0].value[0], b = call->operands[1].value[0];
    Range  k = call->operands[2].value[0];
    double low  = smooth_corner(call, a.low, b.low, k.high, n);
    double high = smooth_corner(call, a.high, b.high, k.low, n);
    Range range = {isnan(low) ? -HUGE_VAL : low, isnan(high) ? HUGE_VAL : high};
    double scale = fmin(range_largest(a) + range_largest(b), 1e300) + fmin(fabs(k.high), 1e300);
    return loosened(range, scale);
}

/* A width (or number of steps) that moves with the point would need a rule of its own. */
static Fact fact_smooth(const Call *call, uint32_t count, Range value, double slope, Jet jet)
{
    Fact fact = fact_unknown(1);
    if (operands_constant(call, 2, count)) {
        fact_set(&fact, 0, jet);
        fact.slope = slope;
    }
    fact.value[0] = value;
    return fact;
}

/* The derivatives by a and b are at least 0 and sum to 1; further apart than the width, one of
   them is 1. */
static Fact smooth_mean(const Call *call, uint32_t count, Range value)
{
    const Fact *a = &call->operands[0], *b = &call->operands[1];
    Jet    left = jet_of(a, 0), right = jet_of(b, 0);
    double width = fmax(call->operands[2].value[0].high, 0);
    if (call->op != OP_smin_exponential && left.value.high + width <= right.value.low)
        return fact_smooth(call, count, value, a->slope, left);
    if (call->op != OP_smin_exponential && right.value.high + width <= left.value.low)
        return fact_smooth(call, count, value, b->slope, right);
    return fact_smooth(call, count, value, fmax(a->slope, b->slope), jet_hull(left, right));
}

static Fact fact_smin(const Call *call) { return smooth_mean(call, 3, smooth_range(call, 0)); }

/* Along the arc the derivatives by a and b are the sides of a unit vector: |a'| and |b'| add as
   the sides of a right triangle, at most sqrt 2 times the larger. */
static Fact fact_smin_circular(const Call *call)
{
    const Fact *a = &call->operands[0], *b = &call->operands[1];
    Jet    left = jet_of(a, 0), right = jet_of(b, 0);
    double width = call->operands[2].value[0].high;
    Range  value = smooth_range(call, 0), share = {0, 1};
    if (left.value.low >= fmax(width, right.value.high))
        return fact_smooth(call, 3, value, b->slope, right);
    if (right.value.low >= fmax(width, left.value.high))
        return fact_smooth(call, 3, value, a->slope, left);
    Jet sum = jet_add(jet_times(left, share), jet_times(right, share));
    return fact_smooth(call, 3, value, hypot_upward(a->slope, b->slope), sum);
}

/* The third candidate, (a + b - k) / sqrt 2, is as steep as sqrt 1/2 of both together. */
static Fact fact_smin_chamfer(const Call *call)
{
    const Fact *a = &call->operands[0], *b = &call->operands[1];
    Jet    candidates[3] = {jet_of(a, 0), jet_of(b, 0)};
    double both      = product_upward(sqrt(0.5) * (1 + 0x1p-50), sum_upward(a->slope, b->slope));
    double slopes[3] = {a->slope, b->slope, both}, slope = 0;
    Range  root      = {sqrt(0.5) * (1 - 0x1p-50), sqrt(0.5) * (1 + 0x1p-50)};
    Jet    sum       = jet_add(candidates[0], candidates[1]);
    sum.value        = range_sub(sum.value, range_above(call->operands[2].value[0], 0));
    candidates[2]    = jet_times(sum, root);
    double least     = fmin(candidates[0].value.high, candidates[1].value.high);
    Jet    hull      = {.gradient = {{HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, -HUGE_VAL},
                                     {HUGE_VAL, -HUGE_VAL}}};
    for (int i = 0; i < 3; i++)
        if (candidates[i].value.low <= least) {
            hull  = jet_hull(hull, candidates[i]);
            slope = fmax(slope, slopes[i]);
        }
    return fact_smooth(call, 3, smooth_range(call, 0), slope, hull);
}

/* On each step one of a and b has the derivative 1 and the other 0 (evaluate.c). */
static Fact fact_smin_stairs(const Call *call)
{
    Range a = call->operands[0].value[0], b = call->operands[1].value[0];
    Range k = call->operands[2].value[0], n = call->operands[3].value[0];
    Range value = range_min(a, b);
    double lowest = sum_upward(sum_upward(-a.low, -b.low), fmax(k.high, 0)) / -2;
    value.low = fmin(value.low, lowest);
    if (range_is_single(k) && range_is_single(n))
        value = range_intersect(value, smooth_range(call, n.low));
    double scale = range_largest(a) + range_largest(b) + range_largest(k);
    return smooth_mean(call, 4, loosened(value, scale));
}

static Fact fact_blend_weight(const Call *call)
{
    const Fact *a = &call->operands[0], *b = &call->operands[1];
    Range  k     = call->operands[2].value[0], value = {1, 0};
    double ks[2] = {k.low, k.high};
    for (int i = 0; i < 2; i++) {
        double low  = smooth_corner(call, a->value[0].high, b->value[0].low, ks[i], 0);
        double high = smooth_corner(call, a->value[0].low, b->value[0].high, ks[i], 0);
        value       = range_hull(value, (Range){low, high});
    }
    double steepest = k.low > 0 ? 0.5 / k.low * (1 + 0x1p-50) : HUGE_VAL;
    double slope    = product_upward(steepest, sum_upward(a->slope, b->slope));
    Jet    apart    = jet_sub(jet_of(b, 0), jet_of(a, 0));
    Jet    jet      = jet_times(apart, (Range){0, steepest});
    bool   flat     = range_is_single(value);
    return fact_smooth(call, 3, flat ? value : loosened(value, 1), slope, jet);
}

/* ---- one operation ---- */

#define ZERO      range_of(0)
#define ONE       range_of(1)
#define MINUS_ONE range_of(-1)
#define TWO       range_of(2)
#define HALF      range_of(0.5)
#define LN2       ((Range){0.69314718055994528, 0.6931471805599454})

static Fact rule_of_row(const Call *call, uint32_t index, const double *constant)
{
    const Fact *o = call->operands;
    Partials    rows[4];
    Fact        fact = {0};
    switch (call->op) {
    case OP_CONSTANT:
        for (uint32_t i = 0; i < call->size; i++)
            fact.value[i] = range_of(constant[i]);
        return fact;
    case OP_COMPONENT:
        return fact_component(&o[0], index);
#define MAP(name, arity, glsl, value_, range, da, db, dc, norm, meaning)                           \
    case OP_##name:                                                                                \
        for (uint32_t i = 0; i < call->size; i++) {                                                \
            Range a = o[0].value[i], b = arity > 1 ? o[arity > 1].value[i] : ZERO;                 \
            Range c = arity > 2 ? o[arity > 2 ? 2 : 0].value[i] : ZERO;                            \
            Range r = (range);                                                                     \
            (void)b, (void)c;                                                                      \
            rows[i] = (Partials){r, {da, db, dc}};                                                 \
        }                                                                                          \
        return fact_map(norm, arity, o, rows, call->size);
#define OP(name, signature, glsl, evaluate, facts, meaning)                                        \
    case OP_##name:                                                                                \
        return facts(call);
#include "compiler/graph/ops.def"
#undef MAP
#undef OP
    default:
        assert(!"leaves have facts of their own");
        return fact_unknown(call->size);
    }
}

/* Quotients by 0 all over the box: of 0, too, whose derivatives make the slope seem to be 0. */
static bool is_defined_nowhere(const Call *call)
{
    for (uint32_t i = 0; call->op == OP_div && i < call->size; i++)
        if (range_is_zero(call->operands[1].value[i]))
            return true;
    return false;
}

Fact op_fact(Op op, GraphType type, uint32_t index, const GraphType *types, const Fact *operands,
             const double *constant)
{
    Call call = {.op = op, .type = type, .types = types, .operands = operands};
    call.size = components(type);
    if (op != OP_CONSTANT && op != OP_COMPONENT && components(types[0]) > call.size)
        call.size = components(types[0]);
    Fact fact = is_defined_nowhere(&call) ? fact_unknown(call.size)
                                          : rule_of_row(&call, index, constant);
    return fact_agreed(fact, components(type));
}
