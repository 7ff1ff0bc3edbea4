/*
 * stencils.c: the unit vectors around a hit (stencil.glsl, which is C as well): of length 1, all
 * different, as many as the solid has corners and as far apart, and the sum of v v^T is a third
 * of their number times the identity.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "runtime/shaders/stencil.h"

typedef struct Solid {
    const char *name;
    KrsNormals  normals;
    uint        corners, neighbours; /* of a corner */
    double      edge;                /* for corners on the unit sphere */
} Solid;

static double dot(vec3 a, vec3 b)
{
    return (double)a.x * b.x + (double)a.y * b.y + (double)a.z * b.z;
}

static void corners_are_those_of_a_solid(const Solid *solid)
{
    Stencil s = find_stencil(solid->normals);
    if (s.taps != solid->corners)
        fail_msg("%s: %u taps, and %u corners", solid->name, s.taps, solid->corners);
    for (uint i = 0; i < s.taps; i++) {
        uint neighbours = 0;
        vec3 v          = s.corner(i);
        if (fabs(dot(v, v) - 1) > 1e-6)
            fail_msg("%s: corner %u has length %g", solid->name, i, sqrt(dot(v, v)));
        for (uint k = 0; k < s.taps; k++) {
            double apart = sqrt(fmax(2 - 2 * dot(v, s.corner(k)), 0));
            if (k != i && apart < solid->edge - 1e-4)
                fail_msg("%s: corners %u and %u are %g apart", solid->name, i, k, apart);
            neighbours += fabs(apart - solid->edge) < 1e-4;
        }
        if (neighbours != solid->neighbours)
            fail_msg("%s: corner %u has %u neighbours", solid->name, i, neighbours);
    }
}

static void squares_are_isotropic(const Solid *solid)
{
    Stencil s         = find_stencil(solid->normals);
    double  sum[3][3] = {{0}};
    for (uint i = 0; i < s.taps; i++) {
        vec3   v    = s.corner(i);
        double c[3] = {v.x, v.y, v.z};
        for (int k = 0; k < 9; k++)
            sum[k / 3][k % 3] += c[k / 3] * c[k % 3];
    }
    for (int k = 0; k < 9; k++)
        if (fabs(sum[k / 3][k % 3] - (k / 3 == k % 3 ? s.taps / 3.0 : 0)) > 1e-5)
            fail_msg("%s: entry %d of the sum of v v^T is %g", solid->name, k, sum[k / 3][k % 3]);
}

static void platonic_solids(void **state)
{
    (void)state;
    const double golden = (1 + sqrt(5)) / 2;
    const Solid  all[]  = {
          {"tetrahedron", KRS_NORMALS_TETRAHEDRON, 4, 3, sqrt(8.0 / 3)},
          {"octahedron", KRS_NORMALS_OCTAHEDRON, 6, 4, sqrt(2)},
          {"cube", KRS_NORMALS_CUBE, 8, 3, 2 / sqrt(3)},
          {"icosahedron", KRS_NORMALS_ICOSAHEDRON, 12, 5, 2 / sqrt(1 + golden * golden)},
          {"dodecahedron", KRS_NORMALS_DODECAHEDRON, 20, 3, 2 / (golden * sqrt(3))},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        corners_are_those_of_a_solid(&all[i]);
        squares_are_isotropic(&all[i]);
    }
}

static void steps_forward(void **state)
{
    (void)state;
    assert_int_equal(forward_taps, 4);
    for (uint i = 0; i < 4; i++) {
        vec3 v = forward(i);
        assert_true(v.x == (i == 1) && v.y == (i == 2) && v.z == (i == 3));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(platonic_solids),
        cmocka_unit_test(steps_forward),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
