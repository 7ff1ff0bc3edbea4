/*
 * elementary.c: functions of numbers in double precision that give the same on every machine.
 *
 * Arguments are reduced to where a Taylor series is short.  Its coefficients are what they are in textbooks, so nobody has to
 * believe them.  What a reduction rounds off is kept as a second, small number.
 */
#include "compiler/base/elementary.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* ---- parts of numbers ---- */

static uint64_t bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static double number_of(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static double power_of_2(int n) { return number_of((uint64_t)(n + 1023) << 52); }

/* Returns x 2^n, by two factors where either alone may overflow or underflow. */
static double scaled(double x, int n)
{
    if (n > -1000 && n < 1000)
        return x * power_of_2(n);
    return x * power_of_2(n / 2) * power_of_2(n - n / 2);
}

/* Returns the nearest whole number; |x| < 2^51. */
static double nearest(double x) { return (x + 0x1.8p52) - 0x1.8p52; }

/* A number that is the sum of two, of which the second is about what rounding took from the first. */
typedef struct Pair {
    double high, low;
} Pair;

/* Returns a + b without an error, by Knuth. */
static Pair exact_sum(double a, double b)
{
    const double sum = a + b, part = sum - a;
    return (Pair){sum, (a - (sum - part)) + (b - part)};
}

static double upper_half(double x)
{
    const double large = x * 134217729.0; /* 2^27 + 1 */
    return large - (large - x);
}

/* Returns a b without an error, by Dekker; both are far below the largest number. */
static Pair exact_product(double a, double b)
{
    const double product = a * b, a1 = upper_half(a), b1 = upper_half(b), a2 = a - a1, b2 = b - b1;
    return (Pair){product, a2 * b2 - (((product - a1 * b1) - a2 * b1) - a1 * b2)};
}

static Pair pair_product(Pair a, Pair b)
{
    const Pair product = exact_product(a.high, b.high);
    return (Pair){product.high, product.low + (a.high * b.low + a.low * b.high)};
}

/* Returns the same number, with the nearest double to it as its first part. */
static Pair pair_normalized(Pair a)
{
    const double sum = a.high + a.low;
    return (Pair){sum, (a.high - sum) + a.low};
}

/* Returns c[0] + c[1] x + ... by two sums that do not wait for each other. */
static inline double series(double x, const double *c, size_t count)
{
    const double square = x * x;
    double       even = 0, odd = 0;
    for (size_t i = count; i-- > 0;)
        if (i % 2 == 0)
            even = even * square + c[i];
        else
            odd = odd * square + c[i];
    return even + x * odd;
}
#define SERIES(x, c) series(x, c, sizeof(c) / sizeof *(c))

/* ---- exponentials ---- */

static const Pair   LN2       = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
static const double LN2_START = 0x1.62e42feep-1; /* so short that products by exponents are exact */
static const double LN2_REST  = 0x1.a39ef35793c76p-33;
static const double LOG2_E    = 0x1.71547652b82fep0;
static const double LOG2_E_REST = 0x1.777d0ffda0d24p-56;

/* Returns exp(r + rest) - 1 for |r| < 0.35, and a rest that is much smaller. */
static double exp_less_one(double r, double rest)
{
    static const double c[]    = {1.0 / 2,       1.0 / 6,         1.0 / 24,         1.0 / 120,
                                  1.0 / 720,     1.0 / 5040,      1.0 / 40320,      1.0 / 362880,
                                  1.0 / 3628800, 1.0 / 39916800., 1.0 / 479001600., 1.0 / 6227020800.};
    const double        square = r * r * SERIES(r, c);
    return r + (square + rest * (1 + (r + square)));
}

static double exp_of_pair(Pair x)
{
    if (!(x.high < 709.8)) /* beyond the largest number, or none */
        return x.high * 0x1p1023;
    if (x.high < -745.2)
        return 0;
    const double n = nearest(x.high * LOG2_E), start = x.high - n * LN2_START;
    const double r = start - n * LN2_REST, rest = (start - r) - n * LN2_REST;
    return scaled(1 + exp_less_one(r, rest + x.low), (int)n);
}

double real_exp(double x) { return exp_of_pair((Pair){x, 0}); }

double real_exp2(double x)
{
    if (!(x < 1024))
        return x * 0x1p1023;
    if (x < -1075)
        return 0;
    const double n = nearest(x);
    const Pair   r = pair_product((Pair){x - n, 0}, LN2);
    return scaled(1 + exp_less_one(r.high, r.low), (int)n);
}

/* sinh(x) / x - 1 is x^2 times that, for |x| < 1. */
static const double sinh_series[] = {1.0 / 6,
                                     1.0 / 120,
                                     1.0 / 5040,
                                     1.0 / 362880,
                                     1.0 / 39916800.,
                                     1.0 / 6227020800.,
                                     1.0 / 1307674368e3,
                                     1.0 / 355687428096e3,
                                     1.0 / 121645100408832e3};
static double       small_sinh(double x)
{
    const double square = x * x;
    return x + x * (square * SERIES(square, sinh_series));
}

/* Returns exp(|x|) / 2, also where exp(|x|) is too large. */
static double half_exp(double x)
{
    const double size = fabs(x);
    if (size < 709)
        return 0.5 * real_exp(size);
    const double root = real_exp(0.5 * size);
    return 0.5 * root * root;
}

double real_sinh(double x)
{
    if (fabs(x) < 1)
        return small_sinh(x);
    const double half = half_exp(x);
    return copysign(half - 0.25 / half, x);
}

double real_cosh(double x)
{
    const double half = half_exp(x);
    return half + 0.25 / half;
}

double real_tanh(double x)
{
    if (fabs(x) < 1)
        return small_sinh(x) / real_cosh(x);
    return fabs(x) > 22 ? copysign(1, x) : copysign(1 - 2 / (real_exp(2 * fabs(x)) + 1), x);
}

/* ---- logarithms ---- */

/* Returns a number above 0 as 2^exponent (1 + what is returned), which is from -0.3 to 0.42. */
static double split(double x, int *exponent)
{
    const int      tiny = x < 0x1p-1022 ? 54 : 0;
    const uint64_t bits = bits_of(tiny ? x * 0x1p54 : x), root = 0x3fe6a09e667f3bcd; /* 2^-1/2 */
    const int64_t  above = (int64_t)(bits - root) >> 52;
    *exponent            = (int)above - tiny;
    return number_of(bits - ((uint64_t)above << 52)) - 1;
}

/* Returns log(1 + f) - f + f^2 / 2, from the series of 2 artanh s with s = f / (2 + f). */
static double log_rest(double f)
{
    static const double c[] = {2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11,
                               2.0 / 13, 2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21};
    const double        s = f / (2 + f), square = s * s;
    return s * (0.5 * f * f + square * SERIES(square, c));
}

/* Returns log(x) of an x that is not above 0, or infinite, or no number. */
static double log_at_limits(double x) { return x == 0 ? -HUGE_VAL : x > 0 ? x : (x - x) / 0.0; }

static bool is_limit(double x) { return !(x > 0) || x > 0x1.fffffffffffffp1023; }

double real_log(double x)
{
    int exponent;
    if (is_limit(x))
        return log_at_limits(x);
    const double f = split(x, &exponent), n = exponent;
    return n * LN2_START - ((0.5 * f * f - (log_rest(f) + n * LN2_REST)) - f);
}

double real_log2(double x)
{
    int exponent;
    if (is_limit(x))
        return log_at_limits(x);
    const double f = split(x, &exponent), half = 0.5 * f * f, rest = log_rest(f);
    const double start = upper_half(f - half); /* its product by a short number is exact */
    const double left = ((f - start) - half) + rest, first = upper_half(LOG2_E);
    const Pair   sum = exact_sum(exponent, start * first);
    return sum.high +
           (sum.low + (left * first + (start + left) * ((LOG2_E - first) + LOG2_E_REST)));
}

double real_log1p(double x)
{
    const double sum = 1 + x;
    if (is_limit(sum))
        return log_at_limits(sum);
    if (sum == 1)
        return x;
    const double lost = sum > 2 ? 1 - (sum - x) : x - (sum - 1);
    return real_log(sum) + lost / sum;
}

/* ---- powers ---- */

/* Returns log(x) for a number above 0, to 2^-65 of it. */
static Pair log_pair(double x)
{
    static const double c[]        = {2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11, 2.0 / 13, 2.0 / 15,
                                      2.0 / 17, 2.0 / 19, 2.0 / 21, 2.0 / 23, 2.0 / 25, 2.0 / 27};
    static const Pair   two_thirds = {2.0 / 3, 0x1.5555555555555p-55};
    int                 exponent;
    const double        f = split(x, &exponent), n = exponent;
    const Pair          below  = exact_sum(2, f);
    const double        s      = f / below.high;
    const Pair          back   = exact_product(s, below.high);
    const Pair          arc    = {s, (((f - back.high) - back.low) - s * below.low) / below.high};
    const Pair          square = pair_product(arc, arc);
    const Pair          cube   = pair_product(pair_product(arc, square), two_thirds);
    const double        rest   = s * square.high * square.high * SERIES(square.high, c);
    const Pair          start  = exact_sum(n * LN2_START, 2 * arc.high);
    const Pair          sum    = exact_sum(start.high, cube.high);
    return pair_normalized((Pair){
        sum.high, sum.low + (start.low + (2 * arc.low + (cube.low + (rest + n * LN2_REST))))});
}

static bool is_odd(double y)
{
    return fabs(y) < 0x1p53 && floor(y) == y && floor(0.5 * y) != 0.5 * y;
}

/* Returns the power of a size where that is 0 or infinite, or where the exponent is beyond all that
   matters. */
static double power_at_limits(double size, double y)
{
    return size == 1 ? 1 : (size > 1) == (y > 0) ? HUGE_VAL : 0;
}

double real_pow(double x, double y)
{
    const double size = fabs(x);
    double       power;
    if (y == 0 || x == 1)
        return 1;
    if (y == 2)
        return x * x;
    if (x != x || y != y || (x < 0 && size < HUGE_VAL && floor(y) != y))
        return x != x || y != y ? x + y : (x - x) / 0.0;
    if (size == 0 || size == HUGE_VAL || fabs(y) > 0x1p70)
        power = power_at_limits(size, y);
    else
        power = exp_of_pair(pair_product((Pair){y, 0}, log_pair(size)));
    return signbit(x) && is_odd(y) ? -power : power;
}

/* Returns the cube root by Halley's steps, the last of them from what is right to a unit in the
   last place. */
double real_cbrt(double x)
{
    int exponent;
    if (x == 0 || x - x != 0)
        return x;
    const double part   = frexp(fabs(x), &exponent); /* from 0.5 to 1 */
    const int    thirds = (exponent + 3072) / 3 - 1024, left = exponent - 3 * thirds;
    const double a    = ldexp(part, left); /* from 0.5 to 4 */
    double       root = 0.6 + 0.27 * a;
    for (int i = 0; i < 4; i++) {
        const double cube = root * root * root;
        root += root * (a - cube) / (2 * cube + a);
    }
    return copysign(ldexp(root, thirds), x);
}

double real_hypot(double x, double y)
{
    const double a = fabs(x), b = fabs(y), most = a > b ? a : b;
    if (a == HUGE_VAL || b == HUGE_VAL)
        return HUGE_VAL;
    if (most > 0x1p500)
        return 0x1p600 * sqrt(0x1p-600 * a * (0x1p-600 * a) + 0x1p-600 * b * (0x1p-600 * b));
    if (most < 0x1p-450)
        return 0x1p-600 * sqrt(0x1p600 * a * (0x1p600 * a) + 0x1p600 * b * (0x1p600 * b));
    return sqrt(a * a + b * b);
}

/* ---- angles ---- */

static const Pair HALF_PI = {0x1.921fb54442d18p0, 0x1.1a62633145c07p-54};

/* 2 / pi behind the point, 32 bits a word. */
static const uint32_t two_over_pi[] = {
    0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041, 0xfe5163ab, 0xdebbc561,
    0xb7246e3a, 0x424dd2e0, 0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e, 0xe88235f5, 0x2ebb4484,
    0xe99c7026, 0xb45f7e41, 0x3991d639, 0x835339f4, 0x9c845f8b, 0xbdf9283b, 0x1ff897ff, 0xde05980f,
    0xef2f118b, 0x5a0a6d1f, 0x6d367ecf, 0x27cb09b7, 0x4f463f66, 0x9e5fea2d, 0x7527bac7, 0xebe5f17b,
    0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1, 0x1f8d5d08, 0x56033046, 0xfc7b6bab};

enum { WORDS = 8, FRACTION_WORDS = 5 };

/* Returns 32 bits of a long number, whose words begin with the lowest, from bit `at` on. */
static uint32_t bits_at(const uint32_t *words, int at)
{
    const uint64_t both = words[at / 32] | (uint64_t)words[at / 32 + 1] << 32;
    return (uint32_t)(both >> at % 32);
}

/* Returns the quotient of a number above 0 by pi / 2, less a multiple of 4: its fraction, at most
   1/2, and the whole number before it.  It is multiplied out in whole numbers, but for words of 2 /
   pi that give multiples of 4 (Payne and Hanek 1983). */
static Pair quarter_turns(double x, int *whole)
{
    int            exponent;
    const uint64_t part  = (uint64_t)(frexp(x, &exponent) * 0x1p53);
    const int      shift = exponent - 53, first = shift >= 34 ? (shift - 2) / 32 : 0;
    const int      point = 32 * (first + WORDS) - shift; /* the place of the point in the product */
    uint32_t       product[WORDS + 4] = {0};
    for (int k = 0; k < 2; k++) {
        uint64_t carry = 0;
        for (int i = 0; i < WORDS; i++) {
            const uint64_t word = two_over_pi[first + WORDS - 1 - i];
            carry += product[i + k] + word * (uint32_t)(part >> 32 * k);
            product[i + k] = (uint32_t)carry;
            carry >>= 32;
        }
        product[WORDS + k] = (uint32_t)carry;
    }
    const bool up  = bits_at(product, point - 32) >> 31; /* the fraction is above 1/2 */
    Pair       sum = {0, 0};
    for (int i = FRACTION_WORDS - 1; i >= 0; i--) {
        const uint32_t word = bits_at(product, point - 32 * (i + 1)) ^ (up ? 0xffffffffu : 0);
        const Pair     next = exact_sum(ldexp(word, -32 * (i + 1)), sum.high);
        sum                 = (Pair){next.high, next.low + sum.low};
    }
    *whole = (int)((bits_at(product, point) + up) & 3);
    return up ? (Pair){-sum.high, -sum.low} : sum;
}

/* Returns an angle less a multiple of pi / 2, at most pi / 4 or little more, and how often that was
   taken away, modulo 4. */
static Pair reduced(double x, int *quarter)
{
    if (fabs(x) < 0x1p20) {
        const double n     = nearest(x * (2 / 3.14159265358979323846));
        const double first = x - n * 0x1.921fb544p0, second = n * 0x1.0b4611a6p-34;
        const Pair   start = exact_sum(first, -second); /* both products are exact */
        const Pair   left  = pair_normalized(
               (Pair){start.high, start.low - n * 0x1.3198a2e037073p-69});
        *quarter = (int)n & 3;
        if (fabs(left.high) > 0x1p-30 || n == 0)
            return left;
    }
    int        whole;
    const Pair turn = pair_normalized(pair_product(quarter_turns(fabs(x), &whole), HALF_PI));
    *quarter        = (x < 0 ? -whole : whole) & 3;
    return x < 0 ? (Pair){-turn.high, -turn.low} : turn;
}

static double small_sin(Pair r)
{
    static const double c[]    = {1.0 / 120,           -1.0 / 5040,       1.0 / 362880,
                                  -1.0 / 39916800.,    1.0 / 6227020800., -1.0 / 1307674368e3,
                                  1.0 / 355687428096e3};
    const double        square = r.high * r.high, cube = square * r.high;
    return r.high + (cube * (square * SERIES(square, c) - 1.0 / 6) + r.low * (1 - 0.5 * square));
}

static double small_cos(Pair r)
{
    static const double c[]    = {1.0 / 24,           -1.0 / 720,       1.0 / 40320,
                                  -1.0 / 3628800,     1.0 / 479001600., -1.0 / 87178291200.,
                                  1.0 / 20922789888e3};
    const double        square = r.high * r.high, half = 0.5 * square, most = 1 - half;
    return most + (((1 - most) - half) + (square * square * SERIES(square, c) - r.high * r.low));
}

double real_sin(double x)
{
    int quarter;
    if (!(fabs(x) < HUGE_VAL) || x == 0)
        return x == 0 ? x : x - x;
    const Pair   r    = reduced(x, &quarter);
    const double size = quarter % 2 == 0 ? small_sin(r) : small_cos(r);
    return quarter >= 2 ? -size : size;
}

double real_cos(double x)
{
    int quarter;
    if (!(fabs(x) < HUGE_VAL))
        return x - x;
    const Pair   r    = reduced(x, &quarter);
    const double size = quarter % 2 == 0 ? small_cos(r) : small_sin(r);
    return quarter == 1 || quarter == 2 ? -size : size;
}

double real_tan(double x)
{
    int quarter;
    if (!(fabs(x) < HUGE_VAL) || x == 0)
        return x == 0 ? x : x - x;
    const Pair   r    = reduced(x, &quarter);
    const double sine = small_sin(r), cosine = small_cos(r);
    return quarter % 2 == 0 ? sine / cosine : -cosine / sine;
}

/* ---- angles of slopes ---- */

/* atan(k / 8). */
static const Pair arcs[] = {{0x0.0p+0, 0x0.0p+0},
                            {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                            {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                            {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                            {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                            {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                            {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                            {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                            {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};

/* Returns atan(x) for x from 0 to 1, as an arc of the table and what is left. */
static Pair small_atan(double x)
{
    static const double c[]  = {-1.0 / 3,  1.0 / 5,  -1.0 / 7, 1.0 / 9,
                                -1.0 / 11, 1.0 / 13, -1.0 / 15};
    const int           k    = (int)(8 * x + 0.5);
    const double        from = 0.125 * k, r = (x - from) / (1 + x * from), square = r * r;
    return (Pair){arcs[k].high, r + (r * (square * SERIES(square, c)) + arcs[k].low)};
}

double real_atan(double x)
{
    const double size = fabs(x);
    if (!(size <= 1)) {
        if (x != x)
            return x;
        const Pair arc = small_atan(1 / size);
        return copysign((HALF_PI.high - arc.high) - (arc.low - HALF_PI.low), x);
    }
    const Pair arc = small_atan(size);
    return copysign(arc.high + arc.low, x);
}

double real_atan2(double y, double x)
{
    if (x != x || y != y)
        return x + y;
    const double a = fabs(x), b = fabs(y);
    const bool   steep = b > a;
    const double ratio = a == b ? (a == 0 ? 0 : 1) : steep ? a / b : b / a;
    const Pair   arc   = small_atan(ratio);
    /* The arc from the nearest half axis: that of x where it is positive, where it is negative, or that of y. */
    const double turns = steep ? 1 : signbit(x) ? 2 : 0;
    const bool   back  = steep != (bool)signbit(x) && turns > 0;
    const Pair   from  = {turns * HALF_PI.high, turns * HALF_PI.low};
    const double size  = turns == 0 ? arc.high + arc.low
                         : back     ? (from.high - arc.high) - (arc.low - from.low)
                                    : (from.high + arc.high) + (arc.low + from.low);
    return copysign(size, y);
}

/* Returns sqrt((1 - x) (1 + x)). */
static double other_side(double x) { return sqrt((1 - x) * (1 + x)); }

double real_asin(double x) { return fabs(x) <= 1 ? real_atan2(x, other_side(x)) : (x - x) / 0.0; }

double real_acos(double x)
{
    return fabs(x) <= 1 ? 2 * real_atan2(sqrt(1 - x), sqrt(1 + x)) : (x - x) / 0.0;
}
