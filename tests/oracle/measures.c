/*
 * measures.c: figures of parts against closed forms, and against whether points are inside.
 */
#include "tests/oracle/product.h"
#include "tests/support/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI     3.14159265358979323846
#define ROOT_3 1.73205080756887729353

static KrsMeasures *measure_with(const Product *product, KrsMeasureOptions options)
{
    KrsMeasures *measures;
    assert_int_equal(krs_measure(product->state, &options, &measures), KRS_OK);
    return measures;
}

static void is_near(double found, double expected, double error, const char *what)
{
    if (!(fabs(found - expected) <= error))
        print_message("# %s: %.12g, not %.12g within %g\n", what, found, expected, error);
    assert_true(fabs(found - expected) <= error);
}

/* ---- closed forms ---- */

typedef struct Form {
    const char *text;
    double      volume, center[3], area;
    double      wall; /* INFINITY: there is none */
    double      sure; /* error of the volume that must be proven, relative */
} Form;

static const Form forms[] = {
    {"show box([4, 3, 2]).move([1, 2, 3]);", 24, {1, 2, 3}, 52, 2, 1e-9},
    {"show box([4, 0.004, 4]);", 0.064, {0, 0, 0}, 32.064, 0.004, 1e-9},
    {"show box([4, 3, 0.3]).rotate([1, 2, 3], 40deg).move([5, 0, 0]);",
     3.6,
     {5, 0, 0},
     28.2,
     0.3,
     1e-9},
    {"show sphere(2).move([0, 3, 0]);", 32 * PI / 3, {0, 3, 0}, 16 * PI, 4, 2e-3},
    {"show cylinder(1, 3);", 3 * PI, {0, 0, 0}, 8 * PI, 2, 1e-3},
    {"show torus(1, 0.3);", 2 * PI *PI * 0.09, {0, 0, 0}, 4 * PI *PI * 0.3, 0.6, 5e-3},
    {"show cone(2, 3);", 4 * PI, {0, -0.75, 0}, 4 * PI + 2 * PI * 3.60555127546, INFINITY, 0.2},
    {"show sphere(10) - sphere(9);", 4 * PI / 3 * 271, {0, 0, 0}, 4 * PI * 181, 1, 1e-2},
    {"show box([4, 4, 4]) - box([3, 3, 3.4]);", 64 - 30.6, {0, 0, 0}, 96 + 18 + 40.8, 0.3, 1e-9},
    {"show box([4, 4, 2]) - cylinder(1, 9).rotate([1, 0, 0], 90deg).move([0.7, 0, 0]);",
     32 - 2 * PI,
     {-0.7 * 2 * PI / (32 - 2 * PI), 0, 0},
     64 + 4 * PI - 2 * PI,
     0.3,
     1e-3},
    {"show box([2, 2, 2]); show box([2, 2, 2]).move([1, 0, 0]).paint(#ff0000);",
     12,
     {0.5, 0, 0},
     32,
     2,
     1e-9},
    {"show box([2, 2, 2]); show box([2, 1, 1]).move([2, 0, 0]).paint(#ff0000);",
     10,
     {0.4, 0, 0},
     32,
     1,
     1e-4},
    {"show prism(6, 1, 2);", 3 * ROOT_3, {0, 0, 0}, 12 + 3 * ROOT_3, ROOT_3, 2e-3},
};

static void measures_are_closed_forms(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        const Form  *form    = &forms[i];
        Product      product = product_compile(form->text);
        KrsMeasures *m       = measure_with(&product, (KrsMeasureOptions){.error = 0.004});
        print_message("# %s\n# volume %.9g within %.3g, change %.2g, area %.6g, wall %.12g\n",
                      form->text, m->volume, m->volume_error, m->volume_change, m->area,
                      m->wall.thickness);
        is_near(m->volume, form->volume, m->volume_error, "volume, as proven");
        is_near(m->volume, form->volume, 1e-3 * form->volume, "volume");
        assert_true(m->volume_error <= form->sure * form->volume);
        for (int k = 0; k < 3; k++)
            is_near(m->center[k], form->center[k], m->center_error, "center");
        is_near(m->area, form->area, 3e-3 * form->area, "area");
        if (isinf(form->wall))
            assert_true(isinf(m->wall.thickness));
        else
            is_near(m->wall.thickness, form->wall, 1e-6 * form->wall, "wall");
        krs_measures_free(m);
        product_free(&product);
    }
}

