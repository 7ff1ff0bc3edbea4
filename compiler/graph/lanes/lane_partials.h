/*
 * lane_partials.h: partial derivatives of operations on numbers, first and second, in intervals.
 *
 * Sums and products here are widened by more than their rounding, which costs less than to round exactly.
 */
#ifndef KRS_LANE_PARTIALS_H
#define KRS_LANE_PARTIALS_H

#include "compiler/graph/lanes/lanes.h"

/* By the first three operands.  Not known: the first may jump, or there is no bound. */
typedef struct LanePartials {
    Range first[3], second[3][3]; /* second[k][l] with k <= l */
    bool  known;
} LanePartials;

/* What an operation has at the operands' ranges a, b and c; r is that of its result. */
LanePartials partials_of(uint16_t op, Range a, Range b, Range c, Range r);

static inline Range widened(double low, double high)
{
    return (Range){low - (fabs(low) * 0x1p-52 + 1e-300), high + (fabs(high) * 0x1p-52 + 1e-300)};
}

static inline Range times(Range a, Range b)
{
    double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
    double low = p < q ? p : q, high = p < q ? q : p;
    low  = r < low ? r : low;
    high = r > high ? r : high;
    return widened(s < low ? s : low, s > high ? s : high);
}

static inline Range squared(Range a)
{
    double least = range_least(a), most = range_largest(a);
    double low = least * least * (1 - 0x1p-52) - 1e-300;
    return (Range){low > 0 ? low : 0, most * most * (1 + 0x1p-52) + 1e-300};
}

static inline Range plus(Range a, Range b) { return widened(a.low + b.low, a.high + b.high); }
static inline Range minus(Range a) { return (Range){-a.high, -a.low}; }
static inline Range scaled(double factor, Range a)
{
    return factor < 0 ? widened(factor * a.high, factor * a.low)
                      : widened(factor * a.low, factor * a.high);
}

static inline bool is_finite(Range a) { return isfinite(a.low) && isfinite(a.high); }

#endif
