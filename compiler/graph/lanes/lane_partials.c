/* lane_partials.c: rules for the second derivatives of operations on numbers. */
#include "compiler/graph/lanes/lane_partials.h"

/* ---- of one number ---- */

static Range inverse(Range a) { return range_div(range_of(1), a); }

/* A root has no bounds at 0. */
static Partials partials_of_root(Range a, Range root)
{
    Partials p = {.known = a.low > 0 && root.low > 0};
    if (p.known) {
        p.first[0]     = range_div(range_of(0.5), root);
        p.second[0][0] = minus(range_div(p.first[0], scaled(2, a)));
    }
    return p;
}

static Partials partials_of_one(uint16_t op, Range a, Range r)
{
    Partials p = {.known = true, .first = {range_of(0)}};
    switch (op) {
    case OP_precise: p.first[0] = range_of(1); break;
    case OP_neg: p.first[0] = range_of(-1); break;
    case OP_abs:
        p.first[0] = range_of(a.low >= 0 ? 1 : -1);
        p.known    = a.low >= 0 || a.high <= 0;
        break;
    case OP_sign:
    case OP_floor:
    case OP_ceil:
    case OP_round: p.known = range_is_single(r); break;
    case OP_fract:
        p.first[0] = range_of(1);
        p.known    = range_is_single(range_floor(a));
        break;
    case OP_square:
        p.first[0]     = scaled(2, a);
        p.second[0][0] = range_of(2);
        break;
    case OP_sqrt: return partials_of_root(a, r);
    case OP_exp: p.first[0] = p.second[0][0] = r; break;
    case OP_sin:
        p.first[0]     = range_cos(a);
        p.second[0][0] = minus(r);
        break;
    case OP_cos:
        p.first[0]     = minus(range_sin(a));
        p.second[0][0] = minus(r);
        break;
    case OP_log:
        p.known        = a.low > 0;
        p.first[0]     = inverse(a);
        p.second[0][0] = minus(range_square(p.first[0]));
        break;
    case OP_atan:
        p.first[0]     = inverse(range_add(range_of(1), range_square(a)));
        p.second[0][0] = times(scaled(-2, a), range_square(p.first[0]));
        break;
    default: p.known = false;
    }
    return p;
}

/* ---- of several numbers ---- */

/* One operand, whichever it is, all over the box. */
static Partials partials_of_choice(int chosen)
{
    Partials p = {.known = chosen >= 0};
    if (chosen >= 0)
        p.first[chosen] = range_of(1);
    return p;
}

static int lesser(Range a, Range b) { return a.high <= b.low ? 0 : b.high <= a.low ? 1 : -1; }

/* The operand that a clamped number is, all over the box. */
static int clamped(Range a, Range low, Range high)
{
    if (a.high <= low.low && low.high <= high.low)
        return 1;
    if (max2(a.low, low.low) >= high.high)
        return 2;
    return a.low >= low.high && a.high <= high.low ? 0 : -1;
}

static Partials partials_of_quotient(Range a, Range b)
{
    Partials p = {.known = (b.low > 0 || b.high < 0) && is_finite(a) && is_finite(b)};
    if (!p.known)
        return p;
    Range over = inverse(b), square = range_square(over), quotient = times(a, over);
    p.first[0]     = over;
    p.first[1]     = minus(times(quotient, over));
    p.second[0][1] = minus(square);
    p.second[1][1] = scaled(2, times(quotient, square));
    return p;
}

/* With an exponent that is the same everywhere. */
static Partials partials_of_power(Range a, Range exponent)
{
    double   n = exponent.low;
    Partials p = {.known = range_is_single(exponent) && a.low > 0 && is_finite(a) && isfinite(n)};
    if (p.known) {
        p.first[0]     = scaled(n, range_pow(a, range_of(n - 1)));
        p.second[0][0] = scaled(n * (n - 1), range_pow(a, range_of(n - 2)));
    }
    return p;
}

/* A component over the length of its vector. */
static Partials partials_of_normalize(Range part, Range length, Range unit)
{
    Partials p = {.known = length.low > 0 && is_finite(part) && is_finite(length)};
    if (!p.known)
        return p;
    Range over = inverse(length), square = range_square(over);
    p.first[0]     = over;
    p.first[1]     = minus(times(unit, over));
    p.second[0][1] = minus(square);
    p.second[1][1] = scaled(2, times(unit, square));
    return p;
}

/* Angle of the point (b, a); it jumps on one side. */
static Partials partials_of_angle(Range a, Range b)
{
    Range    square = range_add(range_square(a), range_square(b));
    Partials p      = {.known = square.low > 0 && is_finite(square) &&
                                (b.low > 0 || a.low > 0 || a.high < 0)};
    if (!p.known)
        return p;
    Range over = inverse(square), over2 = range_square(over);
    p.first[0]     = times(b, over);
    p.first[1]     = minus(times(a, over));
    p.second[1][1] = scaled(2, times(times(a, b), over2));
    p.second[0][0] = minus(p.second[1][1]);
    p.second[0][1] = times(plus(range_square(a), minus(range_square(b))), over2);
    return p;
}

static Partials partials_of_mix(Range a, Range b, Range c)
{
    Partials p     = {.known = is_finite(a) && is_finite(b) && is_finite(c)};
    p.first[0]     = range_sub(range_of(1), c);
    p.first[1]     = c;
    p.first[2]     = range_sub(b, a);
    p.second[0][2] = range_of(-1);
    p.second[1][2] = range_of(1);
    return p;
}

Partials partials_of(uint16_t op, Range a, Range b, Range c, Range r)
{
    Partials p = {.known = true};
    switch (op) {
    case OP_add: p.first[0] = p.first[1] = range_of(1); break;
    case OP_sub:
        p.first[0] = range_of(1);
        p.first[1] = range_of(-1);
        break;
    case OP_mul:
        p.first[0]     = b;
        p.first[1]     = a;
        p.second[0][1] = range_of(1);
        break;
    case OP_div: return partials_of_quotient(a, b);
    case OP_pow: return partials_of_power(a, b);
    case OP_normalize: return partials_of_normalize(a, b, r);
    case OP_atan2: return partials_of_angle(a, b);
    case OP_mix: return partials_of_mix(a, b, c);
    case OP_min:
    case LANE_LESSER: return partials_of_choice(lesser(a, b));
    case OP_max:
    case LANE_GREATER: return partials_of_choice(lesser(minus(a), minus(b)));
    case OP_clamp: return partials_of_choice(clamped(a, b, c));
    case OP_select: return partials_of_choice(a.low > 0 ? 1 : a.high <= 0 ? 2 : -1);
    default: return partials_of_one(op, a, r);
    }
    return p;
}
