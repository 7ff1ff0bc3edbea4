/*
 * framing.c: a camera is placed within a bounded number of operations, whatever distances cost, and
 * what is there fills its picture.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/vec.h"
#include "compiler/scene/program.h"
#include "tests/support/random.h"

enum { SCENES = 6, MAX_TEXT = 1 << 16, PLACES = 2000 };

/* What framing.c may take, and the step that is under way then. */
static const double MAX_OPERATIONS = 4e7, OF_LAST_STEP = 2e6;

/* A solid of `corners` spikes around the y axis, which is twisted: its tips are on helices. */
typedef struct Screw {
    int    corners;
    double radius, height, turn; /* in all, in radians */
} Screw;

static size_t write_screw(const Screw *screw, char *text)
{
    size_t end = (size_t)sprintf(text, "let spikes = union([");
    for (int i = 0; i < screw->corners; i++) {
        double a = 2 * M_PI * i / screw->corners, wide = 0.7 * M_PI / screw->corners;
        end += (size_t)sprintf(text + end, "%spolygon([[0, 0], [%g, %g], [%g, %g], [%g, %g]])",
                               i ? ", " : "", 0.5 * screw->radius * cos(a - wide),
                               0.5 * screw->radius * sin(a - wide), screw->radius * cos(a),
                               screw->radius * sin(a), 0.5 * screw->radius * cos(a + wide),
                               0.5 * screw->radius * sin(a + wide));
    }
    /* OpenSCAD's z is up. */
    return end + (size_t)sprintf(text + end,
                                 "]);\nshow spikes.extrude(%g).twist([0, 0, 1], %g)"
                                 ".rotate([1, 0, 0], -90deg);\n",
                                 screw->height, screw->turn / screw->height);
}

/* How much of the height of a picture there is between the highest and the lowest tip, and of its width,
   half as large again, between the others; each is at most 1 where all are seen. */
static void reach_of_tips(const Screw *screw, const KrsCamera *camera, double *wide, double *tall)
{
    double ahead[3], right[3], up[3], low[2] = {HUGE_VAL, HUGE_VAL},
                                      high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int k = 0; k < 3; k++)
        ahead[k] = camera->target[k] - camera->eye[k];
    vector_normalize(ahead);
    cross3(ahead, (double[]){0, 1, 0}, right);
    vector_normalize(right);
    cross3(right, ahead, up);
    for (int i = 0; i < PLACES; i++) {
        double angle = 2 * M_PI * i / PLACES, y = screw->height * (i % 2 ? 0.5 : -0.5);
        double to[3] = {screw->radius * cos(angle) - camera->eye[0], y - camera->eye[1],
                        screw->radius * sin(angle) - camera->eye[2]};
        double scale = 1 / (dot3(to, ahead) * tan(camera->fov / 2));
        double at[2] = {dot3(to, right) * scale / 1.5, dot3(to, up) * scale};
        for (int k = 0; k < 2; k++) {
            low[k]  = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    assert_true(low[0] > -1.05 && low[1] > -1.05 && high[0] < 1.05 && high[1] < 1.05);
    *wide = 0.5 * (high[0] - low[0]);
    *tall = 0.5 * (high[1] - low[1]);
}

static void tell(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    if (diagnostic->code[0] == 'E')
        print_error("%s\n", diagnostic->message);
}

static KrsScene *compile(const char *text)
{
    KrsOptions options = {.studio = true, .diagnostic = tell};
    KrsScene  *scene;
    if (krs_compile_text(text, strlen(text), "scene.krs", &options, &scene) != KRS_OK)
        fail_msg("%s is refused", text);
    return scene;
}

/* The camera, and that placing it again finds the same with as many operations. */
static double place(const KrsScene *scene, KrsCamera *camera)
{
    KrsState *state;
    KrsCamera again;
    uint64_t  ran[2];
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    for (int i = 0; i < 2; i++) {
        uint64_t before = state->ran;
        assert_int_equal(krs_state_fit_camera(state), KRS_OK);
        assert_int_equal(krs_state_camera(state, 0, i ? &again : camera), KRS_OK);
        ran[i] = state->ran - before;
    }
    assert_true(ran[0] == ran[1]);
    assert_memory_equal(again.eye, camera->eye, sizeof again.eye);
    krs_state_free(state);
    return (double)ran[0];
}

static void costly_screws_fill_their_picture(void **state)
{
    static char text[MAX_TEXT];
    Random      random = {7};
    double      most   = 0;
    (void)state;
    for (int i = 0; i < SCENES; i++) {
        Screw     screw = {.corners = 4 + random_below(&random, 20),
                           .radius  = pow(10, random_between(&random, 0, 2)),
                           .turn    = random_between(&random, 0.5, 8)};
        KrsCamera camera;
        double    wide, tall;
        screw.height = screw.radius * random_between(&random, 1, 4);
        write_screw(&screw, text);
        KrsScene *scene = compile(text);
        double    ran   = place(scene, &camera);
        most            = fmax(most, ran);
        if (ran > MAX_OPERATIONS + OF_LAST_STEP)
            fail_msg("%d corners: placing the camera takes %g operations", screw.corners, ran);
        reach_of_tips(&screw, &camera, &wide, &tall);
        if (fmax(wide, tall) < 0.55)
            fail_msg("%d corners: only %g x %g of the picture are filled", screw.corners, wide,
                     tall);
        krs_scene_free(scene);
    }
    assert_true(most > 0.1 * MAX_OPERATIONS); /* some are costly */
}

/* Exact distances to members of an instance group that blend look at all of them. */
static void groups_take_no_more(void **state)
{
    const char *const texts[] = {
        "show union([sphere(1).move([7 * sin(i), i % 60, 0.1 * i]) for i in 0..1000], blend: 0.5);"
        "show plane([0, 1, 0], -2);",
        "show union([box([0.5, 0.2 + i % 7, 0.5]).move([3 * (i % 50), 0, i / 17]) for i in "
        "0..500]);"
        "show plane([0, 1, 0], 0);",
    };
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        KrsScene *scene = compile(texts[i]);
        KrsCamera camera;
        double    ran = place(scene, &camera);
        if (ran > MAX_OPERATIONS + OF_LAST_STEP)
            fail_msg("%s: placing the camera takes %g operations", texts[i], ran);
        krs_scene_free(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(costly_screws_fill_their_picture),
        cmocka_unit_test(groups_take_no_more),
    };
    return cmocka_run_group_tests_name("framing", tests, NULL, NULL);
}
