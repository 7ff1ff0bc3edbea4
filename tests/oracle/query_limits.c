/*
 * query_limits.c: queries of the device at their limits: many of them, hard rays, seams between
 * solids, wrong arguments, and memory that runs out.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "runtime/tracer/query.h"
#include "tests/oracle/device_answers.h"
#include "tests/support/device.h"
#include "tests/support/renderer.h"
#include "tests/support/scarce.h"

/* Batches end within what is asked; memory does not grow with it. */
static void any_number_is_answered(void **context)
{
    static const size_t counts[] = {0, 1, 7, POINTS_AT_ONCE, POINTS_AT_ONCE + 1, MOST};
    uint64_t            held     = 0;
    (void)context;
    Scene s = scene_of("show sphere(1);", KRS_FOR_QUESTIONS);
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        size_t count = counts[c];
        for (size_t i = 0; i < count; i++) {
            double height = 2 + (double)i / MOST;
            memcpy(points[i], (double[]){0, height, 0}, sizeof *points);
            memcpy(aims[i], (double[]){0, i % 2 ? -1 : 1, 0}, sizeof *aims);
        }
        probe_device(s, count);
        for (size_t i = 0; i < count; i++)
            assert_true(fabs(found[i].distance - (points[i][1] - 1)) < 1e-6);
        cast_device(s, count, INFINITY, 0);
        for (size_t i = 0; i < count; i++) {
            assert_int_equal(found[i].hit, i % 2);
            assert_true(!found[i].hit || fabs(found[i].t - (points[i][1] - 1)) < 1e-6);
        }
        if (count == 1)
            held = renderer->gpu.memory_used;
        if (count > 1)
            assert_true(renderer->gpu.memory_used == held);
    }
    scene_close(s);
}

static void hard_rays_are_told(void **context)
{
    (void)context;
    Scene  s             = scene_of("show plane([0.1, 1, 0], 0);", KRS_FOR_QUESTIONS);
    double hard[4][2][3] = {
        {{0, 1e-3, 0}, {1, -0.1, 0}}, /* along an endless plane */
        {{0, 5, 0}, {1, -0.2, 0}},    /* hits far out */
        {{0, 5, 0}, {0, 1, 0.3}},     /* leaves for ever */
        {{0, -1, 0}, {0, 1, 0}},      /* from inside */
    };
    for (int i = 0; i < 4; i++) {
        memcpy(points[i], hard[i][0], sizeof *points);
        memcpy(aims[i], hard[i][1], sizeof *aims);
    }
    cast_device(s, 4, INFINITY, 0);
    assert_true(found[0].unresolved && !found[0].hit && found[0].t > 1);
    assert_true(found[1].hit && fabs(found[1].point[1] + 0.1 * found[1].point[0]) < 1e-4);
    assert_false(found[2].hit || found[2].unresolved);
    assert_true(found[3].hit && fabs(found[3].t - 1) < 1e-6);
    scene_close(s);

    /* Far origins are brought to the box before single precision begins. */
    s = scene_of("show sphere(1);", KRS_FOR_QUESTIONS);
    memcpy(points[0], (double[]){1e7, 0.5, 0}, sizeof *points);
    memcpy(aims[0], (double[]){-1, 0, 0}, sizeof *aims);
    cast_device(s, 1, INFINITY, 0);
    assert_true(found[0].hit && fabs(found[0].t - (1e7 - sqrt(0.75))) < 2e-6);
    scene_close(s);
}

/* Rays through a channel take steps of one length, so some have just none left where they cross the
   wall at its end, and are still looking for the place. */
