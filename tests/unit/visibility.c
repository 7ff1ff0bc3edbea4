/*
 * visibility.c: what is warned of as out of view is hit by no ray of a picture, and what is far out of it is
 * warned of.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "krs/krs.h"
#include "tests/support/random.h"

enum { SCENES = 120, SIDE = 24 };

static const double EYE[3] = {1, 2, 8}, ASPECT = 16.0 / 9, FOV = 0.7, RADIUS = 0.5;

static void listen(void *user, const KrsDiagnostic *diagnostic)
{
    *(bool *)user = *(bool *)user || strcmp(diagnostic->code, "W0402") == 0;
}

/* Returns a camera that looks along -z, and a ball. */
static KrsScene *compile_ball(const double ball[3], const char *projection, bool *warned)
{
    char       text[512];
    KrsOptions options = {.diagnostic = listen, .user = warned};
    KrsScene  *scene   = NULL;
    *warned            = false;
    snprintf(text, sizeof text,
             "camera { eye: [%g, %g, %g], target: [%g, %g, 0], fov: %g, height: 5, "
             "projection: \"%s\" }\nimage { size: [1600, 900] }\n"
             "show sphere(%g).move([%.17g, %.17g, %.17g]);\n",
             EYE[0], EYE[1], EYE[2], EYE[0], EYE[1], FOV, projection, RADIUS, ball[0], ball[1],
             ball[2]);
    assert_int_equal(krs_compile_text(text, strlen(text), "ball.krs", &options, &scene), KRS_OK);
    return scene;
}

/* Tells whether a ray of a picture with SIDE x SIDE pixels hits the ball. */
static bool is_hit(const KrsScene *scene, bool flat)
{
    KrsState *state;
    bool      any = false;
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    for (int i = 0; i < SIDE * SIDE; i++) {
        double half        = flat ? 2.5 : tan(FOV / 2);
        double u           = ASPECT * half * (2.0 * (i % SIDE) / (SIDE - 1) - 1);
        double v           = half * (2.0 * (i / SIDE) / (SIDE - 1) - 1);
        double from[1][3]  = {{EYE[0] + flat * u, EYE[1] + flat * v, EYE[2]}};
        double along[1][3] = {{flat ? 0 : u, flat ? 0 : v, -1}};
        KrsHit hit;
        assert_int_equal(krs_raycast(state, (const double(*)[3])from, (const double(*)[3])along, 1,
                                     100, 1e-4, &hit),
                         KRS_OK);
        any = any || hit.hit;
    }
    krs_state_free(state);
    return any;
}

/* How far beyond the picture's edges, or behind the eye, the middle of the ball is; negative inside. */
static double beyond(const double ball[3], bool flat)
{
    double depth = EYE[2] - ball[2], most = -depth;
    for (int k = 0; k < 2; k++) {
        double half  = (flat ? 2.5 : tan(FOV / 2)) * (k == 0 ? ASPECT : 1);
        double slant = flat ? 1 : hypot(1, half);
        double side  = fabs(ball[k] - EYE[k]) - half * (flat ? 1 : depth);
        most         = fmax(most, side / slant);
    }
    return most;
}

static void balls_out_of_view_are_warned_of(void **state)
{
    const bool flat   = *(bool *)*state;
    Random     random = {7};
    int        count  = 0;
    for (int i = 0; i < SCENES; i++) {
        double ball[3];
        bool   warned;
        random_vector(&random, 12, ball);
        for (int k = 0; k < 3; k++)
            ball[k] += EYE[k];
        KrsScene *scene = compile_ball(ball, flat ? "orthographic" : "perspective", &warned);
        if (warned)
            assert_false(is_hit(scene, flat));
        if (beyond(ball, flat) > 2 * RADIUS) /* its box is at most sqrt(3) radii deep */
            assert_true(warned);
        if (beyond(ball, flat) < RADIUS) /* it reaches into the picture */
            assert_false(warned);
        count += warned;
        krs_scene_free(scene);
    }
    assert_in_range(count, SCENES / 10, SCENES - SCENES / 20);
}

int main(void)
{
    static bool             perspective = false, orthographic = true;
    const struct CMUnitTest tests[] = {
        {"of a perspective", balls_out_of_view_are_warned_of, NULL, NULL, &perspective},
        {"of an orthographic camera", balls_out_of_view_are_warned_of, NULL, NULL, &orthographic},
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
