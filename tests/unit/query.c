/*
 * query.c: questions to the processor through the C interface: arrays, rays that are hard, and
 * arguments that are wrong.
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
#include "compiler/passes/compile.h"
#include "tests/unit/queried.h"

static void arrays_are_answered_in_order(void **context)
{
    enum { COUNT = 500 };
    static double points[COUNT][3], distances[COUNT], normals[COUNT][3];
    static KrsHit hits[COUNT];
    (void)context;
    Scene s = scene_of("show sphere(1); show sphere(0.5).move([3, 0, 0]);");
    for (int i = 0; i < COUNT; i++)
        random_vector(&chance, 5, points[i]);
    assert_int_equal(krs_distance(s.state, (const double(*)[3])points, COUNT, distances), KRS_OK);
    assert_int_equal(krs_normal(s.state, (const double(*)[3])points, COUNT, normals), KRS_OK);
    assert_int_equal(krs_probe(s.state, (const double(*)[3])points, COUNT, hits), KRS_OK);
    for (int i = 0; i < COUNT; i++) {
        const double center[2][3] = {{0, 0, 0}, {3, 0, 0}};
        double       each[2]      = {distance3(points[i], center[0]) - 1,
                                     distance3(points[i], center[1]) - 0.5};
        int          nearer       = each[1] < each[0];
        assert_true(fabs(distances[i] - each[nearer]) < 1e-12);
        assert_true(hits[i].distance == distances[i] && hits[i].hit);
        assert_int_equal(hits[i].component, nearer + 1);
        assert_int_equal(hits[i].instance, 1);
        assert_int_equal(hits[i].level, 0);
        for (int k = 0; k < 3 && fabs(each[0] - each[1]) > 1e-3; k++) {
            double right = (points[i][k] - center[nearer][k]) /
                           distance3(points[i], center[nearer]);
            assert_true(fabs(normals[i][k] - right) < 1e-6);
            assert_true(hits[i].normal[k] == normals[i][k]);
        }
    }
    assert_int_equal(krs_distance(s.state, NULL, 0, NULL), KRS_OK);
    assert_int_equal(krs_raycast(s.state, NULL, NULL, 0, 1, 0, NULL), KRS_OK);
    scene_close(s);
}

static void an_empty_scene_is_far_from_everything(void **context)
{
    (void)context;
    Scene  s           = scene_of("camera { eye: [0, 0, 5] }");
    double point[1][3] = {{1, 2, 3}}, distance, origin[3] = {0, 0, 5}, direction[3] = {0, 0, -1};
    KrsHit hit;
    assert_int_equal(krs_distance(s.state, (const double(*)[3])point, 1, &distance), KRS_OK);
    assert_true(distance == INFINITY);
    assert_int_equal(krs_probe(s.state, (const double(*)[3])point, 1, &hit), KRS_OK);
    assert_int_equal(hit.component, 0);
    hit = cast(s.state, origin, direction, INFINITY, 0);
    assert_false(hit.hit || hit.unresolved);
    scene_close(s);
}

/* A bound is not far from zero between parts that nearly touch, although nothing is there.  A blend
   with it must not swell: the box of the CSG node has no place for that. */
static void what_is_nowhere_adds_nothing(void **context)
{
#define NOWHERE "(sphere(1) & sphere(1).move([0, 2.02, 0]))"
#define BALL    "sphere(1).move([1.6, 1.01, 0])"
    static const char *const pairs[][2] = {
        {"show union(" BALL ", " NOWHERE ", blend: 0.9);", "show " BALL ";"},
        {"show union(" NOWHERE ", " BALL ", blend: 0.9, kind: \"cubic\");", "show " BALL ";"},
        {"show difference(" BALL ", " NOWHERE ", blend: 0.9);", "show " BALL ";"},
        {"show xor(" BALL ", " NOWHERE ", blend: 0.9);", "show " BALL ";"},
        {"show " BALL " | " NOWHERE ".round(0.4);", "show " BALL ";"},
        {"show " BALL " | " NOWHERE ".shell(0.4);", "show " BALL ";"},
    };
    enum { POINTS = 300 };
    (void)context;
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        Scene with = scene_of(pairs[i][0]), without = scene_of(pairs[i][1]);
        for (int k = 0; k < POINTS; k++) {
            double point[1][3], distances[2];
            random_vector(&chance, 2.5, point[0]);
            assert_int_equal(krs_distance(with.state, (const double(*)[3])point, 1, distances),
                             KRS_OK);
            assert_int_equal(
                krs_distance(without.state, (const double(*)[3])point, 1, distances + 1), KRS_OK);
            if (distances[0] != distances[1])
                fail_msg("%s: %.17g instead of %.17g at %g, %g, %g", pairs[i][0], distances[0],
                         distances[1], point[0][0], point[0][1], point[0][2]);
        }
        scene_close(with);
        scene_close(without);
    }
