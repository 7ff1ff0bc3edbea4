/*
 * query.c: questions to the processor through the C interface: arrays, zones, rays that are hard,
 * and arguments that are wrong.
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

#include "compiler/base/vec.h"
#include "compiler/compile.h"
#include "tests/support/random.h"

typedef struct Scene {
    KrsScene *scene;
    KrsFrame *frame;
} Scene;

static Scene scene_of(const char *text)
{
    Scene s;
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &s.scene), KRS_OK);
    assert_int_equal(krs_frame_new(s.scene, &s.frame), KRS_OK);
    return s;
}

static void scene_close(Scene s)
{
    krs_frame_free(s.frame);
    krs_scene_free(s.scene);
}

static Random chance = {2024};

static double uniform(double low, double high) { return random_between(&chance, low, high); }

static KrsHit cast(KrsFrame *frame, const double origin[3], const double direction[3],
                   double farthest, double tolerance)
{
    KrsHit hit;
    double o[1][3], d[1][3];
    memcpy(o, origin, sizeof o);
    memcpy(d, direction, sizeof d);
    assert_int_equal(krs_raycast(frame, (const double(*)[3])o, (const double(*)[3])d, 1, farthest,
                                 tolerance, &hit),
                     KRS_OK);
    return hit;
}

/* ---- closed forms ---- */

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

/* The first t >= 0 that is in the solid interval and in none of the zones' (t starts outside of
   the solid), or -1.  *margin becomes small where less than that decides. */
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
        distance = fmax(distance, zones[i][3] - distance3(point, zones[i]));
    return distance;
}

/* ---- zones ---- */

static void zones_cut_distances(void **context)
{
    (void)context;
    Scene by_language = scene_of("param r = 0.3 in [0, 2];"
                                 "zone { center: [0.9, 0.1, 0], radius: r + 0.2 }"
                                 "for c in [[0.2, 0.8, 0.4, 0.45], [-0.3, -0.2, 0.9, 0.6]] {"
                                 "    zone { center: [c[0], c[1], c[2]], radius: c[3] } }"
                                 "show sphere(1);");
    Scene by_caller   = scene_of("show sphere(1);");
    assert_int_equal(krs_frame_set_zones(by_caller.frame, ZONES, 3), KRS_OK);
    for (int i = 0; i < 2000; i++) {
        double point[1][3], a, b;
        random_vector(&chance, 2, point[0]);
        krs_distance(by_language.frame, (const double(*)[3])point, 1, &a);
        krs_distance(by_caller.frame, (const double(*)[3])point, 1, &b);
        double right = ball_less_zones(point[0], ZONES, 3);
        assert_true(fabs(a - right) < 1e-12 && fabs(b - right) < 1e-12);
    }
    /* A zone of frame time moves with its parameter, and may shrink to nothing. */
    double point[1][3] = {{0.9, 0.1, 0}}, distance;
    assert_int_equal(krs_frame_set(by_language.frame, "r", (double[]){0}, 1), KRS_OK);
    krs_distance(by_language.frame, (const double(*)[3])point, 1, &distance);
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
    assert_int_equal(krs_frame_set_zones(s.frame, ZONES, 3), KRS_OK);
    for (int i = 0; i < 5000; i++) {
        double origin[3], target[3], unit[3], solid[2], holes[3][2], margin = INFINITY;
        do
            random_vector(&chance, 4, origin);
        while (length3(origin) < 1.1);
        random_vector(&chance, 1.2, target);
        double remote = distance3(target, origin), t = -1;
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
        KrsHit hit = cast(s.frame, origin, unit, 100, 0);
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
    KrsHit before = cast(s.frame, origin, direction, 100, 0);
    assert_int_equal(krs_frame_set_zones(s.frame, (const double(*)[4])zone, 1), KRS_OK);
    KrsHit hit = cast(s.frame, origin, direction, 100, 0);
    assert_true(before.hit && hit.hit);
    double z = 2 - sqrt(1.25 * 1.25 - 0.3 * 0.3 - 0.2 * 0.2);
    assert_true(fabs(hit.point[2] - z) < 1e-8 && before.t < hit.t - 0.1);
    assert_int_equal(hit.component, 2);
    assert_true(memcmp(hit.color, before.color, sizeof hit.color) == 0);
    /* Outwards of the solid is towards the middle of the zone. */
    for (int k = 0; k < 3; k++)
        assert_true(fabs(hit.normal[k] - (zone[0][k] - hit.point[k]) / 1.25) < 1e-6);
    assert_int_equal(krs_frame_set_zones(s.frame, NULL, 0), KRS_OK);
    KrsHit after = cast(s.frame, origin, direction, 100, 0);
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
    assert_int_equal(krs_probe(s.frame, (const double(*)[3])point + 1, 1, &smooth), KRS_OK);
    assert_true(fabs(smooth.shading[0] - smooth.normal[0]) > 0.1);
    assert_int_equal(krs_frame_set_zones(s.frame, (const double(*)[4])zone, 1), KRS_OK);
    assert_int_equal(krs_probe(s.frame, (const double(*)[3])point, 1, &cut), KRS_OK);
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
        krs_distance(a.frame, (const double(*)[3])point, 1, &d[0]);
        krs_distance(b.frame, (const double(*)[3])point, 1, &d[1]);
        assert_true(fabs(d[0] - d[1]) < 1e-12);
    }
    scene_close(a);
    scene_close(b);
}

