/*
 * lofts.c: lofts against their definition: at each height the mean of two distances, which are known
 * in closed form here, decides what is inside; or, between convex polygons, the means of their points.
 */
#include <stdio.h>

#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

enum { MAX_FIXTURES = 3, POINTS = 400 };

/* A rectangle with round corners at a level; the rectangle may be a point. */
typedef struct Fixture {
    double wide, high, radius, shift, level;
} Fixture;

typedef struct Loft {
    Fixture fixtures[MAX_FIXTURES];
    int     count;
    double  height;
} Loft;

static double fixture_distance(const Fixture *fixture, Vec p)
{
    double x = fabs(p.x - fixture->shift) - fixture->wide, y = fabs(p.y) - fixture->high;
    return hypot(fmax(x, 0), fmax(y, 0)) + fmin(fmax(x, y), 0) - fixture->radius;
}

static bool in_loft(const void *user, Vec p)
{
    const Loft *loft = user;
    double      at   = p.z / loft->height + 0.5;
    if (!(at >= 0 && at <= 1))
        return false;
    int i = 0;
    while (i + 2 < loft->count && at > loft->fixtures[i + 1].level)
        i++;
    const Fixture *from = &loft->fixtures[i], *to = from + 1;
    double         t = (at - from->level) / (to->level - from->level);
    return (1 - t) * fixture_distance(from, p) + t * fixture_distance(to, p) <= 0;
}

static Product loft_product(const Loft *loft)
{
    SceneText text = {.length = 0};
    scene_write(&text, "show loft([");
    for (int i = 0; i < loft->count; i++) {
        const Fixture *s = &loft->fixtures[i];
        if (s->wide > 0)
            scene_write(&text, "%srectangle([%.17g, %.17g]).offset(%.17g)", i ? ", " : "",
                        2 * s->wide, 2 * s->high, s->radius);
        else
            scene_write(&text, "%scircle(%.17g)", i ? ", " : "", s->radius);
        scene_write(&text, ".move([%.17g, 0])", s->shift);
    }
    scene_write(&text, "], %.17g, levels: [", loft->height);
    for (int i = 0; i < loft->count; i++)
        scene_write(&text, "%s%.17g", i ? ", " : "", loft->fixtures[i].level);
    scene_write(&text, "]);");
    return product_compile(text.bytes);
}

static const Loft lofts[] = {
    {{{0, 0, 0.5, 0, 0}, {0.5, 0.5, 0, 0, 1}}, 2, 1},
    {{{0, 0, 0.9, 0, 0}, {0, 0, 0.2, 0, 1}}, 2, 0.4},
    {{{0.6, 0.2, 0.1, 0, 0}, {0.1, 0.5, 0.05, 0.3, 0.6}, {0, 0, 0.4, -0.2, 1}}, 3, 1.6},
};

static void lofts_are_their_definition(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof lofts / sizeof *lofts; i++) {
        Product product = loft_product(&lofts[i]);
        Trial   trial   = {product_field, &product, in_loft, &lofts[i],
                           vec(0, 0, 0),  1.5,      POINTS,  3 + i};
        judge_acquits(&trial, "loft");
        judge_refutes_steeper(&trial, 1.6, "loft");
        product_free(&product);
    }
}

/* ---- between convex polygons ---- */

enum { MAX_RING = 6, MAX_MEANS = MAX_RING * MAX_RING };

typedef struct Ring {
    double at[MAX_RING][2];
    int    count;
    double level;
} Ring;

typedef struct FlatLoft {
    Ring   rings[MAX_FIXTURES];
    int    count;
    double height;
} FlatLoft;

/* Tells whether all points are on one side of a line from a point of the plane through one of them. */
static bool is_outside(double (*points)[2], int count, const double at[2])
{
    for (int i = 0; i < count; i++) {
        bool left = true, right = true;
        for (int k = 0; k < count; k++) {
            double side = (points[i][0] - at[0]) * (points[k][1] - at[1]) -
                          (points[i][1] - at[1]) * (points[k][0] - at[0]);
            left  = left && side >= 0;
            right = right && side <= 0;
        }
        if (left || right)
            return true;
    }
    return false;
}

