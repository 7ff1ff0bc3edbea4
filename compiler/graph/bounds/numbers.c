/* numbers.c: the rows of ops.def as functions of intervals. */
#include "compiler/graph/bounds/numbers.h"

/* ---- what the columns of ranges are written in ---- */

/* Returns a component over the length of its vector; 0 of 0. */
static Range range_unit_part(Range a, Range length)
{
    const Range unit = {-1 - 0x1p-48, 1 + 0x1p-48};
    if (length.low > 0)
        return range_intersect(range_div(a, length), unit);
    return range_intersect((Range){a.low < 0 ? unit.low : 0, a.high > 0 ? unit.high : 0}, unit);
}

/* Takes whole periods off where the period is above 0; behind the first and the last cell no more
   than there. */
static Range range_moved(Range p, Range period, Range first, Range last)
{
    Range  cell  = range_min(range_max(range_round(range_div(p, period)), first), last);
    Range  moved = range_sub(p, range_mul(period, cell));
    double slack = 0x1p-48 * (range_largest(p) + period.high), half = period.high / 2 + slack;
    Range  before = range_sub(range_of(p.low), range_mul(period, first));
    Range  behind = range_sub(range_of(p.high), range_mul(period, last));
    Range  folded = {min2(-half, before.low - slack), max2(half, behind.high + slack)};
    return range_is_single(cell) || !is_finite(folded) ? moved : range_intersect(moved, folded);
}

Range range_in_cell(Range p, Range period, Range first, Range last)
{
    if (!(period.high > 0))
        return p;
    Range moved = range_moved(p, range_above(period, 0), first, last);
    return period.low > 0 ? moved : range_hull(moved, p);
}

static bool is_in_one_cell(Range p, Range period, Range first, Range last)
{
    Range cell = range_min(range_max(range_round(range_div(p, period)), first), last);
    return period.high <= 0 || (period.low > 0 && is_finite(p) && range_is_single(cell));
}

/* Returns the range of 1/2 + (b - a) / 2k between 0 and 1, and its derivative by b. */
static Range range_weight(Range a, Range b, Range k)
{
    const Range bounds = {0, 1};
    if (!(k.low > 0) || !is_finite(a) || !is_finite(b))
        return bounds;
    Range share = range_div(range_mul(HALF, range_sub(b, a)), k);
    return range_max(range_min(range_add(HALF, share), ONE), ZERO);
}

static Range range_weight_slope(Range k, Range weight)
{
    Range steep = k.low > 0 ? range_div(HALF, k) : (Range){0, HUGE_VAL};
    return weight.low > 0 && weight.high < 1 ? steep : range_hull(steep, ZERO);
}

/* Returns 6 (1 - 2 t) / (b - a)^2 with t = (c - a) / (b - a) from 0 to 1, and 0 beyond. */
static Range bend_of_smoothstep(Range a, Range b, Range c)
{
    Range width = plus(b, minus(a)), t = range_div(plus(c, minus(a)), width);
    Range part = range_intersect(t, (Range){0, 1});
    if (!(part.low <= part.high))
        return ZERO;
    Range bend = range_div(plus(range_of(6), scaled(-12, part)), squared(width));
    return t.low < 0 || t.high > 1 ? range_hull(bend, ZERO) : bend;
}

/* ---- what the columns of choices are written in ---- */

#define A CHOOSES_A
#define B CHOOSES_B
#define C CHOOSES_C
#define D CHOOSES_D

static bool is_one(Range a) { return a.low == 1 && a.high == 1; }

static unsigned lesser(Range a, Range b)
{
    return a.high <= b.low ? A : b.high <= a.low ? B : A | B;
}

/* Returns the operands that min(max(a, b), c) may be. */
static unsigned clamped(Range a, Range b, Range c)
{
    Range    above = range_max(a, b);
    unsigned inner = lesser(range_neg(a), range_neg(b));
    return above.high <= c.low ? inner : above.low >= c.high ? C : inner | C;
}

/* Finds which operands count, as guard_decides of op_values.h does: everywhere, nowhere, or
   neither. */
static unsigned guarded(Range bound, Range least, Range far)
{
    Range nearer = range_min(least, far), inside = range_min(far, ZERO);
    if (bound.low >= nearer.high && bound.low > inside.high)
        return lesser(bound, least);
    return bound.high < nearer.low || bound.high <= inside.low ? C : lesser(bound, least) | C;
}

