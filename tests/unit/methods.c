/*
 * methods.c: how rays advance is not seen.
 *
 * Every way to trace, with beams and without, must give the picture of plain sphere tracing with
 * a hundredth of a pixel of error, but for its own permitted error and for outlines.  Rays that run
 * out of steps are counted, and what is drawn of them is near a surface.  All of it under the
 * validation layers, which must have nothing to say (tests/unit/devices.c shows that they speak).
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

#include "compiler/passes/compile.h"
#include "tests/support/device.h"
#include "tests/unit/traced_scenes.h"

#define FINE_ERROR    0.01 /* of the pictures to compare with, in pixels */
#define DEFAULT_ERROR 0.25 /* krs/vulkan.h */

/* ---- Every method sees the same ---- */

/* Tells whether the picture has an outline here: around the pixel is something else, or something far
   before or behind. */
static bool is_outline(const KrsPicture *picture, int x, int y)
{
    int here = y * WIDTH + x;
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++) {
            if (i < 0 || j < 0 || i >= WIDTH || j >= HEIGHT)
                continue;
            int    there = j * WIDTH + i;
            double depth = picture->depth[here], other = picture->depth[there];
            if (picture->component[there] != picture->component[here] ||
                (picture->component[here] && fabs(other - depth) > 0.05 * depth))
                return true;
        }
    return false;
}

/* Returns the distance between what the ray of a pixel meets in two pictures, in widths of a pixel
   there; HUGE_VAL where only one of them shows something. */
static double apart(const Scene *scene, const KrsPicture *a, const KrsPicture *b, int k)
{
    if (a->component[k] != b->component[k])
        return HUGE_VAL;
    if (a->component[k] == 0)
        return 0;
    double half = tan(scene->fov / 2), pixel = 2 * half / HEIGHT * b->depth[k];
    double u = (2 * (k % WIDTH + 0.5) - WIDTH) / HEIGHT * half;
    double v = (1 - 2 * (k / WIDTH + 0.5) / HEIGHT) * half;
    return fabs((double)a->depth[k] - b->depth[k]) * sqrt(1 + u * u + v * v) / pixel;
}

/* Compares with the fine picture; what differs must be on outlines, and little. */
static bool agrees(const Scene *scene, const KrsPicture *fine, KrsRenderOptions options)
{
    KrsPicture *picture  = render_scene(scene, options);
    double      most     = DEFAULT_ERROR + FINE_ERROR;
    int         outlines = 0, plain = 0, surface = 0;
    for (int k = 0; k < PIXELS; k++) {
        surface += fine->component[k] != 0;
        if (apart(scene, picture, fine, k) <= most)
            continue;
        if (is_outline(fine, k % WIDTH, k / WIDTH))
            outlines++;
        else
            plain++;
    }
    krs_picture_free(picture);
    print_message("# %s, %s: %d pixels differ at outlines (%.2f %%), %d elsewhere\n", scene->name,
                  words(&options), outlines, 100.0 * outlines / PIXELS, plain);
    assert_true(surface > PIXELS / 5);
    return plain == 0 && outlines * 200 < PIXELS;
}

static void methods_agree(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (const Scene *scene = traced_scenes; scene < traced_scenes + SCENES; scene++) {
        KrsPicture *fine = render_scene(scene, (KrsRenderOptions){.methods.trace = KRS_TRACE_PLAIN,
                                                                  .methods.no_beams = true,
                                                                  .error            = FINE_ERROR});
        for (KrsTrace trace = 0; trace < KRS_TRACE_COUNT; trace++)
            for (int beams = 0; beams < 2 && !is_spared(scene, trace); beams++)
                wrong += !agrees(
                    scene, fine,
                    (KrsRenderOptions){.methods.trace = trace, .methods.no_beams = !beams});
        krs_picture_free(fine);
    }
    assert_int_equal(wrong, 0);
}

/* The comparison above can fail: it sees half a pixel. */
static void half_a_pixel_is_found(void **state)
{
    (void)state;
    const Scene *scene  = &traced_scenes[GRID];
    KrsPicture  *fine   = render_scene(scene, (KrsRenderOptions){.error = FINE_ERROR});
    KrsPicture  *nearer = render_scene(scene, (KrsRenderOptions){.error = FINE_ERROR});
    int          differ = 0;
    for (int k = 0; k < PIXELS; k++) /* as a coarse stop would leave it */
        nearer->depth[k] *= (float)(1 - tan(scene->fov / 2) / HEIGHT);
    for (int k = 0; k < PIXELS; k++)
        differ += apart(scene, nearer, fine, k) > DEFAULT_ERROR + FINE_ERROR;
    assert_true(differ > PIXELS / 5);
    krs_picture_free(fine);
    krs_picture_free(nearer);
}