#undef NOWHERE
#undef BALL
}

static void wrong_arguments_are_refused(void **context)
{
    (void)context;
    Scene        s            = scene_of("show sphere(1);");
    const double good[2][3]   = {{0, 0, 5}, {0, 0, -1}};
    const double wrong[][3]   = {{NAN, 0, 0}, {0, INFINITY, 0}, {0, 0, -INFINITY}};
    const double origin[1][3] = {{0, 0, 5}}, still[1][3] = {{0, 0, 0}};
    double       distances[2] = {7, 7}, normals[2][3] = {{7}};
    KrsHit       hits[2] = {{.t = 7}, {.t = 7}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        double points[2][3];
        memcpy(points[0], good[0], sizeof points[0]);
        memcpy(points[1], wrong[i], sizeof points[1]);
        const double(*p)[3] = (const double(*)[3])points;
        assert_int_equal(krs_distance(s.state, p, 2, distances), KRS_BAD_ARGUMENT);
        assert_int_equal(krs_normal(s.state, p, 2, normals), KRS_BAD_ARGUMENT);
        assert_int_equal(krs_probe(s.state, p, 2, hits), KRS_BAD_ARGUMENT);
        assert_int_equal(krs_raycast(s.state, p, good, 2, 9, 0, hits), KRS_BAD_ARGUMENT);
        assert_int_equal(krs_raycast(s.state, good, p, 2, 9, 0, hits), KRS_BAD_ARGUMENT);
    }
    const double(*down)[3] = &good[1];
    assert_int_equal(krs_raycast(s.state, origin, still, 1, 9, 0, hits), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_raycast(s.state, origin, down, 1, -1, 0, hits), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_raycast(s.state, origin, down, 1, NAN, 0, hits), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_raycast(s.state, origin, down, 1, 9, -1, hits), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_raycast(s.state, origin, down, 1, 9, NAN, hits), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_raycast(s.state, origin, down, 1, 9, INFINITY, hits), KRS_BAD_ARGUMENT);
    assert_true(distances[0] == 7 && normals[0][0] == 7 && hits[0].t == 7 && hits[1].t == 7);
    assert_int_equal(krs_raycast(s.state, origin, down, 1, 9, 0, hits), KRS_OK);
    assert_true(fabs(hits[0].t - 4) < 1e-8);
    scene_close(s);
}

static void rays_start_anywhere(void **context)
{
    (void)context;
    Scene        s        = scene_of("show sphere(1);");
    const double along[3] = {0, 0, -3};
    const struct {
        double z, farthest, t;
    } rays[] = {
        {5, 100, 4},      {0, 100, 1},        {0.25, 100, 1.25}, /* inside: the inner wall */
        {1, 100, 0},      {-1, 100, 0},                          /* on the surface */
        {-5, 100, -1},    {5, 3.9, -1},       {5, 4.1, 4},       /* away; too far */
        {5, INFINITY, 4}, {-5, INFINITY, -1}, {1e6, 1e9, 999999}, {5, 0, -1}, {0, 0.5, -1},
    };
    for (size_t i = 0; i < sizeof rays / sizeof *rays; i++) {
        double origin[3] = {0, 0, rays[i].z};
        KrsHit hit       = cast(s.state, origin, along, rays[i].farthest, 0);
        assert_false(hit.unresolved);
        assert_int_equal(hit.hit, rays[i].t >= 0);
        if (hit.hit)
            assert_true(fabs(hit.t - rays[i].t) <= 1e-9 * fmax(1, rays[i].t));
        if (hit.hit)
            assert_true(fabs(hit.distance) <= 1e-9 * fmax(1, rays[i].t));
    }
    scene_close(s);
}

/* Things are as thick as they are: the share of rays that hit a wire does not grow with the
   tolerance (but ways through it that are shorter than a sixteenth of that may be missed), and a
   ray that grazes a ball hits it if it goes in, however little. */
