/*
 * normals.c: smooth mirrors, and what materials know of a surface: its normal, its u and v.
 *
 * Normals behind mirrors are held against the product of matrices that math.md writes down,
 * multiplied out here for every point, and on a ridge against the bisector.  Materials paint the
 * normal as a colour onto balls that are then moved, turned, stretched and copied: the colour of
 * a point must be the place on the ball that the point came from.
 */
#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

#include <stdio.h>
#include <string.h>

/* ---- mirrors ---- */

enum { MAX_MIRRORS = 6 };

/* Balls, one before the first mirror and one after each; after a mirror all is scaled and turned
   about AXIS. */
typedef struct Chain {
    int    mirrors;
    Half   mirror[MAX_MIRRORS];
    Vec    centre[MAX_MIRRORS + 1];
    double radius, scale, angle;
} Chain;

static const Vec AXIS = {1, 2, 3};

static Chain random_chain(Random *random, double scale)
{
    Chain chain  = {.mirrors = 1 + random_below(random, MAX_MIRRORS),
                    .scale   = scale,
                    .angle   = scale == 1 ? 0 : random_between(random, -1, 1)};
    chain.radius = random_between(random, 0.3, 0.8);
    for (int i = 0; i <= chain.mirrors; i++)
        chain.centre[i] = random_in_cube(random, 1);
    for (int i = 0; i < chain.mirrors; i++)
        chain.mirror[i] = (Half){random_unit(random), random_between(random, -0.2, 0.8)};
    return chain;
}

static Product compile_chain(const Chain *chain, const char *smoothing)
{
    SceneText text = {.length = 0};
    scene_write(&text, "show krs {\n");
    for (int i = 0; i <= chain->mirrors; i++) {
        const Vec *c = &chain->centre[i];
        scene_write(&text, "kernel sphere(%.17g).move([%.17g, %.17g, %.17g]);\n", chain->radius,
                    c->x, c->y, c->z);
        if (i == chain->mirrors)
            break;
        const Half *m = &chain->mirror[i];
        scene_write(&text, "reflect plane([%.17g, %.17g, %.17g], %.17g);\n", m->normal.x,
                    m->normal.y, m->normal.z, m->offset);
        scene_write(&text, "mobius rotate([%g, %g, %g], %.17g) * scale(%.17g);\n", AXIS.x, AXIS.y,
                    AXIS.z, chain->angle, chain->scale);
    }
    scene_write(&text, "}%s;\n", smoothing);
    return product_compile(text.bytes);
}

/* v less `share` twice its part along the axis: the matrix S of math.md. */
static Vec reflect(Vec v, Vec axis, double share)
{
    return vec_sub(v, vec_scale(2 * share * vec_dot(v, axis), axis));
}

typedef struct Expected {
    Vec    hard, smooth;
    double distance; /* to the nearest ball, in world units */
    double margin;   /* how much farther the next is; how far from a mirror */
} Expected;

/* Follows the point through the mirrors to every ball; the normal of the nearest comes back by
   whole reflections, and by shares of them. */
static Expected expect(const Chain *chain, Vec point, double width)
{
    Expected result = {.distance = HUGE_VAL, .margin = HUGE_VAL};
    double   excess[MAX_MIRRORS], stretch = 1, to_world[MAX_MIRRORS];
    for (int level = chain->mirrors; level >= 0; level--) {
        Vec    offset   = vec_sub(point, chain->centre[level]);
        double distance = stretch * (vec_length(offset) - chain->radius);
        result.margin   = fmin(result.margin, fabs(distance - result.distance));
        if (distance < result.distance) {
            result.distance = distance;
            result.hard = result.smooth = vec_unit(offset);
            for (int i = level; i < chain->mirrors; i++) {
                double share  = fmin(fmax(excess[i] * to_world[i] / width + 0.5, 0), 1);
                Vec    axis   = chain->mirror[i].normal;
                Vec    about  = vec_unit(AXIS);
                result.hard   = reflect(result.hard, axis, excess[i] > 0);
                result.smooth = reflect(result.smooth, axis, share);
                result.hard   = vec_rotate(result.hard, about, chain->angle);
                result.smooth = vec_rotate(result.smooth, about, chain->angle);
            }
        }
        if (level == 0)
            break;
        stretch *= chain->scale;
        point = vec_rotate(vec_scale(1 / chain->scale, point), vec_unit(AXIS), -chain->angle);
        excess[level - 1]   = half_excess(chain->mirror[level - 1], point);
        to_world[level - 1] = stretch;
        result.margin       = fmin(result.margin, fabs(excess[level - 1]));
        point               = vec_sub(point,
                                      vec_scale(2 * fmax(excess[level - 1], 0), chain->mirror[level - 1].normal));
    }
    result.smooth = vec_unit(result.smooth);
    return result;
}

