/*
 * zones.c: balls that are cut out of a scene by the caller.
 *
 * What is right is computed here, in closed form: a ray meets a ball between the two roots of a
 * square equation, and a ball with zones in it where it is in that interval and in none of theirs.
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
#include "tests/unit/queried.h"

/* [low, high] of the ray within a ball (center, radius); false: it passes by. */
static bool in_ball(const double origin[3], const double unit[3], const double ball[4],
                    double interval[2])
{
    double b = 0, c = -ball[3] * ball[3];
    for (int k = 0; k < 3; k++) {
        double from = origin[k] - ball[k];
        b += from * unit[k];
        c += from * from;
    }
    double root = b * b - c;
    if (root <= 0)
        return false;
    interval[0] = -b - sqrt(root);
    interval[1] = -b + sqrt(root);
    return true;
}

/* Returns the first t >= 0 that is in the solid interval and in none of the zones' (t starts
   outside of the solid), or -1. *margin becomes small where less than that decides. */
static double first_in(const double solid[2], const double (*zones)[2], size_t count,
                       double *margin)
{
    double t       = solid[0];
    bool   left[3] = {false};
    *margin        = fmin(*margin, fabs(t));
    for (size_t i = 0; i < count; i++) {
        if (left[i])
            continue;
        *margin = fmin(*margin, fmin(fabs(zones[i][0] - t), fabs(zones[i][1] - t)));
        if (zones[i][0] < t && t < zones[i][1]) {
            left[i] = true;
            t       = zones[i][1];
            i       = (size_t)-1; /* the others once more, from here */
        }
    }
    *margin = fmin(*margin, fabs(solid[1] - t));
    return t < solid[1] ? t : -1;
}

static const double ZONES[3][4] = {
    {0.9, 0.1, 0, 0.5}, {0.2, 0.8, 0.4, 0.45}, {-0.3, -0.2, 0.9, 0.6}};

static double ball_less_zones(const double point[3], const double (*zones)[4], size_t count)
{
    double distance = length3(point) - 1;
    for (size_t i = 0; i < count; i++)
        distance = fmax(distance, zones[i][3] - apart(point, zones[i]));
    return distance;
}

static void zones_cut_distances(void **context)
{
    (void)context;
    Scene by_language = scene_of("param r = 0.3 in [0, 2];"
                                 "zone { center: [0.9, 0.1, 0], radius: r + 0.2 }"
                                 "for c in [[0.2, 0.8, 0.4, 0.45], [-0.3, -0.2, 0.9, 0.6]] {"
                                 "    zone { center: [c[0], c[1], c[2]], radius: c[3] } }"
                                 "show sphere(1);");
    Scene by_caller   = scene_of("show sphere(1);");
    assert_int_equal(krs_state_set_zones(by_caller.state, ZONES, 3), KRS_OK);
    for (int i = 0; i < 2000; i++) {
        double point[1][3], a, b;
        random_vector(&chance, 2, point[0]);
        krs_distance(by_language.state, (const double(*)[3])point, 1, &a);
        krs_distance(by_caller.state, (const double(*)[3])point, 1, &b);
        double right = ball_less_zones(point[0], ZONES, 3);
        assert_true(fabs(a - right) < 1e-12 && fabs(b - right) < 1e-12);
    }
    /* A zone of frame time moves with its parameter, and may shrink to nothing. */
    double point[1][3] = {{0.9, 0.1, 0}}, distance;
    assert_int_equal(krs_state_set(by_language.state, "r", (double[]){0}, 1), KRS_OK);
    krs_distance(by_language.state, (const double(*)[3])point, 1, &distance);
    assert_true(fabs(distance - 0.2) < 1e-12);
    scene_close(by_language);
    scene_close(by_caller);
}

static void zones_cut_rays(void **context)
{
    (void)context;
    const double ball[4] = {0, 0, 0, 1};
    Scene        s       = scene_of("show sphere(1);");
    size_t       hits = 0, misses = 0, cut = 0, doubtful = 0;
    assert_int_equal(krs_state_set_zones(s.state, ZONES, 3), KRS_OK);
    for (int i = 0; i < 5000; i++) {
        double origin[3], target[3], unit[3], solid[2], holes[3][2], margin = INFINITY;
        do
            random_vector(&chance, 4, origin);
        while (length3(origin) < 1.1);
        random_vector(&chance, 1.2, target);
        double remote = apart(target, origin), t = -1;
        for (int k = 0; k < 3; k++)
            unit[k] = (target[k] - origin[k]) / remote;
        size_t count = 0;
        for (int z = 0; z < 3; z++)
            count += in_ball(origin, unit, ZONES[z], holes[count]);
        bool inside = in_ball(origin, unit, ball, solid);
        if (inside && solid[0] > 0)
            t = first_in(solid, (const double(*)[2])holes, count, &margin);
        if (margin < 1e-6) {
            doubtful++;
            continue;
        }
        KrsHit hit = cast(s.state, origin, unit, 100, 0);
        assert_false(hit.unresolved);
        assert_int_equal(hit.hit, t >= 0);
        if (t >= 0)
            assert_true(fabs(hit.t - t) < 1e-8);
        hits += t >= 0;
        misses += t < 0;
        cut += t >= 0 && t > solid[0] + 1e-6;
    }
    assert_true(hits > 500 && misses > 500 && cut > 200 && doubtful < 100);
    scene_close(s);
}

