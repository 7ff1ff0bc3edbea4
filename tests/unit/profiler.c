/*
 * profiler.c: what parts cost is found while something else is shown, and each pixel has the colour of its part.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "live/pictures/profiler.h"
#include "tests/support/device.h"
#include "tests/support/folder.h"

enum { WIDTH = 96, HEIGHT = 64 };

/* A heavy knot at the left of the picture, a ball at the right. */
static const char scene_text[] =
    "camera { eye: [0, 0, 6], target: [0, 0, 0], fov: 40deg }\n"
    "param r = 0.7 in [0.1, 1];\n"
    "let knot = union([torus(0.7, 0.02 + 0.001 * i^2).rotate([sin(9 * i), cos(5 * i), 1], 40deg * "
    "i)\n"
    "    .twist([0, 1, 0], 10deg) for i in 0..30]).move([-1.2, 0, 0]);\n"
    "show knot | sphere(r).move([1.4, 0, 0]);\n";

static struct {
    Document *document;
    Profiler *profiler;
    View      view;
} stage;

static void nothing_is_told(void *user) { (void)user; }

static int set_up(void **context)
{
    static double            values[1][4] = {{0.8}};
    static const KrsOptions  options      = {.studio = true, .pictures = true};
    const KrsRendererOptions with         = {.device = tested_device()};
    KrsState                *state;
    if (enter_folder(context) != 0)
        return -1;
    FILE *file = fopen("scene.krs", "w");
    fputs(scene_text, file);
    fclose(file);
    stage.document = document_new("scene.krs", &options);
    if (document_read(stage.document) != KRS_OK)
        return -1;
    stage.view = (View){.version    = document_version(stage.document),
                        .values     = values,
                        .width      = WIDTH,
                        .height     = HEIGHT,
                        .samples    = 1,
                        .integrator = KRS_INTEGRATOR_PREVIEW};
    if (krs_state_new(version_scene(stage.view.version), &state) != KRS_OK ||
        krs_state_camera(state, 0, &stage.view.camera) != KRS_OK)
        return -1;
    krs_state_free(state);
    stage.profiler = profiler_new(&with, &options, "scene.krs", (SuppliedText){0}, nothing_is_told,
                                  NULL);
    return stage.profiler ? 0 : -1;
}

static int tear_down(void **context)
{
    profiler_free(stage.profiler);
    version_release(stage.view.version);
    document_free(stage.document);
    return leave_folder(context);
}

static ProfilerState wait_for_it(void)
{
    ProfilerState state = profiler_state(stage.profiler);
    for (int i = 0; i < 12000 && state.busy; i++) {
        usleep(10000);
        state = profiler_state(stage.profiler);
    }
    assert_false(state.busy);
    return state;
}

enum { SIDE = 100 };

/* Each pixel is as bright as its light, but the hue is that of the part: from dark blue (or gray, where it has no line)
   to yellow. */
static bool is_warm(const uint8_t *pixels, double x, double y)
{
    const uint8_t *pixel = &pixels[4 * ((size_t)(y * SIDE) * SIDE + (size_t)(x * SIDE))];
    return pixel[0] > pixel[2] + 20;
}

static void each_part_has_a_line_and_a_colour(void **context)
{
    (void)context;
    Costs  costs;
    double sum = 0;
    assert_true(profiler_start(stage.profiler, &stage.view));
    assert_false(profiler_start(stage.profiler, &stage.view)); /* it is busy */
    const ProfilerState state = wait_for_it();
    assert_int_equal(state.status, KRS_OK);
    assert_int_equal(state.orders, 1);
    assert_true(profiler_take(stage.profiler, &costs));
    assert_true(costs.width >= WIDTH && costs.height == costs.width * 2 / 3 && costs.count >= 2);
    for (size_t i = 0; i < costs.count; i++)
        sum += atof(costs.lines[i].words);
    assert_true(sum > 99.5 && sum < 100.5);
    assert_true(strstr(costs.lines[0].place, "scene.krs:3") ||
                strstr(costs.lines[0].place, "scene.krs:4"));
    assert_string_equal(costs.lines[costs.count - 1].place, "");
    static uint8_t pixels[4 * SIDE * SIDE];
    memset(pixels, 255, sizeof pixels);
    costs_tint(&costs, pixels, SIDE, SIDE);
    assert_false(is_warm(pixels, 0.76, 0.5));
    size_t warm = 0;
    for (double x = 0.1; x < 0.5; x += 0.01)
        for (double y = 0.2; y < 0.8; y += 0.02)
            warm += is_warm(pixels, x, y);
    assert_true(warm > 100);
    costs_free(&costs);
    assert_false(profiler_take(stage.profiler, &costs)); /* it was taken */
}

static void an_order_is_given_up(void **context)
{
    (void)context;
    Costs costs;
    assert_true(profiler_start(stage.profiler, &stage.view));
    profiler_cancel(stage.profiler);
    const ProfilerState state = wait_for_it();
    assert_int_equal(state.status, KRS_INTERRUPTED);
    assert_string_equal(state.message, "given up");
    assert_false(profiler_take(stage.profiler, &costs));
}

static void a_mistake_is_told(void **context)
{
    (void)context;
    Costs costs;
    FILE *file = fopen("scene.krs", "w");
    fputs("show spere(1);\n", file);
    fclose(file);
    assert_true(profiler_start(stage.profiler, &stage.view));
    const ProfilerState state = wait_for_it();
    assert_int_equal(state.status, KRS_BAD_SCENE);
    assert_string_equal(state.message, "the text has a mistake");
    assert_false(profiler_take(stage.profiler, &costs));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_part_has_a_line_and_a_colour),
        cmocka_unit_test(an_order_is_given_up),
        cmocka_unit_test(a_mistake_is_told),
    };
    return cmocka_run_group_tests_name("profiler", tests, set_up, tear_down);
}
