/* mesh_bounds.c: what proofs of meshes take second derivatives to permit, against trying many. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "mesh/proof/smooth.h"

enum { TIMES = 300, STEPS = 60 };

static double between(double low, double high)
{
    static uint64_t state = 1;
    state                 = state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(state >> 11) * 0x1p-53;
}

/* The most of three points, against many weights: it is never less, and hardly more. */
static void most_of_three_points_is_right(void **context)
{
    (void)context;
    for (int i = 0; i < TIMES; i++) {
        double p[3][2], q[3], most = 0;
        for (int k = 0; k < 6; k++)
            p[k / 2][k % 2] = between(-1, 1);
        for (int k = 0; k < 3; k++) {
            double x = p[k][0] - p[(k + 1) % 3][0], y = p[k][1] - p[(k + 1) % 3][1];
            q[k] = x * x + y * y;
        }
        for (int a = 0; a <= STEPS; a++)
            for (int b = 0; a + b <= STEPS; b++) {
                int c = STEPS - a - b;
                most  = fmax(most, (a * b * q[0] + b * c * q[1] + c * a * q[2]) / (STEPS * STEPS));
            }
        double bound = smooth_max_of_three(q[0], q[1], q[2]);
        assert_true(bound >= most * (1 - 1e-12) && bound <= 1.01 * most);
    }
}

/* No second derivatives in the ranges permit more than the forms do. */
static void forms_hold(void **context)
{
    (void)context;
    for (int i = 0; i < TIMES; i++) {
        LaneHessian hessian = {.known = true};
        double      above[6], below[6], nearest = INFINITY;
        for (int k = 0; k < 6; k++) {
            double middle = between(-1, 1), rest = between(0, 0.5);
            hessian.by[k] = (Range){middle - rest, middle + rest};
        }
        smooth_forms(&hessian, above, below);
        for (int k = 0; k < 200; k++) {
            double d[3] = {between(-1, 1), between(-1, 1), between(-1, 1)}, h[6], zero[3] = {0};
            for (int j = 0; j < 6; j++)
                h[j] = k % 2 ? hessian.by[j].low : hessian.by[j].high;
            double bend = h[0] * d[0] * d[0] + h[1] * d[1] * d[1] + h[2] * d[2] * d[2] +
                          2 * (h[3] * d[1] * d[2] + h[4] * d[0] * d[2] + h[5] * d[0] * d[1]);
            double up = smooth_bend(above, d, zero), down = smooth_bend(below, d, zero);
            assert_true(bend <= up + 1e-12 && -bend <= down + 1e-12);
            nearest = fmin(nearest, fmin(up - bend, down + bend));
        }
        assert_true(nearest < 0.5);
    }
}

/* A quadratic function, and what is known of it. */
typedef struct Quadratic {
    double     constant, gradient[3], second[6];
    SmoothCell cell;
} Quadratic;

static double value_of(const Quadratic *f, const double p[3])
{
    const double *h = f->second;
    return f->constant + f->gradient[0] * p[0] + f->gradient[1] * p[1] + f->gradient[2] * p[2] +
           0.5 * (h[0] * p[0] * p[0] + h[1] * p[1] * p[1] + h[2] * p[2] * p[2]) +
           h[3] * p[1] * p[2] + h[4] * p[0] * p[2] + h[5] * p[0] * p[1];
}

static Quadratic random_quadratic(void)
{
    Quadratic   f       = {.constant = between(-0.3, 0.3)};
    LaneHessian hessian = {.known = true};
    double      rest    = between(0, 0.02);
    for (int k = 0; k < 3; k++)
        f.gradient[k] = between(-1, 1);
    for (int k = 0; k < 6; k++) {
        f.second[k]   = between(-2, 2);
        hessian.by[k] = (Range){f.second[k] - rest, f.second[k] + rest};
    }
    smooth_forms(&hessian, f.cell.above, f.cell.below);
    return f;
}

/* Tells whether the value times the sign stays above a level on the way to a corner that is so. */
static bool sees_a_corner(const Quadratic *f, const double (*corners)[3], const double p[3],
                          double sign, double level)
{
    for (int i = 0; i < 4; i++) {
        bool clear = true;
        for (int k = 0; clear && k <= STEPS; k++) {
            double at[3], share = (double)k / STEPS;
            for (int j = 0; j < 3; j++)
                at[j] = p[j] + share * (corners[i][j] - p[j]);
            clear = sign * value_of(f, at) > level - 1e-9;
        }
        if (clear)
            return true;
    }
    return false;
}

/* What is beyond a level sees a corner, and what is not often sees none. */
static void levels_hold(void **context)
{
    enum { TRIALS = 20000, POINTS = 60 };
    size_t beyond = 0, hidden = 0;
    (void)context;
    for (int i = 0; i < TRIALS; i++) {
        Quadratic f = random_quadratic();
        double    corners[4][3], values[4], most = between(0, 0.05), sign = i % 2 ? 1 : -1;
        for (int k = 0; k < 12; k++)
            corners[k / 3][k % 3] = between(-0.5, 0.5);
        for (int k = 0; k < 4; k++)
            values[k] = value_of(&f, corners[k]);
        double level = smooth_level(&f.cell, (const double(*)[3])corners, values, sign > 0, most);
        assert_true(level >= most);
        for (int k = 0; level < INFINITY && k < POINTS; k++) {
            double p[3] = {0, 0, 0}, weights[4], sum = 0;
            for (int j = 0; j < 4; j++)
                sum += weights[j] = -log(between(1e-9, 1));
            for (int j = 0; j < 12; j++)
                p[j % 3] += weights[j / 3] / sum * corners[j / 3][j % 3];
            double value = sign * value_of(&f, p);
            if (value <= most)
                continue;
            bool sees = sees_a_corner(&f, (const double(*)[3])corners, p, sign, most);
            assert_true(sees || value <= level);
            beyond += value > level;
            hidden += !sees;
        }
    }
    print_message("# %zu points beyond levels, %zu that see no corner\n", beyond, hidden);
    assert_true(beyond > 100000 && hidden > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(most_of_three_points_is_right),
        cmocka_unit_test(forms_hold),
        cmocka_unit_test(levels_hold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