static void a_cut_shows_what_it_goes_through(void **context)
{
    (void)context;
    Scene  s          = scene_of("show plane([0, 1, 0], -5); show sphere(1).paint(#ff0000);");
    double zone[1][4] = {{0, 0, 2, 1.25}}, origin[3] = {0.3, 0.2, 9}, direction[3] = {0, 0, -1};
    KrsHit before = cast(s.state, origin, direction, 100, 0);
    assert_int_equal(krs_state_set_zones(s.state, (const double(*)[4])zone, 1), KRS_OK);
    KrsHit hit = cast(s.state, origin, direction, 100, 0);
    assert_true(before.hit && hit.hit);
    double z = 2 - sqrt(1.25 * 1.25 - 0.3 * 0.3 - 0.2 * 0.2);
    assert_true(fabs(hit.point[2] - z) < 1e-8 && before.t < hit.t - 0.1);
    assert_int_equal(hit.component, 2);
    assert_true(memcmp(hit.color, before.color, sizeof hit.color) == 0);
    /* Outwards of the solid is towards the middle of the zone. */
    for (int k = 0; k < 3; k++)
        assert_true(fabs(hit.normal[k] - (zone[0][k] - hit.point[k]) / 1.25) < 1e-6);
    assert_int_equal(krs_state_set_zones(s.state, NULL, 0), KRS_OK);
    KrsHit after = cast(s.state, origin, direction, 100, 0);
    assert_true(after.t == before.t);
    scene_close(s);
}

/* Smooth mirrors bend the normals of the shape, and not those of a cut. */
static void cuts_are_lit_by_their_own_normal(void **context)
{
    (void)context;
    Scene  s          = scene_of("show krs { kernel sphere(1).move([-0.8, 0, 0]);"
                                           "    reflect plane([1, 0, 0], 0); }.smooth_mirrors(1);");
    double zone[1][4] = {{0.2, 0, 1, 0.7}}, point[2][3] = {{0.2, 0, 0.3}, {0.2, 0, 0.8}};
    KrsHit cut, smooth;
    assert_int_equal(krs_probe(s.state, (const double(*)[3])point + 1, 1, &smooth), KRS_OK);
    assert_true(fabs(smooth.shading[0] - smooth.normal[0]) > 0.1);
    assert_int_equal(krs_state_set_zones(s.state, (const double(*)[4])zone, 1), KRS_OK);
    assert_int_equal(krs_probe(s.state, (const double(*)[3])point, 1, &cut), KRS_OK);
    assert_true(fabs(cut.distance) < 1e-12 && fabs(cut.shading[2] - 1) < 1e-6);
    assert_true(memcmp(cut.shading, cut.normal, sizeof cut.normal) == 0);
    scene_close(s);
}

/* The cut is the difference with a sphere, which the language can write, too. */
static void zones_are_differences(void **context)
{
    (void)context;
    static const char body[] =
        "krs { kernel capsule([0, 0, 0], [0.3, 0.6, 0], 0.1); for i in 0..8 {"
        "    reflect plane(random_direction(i), 0.3 + 0.1 * i); } }";
    char with[400], without[400];
    snprintf(with, sizeof with, "zone { center: [0.2, 0.3, 0.1], radius: 0.6 } show %s;", body);
    snprintf(without, sizeof without, "show %s - sphere(0.6).move([0.2, 0.3, 0.1]);", body);
    Scene a = scene_of(with), b = scene_of(without);
    for (int i = 0; i < 2000; i++) {
        double point[1][3], d[2];
        random_vector(&chance, 1.5, point[0]);
        krs_distance(a.state, (const double(*)[3])point, 1, &d[0]);
        krs_distance(b.state, (const double(*)[3])point, 1, &d[1]);
        assert_true(fabs(d[0] - d[1]) < 1e-12);
    }
    scene_close(a);
    scene_close(b);
}

static void bad_zones_change_nothing(void **context)
{
    (void)context;
    Scene        s                          = scene_of("show sphere(1);");
    const double bad[][4]                   = {{0, 0, 0, -1},  {NAN, 0, 0, 1},  {0, INFINITY, 0, 1},
                                               {0, 0, 0, NAN}, {0, 0, 1e19, 1}, {0, 0, 0, INFINITY}};
    double       many[KRS_MAX_ZONES + 1][4] = {{0}}, point[1][3] = {{0.9, 0.1, 0}}, distance;
    assert_int_equal(krs_state_set_zones(s.state, ZONES, 1), KRS_OK);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(krs_state_set_zones(s.state, &bad[i], 1), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_state_set_zones(s.state, (const double(*)[4])many, KRS_MAX_ZONES + 1),
                     KRS_BAD_ARGUMENT);
    krs_distance(s.state, (const double(*)[3])point, 1, &distance);
    assert_true(fabs(distance - 0.5) < 1e-12);
    assert_int_equal(krs_state_set_zones(s.state, (const double(*)[4])many, KRS_MAX_ZONES), KRS_OK);
    krs_distance(s.state, (const double(*)[3])point, 1, &distance);
    assert_true(fabs(distance - (sqrt(0.82) - 1)) < 1e-12);
    scene_close(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(zones_cut_distances),
        cmocka_unit_test(zones_cut_rays),
        cmocka_unit_test(a_cut_shows_what_it_goes_through),
        cmocka_unit_test(cuts_are_lit_by_their_own_normal),
        cmocka_unit_test(zones_are_differences),
        cmocka_unit_test(bad_zones_change_nothing),
    };
    return cmocka_run_group_tests_name("zones", tests, NULL, NULL);
}
