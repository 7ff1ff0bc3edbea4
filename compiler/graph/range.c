/*
 * range.c: interval arithmetic.
 *
 * Sums and products know from the rounding error (found exactly) on which side the true result
 * lies, and move one step outwards only when they must.  Functions of the C library are taken
 * to be right to a few units in the last place, and are widened by more than that.
 */
#include "compiler/graph/range.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "compiler/base/elementary.h"

static const double PI = 3.14159265358979323846;

int box_longest_axis(const Box *box)
{
    int longest = 0;
    for (int k = 1; k < 3; k++)
        if (box->axis[k].high - box->axis[k].low > box->axis[longest].high - box->axis[longest].low)
            longest = k;
    return longest;
}

void box_halve(Box box, Box halves[2])
{
    const int    axis   = box_longest_axis(&box);
    const double middle = 0.5 * (box.axis[axis].low + box.axis[axis].high);
    halves[0] = halves[1]     = box;
    halves[0].axis[axis].high = halves[1].axis[axis].low = middle;
}

double range_cut(Range a)
{
    if (a.low > -HUGE_VAL && a.high < HUGE_VAL)
        return a.low / 2 + a.high / 2;
    if (a.low == -HUGE_VAL && a.high == HUGE_VAL)
        return 0;
    return a.high == HUGE_VAL ? fmax(2 * a.low, 1) : fmin(2 * a.high, -1);
}

/* ---- directed rounding ---- */

/* Returns the next number below.  Those of one sign are in the order of their bits. */
static double step_down(double a)
{
    uint64_t bits;
    if (a == 0 || !isfinite(a))
        return nextafter(a, -HUGE_VAL);
    memcpy(&bits, &a, sizeof bits);
    bits += a > 0 ? UINT64_MAX : 1;
    memcpy(&a, &bits, sizeof a);
    return a;
}

/* Returns (a + b) - the exact sum, by Knuth; a + b is finite. */
static double sum_excess(double a, double b, double sum)
{
    double part = sum - a;
    return -((a - (sum - part)) + (b - part));
}

static inline bool is_number(double a) { return a - a == 0; } /* nor infinite */

static double sum_low_beyond(double a, double b)
{
    double sum = a + b;
    if (isnan(sum))
        return -HUGE_VAL;
    /* an overflow is not yet infinite inwards */
    return isinf(a) || isinf(b) || sum < 0 ? sum : DBL_MAX;
}

static inline double sum_low(double a, double b)
{
    double sum = a + b;
    if (!is_number(sum))
        return sum_low_beyond(a, b);
    return sum_excess(a, b, sum) > 0 ? step_down(sum) : sum;
}

static inline double sum_high(double a, double b) { return 0 - sum_low(-a, -b); }

static double product_low(double a, double b)
{
    if (a == 0 || b == 0)
        return 0; /* also 0 * inf: the factor 0 is exact, the other one only a limit */
    double product = a * b;
    if (isinf(product))
        return isinf(a) || isinf(b) || product < 0 ? product : DBL_MAX;
    if (fabs(product) < 1e-290)
        return step_down(product); /* the error itself could underflow */
    return fma(a, b, -product) < 0 ? step_down(product) : product;
}

static double product_high(double a, double b) { return 0 - product_low(-a, b); }

static double quotient_low(double a, double b)
{
    if (a == 0)
        return 0;
    double quotient = a / b;
    if (isnan(quotient))
        return 0; /* inf / inf: both limits stand at other corners */
    if (isinf(quotient))
        return isinf(a) || b == 0 || quotient < 0 ? quotient : DBL_MAX;
    bool exact = fabs(quotient) > 1e-290 && fma(quotient, b, -a) == 0;
    return exact ? quotient : step_down(quotient);
}

static double quotient_high(double a, double b) { return 0 - quotient_low(-a, b); }

double sum_upward(double a, double b) { return sum_high(a, b); }
double product_upward(double a, double b) { return product_high(a, b); }

