/*
 * query.c: what the device answers about points and rays, with and without zones.
 *
 * Points are held against the evaluator in double precision, as in device.c.  A zone is also what
 * the language can write as a difference, and pictures of both are the same bit by bit.
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

#include "compiler/base/vec.h"
#include "compiler/passes/compile.h"
#include "runtime/tracer/handles.h"
#include "tests/oracle/device_answers.h"
#include "tests/support/renderer.h"

static const char *const scenes[] = {
    "show sphere(1); show box([1, 1, 1]).move([2, 0, 0]).rotate([0, 1, 1], 0.4);",
    "show plane([0, 1, 0], -0.5); show torus(1, 0.3).rotate([1, 0, 0], 0.5);",
    ("show difference(box([2, 2, 2]), sphere(1.25), blend: 0.1) | "
     "capsule([-2, 0, 0], [2, 0, 0], 0.2);"),
    ("show krs { kernel capsule([0, 0, 0], [0.3, 0.6, 0], 0.1); for i in 0..12 {"
     "    reflect plane(random_direction(i), 0.3 + 0.1 * i); } };"),
    ("zone { center: [0.2, 0, 1], radius: 0.7 }"
     "show krs { kernel sphere(1).move([-0.8, 0, 0]); reflect plane([1, 0, 0], 0); }"
     "    .smooth_mirrors(1);"),
    ("zone { center: [0.8, 0.3, 0.2], radius: 0.6 } zone { center: [0, 0, 1], radius: 0.4 }"
     "show sphere(1); show box([1, 1, 1]).move([1.5, 0, 0]);"),
};

static void points_agree_everywhere(void **context)
{
    (void)context;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        Scene s = scene_of(scenes[i], KRS_FOR_QUESTIONS);
        points_agree(s, 4000, 3, 64);
        scene_close(s);
    }
}

static void rays_agree_everywhere(void **context)
{
    (void)context;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        Scene s = scene_of(scenes[i], KRS_FOR_QUESTIONS);
        rays_agree(s, 1500, 3, 0, 64);
        rays_agree(s, 1500, 3, 0.01, 64);
        scene_close(s);
    }
}

/* A wire far thinner than the tolerance. */
static void thin_twigs_are_hit_as_thick_as_they_are(void **context)
{
    (void)context;
    Scene  s    = scene_of("show capsule([-5, 0, 0], [5, 0, 0], 0.001);"
                               "show sphere(1).move([0, 5, 0]);",
                           KRS_FOR_QUESTIONS); /* widens the box */
    size_t hits = 0;
    for (int i = 0; i < 2000; i++) {
        memcpy(points[i], (double[]){uniform(-4, 4), 0.01 * (i + 0.5) / 2000, 3}, sizeof *points);
        memcpy(aims[i], (double[]){0, 0, -1}, sizeof *aims);
    }
    cast_device(s, 2000, 10, 0.005);
    for (int i = 0; i < 2000; i++) {
        double chord = 2 * sqrt(fmax(1e-6 - points[i][1] * points[i][1], 0));
        if ((chord == 0 && points[i][1] > 0.001 + 1e-5) || chord > 0.005 / 16)
            assert_int_equal(found[i].hit, chord > 0);
        hits += found[i].hit;
    }
    assert_in_range(hits, 195, 202);
    scene_close(s);
}

/* ---- zones of the caller ---- */

static double ball_less_zones(const double point[3], const double (*zones)[4], size_t count)
{
    double distance = length3(point) - 1;
    for (size_t i = 0; i < count; i++) {
        double offset[3] = {point[0] - zones[i][0], point[1] - zones[i][1], point[2] - zones[i][2]};
        distance         = fmax(distance, zones[i][3] - length3(offset));
    }
    return distance;
}