static void thin_things_keep_their_width(void **context)
{
    (void)context;
    Scene  wire = scene_of("show capsule([-5, 0, 0], [5, 0, 0], 0.001);"
                            "show sphere(1).move([0, 5, 0]);"); /* widens the box */
    size_t hits = 0;
    for (int i = 0; i < 1000; i++) {
        double origin[3] = {uniform(-4, 4), 0.01 * (i + 0.5) / 1000, 3}, down[3] = {0, 0, -1};
        KrsHit hit   = cast(wire.state, origin, down, 10, 0.005);
        double chord = 2 * sqrt(fmax(1e-6 - origin[1] * origin[1], 0));
        if (chord == 0 || chord > 0.005 / 16)
            assert_int_equal(hit.hit, chord > 0);
        hits += hit.hit;
        if (hit.hit)
            assert_true(fabs(hit.t - 3 + chord / 2) < 0.005);
    }
    assert_in_range(hits, 98, 100);
    scene_close(wire);

    Scene ball = scene_of("show sphere(1);");
    for (double depth = 1e-3; depth > 1e-9; depth /= 3) {
        double in[3] = {-5, 1 - depth, 0}, out[3] = {-5, 1 + depth, 0}, along[3] = {1, 0, 0};
        KrsHit hit = cast(ball.state, in, along, 10, 0), miss = cast(ball.state, out, along, 10, 0);
        assert_true(hit.hit && !hit.unresolved);
        assert_true(fabs(hit.t - (5 - sqrt(2 * depth - depth * depth))) < 1e-6);
        assert_false(miss.hit);
        assert_false(miss.unresolved);
    }
    scene_close(ball);
}

/* A ray that creeps along an endless plane is not called a miss: it is told how far it came. */
static void rays_that_run_out_are_told(void **context)
{
    (void)context;
    Scene  s       = scene_of("show plane([0, 1, 0], 0); show sphere(1).move([1e8, 0, 0]);");
    double near[3] = {0, 1e-4, 0}, high[3] = {0, 5, 0}, along[3] = {1, 0, 0};
    KrsHit hit = cast(s.state, near, along, 1e9, 0);
    assert_true(hit.unresolved);
    assert_false(hit.hit);
    assert_true(hit.t > 1e-4 * KRS_MAX_STEPS && hit.t < 1e8);
    assert_true(fabs(hit.point[0] - hit.t) < 1e-6 && hit.component == 1);
    hit = cast(s.state, high, along, 1e5, 0);
    assert_false(hit.hit || hit.unresolved);
    hit = cast(s.state, near, along, 10, 0); /* resolved where it need not go so far */
    assert_false(hit.hit || hit.unresolved);
    double down[3] = {1, -1e-3, 0};
    hit            = cast(s.state, high, down, INFINITY, 0);
    assert_true(hit.hit && fabs(hit.t - 5e3 * length3(down)) < 1e-4);
    double up[3] = {1, 1e-3, 0.5};
    hit          = cast(s.state, high, up, INFINITY, 0);
    assert_false(hit.hit || hit.unresolved);
    scene_close(s);
}

/* Solids that touch are one: a ray from inside does not end at the seam between them, wherever it
   begins and however it crosses; it ends where they do, and at every gap. */
static void seams_do_not_end_rays(void **context)
{
    static const char *const scenes[] = {
        "show box([1, 1, 1]); show box([1, 1, 1]).move([1, 0, 0]);",
        "show krs { kernel box([1, 1, 1]).move([0.5, 0, 0]); reflect plane([-1, 0, 0], 0); }"
        "    .move([0.5, 0, 0]);",
        "show (box([1, 1, 1]) | box([1, 1, 1]).move([1, 0, 0])).rotate([1, 2, 3], 0.7)"
        "    .rotate([1, 2, 3], -0.7);",
        "show box([1, 1, 1]).repeat([1, 0, 0], [2, 1, 1]).move([0.5, 0, 0]);",
    };
    (void)context;
    for (size_t scene = 0; scene < sizeof scenes / sizeof *scenes; scene++) {
        Scene s = scene_of(scenes[scene]);
        for (int i = 0; i < 600; i++) {
            double tolerance = (double[]){0, 1e-7, 0.01}[i % 3], last = INFINITY;
            double origin[3] = {uniform(-0.45, 1.45), uniform(-0.45, 0.45), uniform(-0.45, 0.45)};
            double along[3]  = {uniform(-1, 1), uniform(-0.3, 0.3), uniform(-0.3, 0.3)};
            double low[3] = {-0.5, -0.5, -0.5}, high[3] = {1.5, 0.5, 0.5};
            for (int k = 0; k < 3; k++)
                last = fmin(last, ((along[k] > 0 ? high : low)[k] - origin[k]) / along[k]);
            KrsHit hit = cast(s.state, origin, along, 100, tolerance);
            assert_true(hit.hit);
            assert_true(fabs(hit.t - last * length3(along)) <= tolerance + 1e-8);
        }
        scene_close(s);
    }
    Scene  s         = scene_of("show box([1, 1, 1]); show box([1, 1, 1]).move([1.000001, 0, 0]);");
    double origin[3] = {-0.3, 0.1, 0.2}, along[3] = {1, 0, 0};
    KrsHit hit = cast(s.state, origin, along, 100, 0);
    assert_true(hit.hit && fabs(hit.t - 0.8) < 1e-9);
    scene_close(s);
}