double hypot_upward(double a, double b)
{
    if (a == 0 || b == 0)
        return a + b;
    double length = real_hypot(a, b);
    return length + length * 0x1p-51;
}

/* Returns a range that is wide enough for the errors of the C library. */
static Range widened(double low, double high)
{
    if (isnan(low) || isnan(high))
        return ANYTHING;
    if (isfinite(low))
        low -= fabs(low) * 0x1p-50 + 0x1p-1070;
    if (isfinite(high))
        high += fabs(high) * 0x1p-50 + 0x1p-1070;
    return (Range){low, high};
}

static Range widened_within(double low, double high, double least, double most)
{
    Range range = widened(low, high);
    return (Range){min2(max2(range.low, least), most), max2(min2(range.high, most), least)};
}

/* ---- one operand ---- */

Range range_abs(Range a) { return (Range){range_least(a), range_largest(a)}; }

Range range_sign(Range a) { return (Range){a.low < 0 ? -1 : 1, a.high > 0 ? 1 : -1}; }

Range range_sign_of(Range a)
{
    return (Range){(a.low > 0) - (a.low < 0), (a.high > 0) - (a.high < 0)};
}

Range range_floor(Range a) { return (Range){floor(a.low), floor(a.high)}; }
Range range_ceil(Range a) { return (Range){ceil(a.low), ceil(a.high)}; }
Range range_round(Range a) { return (Range){floor(a.low + 0.5), floor(a.high + 0.5)}; }

Range range_fract(Range a)
{
    if (!isfinite(a.low) || floor(a.low) != floor(a.high))
        return (Range){0, 1};
    return (Range){a.low - floor(a.low), a.high - floor(a.high)};
}

Range range_square(Range a)
{
    double least = range_least(a), largest = range_largest(a);
    return (Range){product_low(least, least), product_high(largest, largest)};
}

Range range_above(Range a, double least)
{
    return (Range){max2(a.low, least) + 0.0, max2(a.high, least) + 0.0}; /* 1 / sqrt(-0) is -inf */
}

Range range_sqrt(Range a)
{
    a = range_above(a, 0);
    return widened_within(sqrt(a.low), sqrt(a.high), 0, HUGE_VAL);
}

Range range_inversesqrt(Range a)
{
    a = range_above(a, 0);
    return widened_within(1 / sqrt(a.high), 1 / sqrt(a.low), 0, HUGE_VAL);
}

/* Returns the range of -1/2 a^(-3/2). */
Range range_inversesqrt_slope(Range a, Range value)
{
    return range_mul(range_of(-0.5), range_div(value, range_above(a, 0)));
}

Range range_exp(Range a) { return widened_within(real_exp(a.low), real_exp(a.high), 0, HUGE_VAL); }
Range range_exp2(Range a)
{
    return widened_within(real_exp2(a.low), real_exp2(a.high), 0, HUGE_VAL);
}

Range range_log(Range a)
{
    a = range_above(a, 0);
    return widened(real_log(a.low), real_log(a.high));
}

Range range_log2(Range a)
{
    a = range_above(a, 0);
    return widened(real_log2(a.low), real_log2(a.high));
}

/* Tells whether a holds peak + n * period for a whole n; in doubt, yes. */
static bool range_holds(Range a, double peak, double period)
{
    double slack = 1e-12 * (1 + range_largest(a));
    double next  = peak + period * ceil((a.low - slack - peak) / period);
    return next <= a.high + slack;
}

/* Holds a wave between -1 and 1 that has these values at the ends of a. */
static Range range_wave(Range a, double at_low, double at_high, double peak)
{
    if (!isfinite(a.low) || !isfinite(a.high) || range_largest(a) > 1e9)
        return (Range){-1, 1};
    Range wave = widened_within(min2(at_low, at_high), max2(at_low, at_high), -1, 1);
    if (range_holds(a, peak, 2 * PI))
        wave.high = 1;
    if (range_holds(a, peak + PI, 2 * PI))
        wave.low = -1;
    return wave;
}