/* More zones than before, fewer, none: kernels with room for them are made and kept. */
static void zones_come_and_go(void **context)
{
    static const size_t counts[] = {0, 1, 3, 2, KRS_MAX_ZONES, 0, 5};
    double              zones[KRS_MAX_ZONES][4];
    (void)context;
    Scene s = scene_of("show sphere(1);", KRS_FOR_QUESTIONS);
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        size_t count = counts[c];
        for (size_t i = 0; i < count; i++) {
            random_vector(&chance, 0.8, zones[i]);
            zones[i][3] = uniform(0.1, 0.4);
        }
        const ShaderEntry *newest = s.rendering->shaders.first;
        const size_t       room   = s.rendering->max_zone_slots;
        assert_int_equal(krs_state_set_zones(s.state, (const double(*)[4])zones, count), KRS_OK);
        points_agree(s, 2000, 1.5, 16);
        for (size_t i = 0; i < 2000; i++)
            assert_true(fabs(found[i].distance -
                             ball_less_zones(points[i], (const double(*)[4])zones, count)) < 1e-6);
        rays_agree(s, 500, 1.5, 0, 16);
        assert_true(s.rendering->zone_slots >= count && s.rendering->max_zone_slots >= count);
        assert_true((s.rendering->shaders.first == newest) == (count <= room));
    }
    scene_close(s);
}

static const char zoned[] =
    "camera { eye: [3, 2, 4], target: [0, 0, 0] }"
    "zone { center: [0.6, 0.6, 0.7], radius: 0.7 }"
    "show sphere(1).paint(#c04020); show plane([0, 1, 0], -1).paint(#4060a0);";

static const char bare[] =
    "camera { eye: [3, 2, 4], target: [0, 0, 0] }"
    "show sphere(1).paint(#c04020); show plane([0, 1, 0], -1).paint(#4060a0);";

static const char difference[] = "camera { eye: [3, 2, 4], target: [0, 0, 0] }"
                                 "let hole = sphere(0.7).move([0.6, 0.6, 0.7]);"
                                 "show sphere(1).paint(#c04020) - hole.paint(#c04020);"
                                 "show plane([0, 1, 0], -1).paint(#4060a0) - hole.paint(#4060a0);";

static KrsPicture *shoot(Scene s)
{
    KrsRenderOptions options = {.width = 160, .height = 120, .error = 0.05};
    KrsPicture      *picture;
    KrsStatus        status = krs_render(s.rendering, s.state, &options, &picture);
    if (status != KRS_OK)
        print_message("%s\n", krs_renderer_message(renderer));
    assert_int_equal(status, KRS_OK);
    return picture;
}

static bool same_pictures(const KrsPicture *a, const KrsPicture *b)
{
    size_t pixels = 160 * 120;
    return memcmp(a->color, b->color, pixels * 16) == 0 &&
           memcmp(a->depth, b->depth, pixels * 4) == 0 &&
           memcmp(a->normal, b->normal, pixels * 12) == 0 &&
           memcmp(a->component, b->component, pixels * 4) == 0;
}

static void a_zone_looks_like_a_difference(void **context)
{
    const double zone[1][4] = {{0.6, 0.6, 0.7, 0.7}}, nearer[1][4] = {{0.6, 0.6, 0.7, 0.6}};
    (void)context;
    Scene       by_language = scene_of(zoned, KRS_FOR_PICTURES);
    Scene       by_caller   = scene_of(bare, KRS_FOR_PICTURES);
    Scene       by_hand     = scene_of(difference, KRS_FOR_PICTURES);
    KrsPicture *whole       = shoot(by_caller);
    assert_int_equal(krs_state_set_zones(by_caller.state, zone, 1), KRS_OK);
    KrsPicture *a = shoot(by_language), *b = shoot(by_caller), *c = shoot(by_hand);
    assert_true(same_pictures(a, b));
    assert_true(same_pictures(a, c));
    assert_false(same_pictures(a, whole));
    assert_int_equal(krs_state_set_zones(by_caller.state, nearer, 1), KRS_OK);
    KrsPicture *smaller = shoot(by_caller);
    assert_false(same_pictures(a, smaller));
    assert_int_equal(krs_state_set_zones(by_caller.state, NULL, 0), KRS_OK);
    KrsPicture *again = shoot(by_caller);
    assert_true(same_pictures(again, whole));
    KrsPicture *all[] = {whole, a, b, c, smaller, again};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        krs_picture_free(all[i]);
    scene_close(by_language);
    scene_close(by_caller);
    scene_close(by_hand);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_agree_everywhere),
        cmocka_unit_test(rays_agree_everywhere),
        cmocka_unit_test(thin_twigs_are_hit_as_thick_as_they_are),
        cmocka_unit_test(zones_come_and_go),
        cmocka_unit_test(a_zone_looks_like_a_difference),
    };
    return cmocka_run_group_tests_name("device queries", tests, renderer_open, renderer_close);
}
