/*
 * corners.c: sweeps and tubes along polylines and curves that turn sharply, and tubes whose radius
 * varies, against their definitions: prisms between planes of reflection, and unions of many balls.
 */
#include <stdio.h>
#include <string.h>

#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

static const double PI = 3.14159265358979323846;

enum { MAX_POINTS = 6, POINTS = 250, BALLS = 4000 };

static void write_points(SceneText *text, const Vec *points, int count)
{
    for (int i = 0; i < count; i++)
        scene_write(text, "%s[%.17g, %.17g, %.17g]", i ? ", " : "[", points[i].x, points[i].y,
                    points[i].z);
    scene_write(text, "]");
}

/* ---- mitred sweeps ---- */

/* A rectangle of this half size along straight legs. */
typedef struct Legs {
    Vec    points[MAX_POINTS], along[MAX_POINTS], up[MAX_POINTS];
    int    count; /* of points */
    double wide, high;
} Legs;

/* Each leg's frame is the image of the one before in the plane between the two. */
static void legs_frame(Legs *legs, Vec up)
{
    legs->up[0] = up;
    for (int i = 0; i + 1 < legs->count; i++)
        legs->along[i] = vec_unit(vec_sub(legs->points[i + 1], legs->points[i]));
    for (int i = 1; i + 1 < legs->count; i++) {
        Vec mirror = vec_unit(vec_add(legs->along[i - 1], legs->along[i])), last = legs->up[i - 1];
        legs->up[i] = vec_sub(last, vec_scale(2 * vec_dot(last, mirror), mirror));
    }
}

/* Beyond the plane through a point of the path: that of the corner there, or that of an end. */
static bool is_beyond(const Legs *legs, int point, Vec at)
{
    Vec normal = point == 0                 ? legs->along[0]
                 : point + 1 == legs->count ? legs->along[point - 1]
                                            : vec_add(legs->along[point - 1], legs->along[point]);
    return vec_dot(vec_sub(at, legs->points[point]), normal) > 0;
}

static bool in_legs(const void *user, Vec at)
{
    const Legs *legs = user;
    bool        in   = false;
    for (int i = 0; i + 1 < legs->count && !in; i++) {
        Vec q = vec_sub(at, legs->points[i]), side = vec_cross(legs->up[i], legs->along[i]);
        in = is_beyond(legs, i, at) && !is_beyond(legs, i + 1, at) &&
             fabs(vec_dot(q, side)) <= legs->wide && fabs(vec_dot(q, legs->up[i])) <= legs->high;
    }
    return in;
}

/* Legs of about length 1 that turn by up to `most`, from along z. */
static Legs random_legs(Random *random, int count, double most)
{
    Legs legs      = {.count = count, .wide = 0.13, .high = 0.06};
    Vec  along     = vec(0, 0, 1);
    legs.points[0] = random_in_cube(random, 0.3);
    for (int i = 1; i < count; i++) {
        legs.points[i] = vec_add(legs.points[i - 1],
                                 vec_scale(random_between(random, 0.8, 1.2), along));
        Vec axis       = vec_rotate(vec_across(along), along, random_between(random, 0, 2 * PI));
        along          = vec_rotate(along, axis, random_between(random, 0.2, most));
    }
    legs_frame(&legs, vec(0, 1, 0));
    return legs;
}

static void corners_are_mitred(void **state)
{
    (void)state;
    Random random = {41};
    for (int set = 0; set < 24; set++) {
        Legs      legs = random_legs(&random, 3 + set % 3, set < 12 ? PI / 2 : 2.2);
        SceneText text = {.length = 0};
        scene_write(&text, "show sweep(rectangle([%.17g, %.17g]), ", 2 * legs.wide, 2 * legs.high);
        write_points(&text, legs.points, legs.count);
        scene_write(&text, ");");
        Product product = product_compile(text.bytes);
        for (int i = 1; i + 1 < legs.count; i++) { /* at corners alone much is to be seen */
            Trial trial = {product_field,  &product, in_legs, &legs,
                           legs.points[i], 0.35,     POINTS,  (uint64_t)set};
            judge_acquits(&trial, "a sweep with corners");
        }
        product_free(&product);
    }
}

