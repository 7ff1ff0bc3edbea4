/*
 * exact.c: exact sums are those of doubles where doubles are exact, whatever the order and the grouping of their terms; and a
 * single term comes back as it was.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "runtime/film/exact.h"

enum { TERMS = 1000, TRIALS = 200 };

static double random_part(unsigned *state) { return (double)rand_r(state) / RAND_MAX * 2 - 1; }

/* Returns a float of a random size from 2^low to 2^high and either sign. */
static float random_float(unsigned *state, int low, int high)
{
    const int    exponent = low + rand_r(state) % (high - low);
    const double part     = random_part(state);
    return ldexpf((float)copysign(0.5 + 0.49 * fabs(part), part), exponent);
}

static Exact sum_of(const float *terms, size_t count)
{
    Exact sum = {0, 0};
    for (size_t i = 0; i < count; i++)
        sum = exact_sum(sum, exact_of(terms[i]));
    return sum;
}

static void assert_same(Exact a, Exact b)
{
    assert_true(a.low == b.low);
    assert_true(a.high == b.high);
}

static void test_terms_come_back(void **state)
{
    unsigned random = 1;
    (void)state;
    for (int i = 0; i < TERMS * TRIALS; i++) {
        const float term = random_float(&random, -50, 36);
        assert_true(exact_float(exact_of(term)) == term);
    }
    assert_true(exact_float(exact_of(0)) == 0);
    assert_true(exact_float(exact_of(1e-38F)) == 0);
    assert_true(exact_float(exact_of(INFINITY)) == 0x1p36F);
    assert_true(exact_float(exact_of(-INFINITY)) == -0x1p36F);
    assert_true(isnan(exact_float(exact_sum(exact_of(NAN), exact_of(1)))));
    assert_true(isnan(exact_float(exact_sum(exact_of(1), exact_of(NAN)))));
}

/* Multiples of 2^-12 below 2^30: a double has room for the sum of a thousand. */
static void test_sums_are_those_of_doubles(void **state)
{
    unsigned random = 2;
    (void)state;
    for (int trial = 0; trial < TRIALS; trial++) {
        float  terms[TERMS];
        double sum = 0;
        for (int i = 0; i < TERMS; i++) {
            terms[i] = ldexpf(rintf(ldexpf(random_float(&random, -10, 30), 12)), -12);
            sum += (double)terms[i];
        }
        assert_true(exact_float(sum_of(terms, TERMS)) == (float)sum);
    }
}

static void test_order_and_grouping_change_nothing(void **state)
{
    unsigned random = 3;
    (void)state;
    for (int trial = 0; trial < TRIALS; trial++) {
        float terms[TERMS];
        for (int i = 0; i < TERMS; i++)
            terms[i] = random_float(&random, -120, 40);
        const Exact  sum = sum_of(terms, TERMS);
        const size_t cut = (size_t)rand_r(&random) % TERMS;
        assert_same(sum, exact_sum(sum_of(terms, cut), sum_of(terms + cut, TERMS - cut)));
        for (size_t i = TERMS - 1; i > 0; i--) {
            const size_t k    = (size_t)rand_r(&random) % (i + 1);
            const float  term = terms[i];
            terms[i]          = terms[k];
            terms[k]          = term;
        }
        assert_same(sum, sum_of(terms, TERMS));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_terms_come_back),
        cmocka_unit_test(test_sums_are_those_of_doubles),
        cmocka_unit_test(test_order_and_grouping_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