static void is_near(const double found[3], Vec expected, double tolerance, const char *what)
{
    double off = vec_distance(vec(found[0], found[1], found[2]), expected);
    if (!(off <= tolerance))
        fail_msg("%s is (%.9g, %.9g, %.9g), not (%.9g, %.9g, %.9g)", what, found[0], found[1],
                 found[2], expected.x, expected.y, expected.z);
}

static void mirrors_are_smooth(void **state)
{
    (void)state;
    Random random  = {4};
    int    blended = 0, checked = 0;
    for (int trial = 0; trial < 60; trial++) {
        double width = trial % 3 ? 0.4 : 0.05, scale = trial % 2 ? 1 : 0.8;
        Chain  chain = random_chain(&random, scale);
        char   smoothing[60];
        snprintf(smoothing, sizeof smoothing, ".smooth_mirrors(%.17g)", width);
        Product smooth = compile_chain(&chain, smoothing), hard = compile_chain(&chain, "");
        Product pixel = compile_chain(&chain, ".smooth_mirrors()");
        for (int i = 0; i < 60; i++) {
            Vec      point  = random_in_cube(&random, 2);
            Expected should = expect(&chain, point, width);
            if (should.margin < 1e-4)
                continue;
            KrsHit hit = product_probe(&smooth, point), plain = product_probe(&hard, point);
            KrsHit fine = product_probe(&pixel, point);
            assert_true(fabs(hit.distance - should.distance) <= 1e-9);
            is_near(plain.normal, should.hard, 1e-5, "the gradient");
            is_near(plain.shading, should.hard, 1e-5, "the normal of a hard mirror");
            is_near(fine.shading, should.hard, 1e-5, "the normal where a pixel is a point");
            is_near(hit.normal, should.hard, 1e-5, "the gradient under smooth mirrors");
            is_near(hit.shading, should.smooth, 2e-4, "the normal of smooth mirrors");
            blended += vec_distance(should.smooth, should.hard) > 0.02;
            checked++;
        }
        product_free(&smooth);
        product_free(&hard);
        product_free(&pixel);
    }
    print_message("# %d normals, %d of them between two sides\n", checked, blended);
    assert_true(checked > 2500 && blended > 300);
}

/* On a mirror both sides' normals meet in their bisector, whatever the width; a mirror that looks
   straight along the normal leaves nothing of it, and the hard one stands in. */
static void ridges_have_the_bisector(void **state)
{
    (void)state;
    Product product = product_format("show krs { kernel sphere(1).move([-0.6, 0.1, 0.2]);"
                                     " reflect plane([1, 0, 0], 0); }.smooth_mirrors(0.3);");
    Random  random  = {5};
    for (int i = 0; i < 200; i++) {
        double angle = random_between(&random, 0, 7);
        Vec    point = vec(0, 0.1 + 0.8 * cos(angle), 0.2 + 0.8 * sin(angle));
        Vec    left  = vec_unit(vec_sub(point, vec(-0.6, 0.1, 0.2)));
        Vec    right = vec_unit(vec_sub(point, vec(0.6, 0.1, 0.2)));
        is_near(product_probe(&product, point).shading, vec_unit(vec_add(left, right)), 1e-6,
                "the normal on the ridge");
    }
    product_free(&product);
    product    = product_format("show krs { kernel plane([1, 0, 0], 0);"
                                   " reflect plane([1, 0, 0], 0); }.smooth_mirrors(0.3);");
    KrsHit hit = product_probe(&product, vec(-1e-4, 0.3, 0.2));
    assert_true(fabs(hit.shading[0] * hit.shading[0] + hit.shading[1] * hit.shading[1] +
                     hit.shading[2] * hit.shading[2] - 1) < 1e-6);
    product_free(&product);
}