/* Blends that take nothing off where |a - b| is the width or more. */
static unsigned blended(Range a, Range b, Range width)
{
    double gap = max2(b.low - a.high, a.low - b.high);
    return width.high <= 0 || gap * (1 - 0x1p-50) > width.high ? lesser(a, b) : 0;
}

static Range range_select(Range a, Range b, Range c)
{
    return a.low > 0 ? b : a.high <= 0 ? c : range_hull(b, c);
}

static Range range_guard(Range a, Range b, Range c, Range d)
{
    unsigned chosen = guarded(a, b, d);
    Range    out    = range_min(a, b);
    return chosen == C ? c : chosen & C ? range_hull(out, c) : out;
}

/* ---- rows as functions ---- */

#define OPERANDS                                        \
    const Range a = o[0], b = o[1], c = o[2], d = o[3]; \
    (void)a, (void)b, (void)c, (void)d

#define RANGE(name, expression)                  \
    static Range range_of_##name(const Range *o) \
    {                                            \
        OPERANDS;                                \
        return expression;                       \
    }
#define FIRST(name, da, db, dc, dd)                                 \
    static void first_of_##name(const Range *o, Range r, Range *by) \
    {                                                               \
        OPERANDS;                                                   \
        (void)r;                                                    \
        by[0] = da, by[1] = db, by[2] = dc, by[3] = dd;             \
    }
#define SECOND(name, when_defined, smooth, put)                                                \
    static bool defined_of_##name(const Range *o, bool finite)                                 \
    {                                                                                          \
        OPERANDS;                                                                              \
        (void)finite;                                                                          \
        return when_defined;                                                                   \
    }                                                                                          \
    static bool second_of_##name(const Range *o, Range r, const Range *by, Range second[3][3]) \
    {                                                                                          \
        OPERANDS;                                                                              \
        const Range da = by[0], db = by[1], dc = by[2];                                        \
        (void)r, (void)da, (void)db, (void)dc;                                                 \
        if (!(smooth))                                                                         \
            return false;                                                                      \
        put;                                                                                   \
        return true;                                                                           \
    }

#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning) \
    RANGE(name, range)                                                          \
    FIRST(name, da, db, dc, ZERO)
#define NUMBERS(name, arity, value, range, da, db, dc, dd) \
    RANGE(name, range)                                     \
    FIRST(name, da, db, dc, dd)
#define TRUTH(name, count, value, always, never)           \
    RANGE(name, ((Range){(always), (always) || !(never)})) \
    FIRST(name, jumps(r), jumps(r), ZERO, ZERO)
#define LANES1(name, takes, defined, smooth, aa) SECOND(name, defined, smooth, second[0][0] = aa)
#define LANES2(name, takes, defined, smooth, aa, ab, bb) \
    SECOND(name, defined, smooth, second[0][0] = aa; second[0][1] = ab; second[1][1] = bb)
#define LANES3(name, takes, defined, smooth, ac, bc, cc) \
    SECOND(name, defined, smooth, second[0][2] = ac; second[1][2] = bc; second[2][2] = cc)
#define ITSELF(name, expression)                    \
    static Range itself_of_##name(Range a, Range r) \
    {                                               \
        (void)r;                                    \
        return expression;                          \
    }
#define CHOOSES(name, operands, mask)                 \
    static unsigned chooses_of_##name(const Range *o) \
    {                                                 \
        OPERANDS;                                     \
        return mask;                                  \
    }
#include "compiler/graph/ops.def"

enum { TAKES = false, NEEDS = true };

const NumberRow number_rows[OP_COUNT] = {
#define BOTH(name_, arity_, norm_)                                                                 \
    [OP_##name_].arity = arity_, [OP_##name_].norm = norm_, [OP_##name_].range = range_of_##name_, \
    [OP_##name_].first = first_of_##name_,
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning) \
    BOTH(name, arity, norm)[OP_##name].map = true,
#define NUMBERS(name, arity, ...) BOTH(name, arity, NORM_SUM)
#define TRUTH(name, arity, ...)   BOTH(name, arity, NORM_NONE)
#define LANES1(name, takes, ...)                                        \
    [OP_##name].needs = takes, [OP_##name].defined = defined_of_##name, \
    [OP_##name].second = second_of_##name,
#define LANES2 LANES1
#define LANES3 LANES1
#define CHOOSES(name, operands, mask) \
    [OP_##name].sure = operands, [OP_##name].chooses = chooses_of_##name,
#define ITSELF(name, expression) [OP_##name].itself = itself_of_##name,
#include "compiler/graph/ops.def"
#define BLEND_BENDS(name, most) [OP_smin_##name].bend = most,
#include "compiler/graph/blends.def"
};
