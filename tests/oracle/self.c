/*
 * The oracles themselves: clouds, solids, expansions and the judge against closed forms and
 * against second ways to the same answer.  No compiler is needed.
 */
#include "tests/oracle/expand.h"
#include "tests/oracle/judge.h"
#include "tests/oracle/solids.h"

#include <stdarg.h>
#include <setjmp.h>
#include <cmocka.h>

static void nearest_is_the_nearest(void **state)
{
    (void)state;
    Random random = {1};
    Cloud  cloud  = {0};
    assert_true(cloud_nearest(&cloud, vec(0, 0, 0)) == HUGE_VAL);
    for (int i = 0; i < 3000; i++)
        cloud_add(&cloud, random_in_cube(&random, i % 2 ? 1 : 0.1));
    for (int i = 0; i < 1000; i++) {
        Vec    point = random_in_cube(&random, 1.5);
        double best  = HUGE_VAL;
        for (size_t k = 0; k < cloud.count; k++)
            best = fmin(best, vec_distance(point, cloud.points[k]));
        assert_true(fabs(cloud_nearest(&cloud, point) - best) <= 1e-12);
    }
    cloud_free(&cloud);
}

/* Textbook distances, for the cloud of each kind of surface. */
static double sphere_distance(Vec p) { return vec_length(p) - 0.8; }
static double torus_distance(Vec p) { return hypot(hypot(p.x, p.z) - 0.7, p.y) - 0.2; }
static double box_distance(Vec p)
{
    double x = fabs(p.x) - 0.5, y = fabs(p.y) - 0.3, z = fabs(p.z) - 0.7;
    return vec_length(vec(fmax(x, 0), fmax(y, 0), fmax(z, 0))) + fmin(fmax(x, fmax(y, z)), 0);
}
static double cylinder_distance(Vec p)
{
    double out = hypot(p.x, p.z) - 0.5, up = fabs(p.y) - 0.3;
    return hypot(fmax(out, 0), fmax(up, 0)) + fmin(fmax(out, up), 0);
}
static double capsule_distance(Vec p)
{
    return vec_distance(p, vec(0, fmax(-0.4, fmin(p.y, 0.4)), 0)) - 0.3;
}
static double upright_cylinder_distance(Vec p) { return cylinder_distance(vec(p.x, p.z, p.y)); }

static void sphere_cloud(Cloud *cloud) { ellipsoid_cloud(cloud, vec(0.8, 0.8, 0.8), 0.02); }
static void ring_cloud(Cloud *cloud) { torus_cloud(cloud, 0.7, 0.2, 0.02); }
static void box_cloud(Cloud *cloud)
{
    Hull hull = {0};
    for (int i = 0; i < 8; i++)
        hull_add(&hull, i & 1 ? 0.5 : -0.5, i & 2 ? 0.3 : -0.3, i & 4 ? 0.7 : -0.7);
    hull_close(&hull);
    assert_int_equal(hull.face_count, 6);
    hull_cloud(&hull, cloud, 0.02);
}
static void can_cloud(Cloud *cloud)
{
    frustum_cloud(cloud, 0, -0.3, 0.5, -0.3, 0.02);
    frustum_cloud(cloud, 0.5, -0.3, 0.5, 0.3, 0.02);
    frustum_cloud(cloud, 0.5, 0.3, 0, 0.3, 0.02);
}
static void capsule_cloud(Cloud *cloud)
{
    Sweep sweep     = {.curve_count = 1, .radius = 0.3, .radius_end = 0.3};
    sweep.curves[0] = curve_segment(vec(0, -0.4, 0), vec(0, 0.4, 0));
    sweep_cloud(&sweep, cloud, 0.02);
}
static Figure disc_figure(double radius)
{
    Figure figure = {.stroke = {.curve_count = 1, .radius = radius, .radius_end = radius}};
    figure.stroke.curves[0] = curve_segment(vec(0, 0, 0), vec(0, 0, 0));
    return figure;
}
static void extruded_cloud(Cloud *cloud)
{
    Figure disc = disc_figure(0.5);
    extrusion_cloud(&disc, 0.6, cloud, 0.02);
}
static void revolved_cloud(Cloud *cloud)
{
    Figure disc = disc_figure(0.2);
    revolution_cloud(&disc, 0.7, cloud, 0.02);
}
static void revolved_polygon_cloud(Cloud *cloud)
{
    Figure square = {0};
    figure_add(&square, -0.4, -0.3);
    figure_add(&square, 0.4, -0.3);
    figure_add(&square, 0.4, 0.3);
    figure_add(&square, -0.4, 0.3);
    revolution_cloud(&square, 0.1, cloud, 0.02);
}

typedef struct Known {
    const char *name;
    void (*cloud)(Cloud *cloud);
    double (*distance)(Vec p);
} Known;

static const Known known[] = {
    {"sphere", sphere_cloud, sphere_distance},
    {"torus", ring_cloud, torus_distance},
    {"hull", box_cloud, box_distance},
    {"frustum", can_cloud, cylinder_distance},
    {"sweep", capsule_cloud, capsule_distance},
    {"extrusion", extruded_cloud, upright_cylinder_distance},
    {"revolution", revolved_cloud, torus_distance},
    {"revolution across the axis", revolved_polygon_cloud, cylinder_distance},
};
enum { KNOWN = sizeof known / sizeof *known };