/* The last of a chain counts; .mirror is a mirror; widths grow with what they are on. */
static void smoothness_is_inherited(void **state)
{
    (void)state;
    static const char        ball[] = "sphere(1).move([-0.6, 0, 0])";
    static const char *const same[] = {
        "krs { kernel %s; reflect plane([1, 0, 0], 0); }.smooth_mirrors(0.3)",
        "krs { kernel %s; reflect plane([1, 0, 0], 0); }.smooth_mirrors(2).smooth_mirrors(0.3)",
        "%s.mirror(plane([1, 0, 0], 0)).smooth_mirrors(0.3)",
        "%s.scale(0.5).mirror(plane([1, 0, 0], 0)).smooth_mirrors(0.15).scale(2)",
        "(%s.mirror(plane([1, 0, 0], 0)) | sphere(0.1).move([0, 9, 0])).smooth_mirrors(0.3)",
        "%s.mirror(plane([1, 0, 0], 0)).smooth_mirrors(0.3).rotate([1, 2, 3], 1)"
        ".rotate([1, 2, 3], -1)",
        "krs { kernel %s.mirror(plane([1, 0, 0], 0)).smooth_mirrors(0.3);"
        " reflect plane([0, 1, 0], 50); }"};
    Random random = {6};
    Vec    points[50];
    double first[50][3];
    for (int i = 0; i < 50; i++)
        points[i] = vec(random_between(&random, -0.2, 0.2), random_between(&random, -0.9, 0.9),
                        random_between(&random, -0.9, 0.9));
    for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
        char shape[400], text[600];
        snprintf(shape, sizeof shape, same[k], ball);
        snprintf(text, sizeof text, "show %s;", shape);
        Product product = product_compile(text);
        for (int i = 0; i < 50; i++) {
            KrsHit hit = product_probe(&product, points[i]);
            if (k == 0)
                memcpy(first[i], hit.shading, sizeof first[i]);
            is_near(hit.shading, vec(first[i][0], first[i][1], first[i][2]), 1e-6, shape);
        }
        product_free(&product);
    }
}

/* ---- materials ---- */

/* A unit ball, painted with its normal and then mapped: where its point `at` goes. */
typedef struct Move {
    const char *method;
    Vec (*map)(Vec at);
} Move;

static Vec stay(Vec at) { return at; }
static Vec shift(Vec at) { return vec_add(at, vec(0.3, -2, 0.7)); }
static Vec turn(Vec at) { return vec_rotate(at, vec_unit(vec(1, -2, 0.5)), 0.8); }
static Vec shrink(Vec at) { return vec_scale(0.4, at); }
static Vec stretch(Vec at) { return vec(2 * at.x, 0.5 * at.y, 1.3 * at.z); }
static Vec turn_and_stretch(Vec at)
{
    return stretch(vec_rotate(at, vec_unit(vec(1, -2, 0.5)), 0.8));
}
static Vec flip(Vec at) { return vec(-at.x + 3.4, at.y, at.z); }
static Vec third_of_five(Vec at)
{
    return vec_rotate(vec_add(at, vec(4, 0.5, 0.3)), vec(0, 1, 0), 2 * 2 * acos(-1) / 5);
}
static Vec in_a_cell(Vec at) { return vec_add(at, vec(6, 0, -3)); }
static Vec twice_reflected(Vec at)
{
    Vec there = vec_add(at, vec(-1.5, -1.6, 0));
    return vec(-there.x, -there.y, there.z);
}

static Vec invert(Vec at)
{
    Vec centre = vec(0.5, 3, 0), offset = vec_sub(at, centre);
    return vec_add(centre, vec_scale(4 / vec_dot(offset, offset), offset));
}
static Vec twist(Vec at) { return vec_rotate(at, vec(0, 1, 0), 0.5 * at.y); }

static const Move moves[] = {
    {"", stay},
    {".move([0.3, -2, 0.7])", shift},
    {".rotate([1, -2, 0.5], 0.8)", turn},
    {".scale(0.4)", shrink},
    {".scale([2, 0.5, 1.3])", stretch},
    {".rotate([1, -2, 0.5], 0.8).scale([2, 0.5, 1.3])", turn_and_stretch},
    {".mirror(plane([1, 0, 0], 1.7))", flip},
    {".transform(reflect(plane([1, 0, 0], 1.7)))", flip},
    {".move([4, 0.5, 0.3]).repeat_polar(5)", third_of_five},
    {".repeat([3, 0, 3])", in_a_cell},
    {".move([-1.5, -1.6, 0]).mirror(plane([1, 0, 0], 0)).mirror(plane([0, 1, 0], 0))",
     twice_reflected},
    {".transform(invert(center: [0.5, 3, 0], radius: 2))", invert},
    {".twist(axis: [0, 1, 0], rate: 0.5)", twist},
};

static void materials_see_the_normal(void **state)
{
    (void)state;
    Random random = {7};
    for (size_t k = 0; k < sizeof moves / sizeof *moves; k++) {
        Product product = product_format("material m { color: 0.5 + 0.5 * normal }"
                                         "show sphere(1).paint(m)%s;",
                                         moves[k].method);
        for (int i = 0; i < 100; i++) {
            Vec    at  = random_unit(&random);
            KrsHit hit = product_probe(&product, moves[k].map(at));
            double color[3];
            for (int c = 0; c < 3; c++)
                color[c] = 2 * hit.color[c] - 1;
            if (!(fabs(hit.distance) <= 1e-9))
                fail_msg("%s: the point is not on the surface", moves[k].method);
            is_near(color, at, 1e-4, moves[k].method);
        }
        product_free(&product);
    }
}