static void rays_may_end_anywhere(void **context)
{
    enum { RAYS = 20000 };
    const double shortest = 300, longest = 440, tolerance = 0.1;
    size_t       hits = 0, unresolved = 0;
    (void)context;
    Scene s = scene_of("show plane([0, 1, 0], -0.02); show plane([0, -1, 0], -0.02);"
                       "show plane([-1, 0, 0], 0);",
                       KRS_FOR_QUESTIONS);
    for (int i = 0; i < RAYS; i++) {
        memcpy(points[i], (double[]){-shortest - (longest - shortest) * i / RAYS, 0, 0},
               sizeof *points);
        memcpy(aims[i], (double[]){1, 0, 0}, sizeof *aims);
    }
    cast_device(s, RAYS, INFINITY, tolerance);
    for (int i = 0; i < RAYS; i++) {
        assert_true(found[i].hit != found[i].unresolved);
        assert_true(found[i].t <= -points[i][0] + tolerance);
        assert_true(!found[i].hit || found[i].t >= -points[i][0] - tolerance);
        hits += found[i].hit;
        unresolved += found[i].unresolved;
    }
    assert_true(hits > 1000 && unresolved > 1000);
    scene_close(s);
}

/* Solids that touch are one: a ray from inside does not end at the seam between them, wherever it
   begins and however it crosses; it ends where they do, and at every gap. */
static void seams_do_not_end_rays(void **context)
{
    static const char *const touching[] = {
        "show box([1, 1, 1]); show box([1, 1, 1]).move([1, 0, 0]);",
        "show krs { kernel box([1, 1, 1]).move([0.5, 0, 0]); reflect plane([-1, 0, 0], 0); }"
        "    .move([0.5, 0, 0]);",
        "show (box([1, 1, 1]) | box([1, 1, 1]).move([1, 0, 0])).rotate([1, 2, 3], 0.7)"
        "    .rotate([1, 2, 3], -0.7);",
    };
    static const double tolerances[] = {0, 1e-4, 0.01};
    enum { COUNT = 2000 };
    (void)context;
    for (size_t run = 0; run < sizeof touching / sizeof *touching * 3; run++) {
        Scene  s         = scene_of(touching[run / 3], KRS_FOR_QUESTIONS);
        double tolerance = tolerances[run % 3];
        for (int i = 0; i < COUNT; i++)
            for (int k = 0; k < 3; k++) {
                points[i][k] = uniform(-0.45, k == 0 ? 1.45 : 0.45);
                aims[i][k]   = k == 0 ? uniform(-1, 1) : uniform(-0.3, 0.3);
            }
        cast_device(s, COUNT, 100, tolerance);
        for (int i = 0; i < COUNT; i++) {
            const double low[3] = {-0.5, -0.5, -0.5}, high[3] = {1.5, 0.5, 0.5};
            double       last = INFINITY;
            for (int k = 0; k < 3; k++)
                last = fmin(last, ((aims[i][k] > 0 ? high : low)[k] - points[i][k]) / aims[i][k]);
            assert_true(found[i].hit);
            assert_true(fabs(found[i].t - last * length3(aims[i])) <= tolerance + 2e-5);
        }
        scene_close(s);
    }
    Scene s = scene_of("show box([1, 1, 1]); show box([1, 1, 1]).move([1.00001, 0, 0]);",
                       KRS_FOR_QUESTIONS);
    memcpy(points[0], (double[]){-0.3, 0.1, 0.2}, sizeof *points);
    memcpy(aims[0], (double[]){1, 0, 0}, sizeof *aims);
    cast_device(s, 1, 100, 0);
    assert_true(found[0].hit && fabs(found[0].t - 0.8) < 1e-6);
    scene_close(s);
}

static void wrong_questions_are_refused(void **context)
{
    static const double wrong[][3] = {{NAN, 0, 0}, {0, INFINITY, 0}, {0, 0, 1e19}};
    const double        good[1][3] = {{0, 0, 5}}, down[1][3] = {{0, 0, -1}}, still[1][3] = {{0}};
    (void)context;
    Scene         s = scene_of("show sphere(1);", KRS_FOR_QUESTIONS);
    KrsRendering *r = s.rendering;
    KrsState     *f = s.state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(krs_device_probe(r, f, &wrong[i], 1, found), KRS_BAD_ARGUMENT);
        assert_true(strlen(krs_renderer_message(renderer)) > 0);
        assert_int_equal(krs_device_raycast(r, f, &wrong[i], down, 1, 9, 0, found),
                         KRS_BAD_ARGUMENT);
    }
    assert_int_equal(krs_device_raycast(r, f, good, still, 1, 9, 0, found), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_device_raycast(r, f, good, down, 1, -1, 0, found), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_device_raycast(r, f, good, down, 1, 9, NAN, found), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_device_raycast(r, f, good, down, 1, 9, 0, found), KRS_OK);
    assert_string_equal(krs_renderer_message(renderer), "");
    assert_true(found[0].hit && fabs(found[0].t - 4) < 1e-6);
    scene_close(s);
}

