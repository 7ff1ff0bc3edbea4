/*
 * schedules.c: how rays are dealt out to the device is not seen: schedules, crops, bands and slices
 * do not change a bit of any plane.  All of it under the validation layers.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/unit/traced_scenes.h"

static void schedules_are_not_seen(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (const Scene *scene = traced_scenes; scene < traced_scenes + SCENES; scene++)
        for (unsigned variant = 0; variant < 2 * KRS_TRACE_COUNT; variant++) {
            if (is_spared(scene, variant / 2))
                continue;
            /* Automatic relaxation with several rays a pixel, too. */
            KrsRenderOptions options = {.width            = SMALL_WIDTH,
                                        .height           = SMALL_HEIGHT,
                                        .methods.trace    = variant / 2,
                                        .methods.no_beams = variant % 2,
                                        .samples          = variant / 2 == KRS_TRACE_AUTO ? 4 : 1,
                                        .methods.schedule = KRS_SCHEDULE_PIXEL};
            KrsPicture      *whole   = render_scene(scene, options);
            /* The default is one of the others, and one that is repeated is the same: once each. */
            KrsSchedule first = variant == 0 ? KRS_SCHEDULE_DEFAULT : KRS_SCHEDULE_REFILL;
            for (KrsSchedule i = first; i < KRS_SCHEDULE_COUNT; i++) {
                options.methods.schedule = i;
                wrong += !is_part_of(scene, whole, render_scene(scene, options), words(&options));
            }
            krs_picture_free(whole);
        }
    assert_int_equal(wrong, 0);
}

static void crops_are_not_seen(void **state)
{
    (void)state;
    static const KrsWindow crops[] = {
        {33, 17, 41, 30}, {1, 2, 7, 5}, {101, 61, 59, 39}, {0, 99, 160, 1}, {159, 0, 1, 100}};
    size_t wrong = 0;
    for (const Scene *scene = traced_scenes; scene < traced_scenes + SCENES; scene++)
        for (KrsSchedule schedule = 1; schedule < KRS_SCHEDULE_COUNT; schedule++) {
            KrsRenderOptions options = {.methods.schedule = schedule, .samples = 4};
            KrsPicture      *whole   = render_scene(scene, options);
            for (size_t i = 0; i < sizeof crops / sizeof crops[0]; i++) {
                options.crop = crops[i];
                wrong += !is_part_of(scene, whole, render_scene(scene, options), words(&options));
            }
            krs_picture_free(whole);
        }
    assert_int_equal(wrong, 0);
}

static void slices_are_not_seen(void **state)
{
    (void)state;
    static const struct {
        uint32_t  steps_at_once;
        double    slice_ms;
        KrsWindow crop; /* the shortest slices take long */
    } slices[] = {{3, 1e6, {0}}, {512, 1e6, {0}}, {8192, 1e6, {0}}, {512, 1e-3, {30, 20, 40, 40}}};
    size_t wrong = 0;
    for (const Scene *scene = traced_scenes; scene < traced_scenes + SCENES; scene++)
        for (KrsSchedule schedule = 1; schedule < KRS_SCHEDULE_COUNT; schedule++) {
            KrsRenderOptions options = {.width            = SMALL_WIDTH,
                                        .height           = SMALL_HEIGHT,
                                        .methods.schedule = schedule,
                                        .samples          = 2};
            KrsPicture      *whole   = render_scene(scene, options);
            for (size_t i = 0; i < sizeof slices / sizeof slices[0]; i++) {
                options.methods.steps_at_once = slices[i].steps_at_once;
                options.slice_ms              = slices[i].slice_ms;
                options.crop                  = slices[i].crop;
                wrong += !is_part_of(scene, whole, render_scene(scene, options), words(&options));
            }
            krs_picture_free(whole);
        }
    assert_int_equal(wrong, 0);
}

/* Each slice as short as can be, and each ray three steps at a time. */
static void the_shortest_slices_are_not_seen(void **state)
{
    (void)state;
    const Scene *scene = &traced_scenes[PART];
    size_t       wrong = 0;
    for (KrsSchedule schedule = 1; schedule < KRS_SCHEDULE_COUNT; schedule++) {
        KrsRenderOptions options = {
            .methods.schedule = schedule, .methods.steps_at_once = 3, .slice_ms = 1e-3};
        KrsPicture *whole = render_scene(scene, (KrsRenderOptions){.methods.schedule = schedule});
        options.crop      = (KrsWindow){30, 20, 100, 60};
        wrong += !is_part_of(scene, whole, render_scene(scene, options), words(&options));
        krs_picture_free(whole);
    }
    assert_int_equal(wrong, 0);
}