/* Under smooth mirrors a material sees the smooth normal where it is painted outside of them. */
static void materials_see_smoothness(void **state)
{
    (void)state;
    Product product = product_format(
        "material m { color: 0.5 + 0.5 * normal }"
        "show krs { kernel sphere(1).move([-0.6, 0, 0]); reflect plane([1, 0, 0], 0); }"
        "    .smooth_mirrors(0.4).paint(m);");
    Random random = {8};
    for (int i = 0; i < 200; i++) {
        KrsHit hit = product_probe(&product, random_in_cube(&random, 0.9));
        for (int c = 0; c < 3; c++)
            assert_true(fabs(2 * hit.color[c] - 1 - hit.shading[c]) < 1e-9);
    }
    product_free(&product);
}

/* u and v of a shape of one's own, and of the library's, through maps and sequences. */
static void materials_see_u_and_v(void **state)
{
    (void)state;
    static const char declaration[] =
        "shape ball() { distance: length(p) - 1, exact: true, within: sphere(1), "
        "             uv: [0.3 + 0.1 * x, y * z] }"
        "material m { color: [u, v + 0.5, 0] }";
    Random random = {9};
    for (size_t k = 0; k < sizeof moves / sizeof *moves; k++) {
        Product product = product_format("%s show ball().paint(m)%s;", declaration,
                                         moves[k].method);
        for (int i = 0; i < 50; i++) {
            Vec    at  = random_unit(&random);
            KrsHit hit = product_probe(&product, moves[k].map(at));
            is_near(hit.color, vec(0.3 + 0.1 * at.x, 0.5 + at.y * at.z, 0), 1e-9, moves[k].method);
        }
        product_free(&product);
    }
    Product product = product_format("material m { color: [u + 4, v + 4, 0] / 8 } show krs {"
                                     "kernel sphere(1).move([-2, 0, 0]);"
                                     "reflect plane([1, 0, 0], 0); }.paint(m);");
    for (int i = 0; i < 50; i++) {
        Vec    at    = random_unit(&random);
        KrsHit hit   = product_probe(&product, vec(2 - at.x, at.y, at.z));
        Vec    right = vec((4 + atan2(at.z, at.x)) / 8, (4 + asin(at.y)) / 8, 0);
        is_near(hit.color, right, 1e-9, "u and v in a sequence");
    }
    product_free(&product);
}

/* Every primitive of the library has coordinates, and they are numbers. */
static void primitives_have_u_and_v(void **state)
{
    (void)state;
    static const char *const primitives[] = {"sphere()",
                                             "box()",
                                             "cylinder()",
                                             "cone()",
                                             "capped_cone()",
                                             "capsule()",
                                             "round_cone()",
                                             "arc_capsule()",
                                             "torus()",
                                             "ellipsoid()",
                                             "link()",
                                             "octahedron()",
                                             "tetrahedron()",
                                             "dodecahedron()",
                                             "icosahedron()",
                                             "prism()",
                                             "pyramid()",
                                             "wedge()",
                                             "plane()",
                                             "half_space()",
                                             "convex()",
                                             "circle().extrude(1)",
                                             "rectangle().revolve(1)",
                                             "polygon().extrude(1)",
                                             "regular().extrude(1)",
                                             "star().extrude(1)",
                                             "segment().extrude(1)",
                                             "arc().extrude(1)",
                                             "bezier().extrude(1)"};
    Random                   random       = {10};
    for (size_t k = 0; k < sizeof primitives / sizeof *primitives; k++) {
        Product product = product_format("material m { color: [u, v, 0] } show %s.paint(m);",
                                         primitives[k]);
        double  low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
        for (int i = 0; i < 300; i++) {
            KrsHit hit = product_probe(&product, random_in_cube(&random, 1));
            for (int c = 0; c < 2; c++) {
                assert_true(isfinite(hit.color[c]));
                low[c]  = fmin(low[c], hit.color[c]);
                high[c] = fmax(high[c], hit.color[c]);
            }
        }
        if (!(high[0] - low[0] > 0.1 && high[1] - low[1] > 0.1))
            fail_msg("%s: u and v do not tell places apart", primitives[k]);
        product_free(&product);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mirrors_are_smooth),       cmocka_unit_test(ridges_have_the_bisector),
        cmocka_unit_test(smoothness_is_inherited),  cmocka_unit_test(materials_see_the_normal),
        cmocka_unit_test(materials_see_smoothness), cmocka_unit_test(materials_see_u_and_v),
        cmocka_unit_test(primitives_have_u_and_v),
    };
    return cmocka_run_group_tests_name("normals", tests, NULL, NULL);
}