/* Squares of directions overflow, or vanish; origins are far. */
static void directions_have_any_length(void **context)
{
    (void)context;
    Scene s = scene_of("show sphere(1);");
    for (double size = 1e-300; size < 1e301; size *= 1e50) {
        double origin[3] = {3, 0, 4}, direction[3] = {-3 * size, 0, -4 * size};
        KrsHit hit = cast(s.state, origin, direction, 100, 0);
        assert_true(hit.hit && fabs(hit.t - 4) < 1e-8);
    }
    double origin[3] = {3e11, 0, 4e11}, direction[3] = {-3, 0, -4};
    KrsHit hit = cast(s.state, origin, direction, INFINITY, 0);
    assert_true(hit.hit && fabs(hit.t - (5e11 - 1)) < 1e-2);
    scene_close(s);
}

/* Whether a number of rays that are cast at once end where each by itself does, bit for bit. */
static void cast_at_once(const char *text)
{
    enum { COUNT = 75 }; /* more than a run of lanes has, and no whole number of runs */
    double origins[COUNT][3], directions[COUNT][3];
    KrsHit together[COUNT], alone;
    int    hits = 0;
    Scene  s    = scene_of(text);
    for (int i = 0; i < COUNT; i++) { /* some begin inside */
        random_vector(&chance, i % 5 ? 4 : 1, origins[i]);
        random_vector(&chance, 1, directions[i]);
        for (int k = 0; k < 3 && i % 5; k++)
            directions[i][k] = 0.6 * directions[i][k] - origins[i][k];
    }
    assert_int_equal(krs_raycast(s.state, (const double(*)[3])origins,
                                 (const double(*)[3])directions, COUNT, 20, 1e-4, together),
                     KRS_OK);
    for (int i = 0; i < COUNT; i++) {
        assert_int_equal(krs_raycast(s.state, (const double(*)[3])origins + i,
                                     (const double(*)[3])directions + i, 1, 20, 1e-4, &alone),
                         KRS_OK);
        hits += alone.hit;
        if (alone.t != together[i].t || alone.component != together[i].component ||
            alone.hit != together[i].hit || alone.unresolved != together[i].unresolved ||
            memcmp(alone.point, together[i].point, sizeof alone.point) != 0 ||
            memcmp(alone.normal, together[i].normal, sizeof alone.normal) != 0)
            fail_msg("%s: ray %d ends at %.17g beside others, at %.17g alone", text, i,
                     together[i].t, alone.t);
    }
    if (hits < COUNT / 5)
        fail_msg("%s: only %d hits", text, hits);
    scene_close(s);
}

static void rays_at_once_are_those_of_each(void **context)
{
    (void)context;
    cast_at_once("show sphere(1); show box([0.6, 0.5, 0.8]).move([1.5, 0, 0]);");
    cast_at_once("show regular(5, 1).extrude(3).twist([0, 1, 0], 80deg).move([0.2, 0, 0]);");
    cast_at_once("show difference(box([2, 2, 1.1]), sphere(0.6), blend: 0.1); zone { center: [0.5, "
                 "0, 0], radius: 0.9 }");
    cast_at_once(
        "show union([sphere(0.2).move([sin(i), cos(3 * i), sin(7 * i)]) for i in 0..80]);");
    cast_at_once(
        "show sphere(0.4).repeat([0.9, 0.9, 0.9], [3, 2, 3]); show plane([0, 1, 0], -1.5);");
    cast_at_once("show field(sin(4 * x) * cos(4 * y) + sin(4 * z)).within(sphere(1.5));");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_are_answered_in_order),
        cmocka_unit_test(an_empty_scene_is_far_from_everything),
        cmocka_unit_test(what_is_nowhere_adds_nothing),
        cmocka_unit_test(wrong_arguments_are_refused),
        cmocka_unit_test(rays_start_anywhere),
        cmocka_unit_test(thin_things_keep_their_width),
        cmocka_unit_test(rays_that_run_out_are_told),
        cmocka_unit_test(seams_do_not_end_rays),
        cmocka_unit_test(directions_have_any_length),
        cmocka_unit_test(rays_at_once_are_those_of_each),
    };
    return cmocka_run_group_tests_name("queries", tests, NULL, NULL);
}
