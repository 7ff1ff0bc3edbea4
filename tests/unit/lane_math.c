/*
 * lane_math.c: functions of lanes in single precision are near those of the C library in double precision.
 *
 * Errors are counted in units in the last place of the larger of the result and 1, or of the result alone.  A constant that
 * is off by a thousandth must be seen.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <cmocka.h>

#include "compiler/graph/lanes/lane_math.h"
#include "tests/support/random.h"

enum { TRIALS = 20000 };
static const double UNIT = 0x1p-23;

typedef struct Function {
    const char *name;
    float (*single)(float a);
    double (*exact)(double a);
    double low, high, units;
    bool   relative;
} Function;

static double unit_asin(double a) { return asin(a); }
static float  wrong_sin(float a) { return lane_sin(a * 1.001f); }

static const Function functions[] = {
    {"sin", lane_sin, sin, -100, 100, 3, false},
    {"cos", lane_cos, cos, -100, 100, 3, false},
    {"tan", lane_tan, tan, -1.5, 1.5, 8, true},
    {"asin", lane_asin, unit_asin, -1, 1, 4, true},
    {"acos", lane_acos, acos, -1, 1, 4, false},
    {"atan", lane_atan, atan, -20, 20, 4, true},
    {"exp", lane_exp, exp, -80, 80, 4, true},
    {"exp2", lane_exp2, exp2, -120, 120, 4, true},
    {"log", lane_log, log, 1e-30, 1e3, 4, false},
    {"log, small", lane_log, log, 0.8, 1.2, 4, true},
    {"log2", lane_log2, log2, 1e-30, 1e3, 4, false},
    {"log1p", lane_log1p, log1p, 0, 1, 3, false},
    {"sinh", lane_sinh, sinh, -30, 30, 8, true},
    {"cosh", lane_cosh, cosh, -30, 30, 8, true},
    {"tanh", lane_tanh, tanh, -10, 10, 5, true},
};

/* Returns the largest error, in units. */
static double largest_error(const Function *f)
{
    Random chance = {7};
    double most   = 0;
    for (int i = 0; i < TRIALS; i++) {
        const float  a     = (float)random_between(&chance, f->low, f->high);
        const double exact = f->exact((double)a), found = (double)f->single(a);
        const double scale = f->relative ? fabs(exact) : fmax(fabs(exact), 1);
        const double error = fabs(found - exact) / (scale * UNIT + 1e-300);
        most               = error > most ? error : most;
    }
    return most;
}

static void functions_are_near(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) {
        const double error = largest_error(&functions[i]);
        if (!(error <= functions[i].units))
            fail_msg("%s is wrong by %.1f units", functions[i].name, error);
    }
    Function wrong = functions[0];
    wrong.single   = wrong_sin;
    assert_true(largest_error(&wrong) > wrong.units);
}

static void functions_of_two_are_near(void **state)
{
    Random chance = {8};
    (void)state;
    for (int i = 0; i < TRIALS; i++) {
        const float a      = (float)random_between(&chance, -3, 3),
                    b      = (float)random_between(&chance, -3, 3);
        const double angle = atan2((double)a, (double)b), power = pow(fabs((double)a), (double)b);
        assert_true(fabs((double)lane_atan2(a, b) - angle) < 4 * UNIT * 3);
        assert_true(fabs((double)lane_pow(fabsf(a), b) - power) < 40 * UNIT * power);
        assert_true(fabs((double)lane_hypot(a, b) - hypot((double)a, (double)b)) < 8 * UNIT);
    }
}

static void ends_of_ranges(void **state)
{
    (void)state;
    assert_true(lane_log(0) == -HUGE_VALF && isnan(lane_log(-1)) &&
                lane_log(HUGE_VALF) == HUGE_VALF);
    assert_true(lane_exp(200) == HUGE_VALF && lane_exp(-200) == 0 && lane_exp(0) == 1);
    assert_true(lane_exp2(3) == 8 && lane_log2(8) == 3);
    assert_true(lane_pow(0, 0) == 1 && lane_pow(0, 2) == 0 && lane_pow(0, -1) == HUGE_VALF);
    assert_true(fabs((double)lane_pow(-2, 3) + 8) < 1e-5 && isnan(lane_pow(-2, 0.5f)));
    assert_true(lane_atan2(0, 0) == 0 && lane_atan2(0, -1) > 3.1415f && lane_atan2(-1, 0) < -1.57f);
    assert_true(isnan(lane_sin(NAN)) && isnan(lane_exp(NAN)) && isnan(lane_log(NAN)));
    assert_true(lane_smoothstep(0, 1, 2) == 1 && lane_smoothstep(0, 1, -2) == 0 &&
                lane_smoothstep(1, 1, 1) == 1);
    assert_true(lane_mod(-1, 3) == 2 && lane_sign(-2) == -1 && lane_unit(2) == 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(functions_are_near),
                                       cmocka_unit_test(functions_of_two_are_near),
                                       cmocka_unit_test(ends_of_ranges)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
