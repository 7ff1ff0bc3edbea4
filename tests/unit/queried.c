/*
 * queried.c: a scene that questions are put to through the C interface.
 */
#include "tests/unit/queried.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"

Scene scene_of(const char *text)
{
    Scene s;
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &s.scene), KRS_OK);
    assert_int_equal(krs_state_new(s.scene, &s.state), KRS_OK);
    return s;
}

void scene_close(Scene s)
{
    krs_state_free(s.state);
    krs_scene_free(s.scene);
}

Random chance = {2024};

double uniform(double low, double high) { return random_between(&chance, low, high); }

double length3(const double v[3]) { return hypot(hypot(v[0], v[1]), v[2]); }

double apart(const double a[3], const double b[3])
{
    double v[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return length3(v);
}

KrsHit cast(KrsState *state, const double origin[3], const double direction[3], double farthest,
            double tolerance)
{
    KrsHit hit;
    double o[1][3], d[1][3];
    memcpy(o, origin, sizeof o);
    memcpy(d, direction, sizeof d);
    assert_int_equal(krs_raycast(state, (const double(*)[3])o, (const double(*)[3])d, 1, farthest,
                                 tolerance, &hit),
                     KRS_OK);
    return hit;
}
