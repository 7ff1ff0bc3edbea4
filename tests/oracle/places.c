/*
 * places.c: copies along paths, and things that lie about.  A small ball at each place tells where
 * that is, others where its axes point.  Paths are followed in many small steps.
 */
#include <stdio.h>

#include "tests/oracle/product.h"

static const double PI = 3.14159265358979323846;

enum { MAX_PLACES = 400, STEPS = 20000 };

typedef struct Places {
    Vec at[MAX_PLACES], y[MAX_PLACES], z[MAX_PLACES];
    int count;
} Places;

static Vec middle_of(const KrsScene *scene, size_t index)
{
    KrsComponent c;
    assert_int_equal(krs_component(scene, index, &c), KRS_OK);
    return vec((c.low[0] + c.high[0]) / 2, (c.low[1] + c.high[1]) / 2, (c.low[2] + c.high[2]) / 2);
}

/* `list` makes maps. */
static Places find_places(const char *list)
{
    static Places places;
    Product       product = product_format(
              "let places = %s;\n"
                    "for place in places { show sphere(0.01).transform(place); }\n"
                    "for place in places { show sphere(0.01).move([0, 1, 0]).transform(place); }\n"
                    "for place in places { show sphere(0.01).move([0, 0, 1]).transform(place); }\n",
              list);
    places.count = (int)krs_component_count(product.scene) / 3;
    assert_true(places.count <= MAX_PLACES);
    for (int i = 0; i < places.count; i++) {
        size_t at = (size_t)i, count = (size_t)places.count;
        places.at[i] = middle_of(product.scene, at);
        places.y[i]  = vec_sub(middle_of(product.scene, count + at), places.at[i]);
        places.z[i]  = vec_sub(middle_of(product.scene, 2 * count + at), places.at[i]);
    }
    product_free(&product);
    return places;
}

/* ---- a path of two parabolas, step by step ---- */

static const Vec path[2][3] = {{{0, 0, 0}, {0.2, 0.1, 1}, {1, 0.6, 1.2}},
                               {{1, 0.6, 1.2}, {1.8, 1.1, 1.4}, {2, 0.3, 2.5}}};

static Vec path_at(double t)
{
    const Vec *part = path[t < 1 ? 0 : 1];
    double     s    = t < 1 ? t : t - 1;
    return vec_mix(vec_mix(part[0], part[1], s), vec_mix(part[1], part[2], s), s);
}

static Vec path_along(double t)
{
    const Vec *part = path[t < 1 ? 0 : 1];
    double     s    = t < 1 ? t : t - 1;
    return vec_unit(vec_sub(vec_mix(part[1], part[2], s), vec_mix(part[0], part[1], s)));
}

static void near(Vec found, Vec truth, double slack, const char *what, int i)
{
    if (!(vec_distance(found, truth) < slack))
        fail_msg("%s of place %d: (%g, %g, %g), truly (%g, %g, %g)", what, i, found.x, found.y,
                 found.z, truth.x, truth.y, truth.z);
}

static Vec across(Vec v, Vec along)
{
    return vec_unit(vec_sub(v, vec_scale(vec_dot(v, along), along)));
}

/* Walks along the path; at each multiple of the step the next place is due. */
static void follow(const Places *places, double step, bool upright)
{
    Vec    up  = across(vec(0, 1, 0), path_along(0));
    double far = 0;
    int    due = 0;
    for (int i = 0; i <= STEPS && due < places->count; i++) {
        double t     = 2.0 * i / STEPS;
        Vec    along = path_along(t);
        far += i ? vec_distance(path_at(t), path_at(t - 2.0 / STEPS)) : 0;
        up = across(upright ? vec(0, 1, 0) : up, along);
        if (far < due * step - 1e-5)
            continue;
        near(places->at[due], path_at(t), 1e-3, "the point", due);
        near(places->z[due], along, 2e-3, "the z axis", due);
        near(places->y[due], up, 2e-3, "the y axis", due);
        due++;
    }
    assert_int_equal(due, places->count);
}

static double path_length(void)
{
    double far = 0;
    for (int i = 1; i <= STEPS; i++)
        far += vec_distance(path_at(2.0 * i / STEPS), path_at(2.0 * (i - 1) / STEPS));
    return far;
}

static Places find_on_path(const char *more)
{
    char list[600];
    snprintf(list, sizeof list,
             "places_along([[[0, 0, 0], [0.2, 0.1, 1], [1, 0.6, 1.2]],"
             " [[1, 0.6, 1.2], [1.8, 1.1, 1.4], [2, 0.3, 2.5]]], %s)",
             more);
    return find_places(list);
}

static void places_are_even_and_do_not_turn(void **state)
{
    (void)state;
    Places places = find_on_path("count: 13");
    assert_int_equal(places.count, 13);
    follow(&places, path_length() / 12, false);
    places = find_on_path("spacing: 0.25");
    assert_int_equal(places.count, (int)(path_length() / 0.25) + 1);
    follow(&places, 0.25, false);
    places = find_on_path("count: 7, upright: true");
    follow(&places, path_length() / 6, true);
}