static void bad_zones_change_nothing(void **context)
{
    (void)context;
    Scene        s        = scene_of("show sphere(1);");
    const double bad[][4] = {{0, 0, 0, -1},  {NAN, 0, 0, 1},  {0, INFINITY, 0, 1},
                             {0, 0, 0, NAN}, {0, 0, 1e19, 1}, {0, 0, 0, INFINITY}};
    double       many[KRS_MOST_ZONES + 1][4] = {{0}}, point[1][3] = {{0.9, 0.1, 0}}, distance;
    assert_int_equal(krs_frame_set_zones(s.frame, ZONES, 1), KRS_OK);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(krs_frame_set_zones(s.frame, &bad[i], 1), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_frame_set_zones(s.frame, (const double(*)[4])many, KRS_MOST_ZONES + 1),
                     KRS_BAD_ARGUMENT);
    krs_distance(s.frame, (const double(*)[3])point, 1, &distance);
    assert_true(fabs(distance - 0.5) < 1e-12);
    assert_int_equal(krs_frame_set_zones(s.frame, (const double(*)[4])many, KRS_MOST_ZONES),
                     KRS_OK);
    krs_distance(s.frame, (const double(*)[3])point, 1, &distance);
    assert_true(fabs(distance - (sqrt(0.82) - 1)) < 1e-12);
    scene_close(s);
}

/* ---- arrays ---- */

static void arrays_are_answered_in_order(void **context)
{
    enum { COUNT = 500 };
    static double points[COUNT][3], distances[COUNT], normals[COUNT][3];
    static KrsHit hits[COUNT];
    (void)context;
    Scene s = scene_of("show sphere(1); show sphere(0.5).move([3, 0, 0]);");
    for (int i = 0; i < COUNT; i++)
        random_vector(&chance, 5, points[i]);
    assert_int_equal(krs_distance(s.frame, (const double(*)[3])points, COUNT, distances), KRS_OK);
    assert_int_equal(krs_normal(s.frame, (const double(*)[3])points, COUNT, normals), KRS_OK);
    assert_int_equal(krs_probe(s.frame, (const double(*)[3])points, COUNT, hits), KRS_OK);
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
    assert_int_equal(krs_distance(s.frame, NULL, 0, NULL), KRS_OK);
    assert_int_equal(krs_raycast(s.frame, NULL, NULL, 0, 1, 0, NULL), KRS_OK);
    scene_close(s);
}

static void an_empty_scene_is_far_from_everything(void **context)
{
    (void)context;
    Scene  s           = scene_of("camera { eye: [0, 0, 5] }");
    double point[1][3] = {{1, 2, 3}}, distance, origin[3] = {0, 0, 5}, direction[3] = {0, 0, -1};
    KrsHit hit;
    assert_int_equal(krs_distance(s.frame, (const double(*)[3])point, 1, &distance), KRS_OK);
    assert_true(distance == INFINITY);
    assert_int_equal(krs_probe(s.frame, (const double(*)[3])point, 1, &hit), KRS_OK);
    assert_int_equal(hit.component, 0);
    hit = cast(s.frame, origin, direction, INFINITY, 0);
    assert_false(hit.hit || hit.unresolved);
    scene_close(s);
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
        assert_int_equal(krs_distance(s.frame, p, 2, distances), KRS_BAD_ARGUMENT);
        assert_int_equal(krs_normal(s.frame, p, 2, normals), KRS_BAD_ARGUMENT);
        assert_int_equal(krs_probe(s.frame, p, 2, hits), KRS_BAD_ARGUMENT);
        assert_int_equal(krs_raycast(s.frame, p, good, 2, 9, 0, hits), KRS_BAD_ARGUMENT);
        assert_int_equal(krs_raycast(s.frame, good, p, 2, 9, 0, hits), KRS_BAD_ARGUMENT);
    }
    const double(*down)[3] = &good[1];
    assert_int_equal(krs_raycast(s.frame, origin, still, 1, 9, 0, hits), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_raycast(s.frame, origin, down, 1, -1, 0, hits), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_raycast(s.frame, origin, down, 1, NAN, 0, hits), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_raycast(s.frame, origin, down, 1, 9, -1, hits), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_raycast(s.frame, origin, down, 1, 9, NAN, hits), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_raycast(s.frame, origin, down, 1, 9, INFINITY, hits), KRS_BAD_ARGUMENT);
    assert_true(distances[0] == 7 && normals[0][0] == 7 && hits[0].t == 7 && hits[1].t == 7);
    assert_int_equal(krs_raycast(s.frame, origin, down, 1, 9, 0, hits), KRS_OK);
    assert_true(fabs(hits[0].t - 4) < 1e-8);
    scene_close(s);
}

