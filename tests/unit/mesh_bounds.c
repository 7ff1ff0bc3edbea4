/* mesh_bounds.c: what proofs of meshes take second derivatives to permit, against trying many. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "compiler/mesh/smooth.h"

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
        double bound = smooth_most_of_three(q[0], q[1], q[2]);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(most_of_three_points_is_right),
        cmocka_unit_test(forms_hold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