Range range_sin(Range a) { return range_wave(a, real_sin(a.low), real_sin(a.high), PI / 2); }
Range range_cos(Range a) { return range_wave(a, real_cos(a.low), real_cos(a.high), 0); }

Range range_tan(Range a)
{
    if (!isfinite(a.low) || !isfinite(a.high) || range_largest(a) > 1e9 ||
        range_holds(a, PI / 2, PI))
        return ANYTHING;
    return widened(real_tan(a.low), real_tan(a.high));
}

/* Returns the range of 1 + tan^2, without the jump from one end of the line to the other at a
   pole. */
Range range_tan_slope(Range value)
{
    if (value.low == -HUGE_VAL)
        return ANYTHING;
    return range_add(range_of(1), range_square(value));
}

static double unit(double a) { return min2(max2(a, -1), 1); }

Range range_asin(Range a) { return widened(real_asin(unit(a.low)), real_asin(unit(a.high))); }
Range range_acos(Range a)
{
    return widened_within(real_acos(unit(a.high)), real_acos(unit(a.low)), 0, 4);
}

/* Returns the range of 1 / sqrt(1 - a^2), and 0 where a is clamped. */
Range range_asin_slope(Range a)
{
    Range size = range_abs(a);
    if (size.low > 1)
        return range_of(0);
    double low  = size.high > 1 ? 0 : 1 / sqrt((1 - size.low) * (1 + size.low));
    double high = size.high >= 1 ? HUGE_VAL : 1 / sqrt((1 - size.high) * (1 + size.high));
    return widened_within(low, high, 0, HUGE_VAL);
}

Range range_atan(Range a) { return widened(real_atan(a.low), real_atan(a.high)); }
Range range_sinh(Range a) { return widened(real_sinh(a.low), real_sinh(a.high)); }
Range range_tanh(Range a) { return widened_within(real_tanh(a.low), real_tanh(a.high), -1, 1); }

Range range_cosh(Range a)
{
    return widened_within(real_cosh(range_least(a)), real_cosh(range_largest(a)), 1, HUGE_VAL);
}

Range range_sech_square(Range a)
{
    Range cosh_range = range_cosh(a);
    return range_div(range_of(1), range_square(cosh_range));
}

/* ---- two operands ---- */

Range range_add(Range a, Range b)
{
    return (Range){sum_low(a.low, b.low), sum_high(a.high, b.high)};
}

Range range_sub(Range a, Range b) { return range_add(a, range_neg(b)); }

static Range product_of_all(Range a, Range b)
{
    return (Range){min2(min2(product_low(a.low, b.low), product_low(a.low, b.high)),
                        min2(product_low(a.high, b.low), product_low(a.high, b.high))),
                   max2(max2(product_high(a.low, b.low), product_high(a.low, b.high)),
                        max2(product_high(a.high, b.low), product_high(a.high, b.high)))};
}

static bool is_ordered(Range a) { return a.low <= a.high; }

/* Multiplies ranges of which at least one has 0 inside. */
static Range product_across(Range a, Range b)
{
    if (b.low >= 0)
        return (Range){product_low(a.low, b.high), product_high(a.high, b.high)};
    if (b.high <= 0)
        return (Range){product_low(a.high, b.low), product_high(a.low, b.low)};
    return (Range){min2(product_low(a.low, b.high), product_low(a.high, b.low)),
                   max2(product_high(a.low, b.low), product_high(a.high, b.high))};
}

