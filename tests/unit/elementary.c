/*
 * Functions of numbers agree with those of the C library in more digits, have its values at limits, and give the same
 * bits whatever compiles them.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "tests/support/random.h"

enum { TRIALS = 20000 };
static const double MAX_UNITS = 3;

typedef enum Domain { ANY, UNIT, ABOVE_0, ABOVE_1, SMALL_POWERS } Domain;

typedef struct Function {
    const char *name;
    double (*own)(double);
    double (*of_c)(double);
    long double (*exact)(long double);
    Domain domain;
} Function;

#define FUNCTION(name, domain)                    \
    {                                             \
#name, real_##name, name, name##l, domain \
    }
static const Function functions[] = {
    FUNCTION(sin, ANY),           FUNCTION(cos, ANY),           FUNCTION(tan, ANY),
    FUNCTION(asin, UNIT),         FUNCTION(acos, UNIT),         FUNCTION(atan, ANY),
    FUNCTION(sinh, SMALL_POWERS), FUNCTION(cosh, SMALL_POWERS), FUNCTION(tanh, SMALL_POWERS),
    FUNCTION(exp, SMALL_POWERS),  FUNCTION(exp2, SMALL_POWERS), FUNCTION(log, ABOVE_0),
    FUNCTION(log2, ABOVE_0),      FUNCTION(log1p, ABOVE_1),     FUNCTION(cbrt, ANY),
};
enum { FUNCTIONS = sizeof functions / sizeof *functions };

typedef struct Function2 {
    const char *name;
    double (*own)(double, double);
    double (*of_c)(double, double);
    long double (*exact)(long double, long double);
    Domain domains[2];
} Function2;

#define FUNCTION2(name, first, second)                       \
    {                                                        \
#name, real_##name, name, name##l, { first, second } \
    }
static const Function2 functions2[] = {FUNCTION2(pow, ABOVE_0, ANY), FUNCTION2(atan2, ANY, ANY),
                                       FUNCTION2(hypot, ANY, ANY)};
enum { FUNCTIONS2 = sizeof functions2 / sizeof *functions2 };

/* ---- numbers ---- */

/* Of all sizes, and often near 1. */
static double any(Random *random, double exponents)
{
    const double size = random_below(random, 3) == 0
                            ? random_between(random, 0, 2)
                            : exp2(random_between(random, -exponents, exponents));
    return random_below(random, 2) == 0 ? size : -size;
}

static double from(Random *random, Domain domain)
{
    switch (domain) {
    case UNIT: return fmod(any(random, 30), 1);
    case ABOVE_0: return fabs(any(random, 1000));
    case ABOVE_1: return fmax(any(random, 30), -1 + 0x1p-40);
    case SMALL_POWERS: return any(random, 9);
    default: return any(random, 60);
    }
}

/* Returns how many units of its last place a number is from what it should be. */
static double units(double found, long double exact)
{
    const double whole = (double)exact;
    if (!isfinite(whole) || whole == 0 || fabs(whole) < 0x1p-1020)
        return found == whole || fabs(whole) < 0x1p-1020 ? 0 : HUGE_VAL;
    return (double)fabsl((long double)found - exact) /
           (nextafter(fabs(whole), HUGE_VAL) - fabs(whole));
}

static void agree(void **state)
{
    Random random = {.state = 1};
    (void)state;
    for (size_t i = 0; i < FUNCTIONS; i++)
        for (int k = 0; k < TRIALS; k++) {
            const double x   = from(&random, functions[i].domain);
            const double off = units(functions[i].own(x), functions[i].exact(x));
            if (!(off <= MAX_UNITS))
                fail_msg("%s(%a) is %a, %g units off", functions[i].name, x, functions[i].own(x),
                         off);
        }
    for (size_t i = 0; i < FUNCTIONS2; i++)
        for (int k = 0; k < TRIALS; k++) {
            const Function2 *f = &functions2[i];
            const double     x = from(&random, f->domains[0]), y = from(&random, f->domains[1]);
            const double     off = units(f->own(x, y), f->exact(x, y));
            if (!(off <= MAX_UNITS))
                fail_msg("%s(%a, %a) is %a, %g units off", f->name, x, y, f->own(x, y), off);
        }
}