/* ---- rays ---- */

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
        KrsHit hit       = cast(s.frame, origin, along, rays[i].farthest, 0);
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
        KrsHit hit = cast(wire.frame, origin, down, 10, 0.005);
        double way = 2 * sqrt(fmax(1e-6 - origin[1] * origin[1], 0));
        if (way == 0 || way > 0.005 / 16)
            assert_int_equal(hit.hit, way > 0);
        hits += hit.hit;
        if (hit.hit)
            assert_true(fabs(hit.t - 3 + way / 2) < 0.005);
    }
    assert_in_range(hits, 98, 100);
    scene_close(wire);

    Scene ball = scene_of("show sphere(1);");
    for (double depth = 1e-3; depth > 1e-9; depth /= 3) {
        double in[3] = {-5, 1 - depth, 0}, out[3] = {-5, 1 + depth, 0}, along[3] = {1, 0, 0};
        KrsHit hit = cast(ball.frame, in, along, 10, 0), miss = cast(ball.frame, out, along, 10, 0);
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
    KrsHit hit = cast(s.frame, near, along, 1e9, 0);
    assert_true(hit.unresolved);
    assert_false(hit.hit);
    assert_true(hit.t > 1e-4 * KRS_MOST_STEPS && hit.t < 1e8);
    assert_true(fabs(hit.point[0] - hit.t) < 1e-6 && hit.component == 1);
    hit = cast(s.frame, high, along, 1e5, 0);
    assert_false(hit.hit || hit.unresolved);
    hit = cast(s.frame, near, along, 10, 0); /* resolved where it need not go so far */
    assert_false(hit.hit || hit.unresolved);
    double down[3] = {1, -1e-3, 0};
    hit            = cast(s.frame, high, down, INFINITY, 0);
    assert_true(hit.hit && fabs(hit.t - 5e3 * length3(down)) < 1e-4);
    double up[3] = {1, 1e-3, 0.5};
    hit          = cast(s.frame, high, up, INFINITY, 0);
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
            KrsHit hit = cast(s.frame, origin, along, 100, tolerance);
            assert_true(hit.hit);
            assert_true(fabs(hit.t - last * length3(along)) <= tolerance + 1e-8);
        }
        scene_close(s);
    }
    Scene  s         = scene_of("show box([1, 1, 1]); show box([1, 1, 1]).move([1.000001, 0, 0]);");
    double origin[3] = {-0.3, 0.1, 0.2}, along[3] = {1, 0, 0};
    KrsHit hit = cast(s.frame, origin, along, 100, 0);
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
        KrsHit hit = cast(s.frame, origin, direction, 100, 0);
        assert_true(hit.hit && fabs(hit.t - 4) < 1e-8);
    }
    double origin[3] = {3e11, 0, 4e11}, direction[3] = {-3, 0, -4};
    KrsHit hit = cast(s.frame, origin, direction, INFINITY, 0);
    assert_true(hit.hit && fabs(hit.t - (5e11 - 1)) < 1e-2);
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
        cmocka_unit_test(arrays_are_answered_in_order),
        cmocka_unit_test(an_empty_scene_is_far_from_everything),
        cmocka_unit_test(wrong_arguments_are_refused),
        cmocka_unit_test(rays_start_anywhere),
        cmocka_unit_test(thin_things_keep_their_width),
        cmocka_unit_test(rays_that_run_out_are_told),
        cmocka_unit_test(seams_do_not_end_rays),
        cmocka_unit_test(directions_have_any_length),
    };
    return cmocka_run_group_tests_name("queries", tests, NULL, NULL);
}
