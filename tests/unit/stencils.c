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
#include <sys/types.h>
#include <cmocka.h>

typedef struct vec3 {
    float x, y, z;
} vec3;
#define vec3(x, y, z) ((vec3){(float)(x), (float)(y), (float)(z)})

#define STENCIL 1
#define TAPS forward_taps
#define stencil forward
#include "runtime/shaders/stencil.glsl"
#undef STENCIL
#undef TAPS
#undef stencil
#define STENCIL 2
#define TAPS tetrahedron_taps
#define stencil tetrahedron
#include "runtime/shaders/stencil.glsl"
#undef STENCIL
#undef TAPS
#undef stencil
#define STENCIL 3
#define TAPS octahedron_taps
#define stencil octahedron
#include "runtime/shaders/stencil.glsl"
#undef STENCIL
#undef TAPS
#undef stencil
#define STENCIL 4
#define TAPS cube_taps
#define stencil cube
#include "runtime/shaders/stencil.glsl"
#undef STENCIL
#undef TAPS
#undef stencil
#define STENCIL 5
#define TAPS icosahedron_taps
#define stencil icosahedron
#include "runtime/shaders/stencil.glsl"
#undef STENCIL
#undef TAPS
#undef stencil
#define STENCIL 6
#define TAPS dodecahedron_taps
#define stencil dodecahedron
#include "runtime/shaders/stencil.glsl"

typedef vec3 Corner(uint i);
typedef struct Stencil {
    const char *name;
    Corner     *corner;
    uint        taps, corners, neighbours; /* of a corner */
    double      edge; /* for corners on the unit sphere */
} Stencil;

static double dot(vec3 a, vec3 b) { return (double)a.x * b.x + (double)a.y * b.y + (double)a.z * b.z; }

static void corners_are_those_of_a_solid(const Stencil *s)
{
    if (s->taps != s->corners)
        fail_msg("%s: %u taps, and %u corners", s->name, s->taps, s->corners);
    for (uint i = 0; i < s->taps; i++) {
        uint neighbours = 0;
        vec3 v = s->corner(i);
        if (fabs(dot(v, v) - 1) > 1e-6)
            fail_msg("%s: corner %u has length %g", s->name, i, sqrt(dot(v, v)));
        for (uint k = 0; k < s->taps; k++) {
            double apart = sqrt(fmax(2 - 2 * dot(v, s->corner(k)), 0));
            if (k != i && apart < s->edge - 1e-4)
                fail_msg("%s: corners %u and %u are %g apart", s->name, i, k, apart);
            neighbours += fabs(apart - s->edge) < 1e-4;
        }
        if (neighbours != s->neighbours)
            fail_msg("%s: corner %u has %u neighbours", s->name, i, neighbours);
    }
}

static void squares_are_isotropic(const Stencil *s)
{
    double sum[3][3] = {{0}};
    for (uint i = 0; i < s->taps; i++) {
        vec3   v = s->corner(i);
        double c[3] = {v.x, v.y, v.z};
        for (int k = 0; k < 9; k++)
            sum[k / 3][k % 3] += c[k / 3] * c[k % 3];
    }
    for (int k = 0; k < 9; k++)
        if (fabs(sum[k / 3][k % 3] - (k / 3 == k % 3 ? s->taps / 3.0 : 0)) > 1e-5)
            fail_msg("%s: entry %d of the sum of v v^T is %g", s->name, k, sum[k / 3][k % 3]);
}

static void platonic_solids(void **state)
{
    (void)state;
    const double golden = (1 + sqrt(5)) / 2;
    const Stencil all[] = {
        {"tetrahedron", tetrahedron, tetrahedron_taps, 4, 3, sqrt(8.0 / 3)},
        {"octahedron", octahedron, octahedron_taps, 6, 4, sqrt(2)},
        {"cube", cube, cube_taps, 8, 3, 2 / sqrt(3)},
        {"icosahedron", icosahedron, icosahedron_taps, 12, 5, 2 / sqrt(1 + golden * golden)},
        {"dodecahedron", dodecahedron, dodecahedron_taps, 20, 3, 2 / (golden * sqrt(3))},
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