Range range_mul(Range a, Range b)
{
    if (range_is_zero(a) || range_is_zero(b))
        return range_of(0);
    if (a.low == 1 && a.high == 1)
        return b;
    if (b.low == 1 && b.high == 1)
        return a;
    if (!is_ordered(a) || !is_ordered(b))
        return product_of_all(a, b);
    if (a.low < 0 && a.high > 0)
        return product_across(a, b);
    if (b.low < 0 && b.high > 0)
        return product_across(b, a);
    /* Signs tell which ends make the least and the greatest. */
    bool   up = b.low >= 0, right = a.low >= 0;
    double a_least = up ? a.low : a.high, a_most = up ? a.high : a.low;
    double b_least = right ? b.low : b.high, b_most = right ? b.high : b.low;
    return (Range){product_low(a_least, b_least), product_high(a_most, b_most)};
}

Range range_div(Range a, Range b)
{
    if (b.low <= 0 && b.high >= 0) {
        if (b.low < 0 || range_is_zero(b))
            return ANYTHING; /* zero has no sign: what is divided by it has that of the dividend */
        b.low = 0.0;         /* the quotient is unbounded on the side that the other end has */
    }
    if (b.low > 0 && is_ordered(a) && is_ordered(b) && isfinite(a.low) && isfinite(a.high) &&
        isfinite(b.high))
        return (Range){quotient_low(a.low, a.low >= 0 ? b.high : b.low),
                       quotient_high(a.high, a.high >= 0 ? b.low : b.high)};
    return (Range){min2(min2(quotient_low(a.low, b.low), quotient_low(a.low, b.high)),
                        min2(quotient_low(a.high, b.low), quotient_low(a.high, b.high))),
                   max2(max2(quotient_high(a.low, b.low), quotient_high(a.low, b.high)),
                        max2(quotient_high(a.high, b.low), quotient_high(a.high, b.high)))};
}

/* The range is between 0 and b, and less where the same multiple of b is taken off all over. */
Range range_mod(Range a, Range b)
{
    Range whole = {min2(b.low, 0), max2(b.high, 0)};
    Range times = range_floor(range_div(a, b));
    if (!range_is_single(times) || !isfinite(times.low))
        return whole;
    return range_intersect(whole, range_sub(a, range_mul(times, b)));
}

/* A monotone function of each operand has its extremes at the corners. */
static Range range_corners(double f(double, double), Range a, Range b)
{
    double p = f(a.low, b.low), q = f(a.low, b.high), r = f(a.high, b.low), s = f(a.high, b.high);
    if (isnan(p) || isnan(q) || isnan(r) || isnan(s))
        return ANYTHING;
    return widened(min2(min2(p, q), min2(r, s)), max2(max2(p, q), max2(r, s)));
}

Range range_pow(Range a, Range b)
{
    if (a.low >= 0)
        return range_intersect((Range){0, HUGE_VAL}, range_corners(real_pow, range_above(a, 0), b));
    if (!range_is_single(b) || floor(b.low) != b.low || (b.low < 0 && a.high >= 0))
        return ANYTHING;
    bool even = fmod(b.low, 2) == 0;
    return range_corners(real_pow, even ? range_abs(a) : a, b);
}

Range range_pow_slope(Range a, Range b)
{
    if (range_is_zero(b))
        return range_of(0);
    return range_mul(b, range_pow(a, range_sub(b, range_of(1))));
}

Range range_pow_slope_exponent(Range a, Range value)
{
    return a.low < 0 ? ANYTHING : range_mul(value, range_log(a));
}

/* Tells whether the half line b < 0, a = 0, across which the angle jumps, meets the inside. */
static bool crosses_cut(Range a, Range b) { return a.low < 0 && a.high >= 0 && b.low < 0; }

static double angle_of(double a, double b) { return real_atan2(a + 0.0, b + 0.0); } /* no -0 */

Range range_atan2(Range a, Range b)
{
    if (crosses_cut(a, b))
        return widened(-PI, PI);
    Range angle  = range_corners(angle_of, a, b);
    bool  origin = range_least(a) == 0 && range_least(b) == 0;
    return origin ? range_hull(angle, range_of(0)) : angle;
}

