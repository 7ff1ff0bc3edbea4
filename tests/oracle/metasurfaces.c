/*
 * metasurfaces.c: metasurfaces against what they are defined by.
 *
 * A metasurface is a sum of falloffs that are written down here again; where it is crossed is found
 * by bisection along rays in all directions.  Its bound is never above the truth.
 */
#include "tests/oracle/product.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Blob {
    Vec    centre;
    double radius;
} Blob;

typedef struct Meta {
    int    kind;
    double level, reach;
    Blob   blobs[12];
    int    count;
} Meta;

static const char *const falloffs[] = {"wyvill", "soft", "gaussian", "exponential"};

static double falloff(int kind, double t)
{
    if (t >= 1)
        return 0;
    double u = t * t;
    switch (kind) {
    case 0: return pow(1 - u, 3);
    case 1: return 1 - 22.0 / 9 * u + 17.0 / 9 * u * u - 4.0 / 9 * u * u * u;
    case 2: return (exp(-4 * u) - exp(-4)) / (1 - exp(-4));
    default: return (exp(-4 * t) - exp(-4)) / (1 - exp(-4));
    }
}

static double excess(const Meta *meta, Vec p)
{
    double sum = -meta->level;
    for (int i = 0; i < meta->count; i++) {
        double distance = vec_distance(p, meta->blobs[i].centre) - meta->blobs[i].radius;
        sum += falloff(meta->kind, fmax(distance, 0) / meta->reach);
    }
    return sum;
}

static Meta meta_new(Random *random, int kind, char *text, size_t size)
{
    Meta   meta = {.kind = kind, .count = 1 + random_below(random, 12)};
    size_t used = 0;
    meta.level  = random_between(random, 0.1, 1.2);
    meta.reach  = random_between(random, 0.3, 1.5);
    used += (size_t)snprintf(text, size, "meta([");
    for (int i = 0; i < meta.count; i++) {
        Blob b        = {random_in_cube(random, 1.2), random_between(random, 0.05, 0.5)};
        meta.blobs[i] = b;
        used += (size_t)snprintf(text + used, size - used,
                                 "%ssphere(%.17g).move([%.17g, %.17g, %.17g])", i ? ", " : "",
                                 b.radius, b.centre.x, b.centre.y, b.centre.z);
    }
    snprintf(text + used, size - used, "], level: %.17g, falloff: \"%s\", reach: %.17g)",
             meta.level, falloffs[kind], meta.reach);
    return meta;
}

/* Returns the shortest way along `rays` rays to where the sum crosses the level; infinite if none
   does. */
static double distance_to_surface(const Meta *meta, Random *random, Vec p, int rays)
{
    enum { STEPS = 200 };
    double nearest = INFINITY, own = excess(meta, p);
    for (int i = 0; i < rays; i++) {
        Vec    direction = random_unit(random);
        double farthest = fmin(nearest, 4), low = 0, high = 0;
        for (int k = 1; k <= STEPS && high == 0; k++) {
            double t = farthest * k / STEPS;
            if ((excess(meta, vec_add(p, vec_scale(t, direction))) > 0) != (own > 0))
                high = t;
            else
                low = t;
        }
        for (int k = 0; k < 50 && high > 0; k++) {
            double t = (low + high) / 2;
            if ((excess(meta, vec_add(p, vec_scale(t, direction))) > 0) != (own > 0))
                high = t;
            else
                low = t;
        }
        nearest = high > 0 ? high : nearest;
    }
    return nearest;
}

static void meta_bounds_hold(void **state)
{
    (void)state;
    Random random = {.state = 11};
    for (int trial = 0; trial < 40; trial++) {
        char   text[4000], scene[4100];
        double most = 0, sum = 0;
        Meta   meta = meta_new(&random, trial % 4, text, sizeof text);
        int    near = 0;
        snprintf(scene, sizeof scene, "show %s;", text);
        Product product = product_compile(scene);
        for (int i = 0; i < 150; i++) {
            Vec    p        = random_in_cube(&random, 2.5);
            double d        = product_distance(&product, p),
                   distance = distance_to_surface(&meta, &random, p, 40);
            assert_true((d <= 0) == (excess(&meta, p) >= 0) || fabs(d) < 1e-12);
            assert_true(fabs(d) <= distance);
            most = fmax(most, fabs(d) / distance);
            if (isfinite(distance) && d > 0) {
                sum += d / distance;
                near++;
            }
        }
        assert_true(near < 20 || sum / near > 0.1); /* it is of use */
        product_free(&product);
    }
}

/* From outside to the surface; false when the way leads past it. */
static bool walk_in(const Product *product, Vec direction, Vec *surface)
{
    double t = 0;
    for (int i = 0; i < 4000; i++) {
        *surface = vec_scale(4 - t, direction);
        double d = product_distance(product, *surface);
        if (d < 1e-9)
            return true;
        t += fmax(d, 1e-6);
        if (t > 4)
            return false;
    }
    return false;
}