/* The least wall of a ball with a void that is not in its middle, and of a plate with a hole near its side. */
static void walls_are_the_thinnest(void **state)
{
    Random random = {77};
    (void)state;
    for (int i = 0; i < 8; i++) {
        double  at[3], hole = random_between(&random, 0.2, 0.5), off, expected;
        Product product;
        random_vector(&random, 1, at);
        if (i % 2) {
            double length = sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]);
            off           = random_between(&random, 0.05, 0.3);
            for (int k = 0; k < 3; k++)
                at[k] *= off / length;
            expected = 1 - hole - off;
            product  = product_format("show sphere(1) - sphere(%.17g).move([%.17g, %.17g, %.17g]);",
                                      hole, at[0], at[1], at[2]);
        } else {
            off      = random_between(&random, 0.02, 0.3);
            expected = off;
            product  = product_format(
                 "show (box([3, 2, 4]) - cylinder(%.17g, 9).move([%.17g, 0, 0.1]))"
                  ".rotate([%.6f, %.6f, 2], 50deg);",
                 hole, 1.5 - hole - off, at[0], at[1]);
        }
        KrsMeasures *m = measure_with(
            &product, (KrsMeasureOptions){.error = 0.03, .nozzle = 1.01 * expected});
        double length = 0;
        for (int k = 0; k < 3; k++)
            length += pow(m->wall.to[k] - m->wall.from[k], 2);
        is_near(m->wall.thickness, expected, 1e-6, "thinnest wall");
        is_near(sqrt(length), expected, 1e-6, "its ends");
        krs_measures_free(m);
        product_free(&product);
    }
}

/* ---- how they lie ---- */

typedef struct Lie {
    const char *text;
    double      degrees; /* of the overhang */
    double      up[3];
    double      base, overhang, error; /* as it is */
    double      best[3];               /* upwards; 0, 0, 0: none stands */
    double      best_overhang;
} Lie;

static const Lie lies[] = {
    /* A slab on a post; on its head nothing hangs over. */
    {"show box([4, 4, 1]).move([0, 0, 2]) | box([1, 1, 3]);",
     45,
     {0, 0, 1},
     1,
     15,
     1e-9,
     {0, 0, -1},
     0},
    /* A plate that leans by 30 and by 60 degrees from upright. */
    {"show box([4, 0.5, 3]).rotate([1, 0, 0], 30deg);", 45, {0, 0, 1}, 0, 2, 1e-9, {1, 0, 0}, 0},
    {"show box([4, 0.5, 3]).rotate([1, 0, 0], 60deg);", 45, {0, 0, 1}, 0, 12, 1e-9, {1, 0, 0}, 0},
    {"show box([4, 0.5, 3]).rotate([1, 0, 0], 60deg);", 61, {0, 0, 1}, 0, 0, 1e-9, {1, 0, 0}, 0},
    /* Cones on their tips: they lean by 45 degrees and a bit more or less. */
    {"show cone(2, 2.1).rotate([1, 0, 0], -90deg);", 45, {0, 0, 1}, 0, 0, 1e-3, {0, 0, -1}, 0},
    {"show cone(2.1, 2).rotate([1, 0, 0], -90deg);",
     45,
     {0, 0, 1},
     0,
     2.1 * 2.9 * PI,
     0.03,
     {0, 0, -1},
     0},
    {"show cone(2, 2.1);", 45, {0, -1, 0}, 0, 0, 1e-3, {0, 1, 0}, 0},
    /* A ball: 2 pi r^2 (1 - sin(angle)). */
    {"show sphere(1);", 45, {0, 0, 1}, 0, 2 * PI * 0.292893218813, 0.02, {0, 0, 0}, 0},
    {"show sphere(1);", 30, {0, 1, 1}, 0, PI, 0.03, {0, 0, 0}, 0},
    /* Its center is not above its foot. */
    {"show box([1, 1, 1]) | box([8, 1, 1]).move([3.5, 0, 1]);",
     45,
     {0, 0, 1},
     1,
     7,
     1e-9,
     {0, 0, -1},
     0},
    {"show cylinder(1, 3);", 45, {0, 1, 0}, PI, 0, 0.02, {0, 1, 0}, 0},
};

static bool is_same_way(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] > 0.9999;
}

