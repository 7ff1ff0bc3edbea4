/*
 * numbers.h: what rows of ops.def say of operations on numbers, in intervals.
 *
 * MAP rows are such operations, component by component; of NUMBERS and TRUTH rows a vector's components are
 * operands (ops.def).  Sums and products here are widened by more than their rounding, which costs less than to round
 * exactly.
 */
#ifndef KRS_NUMBERS_H
#define KRS_NUMBERS_H

#include "compiler/graph/graph.h"
#include "compiler/graph/range.h"

/* The ways in which slopes combine: ops.def. */
typedef enum Norm { NORM_SUM, NORM_CONVEX, NORM_MIX, NORM_NONE } Norm;

/* The columns of derivatives are written in these ranges. */
#define ZERO      range_of(0)
#define ONE       range_of(1)
#define MINUS_ONE range_of(-1)
#define TWO       range_of(2)
#define HALF      range_of(0.5)
#define LN2       ((Range){0.69314718055994528, 0.6931471805599454})

/* The operands that something may be, or that are meant: ops.def. */
enum { CHOOSES_A = 1, CHOOSES_B = 2, CHOOSES_C = 4, CHOOSES_D = 8 };

/* All get the ranges of MAX_OPERANDS operands, of which `arity` count; r is that of the result. */
typedef struct NumberRow {
    uint8_t arity; /* 0: there is no row, and the rule of facts tells its range and derivatives */
    bool    map, needs;
    uint8_t norm, sure;
    double  bend; /* of smooth minima: blends.def */
    Range (*range)(const Range *o);
    /* Its derivatives by each operand, where there are corners the hull of those around. */
    void (*first)(const Range *o, Range r, Range *by);
    /* The second ones, second[k][l] with k <= l and two operands of the first three; false: the first may jump, or there is
       no bound.  NULL: so it is. */
    bool (*second)(const Range *o, Range r, const Range *by, Range second[3][3]);
    bool (*defined)(const Range *o, bool finite); /* NULL: where all are finite, if it stays so */
    Range (*itself)(Range a,
                    Range r); /* where both operands are one number; NULL: r, as of others */
    unsigned (*chooses)(const Range *o); /* NULL: it may be another number everywhere */
} NumberRow;

extern const NumberRow number_rows[OP_COUNT];

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

/* Holds the values of p less whole periods, as many as lead nearest to 0, but not below `first` nor above
   `last`. Where the period is not above 0 it holds those of p. */
Range range_in_cell(Range p, Range period, Range first, Range last);

#endif