/* ---- Rays that run out of steps ---- */

enum { FEW_STEPS = 8 };

/* Tells whether rays have run out, and what is seen all the same is what is there: a hit is one of rays
   that have all their steps, and at the same depth to a pixel's width. */
static bool ends_are_hits(const Scene *scene, const KrsPicture *full, const KrsPicture *picture,
                          const char *what)
{
    unsigned long long unresolved = picture->stats.unresolved;
    size_t             drawn = 0, invented = 0;
    for (int k = 0; k < SMALL_WIDTH * SMALL_HEIGHT; k++)
        if (picture->component[k] != 0) {
            double pixel = 2 * tan(scene->fov / 2) / picture->height * full->depth[k];
            drawn++;
            invented += full->component[k] == 0 ||
                        !(fabs(picture->depth[k] - full->depth[k]) <= pixel);
        }
    if (invented > 0 || unresolved == 0)
        print_message("# %s, %s: %llu rays ran out, %zu drawn, %zu of them where nothing is\n",
                      scene->name, what, unresolved, drawn, invented);
    return unresolved > 0 && invented == 0;
}

static void rays_that_run_out_show_nothing(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (const Scene *scene = traced_scenes; scene < traced_scenes + SCENES; scene++)
        for (unsigned variant = 0; variant < 2 * KRS_TRACE_COUNT; variant++) {
            if (is_spared(scene, variant / 2))
                continue;
            KrsRenderOptions options  = {.width            = SMALL_WIDTH,
                                         .height           = SMALL_HEIGHT,
                                         .methods.trace    = variant / 2,
                                         .methods.no_beams = variant % 2,
                                         .methods.schedule = KRS_SCHEDULE_PIXEL};
            KrsPicture      *full     = render_scene(scene, options);
            options.methods.max_steps = FEW_STEPS;
            KrsPicture *whole         = render_scene(scene, options);
            wrong += !ends_are_hits(scene, full, whole, words(&options));
            for (KrsSchedule i = KRS_SCHEDULE_REFILL; i < KRS_SCHEDULE_COUNT; i++) {
                options.methods.schedule = i;
                KrsPicture *picture      = render_scene(scene, options);
                wrong += picture->stats.unresolved != whole->stats.unresolved;
                wrong += !is_part_of(scene, whole, picture, words(&options));
            }
            krs_picture_free(whole);
            krs_picture_free(full);
        }
    assert_int_equal(wrong, 0);
}

/* With early outs a march sees bounds of what is far for its size, and near a surface of something
   else these are small, too. */
static void rays_with_early_outs_that_run_out_show_nothing(void **state)
{
    (void)state;
    KrsRendererOptions options = {.device = tested_device(), .early_outs = KRS_EARLY_OUTS_ON};
    KrsRenderer       *early;
    size_t             wrong = 0;
    assert_int_equal(krs_renderer_new(&options, &early), KRS_OK);
    for (int i = 0; i < SCENES; i++) {
        Scene scene = traced_scenes[i];
        if (i == LANDSCAPE || i == INSIDE)
            continue; /* nothing in them is left out */
        assert_int_equal(krs_rendering_new(early, scene.scene, KRS_FOR_PICTURES, &scene.rendering),
                         KRS_OK);
        for (int k = 0; k < 2 * KRS_COMPONENTS_COUNT; k++) {
            KrsRenderOptions rendering  = {.width              = SMALL_WIDTH,
                                           .height             = SMALL_HEIGHT,
                                           .methods.no_beams   = k % 2,
                                           .methods.components = k / 2,
                                           .methods.schedule   = KRS_SCHEDULE_PIXEL};
            KrsPicture      *full       = render_scene(&scene, rendering);
            rendering.methods.max_steps = FEW_STEPS;
            KrsPicture *picture         = render_scene(&scene, rendering);
            wrong += !ends_are_hits(&scene, full, picture, words(&rendering));
            krs_picture_free(picture);
            krs_picture_free(full);
        }
        krs_rendering_free(scene.rendering);
    }
    krs_renderer_free(early);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(methods_agree, hear_layers),
        cmocka_unit_test_teardown(half_a_pixel_is_found, hear_layers),
        cmocka_unit_test_teardown(rays_that_run_out_show_nothing, hear_layers),
        cmocka_unit_test_teardown(rays_with_early_outs_that_run_out_show_nothing, hear_layers),
    };
    spirv_start(); /* held for all, so that no renderer starts the shader compiler anew */
    int failed = cmocka_run_group_tests_name("methods", tests, open_scenes, close_scenes);
    spirv_stop();
    return failed;
}