static void parts_lie_as_they_should(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        const Lie        *lie     = &lies[i];
        Product           product = product_compile(lie->text);
        KrsMeasureOptions options = {.error = 0.004, .overhang = lie->degrees * PI / 180};
        memcpy(options.up, lie->up, sizeof options.up);
        KrsMeasures *m = measure_with(&product, options);
        print_message("# %s: base %.6g, overhang %.6g; best [%.3g, %.3g, %.3g]\n", lie->text,
                      m->as_is.base, m->as_is.overhang, m->orientations[0].up[0],
                      m->orientations[0].up[1], m->orientations[0].up[2]);
        is_near(m->as_is.base, lie->base, 0.02 * lie->base + 2e-3, "base");
        is_near(m->as_is.overhang, lie->overhang, lie->error, "overhang");
        bool none = lie->best[0] == 0 && lie->best[1] == 0 && lie->best[2] == 0;
        assert_int_equal(m->orientations[0].stands, !none);
        if (!none) {
            bool found = false;
            for (size_t k = 0; k < m->orientation_count; k++) /* others may be as good */
                found = found || (is_same_way(m->orientations[k].up, lie->best) &&
                                  m->orientations[k].stands &&
                                  fabs(m->orientations[k].overhang - m->orientations[0].overhang) <=
                                      0.002 * m->area);
            assert_true(found);
            is_near(m->orientations[0].overhang, lie->best_overhang, 0.002 * m->area, "best");
        }
        krs_measures_free(m);
        product_free(&product);
    }
    Product      product = product_compile(lies[9].text);
    KrsMeasures *m       = measure_with(&product, (KrsMeasureOptions){0});
    assert_false(m->as_is.stands);
    krs_measures_free(m);
    product_free(&product);
}

/* A brick that was turned at random lies best on a face, in the direction of which it was turned. */
static void turned_bricks_are_found_flat(void **state)
{
    Random random = {5};
    (void)state;
    for (int i = 0; i < 5; i++) {
        double axis[3], angle = random_between(&random, 10, 170);
        random_vector(&random, 1, axis);
        Product product = product_format("show (box([4, 4, 1]).move([0, 0, 2]) | box([1, 1, 3]))"
                                         ".rotate([%.9f, %.9f, %.9f], %.9fdeg);",
                                         axis[0], axis[1], axis[2], angle);
        KrsMeasures *m  = measure_with(&product, (KrsMeasureOptions){0});
        is_near(m->volume, 19, 1e-9, "volume");
        is_near(m->orientations[0].overhang, 0, 1e-9, "overhang");
        is_near(m->orientations[0].base, 16, 1e-6, "base");
        is_near(m->orientations[0].height, 4, 1e-6, "height");
        krs_measures_free(m);
        product_free(&product);
    }
}

/* ---- random solids ---- */

static void write_part(SceneText *text, Random *random)
{
    static const char *const parts[] = {"box([%.3f, %.3f, %.3f])",
                                        "cylinder(%.3f, %.3f)",
                                        "sphere(%.3f)",
                                        "torus(1.2 * %.3f, 0.4 * %.3f)",
                                        "prism(5, %.3f, %.3f)",
                                        "box([%.3f, %.3f, %.3f]).round(0.1)",
                                        "capsule([0, 0, 0], [%.3f, %.3f, 0.1], 0.3)",
                                        "ellipsoid([%.3f, %.3f, %.3f])"};
    double                   sizes[3], at[3], axis[3];
    for (int k = 0; k < 3; k++)
        sizes[k] = random_between(random, 0.5, 1.5);
    random_vector(random, 1, at);
    random_vector(random, 1, axis);
    scene_write(text, "(");
    char part[256];
    snprintf(part, sizeof part, parts[random_below(random, sizeof parts / sizeof *parts)], sizes[0],
             sizes[1], sizes[2]);
    scene_write(text, "%s.rotate([%.3f, %.3f, %.3f], %.3f).move([%.3f, %.3f, %.3f]))", part,
                axis[0], axis[1], axis[2] + 2, random_between(random, -3, 3), at[0], at[1], at[2]);
}