Range range_atan2_slope(Range a, Range b, Range numerator)
{
    Range square = range_add(range_square(a), range_square(b));
    if (square.low <= 0 || crosses_cut(a, b))
        return ANYTHING;
    Range bound = range_inversesqrt(square);
    return range_intersect(range_div(numerator, square), (Range){-bound.high, bound.high});
}

Range range_is_less(Range a, Range b)
{
    if (a.high <= b.low)
        return range_of(1);
    return (Range){0, b.high <= a.low ? 0 : 1};
}

Range range_step(Range edge, Range a) { return (Range){a.low >= edge.high, a.high >= edge.low}; }

/* ---- three operands ---- */

/* Returns the range of a mix, which is linear in each operand: the extremes are at the corners. */
Range range_mix(Range a, Range b, Range c)
{
    Range mixed = {HUGE_VAL, -HUGE_VAL};
    for (int corner = 0; corner < 8; corner++) {
        Range x = range_of(corner & 1 ? a.low : a.high), y = range_of(corner & 2 ? b.low : b.high);
        Range t       = range_of(corner & 4 ? c.low : c.high);
        Range rest    = range_mul(x, range_sub(range_of(1), t));
        Range product = range_mul(y, t);
        mixed         = range_hull(mixed, range_add(rest, product));
    }
    return isnan(mixed.low) ? ANYTHING : widened(mixed.low, mixed.high);
}

/* Returns the range of (c - a) / (b - a), clamped; where a = b it is a step. */
static Range smoothstep_progress(Range a, Range b, Range c)
{
    Range width = range_sub(b, a);
    if (width.low <= 0 && width.high >= 0)
        return (Range){0, 1};
    Range progress = range_div(range_sub(c, a), width);
    return (Range){min2(max2(progress.low, 0), 1), max2(min2(progress.high, 1), 0)};
}

static double smooth(double t) { return t * t * (3 - 2 * t); }

/* Tells whether a smoothstep is constant: whatever the order of a and b, c beyond both of them on
   one side decides. */
static bool smoothstep_is_flat(Range a, Range b, Range c, Range *value)
{
    bool rising = a.high <= b.low, falling = b.high < a.low;
    if (!rising && !falling)
        return false;
    if (c.high < min2(a.low, b.low))
        *value = range_of(rising ? 0 : 1);
    else if (c.low > max2(a.high, b.high))
        *value = range_of(rising ? 1 : 0);
    else
        return false;
    return true;
}

Range range_smoothstep(Range a, Range b, Range c)
{
    Range value;
    if (!is_number(range_largest(a)) || !is_number(range_largest(b)))
        return (Range){0, 1}; /* infinite / infinite counts as 0 */
    if (smoothstep_is_flat(a, b, c, &value))
        return value;
    Range t = smoothstep_progress(a, b, c);
    return widened_within(smooth(t.low), smooth(t.high), 0, 1);
}

/* Returns the range of 6 t (1 - t) times the derivative of t by a, b or c; what divides is b - a. */
Range range_smoothstep_slope(Range a, Range b, Range c, int operand)
{
    Range value, width = range_sub(b, a);
    if (smoothstep_is_flat(a, b, c, &value))
        return range_of(0);
    if (width.low <= 0 && width.high >= 0)
        return ANYTHING;
    Range  t   = smoothstep_progress(a, b, c);
    double low = 6 * t.low * (1 - t.low), high = 6 * t.high * (1 - t.high);
    bool   peak  = t.low <= 0.5 && t.high >= 0.5;
    Range  rise  = widened_within(min2(low, high), peak ? 1.5 : max2(low, high), 0, 1.5);
    Range  by[3] = {range_sub(t, range_of(1)), range_neg(t), range_of(1)};
    return range_div(range_mul(rise, by[operand]), width);
}

/* ---- jumps ---- */

Range jumps(Range steps) { return unless_jumps(steps, range_of(0)); }

Range unless_jumps(Range steps, Range derivative)
{
    return range_is_single(steps) ? derivative : ANYTHING;
}