/* All around, and with the frame of the first place where the way ends. */
static void closed_paths_are_even(void **state)
{
    (void)state;
    const char *circle =
        "places_along(bow([1, 0, 0], [-1, 0, 0], [cos(-1deg), 0, sin(-1deg)]), count: 9)";
    Places arc = find_places(circle);
    assert_int_equal(arc.count, 9);
    for (int i = 0; i < 9; i++) {
        double angle = PI / 180 * 359 * i / 8;
        near(arc.at[i], vec(cos(angle), 0, sin(angle)), 2e-3, "the point", i);
        near(arc.y[i], vec(0, 1, 0), 1e-6, "the y axis", i);
    }
    Places ring = find_places(
        "places_along(spline([[cos(60deg * i), 0.3 * sin(120deg * i + 0.3), sin(60deg * i)]"
        " for i in 0..6], closed: true), count: 60)");
    assert_int_equal(ring.count, 60);
    for (int i = 0; i < 60; i++) { /* from each place to the next all is alike, also at the end */
        int    next = (i + 1) % 60;
        double step = vec_distance(ring.at[i], ring.at[next]);
        if (!(fabs(step - vec_distance(ring.at[0], ring.at[1])) < 0.01 * step) ||
            vec_distance(ring.y[i], ring.y[next]) > 0.2)
            fail_msg("place %d is %g from the next, its y axis %g", i, step,
                     vec_distance(ring.y[i], ring.y[next]));
    }
    Places rounded = find_places(
        "places_along(polyline([[0, 0, 0], [2, 0, 0], [2, 0, 2], [0, 0, 2]],"
        " closed: true), spacing: 0.41)");
    assert_int_equal(rounded.count, 20);
    near(rounded.at[5], vec(2, 0, 0), 1e-3, "the point", 5);
}

/* What repeat_along shows is a copy at each place. */
static void copies_stand_at_places(void **state)
{
    (void)state;
    static const char way[]   = "spline([[0, 0, 0], [1, 1, 1], [3, 0.5, 0], [4, 1.5, -1]])";
    static const char thing[] = "(box([0.3, 0.1, 0.05]) | sphere(0.08).move([0, 0.2, 0.1]))";
    Product           copies  = product_format("show repeat_along(%s, %s, count: 20);", thing, way);
    Product           apart   = product_format("let places = places_along(%s, 20);\n"
                                                           "show union([%s.transform(place) for place in places]);",
                                               way, thing);
    Random            random  = {4};
    for (int i = 0; i < 300; i++) {
        Vec p = vec_add(random_in_cube(&random, 2.2), vec(2, 0.5, 0));
        assert_float_equal(product_distance(&copies, p), product_distance(&apart, p), 1e-9);
    }
    product_free(&copies);
    product_free(&apart);
}

/* ---- at random ---- */

static int count_near(const Places *places, Vec centre, double radius)
{
    int count = 0;
    for (int i = 0; i < places->count; i++)
        count += vec_distance(places->at[i], centre) < radius;
    return count;
}

/* More places leave the others alone; another seed does not. */
static void scattered_places_stay(void **state)
{
    (void)state;
    Places few   = find_places("scattered(200, size: [4, 0, 2], seed: 3)");
    Places many  = find_places("scattered(300, size: [4, 0, 2], seed: 3)");
    Places other = find_places("scattered(200, size: [4, 0, 2], seed: 4)");
    assert_int_equal(few.count, 200);
    assert_int_equal(many.count, 300);
    int same = 0;
    for (int i = 0; i < 200; i++) {
        assert_true(vec_distance(few.at[i], many.at[i]) < 1e-12);
        assert_true(vec_distance(few.z[i], many.z[i]) < 1e-12);
        assert_true(fabs(few.at[i].x) <= 2 && fabs(few.at[i].y) < 1e-12 && fabs(few.at[i].z) <= 1);
        same += vec_distance(few.at[i], other.at[i]) < 0.01;
    }
    assert_true(same < 3);
}

/* As many in one half as in the other, and turned in all directions. */
static void scattered_places_are_even(void **state)
{
    (void)state;
    Places places = find_places("scattered(400, size: [2, 2, 2], seed: 1, scales: [0.5, 2])");
    Vec    sum = vec(0, 0, 0), turned = vec(0, 0, 0);
    double least = HUGE_VAL, most = 0;
    for (int i = 0; i < places.count; i++) {
        sum    = vec_add(sum, places.at[i]);
        turned = vec_add(turned, vec_unit(places.z[i]));
        least  = fmin(least, vec_length(places.z[i]));
        most   = fmax(most, vec_length(places.z[i]));
    }
    assert_true(vec_length(sum) < 0.1 * 400 && vec_length(turned) < 0.15 * 400);
    assert_true(least >= 0.5 && least < 0.52 && most <= 2 && most > 1.98);
    int inner = count_near(&places, vec(0, 0, 0), 1); /* pi / 6 of the cube */
    assert_true(inner > 400 * 0.42 && inner < 400 * 0.62);
}

static void scattered_places_keep_to_the_region(void **state)
{
    (void)state;
    Places disc = find_places(
        "scattered(300, region: circle(1).move([2, 0.5]), seed: 2, apart: 0.1)");
    assert_true(disc.count > 60 && disc.count < 240);
    for (int i = 0; i < disc.count; i++) {
        assert_true(vec_distance(disc.at[i], vec(2, 0, -0.5)) <= 1 + 1e-6);
        for (int k = 0; k < i; k++)
            assert_true(vec_distance(disc.at[i], disc.at[k]) >= 0.1);
    }
    Places ball = find_places("scattered(200, region: sphere(1) - sphere(0.7), seed: 2)");
    for (int i = 0; i < ball.count; i++)
        assert_true(vec_length(ball.at[i]) <= 1 + 1e-6 && vec_length(ball.at[i]) >= 0.7 - 1e-6);
    assert_true(ball.count > 30);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_are_even_and_do_not_turn),
        cmocka_unit_test(closed_paths_are_even),
        cmocka_unit_test(copies_stand_at_places),
        cmocka_unit_test(scattered_places_stay),
        cmocka_unit_test(scattered_places_are_even),
        cmocka_unit_test(scattered_places_keep_to_the_region),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