/* Counts points: the volume and the center, which share nothing with cells. */
static void solids_hold_as_many_points(void **state)
{
    enum { SOLIDS = 8, POINTS = 40000 };
    static double points[POINTS][3], distances[POINTS];
    Random        random = {1234};
    (void)state;
    for (int i = 0; i < SOLIDS; i++) {
        SceneText text = {.length = 0};
        scene_write(&text, "show ");
        write_part(&text, &random);
        for (int k = 1 + random_below(&random, 3); k > 0; k--) {
            scene_write(&text, "%s", k == 1 ? " - " : " | ");
            write_part(&text, &random);
        }
        scene_write(&text, ";");
        Product      product = product_compile(text.bytes);
        KrsMeasures *m       = measure_with(&product, (KrsMeasureOptions){.error = 0.08});
        if (m->volume == 0) {
            krs_measures_free(m);
            product_free(&product);
            continue;
        }
        double box = 1, inside = 0, center[3] = {0};
        for (int k = 0; k < 3; k++)
            box *= m->high[k] - m->low[k];
        for (int p = 0; p < POINTS; p++)
            for (int k = 0; k < 3; k++)
                points[p][k] = random_between(&random, m->low[k], m->high[k]);
        krs_distance(product.state, (const double(*)[3])points, POINTS, distances);
        for (int p = 0; p < POINTS; p++)
            if (distances[p] <= 0) {
                inside++;
                for (int k = 0; k < 3; k++)
                    center[k] += points[p][k];
            }
        double part = inside / POINTS, deviation = box * sqrt(part * (1 - part) / POINTS);
        print_message("# %s\n# %.6g within %.2g; by points %.6g\n", text.bytes, m->volume,
                      m->volume_error, box * part);
        is_near(m->volume, box * part, 4.5 * deviation + m->volume_error, "volume");
        assert_true(m->volume_change <= m->volume_error);
        for (int k = 0; k < 3; k++)
            is_near(m->center[k], center[k] / inside,
                    4.5 * (m->high[k] - m->low[k]) / sqrt(12 * inside) + m->center_error, "center");
        krs_measures_free(m);
        product_free(&product);
    }
}

/* ---- what is asked for ---- */

static void options_are_kept(void **state)
{
    Product product = product_compile(
        "let ball = sphere(1); show ball; let cube = box([2, 2, 2])"
        ".move([5, 0, 0]); show cube; show half_space([0, 1, 0], -1);");
    KrsMeasures *m;
    (void)state;
    assert_int_equal(krs_measure(product.state, NULL, &m), KRS_BAD_ARGUMENT); /* it has no end */
    assert_null(m);
    m = measure_with(&product, (KrsMeasureOptions){.component = 2});
    is_near(m->volume, 8, 1e-9, "of a component");
    krs_measures_free(m);
    m = measure_with(
        &product,
        (KrsMeasureOptions){.component = 2, .within = true, .low = {5, -9, -9}, .high = {9, 9, 9}});
    is_near(m->volume, 4, m->volume_error, "within a box, as proven");
    is_near(m->volume, 4, 4e-3, "within a box");
    is_near(m->low[0], 5, 1e-9, "its side");
    krs_measures_free(m);
    KrsMeasureOptions wrong[] = {{.component = 9},
                                 {.component = 1, .nozzle = -1},
                                 {.component = 1, .overhang = 4},
                                 {.component = 1, .up = {NAN, 0, 0}},
                                 {.component = 1, .error = -1}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(krs_measure(product.state, &wrong[i], &m), KRS_BAD_ARGUMENT);
    product_free(&product);
    product = product_compile("show intersection(sphere(1), sphere(1).move([9, 0, 0]));");
    m       = measure_with(&product, (KrsMeasureOptions){0});
    assert_true(m->volume == 0 && m->area == 0);
    krs_measures_free(m);
    product_free(&product);
}

static bool stop_later(void *user, double fraction)
{
    double *least = user;
    assert_true(fraction >= 0 && fraction <= 1);
    return fraction < *least;
}

static void work_can_be_stopped(void **state)
{
    Product product = product_compile("show sphere(1) - sphere(0.5);");
    (void)state;
    for (double part = 0; part < 1; part += 0.24) {
        KrsMeasures *m;
        assert_int_equal(krs_measure(product.state,
                                     &(KrsMeasureOptions){.progress = stop_later, .user = &part},
                                     &m),
                         KRS_INTERRUPTED);
        assert_null(m);
    }
    product_free(&product);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(measures_are_closed_forms),
        cmocka_unit_test(walls_are_the_thinnest),
        cmocka_unit_test(parts_lie_as_they_should),
        cmocka_unit_test(turned_bricks_are_found_flat),
        cmocka_unit_test(solids_hold_as_many_points),
        cmocka_unit_test(options_are_kept),
        cmocka_unit_test(work_can_be_stopped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
