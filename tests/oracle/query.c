/*
 * query.c: what the device answers about points and rays, with and without zones.
 *
 * Points are held against the evaluator in double precision, as in device.c.  Rays are not
 * compared with another march but with what the evaluator says along them: where a ray is said to
 * hit there is a surface, and before that, at many places, there is none.  A zone is also what the
 * language can write as a difference, and pictures of both are the same bit by bit.
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
#include "compiler/compile.h"
#include "runtime/tracer/renderer.h"
#include "tests/support/device.h"
#include "tests/support/random.h"
#include "tests/support/renderer.h"
#include "tests/support/scarce.h"

typedef struct Scene {
    KrsScene     *scene;
    KrsFrame     *frame;
    KrsRendering *rendering;
} Scene;

static Scene scene_ready(KrsStatus status, KrsScene *scene, KrsPurpose purpose)
{
    Scene s = {.scene = scene};
    assert_int_equal(status, KRS_OK);
    assert_int_equal(krs_frame_new(scene, &s.frame), KRS_OK);
    status = krs_rendering_new_for(renderer, scene, purpose, &s.rendering);
    if (status != KRS_OK)
        print_message("%s\n", krs_renderer_message(renderer));
    assert_int_equal(status, KRS_OK);
    return s;
}

static Scene scene_of(const char *text, KrsPurpose purpose)
{
    KrsScene *scene;
    KrsStatus status = krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene);
    return scene_ready(status, scene, purpose);
}

static void scene_close(Scene s)
{
    krs_rendering_free(s.rendering);
    krs_frame_free(s.frame);
    krs_scene_free(s.scene);
}

static Random chance = {77};

static double uniform(double low, double high) { return random_between(&chance, low, high); }

enum { MOST = 40000 };
static double points[MOST][3], aims[MOST][3];
static KrsHit found[MOST], wanted[MOST];
#define POINTS ((const double(*)[3])points)
#define AIMS   ((const double(*)[3])aims)

static void probe_device(Scene s, size_t count)
{
    KrsStatus status = krs_device_probe(s.rendering, s.frame, POINTS, count, found);
    if (status != KRS_OK)
        print_message("%s\n", krs_renderer_message(renderer));
    assert_int_equal(status, KRS_OK);
}

static void cast_device(Scene s, size_t count, double farthest, double tolerance)
{
    KrsStatus status = krs_device_raycast(s.rendering, s.frame, POINTS, AIMS, count, farthest,
                                          tolerance, found);
    if (status != KRS_OK)
        print_message("%s\n", krs_renderer_message(renderer));
    assert_int_equal(status, KRS_OK);
}

/* ---- comparisons ---- */

/* The evaluator's answers at points that single precision has, too. */
static void points_agree(Scene s, size_t count, double size, double roughness)
{
    size_t wrong_ids = 0, wrong_normals = 0;
    for (size_t i = 0; i < count; i++) {
        random_vector(&chance, size, points[i]);
        for (int k = 0; k < 3; k++)
            points[i][k] = (float)points[i][k];
    }
    probe_device(s, count);
    assert_int_equal(krs_probe(s.frame, POINTS, count, wanted), KRS_OK);
    for (size_t i = 0; i < count; i++) {
        double allowed = roughness * 0x1p-23 * (1 + length3(points[i]) + fabs(wanted[i].distance));
        assert_true(fabs(found[i].distance - wanted[i].distance) <= allowed);
        assert_true(memcmp(found[i].point, points[i], sizeof points[i]) == 0 && found[i].hit);
        wrong_ids += found[i].component != wanted[i].component ||
                     found[i].level != wanted[i].level || found[i].instance != wanted[i].instance;
        for (int k = 0; k < 3; k++)
            if (fabs(found[i].normal[k] - wanted[i].normal[k]) > 0.01 ||
                fabs(found[i].shading[k] - wanted[i].shading[k]) > 0.01) {
                wrong_normals++;
                break;
            }
    }
    /* Ties, and edges that a difference reaches over. */
    assert_true(wrong_ids * 200 <= count);
    assert_true(wrong_normals * 20 <= count);
}