/* ---- limits ---- */

static const double limits[] = {0,        -0.0,      1,       -1,     2,
                                -2,       3,         -3,      0.5,    -0.5,
                                1.5,      1e-310,    -1e-310, 5e-324, 1e300,
                                -1e300,   709.79,    711,     -745.2, -746,
                                1024,     -1075,     -1076,   1e17,   9007199254740993.0,
                                HUGE_VAL, -HUGE_VAL, NAN};
enum { LIMITS = sizeof limits / sizeof *limits };

/* Tells whether numbers are both none, or equal with their signs; others are for `agree`. */
static bool is_same_limit(double a, double b)
{
    if (isnan(a) || isnan(b))
        return isnan(a) && isnan(b);
    if (a != 0 && b != 0 && isfinite(a) && isfinite(b))
        return true;
    return a == b && signbit(a) == signbit(b);
}

static void limits_are_those_of_c(void **state)
{
    (void)state;
    for (size_t i = 0; i < FUNCTIONS; i++)
        for (int k = 0; k < LIMITS; k++) {
            const double own = functions[i].own(limits[k]), of_c = functions[i].of_c(limits[k]);
            if (!is_same_limit(own, of_c))
                fail_msg("%s(%g) is %g, in C %g", functions[i].name, limits[k], own, of_c);
        }
    for (size_t i = 0; i < FUNCTIONS2; i++)
        for (int k = 0; k < LIMITS * LIMITS; k++) {
            const double x = limits[k / LIMITS], y = limits[k % LIMITS];
            const double own = functions2[i].own(x, y), of_c = functions2[i].of_c(x, y);
            if (!is_same_limit(own, of_c))
                fail_msg("%s(%g, %g) is %g, in C %g", functions2[i].name, x, y, own, of_c);
        }
}

static void whole_numbers_are_exact(void **state)
{
    (void)state;
    for (int k = -1074; k < 1024; k++) {
        assert_true(real_exp2(k) == ldexp(1, k));
        assert_true(real_log2(ldexp(1, k)) == k);
    }
    for (int k = 0; k < 1000; k++) {
        assert_true(real_cbrt((double)k * k * k) == k);
        assert_true(real_pow(k, 3) == (double)k * k * k);
        assert_true(real_hypot(3 * k, 4 * k) == 5 * k);
    }
    assert_true(real_acos(-1) == M_PI && real_acos(0) == M_PI_2 && real_asin(1) == M_PI_2);
    assert_true(real_atan2(0, -1) == M_PI && 4 * real_atan(1) == M_PI);
}

/* ---- bits ---- */

static uint64_t hash_with(uint64_t hash, double number)
{
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    return (hash ^ bits) * 0x100000001b3u;
}

/* The hash is that of gcc and clang for x86-64, with all optimizations and none. */
static void bits_are_the_same(void **state)
{
    Random   random = {.state = 2};
    uint64_t hash   = 0xcbf29ce484222325u;
    (void)state;
    for (int k = 0; k < 1000; k++) {
        const double first  = random_between(&random, -1, 1),
                     second = random_between(&random, -1, 1);
        const double x      = ldexp(first, random_below(&random, 40) - 20);
        const double y      = ldexp(second, random_below(&random, 40) - 20);
        for (size_t i = 0; i < FUNCTIONS; i++) {
            const double found = functions[i].own(functions[i].domain == UNIT ? fmod(x, 1) : x);
            hash               = hash_with(hash, isnan(found) ? 0 : found);
        }
        for (size_t i = 0; i < FUNCTIONS2; i++) {
            const double found = functions2[i].own(x, y);
            hash               = hash_with(hash, isnan(found) ? 0 : found);
        }
    }
    assert_int_equal(hash, 0x9b0bead94fe2891au);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agree), cmocka_unit_test(limits_are_those_of_c),
        cmocka_unit_test(whole_numbers_are_exact), cmocka_unit_test(bits_are_the_same)};
    return cmocka_run_group_tests_name("elementary functions", tests, NULL, NULL);
}