static void clouds_bracket_known_distances(void **state)
{
    (void)state;
    for (const Known *k = known; k < known + KNOWN; k++) {
        Random random = {2};
        Cloud  cloud  = {0};
        k->cloud(&cloud);
        assert_true(cloud.spacing > 0.005 && cloud.spacing < 0.06);
        for (int i = 0; i < 2000; i++) {
            Vec    point = random_in_cube(&random, 1.4);
            double truth = fabs(k->distance(point)), found = cloud_nearest(&cloud, point);
            if (!(truth <= found + 1e-9 && found <= truth + cloud.spacing))
                fail_msg("%s: true distance %g, found %g, spacing %g", k->name, truth, found,
                         cloud.spacing);
        }
        cloud_free(&cloud);
    }
}

static void arcs_go_through_their_points(void **state)
{
    (void)state;
    Random random = {3};
    for (int i = 0; i < 200; i++) {
        Vec   a = random_in_cube(&random, 1), b = random_in_cube(&random, 1);
        Vec   c     = random_in_cube(&random, 1);
        Curve arc   = curve_arc(a, b, c);
        Sweep spine = {.curves = {arc}, .curve_count = 1};
        assert_true(vec_distance(curve_at(&arc, 0), a) < 1e-9);
        assert_true(vec_distance(curve_at(&arc, 1), c) < 1e-9);
        assert_true(sweep_depth(&spine, b) < 1e-6);
    }
}

static void swept_depth_of_a_capsule(void **state)
{
    (void)state;
    Random random   = {4};
    Sweep  sweep    = {.curve_count = 1, .radius = 0.3, .radius_end = 0.3};
    sweep.curves[0] = curve_segment(vec(0, -0.4, 0), vec(0, 0.4, 0));
    for (int i = 0; i < 2000; i++) {
        Vec point = random_in_cube(&random, 1.5);
        assert_true(fabs(sweep_depth(&sweep, point) - capsule_distance(point)) < 1e-7);
    }
}

static void hulls_have_their_faces(void **state)
{
    (void)state;
    Hull octahedron = {0}, square = {0};
    for (int i = -1; i <= 1; i += 2) {
        hull_add(&octahedron, i, 0, 0);
        hull_add(&octahedron, 0, i, 0);
        hull_add(&octahedron, 0, 0, i);
    }
    hull_close(&octahedron);
    assert_int_equal(octahedron.face_count, 8);
    for (int i = 0; i < 4; i++)
        hull_add(&square, i & 1 ? 1 : -1, -1, i & 2 ? 1 : -1);
    hull_add(&square, 0, 1, 0);
    hull_close(&square);
    assert_int_equal(square.face_count, 5);
    assert_true(hull_contains(&square, vec(0.4, 0, 0.4)));
    assert_false(hull_contains(&square, vec(0.6, 0, 0.4)));
}