/* The image of a sweep in the plane of its corner is itself, also where twist and taper change its legs. */
static void corners_meet(void **state)
{
    (void)state;
    Random        random  = {42};
    const Product product = product_compile("show sweep(star(5, 0.2, 0.1), [[-1, 0, 0], [0, 0, 0], "
                                            "[0, 0, -1]], twist: 90deg, taper: 0.5);");
    for (int i = 0; i < 4000; i++) {
        double a = random_between(&random, -0.3, 0.3), b = random_between(&random, -0.3, 0.3);
        Vec    at = vec(a + 1e-4, b, a - 1e-4), image = vec(a - 1e-4, b, a + 1e-4);
        double here = product_distance(&product, at), there = product_distance(&product, image);
        if (fabs(here) > 2e-3 && fabs(there) > 2e-3 && (here < 0) != (there < 0))
            fail_msg("at (%g, %g, %g) the corner does not meet: %g and %g", a, b, a, here, there);
    }
    Product gone = product;
    product_free(&gone);
}

/* A parabola that turns by more than a right angle is a sweep like any other: near its curve inside. */
static void sharp_curves_are_swept(void **state)
{
    (void)state;
    Random random = {43};
    for (int set = 0; set < 20; set++) {
        double    open    = random_between(&random, 0.5, 0.9);
        Vec       part[3] = {vec(-open, 0, 0), vec(0, 2.5, 0),
                             vec(open, 0, random_between(&random, -0.2, 0.2))};
        SceneText text    = {.length = 0};
        scene_write(&text, "show sweep(circle(0.02), [");
        write_points(&text, part, 3);
        scene_write(&text, "]);");
        Product product = product_compile(text.bytes);
        for (int i = 0; i <= 60; i++) {
            double t     = i / 60.0 * 0.998 + 0.001;
            Vec    at    = vec_mix(vec_mix(part[0], part[1], t), vec_mix(part[1], part[2], t), t);
            Vec    along = vec_unit(
                   vec_sub(vec_mix(part[1], part[2], t), vec_mix(part[0], part[1], t)));
            Vec out = vec_rotate(vec_across(along), along, i);
            assert_true(product_distance(&product, vec_add(at, vec_scale(0.0195, out))) < 0);
            assert_true(product_distance(&product, vec_add(at, vec_scale(0.0205, out))) > 0);
        }
        product_free(&product);
    }
}

/* ---- tubes of balls ---- */

typedef struct Balls {
    Vec    centres[BALLS];
    double radii[BALLS];
    int    count;
} Balls;

/* Returns the distance to a union of balls. */
static double balls_distance(const Balls *balls, Vec at)
{
    double best = HUGE_VAL;
    for (int i = 0; i < balls->count; i++)
        best = fmin(best, vec_distance(at, balls->centres[i]) - balls->radii[i]);
    return best;
}

/* `from` and `to`: of straight lines the middle is between. */
static void add_balls(Balls *balls, const Vec *part, double from, double to, int count)
{
    for (int i = 0; i <= count && balls->count < BALLS; i++) {
        double t                     = (double)i / count;
        balls->centres[balls->count] = vec_mix(vec_mix(part[0], part[1], t),
                                               vec_mix(part[1], part[2], t), t);
        balls->radii[balls->count++] = from + t * (to - from);
    }
}