static bool in_flat_loft(const void *user, Vec p)
{
    const FlatLoft *loft = user;
    double          at   = p.z / loft->height + 0.5, means[MAX_MEANS][2];
    int             i = 0, count = 0;
    if (!(at >= 0 && at <= 1))
        return false;
    while (i + 2 < loft->count && at > loft->rings[i + 1].level)
        i++;
    const Ring *from = &loft->rings[i], *to = from + 1;
    double      t = (at - from->level) / (to->level - from->level);
    for (int a = 0; a < from->count; a++)
        for (int b = 0; b < to->count; b++, count++)
            for (int k = 0; k < 2; k++)
                means[count][k] = (1 - t) * from->at[a][k] + t * to->at[b][k];
    return !is_outside(means, count, (double[2]){p.x, p.y});
}

static Product flat_loft_product(const FlatLoft *loft)
{
    SceneText text = {.length = 0};
    scene_write(&text, "show loft([");
    for (int i = 0; i < loft->count; i++) {
        scene_write(&text, "%spolygon([", i ? ", " : "");
        for (int k = 0; k < loft->rings[i].count; k++)
            scene_write(&text, "%s[%.17g, %.17g]", k ? ", " : "", loft->rings[i].at[k][0],
                        loft->rings[i].at[k][1]);
        scene_write(&text, "])");
    }
    scene_write(&text, "], %.17g, levels: [", loft->height);
    for (int i = 0; i < loft->count; i++)
        scene_write(&text, "%s%.17g", i ? ", " : "", loft->rings[i].level);
    scene_write(&text, "]);");
    return product_compile(text.bytes);
}

/* Corners of an ellipse somewhere, either way around. */
static FlatLoft random_flat_loft(Random *random)
{
    static const double levels[2][MAX_FIXTURES] = {{0, 1, 1}, {0, 0.4, 1}};
    FlatLoft            loft = {.count = random_between(random, 0, 1) < 0.5 ? 2 : 3};
    loft.height              = random_between(random, 0.4, 1.6);
    for (int i = 0; i < loft.count; i++) {
        Ring  *ring = &loft.rings[i];
        double turn = random_between(random, 0, 7), wide = random_between(random, 0.2, 0.8),
               high = random_between(random, 0.2, 0.8), aside = random_between(random, -0.3, 0.3);
        int way     = random_between(random, 0, 1) < 0.5 ? 1 : -1;
        ring->count = 3 + (int)random_between(random, 0, MAX_RING - 2.001);
        ring->level = levels[loft.count - 2][i];
        for (int k = 0; k < ring->count; k++) {
            double angle   = turn + way * 2 * acos(-1) * k / ring->count;
            ring->at[k][0] = wide * cos(angle) + aside;
            ring->at[k][1] = high * sin(angle);
        }
    }
    return loft;
}

static void lofts_of_polygons_are_means(void **state)
{
    (void)state;
    Random random = {11};
    for (uint64_t i = 0; i < 12; i++) {
        FlatLoft loft    = random_flat_loft(&random);
        Product  product = flat_loft_product(&loft);
        Trial    trial   = {product_field, &product, in_flat_loft, &loft,
                            vec(0, 0, 0),  1.5,      POINTS,       30 + i};
        judge_acquits(&trial, "loft of polygons");
        judge_refutes_steeper(&trial, 1.6, "loft of polygons");
        product_free(&product);
    }
}

/* Corners are those of convex polygons alone; parameters may say where they are. */
static void corners_are_of_convex_polygons(void **state)
{
    (void)state;
    Product product = product_compile(
        "param w = 1 in [0.5, 2];\n"
        "def has(figure, n) = assert(len(figure.corners()) == n, n) in true;\n"
        "let checks = [\n"
        "    has(rectangle([w, 1]).rotate(20deg * w).move([w, 0]), 4), has(regular(7, w), 7),\n"
        "    has(polygon([[0, 0], [1, 0], [1, 1]]).paint(red), 3),\n"
        "    has(polygon([[0, 0], [1, 1], [1, 0]]).scale([2, 0.5]), 3),\n"
        "    has(polygon([[0, 0], [1, 0], [2, 0], [2, 2]]), 4), has(circle(1), 0),\n"
        "    has(polygon([[0, 0], [2, 0], [0.5, 0.5], [0, 2]]), 0), has(star(5, 1, 0.4), 0),\n"
        "    has(polygon([[0, 0], [1, 1], [1, 0], [0, 1]]), 0), has(rectangle([1, 1]).round(0.1), "
        "0),\n"
        "    has(polygon([[0, 0], [w, 0], [1, 1]]), 0), has(regular(129, 1), 0),\n"
        "    has(polygon([[cos(144deg * i), sin(144deg * i)] for i in 0..5]), 0),\n"
        "    has(rectangle([1, 1]) | rectangle([1, 1]).move([3, 0]), 0), has(sphere(1), 0)];\n"
        "show sphere(1 + len(checks));\n");
    product_free(&product);
}