static void concave_polygons(void **state)
{
    (void)state;
    Figure       l             = {0};
    const double corners[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    for (int i = 0; i < 6; i++)
        figure_add(&l, corners[i][0], corners[i][1]);
    Random random = {5};
    for (int i = 0; i < 2000; i++) {
        double x = random_between(&random, -0.5, 2.5), y = random_between(&random, -0.5, 2.5);
        bool   inside = x > 0 && y > 0 && ((x < 2 && y < 1) || (x < 1 && y < 2));
        assert_int_equal(figure_contains(&l, x, y), inside);
    }
}

static Sequence sample_sequence(Random *random, int mirrors)
{
    Sequence sequence = {.mirror_count = mirrors};
    for (int i = 0; i < mirrors; i++)
        sequence.mirrors[i] = (Half){random_unit(random), random_between(random, -0.3, 0.6)};
    for (int level = 0; level <= mirrors; level++) {
        Body *body  = &sequence.bodies[sequence.body_count++];
        *body       = (Body){.level = level, .from = random_in_cube(random, 0.6), .radius = 0.3};
        body->to    = level % 3 == 1 ? random_in_cube(random, 0.6) : body->from;
        body->box   = level % 3 == 2;
        body->sides = vec(0.3, 0.2, 0.4);
        body->axis  = random_unit(random);
        body->angle = random_between(random, -3, 3);
    }
    return sequence;
}

static bool body_contains(const Body *body, Vec p)
{
    if (body->box) {
        Vec q = vec_rotate(vec_sub(p, body->from), body->axis, -body->angle);
        return fabs(q.x) <= body->sides.x && fabs(q.y) <= body->sides.y &&
               fabs(q.z) <= body->sides.z;
    }
    Sweep sweep     = {.curve_count = 1, .radius = body->radius, .radius_end = body->radius};
    sweep.curves[0] = curve_segment(body->from, body->to);
    return sweep_depth(&sweep, p) <= 0;
}

/* L_i word for word. */
static bool level_contains(const Sequence *sequence, int level, Vec p)
{
    for (int i = 0; i < sequence->body_count; i++)
        if (sequence->bodies[i].level == level && body_contains(&sequence->bodies[i], p))
            return true;
    if (level == 0)
        return false;
    Half   mirror = sequence->mirrors[level - 1];
    double excess = half_excess(mirror, p);
    Vec    image  = vec_sub(p, vec_scale(2 * excess, mirror.normal));
    return level_contains(sequence, level - 1, excess <= 0 ? p : image);
}

static void expansions_contain_what_the_model_says(void **state)
{
    (void)state;
    Random random = {6};
    int    inside = 0;
    for (int repeat = 0; repeat < 6; repeat++) {
        Sequence  sequence  = sample_sequence(&random, repeat);
        Expansion expansion = expand(&sequence);
        for (int i = 0; i < 1000; i++) {
            Vec  point = random_in_cube(&random, 1.2);
            bool truth = level_contains(&sequence, sequence.mirror_count, point);
            inside += truth;
            assert_int_equal(expansion_contains(&expansion, point), truth);
        }
        expansion_free(&expansion);
    }
    assert_true(inside > 300 && inside < 5000);
}

/* No point of the set is nearer than the distance; some are hardly farther. */
static void expansion_distances_are_tight(void **state)
{
    (void)state;
    Random    random    = {7};
    Sequence  sequence  = sample_sequence(&random, 5);
    Expansion expansion = expand(&sequence);
    Cloud     inner     = {0};
    while (inner.count < 12000) {
        Vec point = random_in_cube(&random, 3);
        if (expansion_contains(&expansion, point))
            cloud_add(&inner, point);
    }
    int cut = 0;
    for (int i = 0; i < 1500; i++) {
        Vec point = random_in_cube(&random, 3);
        if (expansion_contains(&expansion, point))
            continue;
        bool   sure;
        double distance = expansion_distance(&expansion, point, &sure);
        double found    = cloud_nearest(&inner, point);
        assert_true(distance <= found + 1e-6);
        assert_true(found <= distance + 0.2);
        cut += !sure;
    }
    assert_true(cut > 20);
    cloud_free(&inner);
    expansion_free(&expansion);
}

static void rays_enter_where_points_are_inside(void **state)
{
    (void)state;
    Random   random   = {8};
    Sequence sequence = sample_sequence(&random, 4);
    int      kept = 0, hits = 0;
    for (int i = 0; i < sequence.body_count; i++)
        if (sequence.bodies[i].level % 3 != 1)
            sequence.bodies[kept++] = sequence.bodies[i];
    sequence.body_count = kept;
    Expansion expansion = expand(&sequence);
    for (int i = 0; i < 200; i++) {
        Vec    origin    = vec_scale(4, random_unit(&random));
        Vec    direction = vec_unit(vec_sub(random_in_cube(&random, 1), origin));
        double enter     = expansion_enter(&expansion, origin, direction);
        bool   sure;
        if (enter < HUGE_VAL) {
            Vec end = vec_add(origin, vec_scale(enter, direction));
            assert_true(expansion_distance(&expansion, end, &sure) < 1e-6);
            hits++;
        }
        for (double t = 0; t < fmin(enter, 8) - 1e-6; t += 0.02)
            assert_false(expansion_contains(&expansion, vec_add(origin, vec_scale(t, direction))));
    }
    assert_true(hits > 50);
    expansion_free(&expansion);
}

static double ball_field(const void *user, Vec p)
{
    (void)user;
    return sphere_distance(p);
}
static double inverted_field(const void *user, Vec p) { return -ball_field(user, p); }
static double swollen_field(const void *user, Vec p) { return ball_field(user, p) - 0.05; }
static double broken_field(const void *user, Vec p) { return p.x > 0 ? NAN : ball_field(user, p); }
static bool   ball_inside(const void *user, Vec p) { return ball_field(user, p) <= 0; }

static void the_judge_can_refute(void **state)
{
    (void)state;
    Trial trial = {ball_field, NULL, ball_inside, NULL, vec(0, 0, 0), 1.5, 1000, 9};
    judge_acquits(&trial, "a ball");
    judge_refutes_larger(&trial, 1.15, "a ball");
    judge_refutes_steeper(&trial, 1.15, "a ball");
    trial.field = inverted_field;
    assert_true(judge(&trial).sign_errors > 100);
    trial.field = swollen_field;
    assert_true(judge(&trial).sign_errors > 0 && judge(&trial).slope_errors == 0);
    trial.field = broken_field;
    assert_true(judge(&trial).sign_errors > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nearest_is_the_nearest),
        cmocka_unit_test(clouds_bracket_known_distances),
        cmocka_unit_test(arcs_go_through_their_points),
        cmocka_unit_test(swept_depth_of_a_capsule),
        cmocka_unit_test(hulls_have_their_faces),
        cmocka_unit_test(concave_polygons),
        cmocka_unit_test(expansions_contain_what_the_model_says),
        cmocka_unit_test(expansion_distances_are_tight),
        cmocka_unit_test(rays_enter_where_points_are_inside),
        cmocka_unit_test(the_judge_can_refute),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
