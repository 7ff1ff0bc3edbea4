/*
 * instance_ends.c: shaders leave the lists of exponential blends early.  The oracle is the definition, in double
 * precision over all parts.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "compiler/graph/instance_table.h"
#include "compiler/scene/program.h"
#include "krs/vulkan.h"
#include "tests/support/device.h"
#include "tests/support/random.h"

enum { BALLS = 300, POINTS = 20000, LONGEST = 100 * BALLS };

/* Coordinates are up to 2. */
static const double RADIUS = 0.25, ROUNDED = 3e-6, ALLOWED = 1e-4;
/* What sums lack near the surface, where the sum of what is looked at decides, as a part of what the whole sum would. */
static const double LACKS = 1.15;

static double places[BALLS][3];
static float  points[POINTS][3], found[POINTS];
static Random randomness = {11};

static void write_scene(char *text, double width)
{
    char *end = text + sprintf(text, "show union([");
    for (int i = 0; i < BALLS; i++) {
        for (int k = 0; k < 3; k++)
            places[i][k] = random_between(&randomness, -2, 2);
        end += sprintf(end, "sphere(%g).move([%.17g, %.17g, %.17g]),\n", RADIUS, places[i][0],
                       places[i][1], places[i][2]);
    }
    sprintf(end, "], blend: %g, kind: \"exponential\");", width);
}

static double blended(const float point[3], double width)
{
    double distances[BALLS], least = HUGE_VAL, sum = 0;
    for (int i = 0; i < BALLS; i++) {
        const double *c = places[i];
        distances[i]    = hypot(hypot((double)point[0] - c[0], (double)point[1] - c[1]),
                                (double)point[2] - c[2]) -
                       RADIUS;
        least = fmin(least, distances[i]);
    }
    for (int i = 0; i < BALLS; i++)
        sum += exp((least - distances[i]) / width);
    return least - width * log(sum);
}

static bool some_function_ends(const Instances *instances)
{
    for (size_t i = 0; i < instances->functions.count; i++)
        if (instances->functions.items[i].ends)
            return true;
    return false;
}

/* In shaders of a scene of that width. */
static void sample(double width)
{
    static char        text[LONGEST];
    KrsRendererOptions options = {.device = tested_device()};
    KrsRenderer       *renderer;
    KrsScene          *scene;
    KrsState          *state;
    KrsRendering      *rendering;
    write_scene(text, width);
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = (float)random_between(&randomness, -2.2, 2.2);
    if (krs_renderer_new(&options, &renderer) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    assert_int_equal(krs_compile_text(text, strlen(text), "ends.krs", NULL, &scene), KRS_OK);
    assert_true(some_function_ends(scene->graph->instances));
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_rendering_new(renderer, scene, KRS_FOR_PICTURES, &rendering), KRS_OK);
    assert_int_equal(
        krs_device_distance(rendering, state, (const float(*)[3])points, POINTS, found), KRS_OK);
    krs_rendering_free(rendering);
    krs_state_free(state);
    krs_scene_free(scene);
    krs_renderer_free(renderer);
}

/* Never too large; right on the surface and within; and outside near it but for what a sum may lack. */
static void sums_end_where_nothing_counts(void **state)
{
    (void)state;
    static const double widths[] = {0.15, 0.05, 0.1};
    for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
        double width = widths[w], most = ALLOWED * width + ROUNDED;
        int    within = 0, near = 0;
        sample(width);
        for (int i = 0; i < POINTS; i++) {
            double wanted = blended(points[i], width), far = 1 - exp(-wanted / width);
            double lacks = wanted > 0 ? LACKS * width * log(1 + 0.2 * far * far) : 0;
            assert_true((double)found[i] <= wanted + most);
            if (wanted > 0.02)
                continue;
            assert_true((double)found[i] >= wanted - most - lacks);
            within += wanted < 0;
            near += fabs(wanted) < 0.02;
        }
        assert_true(within > POINTS / 20 && near > POINTS / 1000);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sums_end_where_nothing_counts)};
    return cmocka_run_group_tests_name("sums of instance groups in shaders", tests, NULL, NULL);
}