/* Where rays end is told by indices that the device writes: they are not followed blindly. */
static void wrong_answers_are_refused(void **context)
{
    (void)context;
    const RayHitBlock good[4] = {{1, STATE_HIT, 1, 9},
                                 {9, STATE_MISS, 77, 2},
                                 {2, STATE_HIT, 0, 8},
                                 {3, STATE_MARCHING, 2, 99}};
    assert_true(ray_hits_are_valid(good, 4, 3));
    assert_true(ray_hits_are_valid(good, 0, 0));
    assert_false(ray_hits_are_valid(good, 4, 2)); /* the last ray has no place */
    assert_false(ray_hits_are_valid(good, 4, 5)); /* more places than rays */
    const RayHitBlock faults[] = {{1, STATE_HIT, 3, 9},
                                  {1, STATE_HIT, UINT32_MAX, 9},
                                  {1, STATE_MARCHING, 3, 9},
                                  {1, STATE_MISS + 1, 0, 9}};
    for (size_t fault = 0; fault < sizeof faults / sizeof *faults; fault++)
        for (int at = 0; at < 4; at++) {
            RayHitBlock ray_hits[4];
            memcpy(ray_hits, good, sizeof ray_hits);
            ray_hits[at] = faults[fault];
            assert_false(ray_hits_are_valid(ray_hits, 4, 3));
        }
}

/* Memory that runs out at any allocation of ours ends the call with its status. */
static void memory_may_run_out(void **context)
{
    Scarce             scarce     = {0};
    KrsRendererOptions options    = {.device    = tested_device(),
                                     .allocator = scarce_allocator(&scarce)};
    KrsRenderer       *shared     = renderer, *own;
    const double       zone[1][4] = {{0, 0, 1, 0.5}};
    (void)context;
    assert_int_equal(krs_renderer_new(&options, &own), KRS_OK);
    renderer        = own;
    size_t failures = 0;
    for (int64_t failing = 1; failing <= 200; failing++) {
        Scene s = scene_of("show sphere(1);", KRS_FOR_QUESTIONS);
        if (failing % 2)
            assert_int_equal(krs_state_set_zones(s.state, zone, 1), KRS_OK);
        memcpy(points[0], (double[]){0, 0, 5}, sizeof *points);
        memcpy(aims[0], (double[]){0, 0, -1}, sizeof *aims);
        scarce.failing    = scarce.made + (failing + 1) / 2;
        KrsStatus status  = krs_device_raycast(s.rendering, s.state, POINTS, AIMS, 1, 9, 0, found);
        bool      reached = scarce.made >= scarce.failing;
        scarce.failing    = 0;
        assert_int_equal(status, reached ? KRS_OUT_OF_MEMORY : KRS_OK);
        failures += reached;
        /* The next call is as if nothing had been. */
        cast_device(s, 1, 9, 0);
        assert_true(found[0].hit && fabs(found[0].t - (failing % 2 ? 4.5 : 4)) < 1e-5);
        scene_close(s);
        if (!reached && failing % 2)
            break;
    }
    assert_true(failures > 2);
    krs_renderer_free(own);
    assert_int_equal(scarce.held, 0);
    renderer = shared;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_number_is_answered),      cmocka_unit_test(hard_rays_are_told),
        cmocka_unit_test(rays_may_end_anywhere),       cmocka_unit_test(seams_do_not_end_rays),
        cmocka_unit_test(wrong_questions_are_refused), cmocka_unit_test(wrong_answers_are_refused),
        cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests_name("limits of device queries", tests, renderer_open,
                                       renderer_close);
}