/* Along straight lines the distance outside is that to the balls. */
static void radii_belong_to_points(void **state)
{
    (void)state;
    static Balls balls;
    Random       random = {44};
    for (int set = 0; set < 12; set++) {
        Vec       points[MAX_POINTS];
        double    radii[MAX_POINTS];
        int       count = 2 + set % 4;
        SceneText text  = {.length = 0};
        for (int i = 0; i < count; i++) {
            points[i] = random_in_cube(&random, 1);
            radii[i]  = random_between(&random, 0, 0.3);
        }
        scene_write(&text, "show tube(");
        write_points(&text, points, count);
        for (int i = 0; i < count; i++)
            scene_write(&text, "%s%.17g", i ? ", " : ", [", radii[i]);
        scene_write(&text, "]);");
        Product product = product_compile(text.bytes);
        balls.count     = 0;
        for (int i = 0; i + 1 < count; i++)
            add_balls(&balls,
                      (Vec[]){points[i], vec_mix(points[i], points[i + 1], 0.5), points[i + 1]},
                      radii[i], radii[i + 1], BALLS / count - 1);
        for (int i = 0; i < POINTS; i++) {
            Vec    at    = random_in_cube(&random, 1.5);
            double truth = balls_distance(&balls, at), distance = product_distance(&product, at);
            if (truth > 0 && !(fabs(distance - truth) < 2e-3))
                fail_msg("%d points: %g, truly %g", count, distance, truth);
        }
        product_free(&product);
    }
}

/* Along curves the surface is that of the balls, and the distance a bound. */
static void radii_vary_along_curves(void **state)
{
    (void)state;
    static Balls balls;
    Random       random = {45};
    for (int set = 0; set < 20; set++) {
        Vec    part[3] = {random_in_cube(&random, 1), random_in_cube(&random, 1),
                          random_in_cube(&random, 1)};
        double radii[3];
        for (int i = 0; i < 3; i++)
            radii[i] = random_between(&random, 0, 0.3);
        const int some = 2 + set % 2;
        SceneText text = {.length = 0};
        scene_write(&text, "show tube([");
        write_points(&text, part, 3);
        scene_write(&text, "], [%.17g, %.17g", radii[0], radii[1]);
        scene_write(&text, some == 3 ? ", %.17g]);" : "]);", radii[2]);
        Product product = product_compile(text.bytes);
        balls.count     = 0;
        for (int i = 0; i < BALLS; i++) {
            double t = (double)i / (BALLS - 1), place = t * (some - 1);
            int    last                = place < 1 ? 0 : some - 2;
            balls.centres[balls.count] = vec_mix(vec_mix(part[0], part[1], t),
                                                 vec_mix(part[1], part[2], t), t);
            balls.radii[balls.count++] = radii[last] +
                                         (place - last) * (radii[last + 1] - radii[last]);
        }
        for (int i = 0; i < POINTS; i++) {
            Vec    at    = random_in_cube(&random, 1.5);
            double truth = balls_distance(&balls, at), distance = product_distance(&product, at);
            if (!(distance <= fmax(truth, 0) + 1e-5 && (distance < 0) == (truth < 0)) &&
                fabs(truth) > 1e-4)
                fail_msg("a bound of %g, truly %g", distance, truth);
            if (truth > 0 && !(distance >= truth / 6))
                fail_msg("a bound of %g is too small, truly %g", distance, truth);
        }
        product_free(&product);
    }
}

/* Each point of a spline has its radius. */
static void splines_have_radii(void **state)
{
    (void)state;
    for (int closed = 0; closed < 2; closed++) {
        Product product = product_format(
            "show tube(spline([[cos(72deg * i), sin(72deg * i), 0] for i in 0..5], closed: %s),"
            " [0.05 + 0.05 * i for i in 0..5]);",
            closed ? "true" : "false");
        for (int i = 0; i < 5; i++) {
            Vec at = vec(cos(0.4 * PI * i), sin(0.4 * PI * i), 0);
            for (int side = -1; side <= 1; side += 2) {
                double far = 0;
                while (product_distance(&product, vec_add(at, vec(0, 0, side * far))) < 0)
                    far += 1e-4;
                /* balls beside it may be a little larger there */
                assert_true(far >= 0.05 + 0.05 * i - 1e-3 && far <= 0.05 + 0.05 * i + 0.004);
            }
        }
        product_free(&product);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corners_are_mitred),      cmocka_unit_test(corners_meet),
        cmocka_unit_test(sharp_curves_are_swept),  cmocka_unit_test(radii_belong_to_points),
        cmocka_unit_test(radii_vary_along_curves), cmocka_unit_test(splines_have_radii),
    };
    return cmocka_run_group_tests_name("corners", tests, NULL, NULL);
}