/* How far the evaluator contradicts an answer about a ray from the open: by the distance where it
   is said to hit, and by how deep the ray was in something before. */
static double contradiction(Scene s, size_t i, double farthest)
{
    enum { PLACES = 400 };
    static double places[PLACES + 1][3], there[PLACES + 1];
    double        unit[3], length = length3(aims[i]), worst = 0;
    double        t = found[i].hit || found[i].unresolved ? found[i].t : farthest;
    for (int k = 0; k < 3; k++)
        unit[k] = aims[i][k] / length;
    for (int p = 0; p <= PLACES; p++)
        for (int k = 0; k < 3; k++)
            places[p][k] = points[i][k] + t * p / PLACES * unit[k];
    assert_int_equal(krs_distance(s.frame, (const double(*)[3])places, PLACES + 1, there), KRS_OK);
    for (int p = 0; p < PLACES; p++)
        worst = fmax(worst, -there[p]);
    if (found[i].hit)
        worst = fmax(worst, fabs(there[PLACES]));
    return worst;
}

/* Rays from places in the open, of which some may be near nothing. */
static void aim_rays(Scene s, size_t count, double size)
{
    for (size_t i = 0; i < count;) {
        double target[3], distance;
        random_vector(&chance, size, points[i]);
        random_vector(&chance, 0.7 * size, target);
        assert_int_equal(krs_distance(s.frame, POINTS + i, 1, &distance), KRS_OK);
        if (distance < 0.02)
            continue;
        for (int k = 0; k < 3; k++)
            aims[i][k] = 3 * (target[k] - points[i][k]);
        i++;
    }
}

static void rays_agree(Scene s, size_t count, double size, double tolerance, double roughness)
{
    double farthest = 4 * size, worst = 0;
    size_t hits = 0, misses = 0, unresolved = 0;
    aim_rays(s, count, size);
    cast_device(s, count, farthest, tolerance);
    for (size_t i = 0; i < count; i++) {
        double allowed = tolerance + roughness * 0x1p-23 * (1 + 2 * size);
        worst          = fmax(worst, contradiction(s, i, farthest) / allowed);
        hits += found[i].hit;
        unresolved += found[i].unresolved;
        misses += !found[i].hit && !found[i].unresolved;
        assert_false(found[i].hit && found[i].t > farthest);
    }
    if (worst > 1 || hits * 20 < count || misses * 100 < count || unresolved * 500 > count)
        print_message("worst %g, %zu hits, %zu misses, %zu unresolved\n", worst, hits, misses,
                      unresolved);
    assert_true(worst <= 1);
    assert_true(hits * 20 >= count && misses * 100 >= count && unresolved * 500 <= count);
}

/* ---- scenes ---- */

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
        double way = 2 * sqrt(fmax(1e-6 - points[i][1] * points[i][1], 0));
        if ((way == 0 && points[i][1] > 0.001 + 1e-5) || way > 0.005 / 16)
            assert_int_equal(found[i].hit, way > 0);
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
        double away[3] = {point[0] - zones[i][0], point[1] - zones[i][1], point[2] - zones[i][2]};
        distance       = fmax(distance, zones[i][3] - length3(away));
    }
    return distance;
}