/* Tells whether the normal there is along an axis, as on the faces of a box. */
static bool is_on_a_face(const Product *product, Vec p)
{
    const double h = 1e-5;
    double       slopes[3], size = 0, most = 0;
    for (int k = 0; k < 3; k++) {
        Vec direction = vec(k == 0 ? h : 0, k == 1 ? h : 0, k == 2 ? h : 0);
        slopes[k]     = product_distance(product, vec_add(p, direction)) -
                    product_distance(product, vec_sub(p, direction));
        size = hypot(size, slopes[k]);
        most = fmax(most, fabs(slopes[k]));
    }
    return most > size * (1 - 1e-5);
}

/* Shapes of which only a bound is known must not count as their boxes; and steps stay safe. */
static void bounds_in_metasurfaces_show_no_box(void **state)
{
    static const char *const scenes[] = {
        "show meta([ellipsoid([1, 0.15, 0.6])]);",
        "show meta([ellipsoid([1.2, 0.3, 0.3]), sphere(0.2).move([0, 0.6, 0])], level: 0.3);",
        "show meta([box([0.4, 1.6, 0.4]).twist([0, 1, 0], 3), sphere(0.3).move([0.8, 0, 0])]);",
    };
    (void)state;
    Random random = {.state = 31};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        Product product = product_compile(scenes[i]);
        int     found = 0, flat = 0;
        for (int k = 0; k < 300; k++) {
            Vec surface;
            if (!walk_in(&product, random_unit(&random), &surface))
                continue;
            found++;
            flat += is_on_a_face(&product, surface);
        }
        if (found < 250 || flat > found / 20)
            fail_msg("%s: of %d points %d on flat faces", scenes[i], found, flat);
        for (int k = 0; k < 300; k++) {
            Vec    p = random_in_cube(&random, 2);
            double d = product_distance(&product, p);
            for (int n = 0; n < 20 && d > 0; n++)
                assert_true(product_distance(&product, random_in_ball(&random, p, 0.999 * d)) > 0);
        }
        product_free(&product);
    }
}

/* Everything solid is in the box, and the distance for blends rises no faster than 1. */
static void meta_is_steady(void **state)
{
    (void)state;
    Random random = {.state = 13};
    for (int trial = 0; trial < 12; trial++) {
        char         text[4000], scene[4200];
        KrsComponent component;
        Meta         meta = meta_new(&random, trial % 4, text, sizeof text);
        snprintf(scene, sizeof scene, "show union(%s, sphere(0.1).move([50, 0, 0]), blend: 0.01);",
                 text);
        Product product = product_compile(scene);
        assert_int_equal(krs_component(product.scene, 0, &component), KRS_OK);
        for (int i = 0; i < 4000; i++) {
            Vec a = random_in_cube(&random, 3);
            Vec b = vec_add(
                a, vec_scale(pow(10, random_between(&random, -5, 0)), random_unit(&random)));
            double da = product_distance(&product, a), db = product_distance(&product, b);
            assert_true(fabs(da - db) <= vec_distance(a, b) * (1 + 1e-9) + 1e-12);
            assert_true((da <= 0) == (excess(&meta, a) >= 0) || fabs(da) < 1e-12);
            if (da <= 0)
                assert_true(a.x >= component.low[0] && a.x <= component.high[0] &&
                            a.y >= component.low[1] && a.y <= component.high[1] &&
                            a.z >= component.low[2] && a.z <= component.high[2]);
        }
        product_free(&product);
    }
}

/* At level 1 the shapes themselves are left, of whatever kind. */
static void meta_of_other_shapes(void **state)
{
    (void)state;
    Random  random = {.state = 17};
    Product meta   = product_compile("show meta([box([1, 2, 0.5]), box([2, 0.4, 1]) - sphere(0.7),"
                                       "  torus(1.5, 0.2)], level: 1, reach: 0.3);");
    Product plain  = product_compile("show union(box([1, 2, 0.5]), box([2, 0.4, 1]) - sphere(0.7),"
                                      "  torus(1.5, 0.2));");
    for (int i = 0; i < 5000; i++) {
        Vec p = random_in_cube(&random, 2);
        if (product_distance(&plain, p) < -1e-9)
            assert_true(product_distance(&meta, p) <= 1e-12);
    }
    product_free(&meta);
    product_free(&plain);
    Product none = product_compile("show meta([]); show sphere(1);");
    assert_true(fabs(product_distance(&none, vec(3, 0, 0)) - 2) < 1e-9);
    product_free(&none);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(meta_bounds_hold),
        cmocka_unit_test(bounds_in_metasurfaces_show_no_box),
        cmocka_unit_test(meta_is_steady),
        cmocka_unit_test(meta_of_other_shapes),
    };
    return cmocka_run_group_tests_name("metasurfaces", tests, NULL, NULL);
}
