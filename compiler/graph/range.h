/*
 * range.h: interval arithmetic for the `range` and derivative columns of ops.def.
 *
 * Each function gives a range that holds every value for operands in theirs, where the value is
 * defined; what is not a number (inf - inf) makes an end infinite.  Sums and products round
 * outwards only where they are inexact, so that simple numbers stay simple.
 */
#ifndef KRS_RANGE_H
#define KRS_RANGE_H

#include <math.h>
#include <stdbool.h>

#include "compiler/base/minmax.h"

typedef struct Range {
    double low, high; /* low <= high; may be infinite; [-inf, inf] is "anything" */
} Range;

typedef struct Box {
    Range axis[3];
} Box;

/* Returns the axis along which it is longest, the first of those: 0, 1 or 2. */
int box_longest_axis(const Box *box);
/* Cuts a box in the middle of that axis: the half of lesser coordinates comes first. */
void box_halve(Box box, Box halves[2]);
/* Returns where to cut a range in two: in the middle, or further and further out where there is none. */
double range_cut(Range a);

#define ANYTHING ((Range){-HUGE_VAL, HUGE_VAL})

static inline Range range_of(double number) { return (Range){number, number}; }
static inline bool  range_is_zero(Range a) { return a.low == 0 && a.high == 0; }
static inline bool  range_is_single(Range a) { return a.low == a.high; }

static inline Range range_hull(Range a, Range b)
{
    return (Range){min2(a.low, b.low), max2(a.high, b.high)};
}

/* Intersects ranges that must overlap; if they do not it returns a. */
static inline Range range_intersect(Range a, Range b)
{
    Range common = {max2(a.low, b.low), min2(a.high, b.high)};
    return common.low <= common.high ? common : a;
}

/* Returns the greatest and the least size of a value. */
static inline double range_largest(Range a) { return max2(fabs(a.low), fabs(a.high)); }
static inline double range_least(Range a) { return a.low > 0 ? a.low : a.high < 0 ? -a.high : 0; }

/* Bounds that are never below the exact sum or product of numbers >= 0; 0 * inf is 0. */
double sum_upward(double a, double b);
double product_upward(double a, double b);
double hypot_upward(double a, double b);

static inline Range range_neg(Range a) { return (Range){-a.high, -a.low}; }
Range               range_abs(Range a);
Range               range_sign(Range a);    /* derivative of abs */
Range               range_sign_of(Range a); /* value of sign, 0 for 0 */
Range               range_floor(Range a);
Range               range_ceil(Range a);
Range               range_round(Range a);
Range               range_fract(Range a);
Range               range_square(Range a);
Range               range_sqrt(Range a);
Range               range_inversesqrt(Range a);
Range               range_inversesqrt_slope(Range a, Range value);
Range               range_exp(Range a);
Range               range_exp2(Range a);
Range               range_log(Range a);
Range               range_log2(Range a);
Range               range_above(Range a, double least); /* the part of a that is not below */
Range               range_sin(Range a);
Range               range_cos(Range a);
Range               range_tan(Range a);
Range               range_tan_slope(Range value);
Range               range_asin(Range a);
Range               range_acos(Range a);
Range               range_asin_slope(Range a);
Range               range_atan(Range a);
Range               range_sinh(Range a);
Range               range_cosh(Range a);
Range               range_tanh(Range a);
Range               range_sech_square(Range a);

Range range_add(Range a, Range b);
Range range_sub(Range a, Range b);
Range range_mul(Range a, Range b);
Range range_div(Range a, Range b);
Range range_mod(Range a, Range b);
Range range_pow(Range a, Range b);
Range range_pow_slope(Range a, Range b);
Range range_pow_slope_exponent(Range a, Range value);
Range range_atan2(Range a, Range b);
/* Returns the range of numerator / (a^2 + b^2). */
Range               range_atan2_slope(Range a, Range b, Range numerator);
static inline Range range_min(Range a, Range b)
{
    return (Range){min2(a.low, b.low), min2(a.high, b.high)};
}
static inline Range range_max(Range a, Range b)
{
    return (Range){max2(a.low, b.low), max2(a.high, b.high)};
}
Range range_is_less(Range a, Range b); /* 1 where a is the lesser, 0 where b is; else [0, 1] */
Range range_step(Range edge, Range a);
Range range_mix(Range a, Range b, Range c);
Range range_smoothstep(Range a, Range b, Range c);
Range range_smoothstep_slope(Range a, Range b, Range c, int operand);

/* Returns the derivatives of what jumps from one value of `steps` to the next. */
Range jumps(Range steps);
Range unless_jumps(Range steps, Range derivative);

#endif