/* A picture too large for one band, and parts of it that are in other bands when alone. */
static void bands_are_not_seen(void **state)
{
    (void)state;
    static const KrsWindow crops[] = {
        {0, 243, 1000, 30}, {3, 500, 900, 9}, {0, 599, 1000, 1}, {490, 0, 13, 600}};
    const Scene *scene = &traced_scenes[LANDSCAPE];
    size_t       wrong = 0;
    for (KrsSchedule schedule = 1; schedule < KRS_SCHEDULE_COUNT; schedule++) {
        KrsRenderOptions options = {.width = 1000, .height = 600, .methods.schedule = schedule};
        KrsPicture      *whole   = render_scene(scene, options);
        for (size_t i = 0; i < sizeof crops / sizeof crops[0]; i++) {
            options.crop = crops[i];
            wrong += !is_part_of(scene, whole, render_scene(scene, options), words(&options));
        }
        krs_picture_free(whole);
    }
    assert_int_equal(wrong, 0);
}

/* lavapipe ends the loops of a dispatch silently when they have had 65,535 turns together; those
   within a distance are a hundred and more for each of a ray's steps. */
static void loops_within_distances_count(void **state)
{
    (void)state;
    Scene scene = {.name = "64 iterations",
                   .text = "camera { eye: [0, 0, -6], projection: \"orthographic\", height: 2.6 }"
                           "show julia(c: [-0.083, 0, -0.83, -0.025], power: 2, iterations: 64);"};
    assert_int_equal(open_scene(&scene), KRS_OK);
    KrsRenderOptions options = {
        .width = 240, .height = 136, .methods.schedule = KRS_SCHEDULE_PIXEL};
    KrsPicture *whole        = render_scene(&scene, options);
    options.methods.schedule = KRS_SCHEDULE_REFILL;
    assert_true(is_part_of(&scene, whole, render_scene(&scene, options), words(&options)));
    krs_picture_free(whole);
    close_scene(&scene);
}

/* Lanes take more pixels each of a large picture.  Those whose normal needs more taps at an edge fall behind,
   so lanes are at different pixels of their lists. */
static void pixels_of_a_lane_are_not_seen(void **state)
{
    (void)state;
    const Scene     *scene   = &traced_scenes[INSIDE];
    KrsRenderOptions options = {.width = 1000, .height = 600};
    KrsPicture      *whole   = render_scene(scene, options);
    double           covered = 0;
    for (size_t i = 0; i < (size_t)whole->width * whole->height; i++)
        covered += whole->color[4 * i + 3];
    assert_true(covered > 2 * 64 * 8 * 64); /* else each has as few as in the crop */
    options.crop = (KrsWindow){100, 50, 250, 110};
    assert_true(is_part_of(scene, whole, render_scene(scene, options), words(&options)));
    krs_picture_free(whole);
}

/* The comparison of planes sees a single bit. */
static void a_flipped_bit_is_found(void **state)
{
    (void)state;
    const Scene *scene = &traced_scenes[GRID];
    KrsPicture  *whole = render_scene(scene, (KrsRenderOptions){0});
    KrsWindow    crop  = {40, 30, 20, 20};
    KrsPicture  *part  = render_scene(scene, (KrsRenderOptions){.crop = crop});
    part->steps[20 * 20 - 1] ^= 1;
    assert_false(is_part_of(scene, whole, part, "a planted fault"));
    krs_picture_free(whole);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(schedules_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(crops_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(slices_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(the_shortest_slices_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(bands_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(loops_within_distances_count, hear_layers),
        cmocka_unit_test_teardown(pixels_of_a_lane_are_not_seen, hear_layers),
        cmocka_unit_test_teardown(a_flipped_bit_is_found, hear_layers),
    };
    spirv_start(); /* held for all, so that no renderer starts the shader compiler anew */
    int failed = cmocka_run_group_tests_name("schedules", tests, open_scenes, close_scenes);
    spirv_stop();
    return failed;
}