/* ---- slopes ---- */

/* From a cone the bound differs by how much steeper than its own slope its walls may be. */
static void lofts_are_sharp(void **state)
{
    (void)state;
    Product product = product_format("show loft([circle(0.9), circle(0.2)], 0.4);");
    double  slope   = hypot(1, 0.7 / 0.4);
    for (int i = 0; i < 50; i++) {
        double z = -0.15 + 0.006 * i, out = 0.9 - 0.7 * (z / 0.4 + 0.5) + 0.002;
        double truth = 0.002 / slope,
               found = product_distance(&product, vec(out * 0.6, out * 0.8, z));
        if (out > 0.9) /* outside of the box */
            continue;
        if (!(found <= truth * 1.000001 && found > 0.94 * truth))
            fail_msg("at height %g: %g, truly %g", z, found, truth);
    }
    product_free(&product);
}

/* Tables of corners have the distances that a mean needs, also where it is far from all of them. */
static void many_corners_are_mixed_as_well(void **state)
{
    (void)state;
    Product many = product_compile(
        "show loft([polygon([[cos(4deg * i), sin(4deg * i)] for i in 0..90]), circle(0.3)], 2);");
    Product few    = product_compile("show loft([regular(90, 1).rotate(-90deg), circle(0.3)], 2);");
    Random  random = {5};
    for (int i = 0; i < 500; i++) {
        Vec    point = random_in_cube(&random, 1.4);
        double a = product_distance(&many, point), b = product_distance(&few, point);
        if (!(fabs(a - b) < 0.01))
            fail_msg("at (%g, %g, %g): %g by a table, %g by a formula", point.x, point.y, point.z,
                     a, b);
    }
    product_free(&many);
    product_free(&few);
}

/* `extremes` holds of closed forms, and is not much wider. */
static void extremes_are_bounds(void **state)
{
    (void)state;
    Product product = product_compile(
        "param r = 1 in [0.5, 2];\n"
        "def near(found, low, high, slack) =\n"
        "    assert(found[0] <= low and found[0] >= low - slack, found[0], low) in\n"
        "    assert(found[1] >= high and found[1] <= high + slack, found[1], high) in true;\n"
        "let checks = [\n"
        "    near(extremes(x * y, [-1, -1], [2, 1]), -2, 2, 0.1),\n"
        "    near(extremes(length(p), [1, 1, 1], [2, 2, 2]), sqrt(3), sqrt(12), 0.1),\n"
        "    near(extremes(sin(x) + cos(x), [0, 0], [1.5, 0]), 1, sqrt(2), 0.05),\n"
        "    near(extremes(r * x, [0, 0], [1, 1]), 0, 2, 0.1),\n"
        "    near(extremes(r * x, [0, 0], [1, 1], slope: 2), 0, 2, 0.1),\n"
        "    near(extremes(floor(x), [0.5, 0], [2.5, 0]), 0, 2, 1e-9),\n"
        "    near(extremes(x - x * x, [0, 0], [1, 1], slope: 1), 0, 0.25, 0.02),\n"
        "    near(extremes(rectangle([1, 1]).distance([x, y]) - circle(0.5).distance([x, y]),\n"
        "                  [-0.5, -0.5], [0.5, 0.5], slope: 2), 0.5 - sqrt(0.5), 0, 0.04)];\n"
        "show sphere(1 + len(checks));\n");
    product_free(&product);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lofts_are_their_definition),
        cmocka_unit_test(lofts_of_polygons_are_means),
        cmocka_unit_test(corners_are_of_convex_polygons),
        cmocka_unit_test(lofts_are_sharp),
        cmocka_unit_test(many_corners_are_mixed_as_well),
        cmocka_unit_test(extremes_are_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