/* More zones than before, fewer, none: kernels with room for them are made and kept. */
static void zones_come_and_go(void **context)
{
    static const size_t counts[] = {0, 1, 3, 2, KRS_MOST_ZONES, 0, 5};
    double              zones[KRS_MOST_ZONES][4];
    (void)context;
    Scene s = scene_of("show sphere(1);", KRS_FOR_QUESTIONS);
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        size_t count = counts[c];
        for (size_t i = 0; i < count; i++) {
            random_vector(&chance, 0.8, zones[i]);
            zones[i][3] = uniform(0.1, 0.4);
        }
        const Kernel before = s.rendering->zoned.sample;
        const size_t room   = s.rendering->zoned.zones;
        assert_int_equal(krs_frame_set_zones(s.frame, (const double(*)[4])zones, count), KRS_OK);
        points_agree(s, 2000, 1.5, 16);
        for (size_t i = 0; i < 2000; i++)
            assert_true(fabs(found[i].distance -
                             ball_less_zones(points[i], (const double(*)[4])zones, count)) < 1e-6);
        rays_agree(s, 500, 1.5, 0, 16);
        assert_true(s.rendering->zoned.zones >= count);
        if (count <= room)
            assert_true(s.rendering->zoned.sample.pipeline == before.pipeline);
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
    KrsStatus        status = krs_render(s.rendering, s.frame, &options, &picture);
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
    assert_int_equal(krs_frame_set_zones(by_caller.frame, zone, 1), KRS_OK);
    KrsPicture *a = shoot(by_language), *b = shoot(by_caller), *c = shoot(by_hand);
    assert_true(same_pictures(a, b));
    assert_true(same_pictures(a, c));
    assert_false(same_pictures(a, whole));
    assert_int_equal(krs_frame_set_zones(by_caller.frame, nearer, 1), KRS_OK);
    KrsPicture *smaller = shoot(by_caller);
    assert_false(same_pictures(a, smaller));
    assert_int_equal(krs_frame_set_zones(by_caller.frame, NULL, 0), KRS_OK);
    KrsPicture *again = shoot(by_caller);
    assert_true(same_pictures(again, whole));
    KrsPicture *all[] = {whole, a, b, c, smaller, again};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        krs_picture_free(all[i]);
    scene_close(by_language);
    scene_close(by_caller);
    scene_close(by_hand);
}

/* ---- counts, ends and errors ---- */

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
    KrsFrame     *f = s.frame;
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
    const WayBlock good[4] = {{1, QUERY_HIT, 1, 9},
                              {9, QUERY_MISS, 77, 2},
                              {2, QUERY_HIT, 0, 8},
                              {3, QUERY_MARCHING, 2, 99}};
    assert_true(ways_are_sound(good, 4, 3));
    assert_true(ways_are_sound(good, 0, 0));
    assert_false(ways_are_sound(good, 4, 2)); /* the last ray has no place */
    assert_false(ways_are_sound(good, 4, 5)); /* more places than rays */
    const WayBlock faults[] = {{1, QUERY_HIT, 3, 9},
                               {1, QUERY_HIT, UINT32_MAX, 9},
                               {1, QUERY_MARCHING, 3, 9},
                               {1, QUERY_MISS + 1, 0, 9}};
    for (size_t fault = 0; fault < sizeof faults / sizeof *faults; fault++)
        for (int at = 0; at < 4; at++) {
            WayBlock ways[4];
            memcpy(ways, good, sizeof ways);
            ways[at] = faults[fault];
            assert_false(ways_are_sound(ways, 4, 3));
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
            assert_int_equal(krs_frame_set_zones(s.frame, zone, 1), KRS_OK);
        memcpy(points[0], (double[]){0, 0, 5}, sizeof *points);
        memcpy(aims[0], (double[]){0, 0, -1}, sizeof *aims);
        scarce.failing    = scarce.made + (failing + 1) / 2;
        KrsStatus status  = krs_device_raycast(s.rendering, s.frame, POINTS, AIMS, 1, 9, 0, found);
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
        cmocka_unit_test(points_agree_everywhere),
        cmocka_unit_test(rays_agree_everywhere),
        cmocka_unit_test(thin_twigs_are_hit_as_thick_as_they_are),
        cmocka_unit_test(zones_come_and_go),
        cmocka_unit_test(a_zone_looks_like_a_difference),
        cmocka_unit_test(any_number_is_answered),
        cmocka_unit_test(hard_rays_are_told),
        cmocka_unit_test(seams_do_not_end_rays),
        cmocka_unit_test(wrong_questions_are_refused),
        cmocka_unit_test(wrong_answers_are_refused),
        cmocka_unit_test(memory_may_run_out),
    };
    spirv_start();
    int failed = cmocka_run_group_tests_name("device queries", tests, renderer_open,
                                             renderer_close);
    spirv_stop();
    return failed;
}
