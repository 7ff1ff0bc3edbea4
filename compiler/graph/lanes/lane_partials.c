/* lane_partials.c: partial derivatives by the rows of ops.def. */
#include "compiler/graph/lanes/lane_partials.h"
#include "compiler/graph/bounds/rules.h"

/* Tells whether one operand is taken all over the box: min, max and clamp have the derivatives 1 and 0. */
static bool chooses_one(Range da, Range db, Range dc)
{
    return range_is_single(da) && range_is_single(db) && range_is_single(dc) &&
           da.low + db.low + dc.low == 1;
}

/* 6 (1 - 2 t) / (b - a)^2 with t = (c - a) / (b - a) from 0 to 1, and 0 beyond. */
static Range bend_of_smoothstep(Range a, Range b, Range c)
{
    Range width = plus(b, minus(a)), t = range_div(plus(c, minus(a)), width);
    Range part = range_intersect(t, (Range){0, 1});
    if (!(part.low <= part.high))
        return range_of(0);
    Range bend = range_div(plus(range_of(6), scaled(-12, part)), squared(width));
    return t.low < 0 || t.high > 1 ? range_hull(bend, range_of(0)) : bend;
}

/* A component over the length of its vector. */
static LanePartials partials_of_normalize(Range length, Range unit)
{
    LanePartials p = {.known = length.low > 0};
    if (!p.known)
        return p;
    Range over = range_div(range_of(1), length), square = squared(over);
    p.first[0]     = over;
    p.first[1]     = minus(times(unit, over));
    p.second[0][1] = minus(square);
    p.second[1][1] = scaled(2, times(unit, square));
    return p;
}

static LanePartials partials_of_select(Range condition)
{
    LanePartials p = {.known = condition.low > 0 || condition.high <= 0};
    if (p.known)
        p.first[condition.low > 0 ? 1 : 2] = range_of(1);
    return p;
}

/* The rows' columns; each row has its own variables. */
static LanePartials partials_of_row(uint16_t op, Range a, Range b, Range c, Range r)
{
    LanePartials p = {.known = false};
    switch (op) {
#define MAP(name, arity, called, glsl, value, range, da_, db_, dc_, norm, meaning) \
    case OP_##name: {                                                              \
        const Range da = (da_), db = (db_), dc = (dc_);                            \
        (void)a, (void)b, (void)c, (void)r, (void)db, (void)dc;
#define LANES1(name, takes, defined, smooth, aa) \
    p.known        = (smooth);                   \
    p.first[0]     = da;                         \
    p.second[0][0] = p.known ? (aa) : ZERO;      \
    return p;                                    \
    }
#define LANES2(name, takes, defined, smooth, aa, ab, bb) \
    p.known        = (smooth);                           \
    p.first[0]     = da;                                 \
    p.first[1]     = db;                                 \
    p.second[0][0] = p.known ? (aa) : ZERO;              \
    p.second[0][1] = p.known ? (ab) : ZERO;              \
    p.second[1][1] = p.known ? (bb) : ZERO;              \
    return p;                                            \
    }
#define LANES3(name, takes, defined, smooth, ac, bc, cc) \
    p.known        = (smooth);                           \
    p.first[0]     = da;                                 \
    p.first[1]     = db;                                 \
    p.first[2]     = dc;                                 \
    p.second[0][2] = p.known ? (ac) : ZERO;              \
    p.second[1][2] = p.known ? (bc) : ZERO;              \
    p.second[2][2] = p.known ? (cc) : ZERO;              \
    return p;                                            \
    }
#include "compiler/graph/ops.def"
    default: return p;
    }
}

LanePartials partials_of(uint16_t op, Range a, Range b, Range c, Range r)
{
    switch (op) {
    case OP_normalize: return partials_of_normalize(b, r);
    case OP_select: return partials_of_select(a);
    case LANE_LESSER: return partials_of_row(OP_min, a, b, c, r);
    case LANE_GREATER: return partials_of_row(OP_max, a, b, c, r);
    default: return partials_of_row(op, a, b, c, r);
    }
}
