/*
 * tangents.c: the direction in which highlights are drawn out, behind maps that are followed by hand.
 *
 * A ball is moved, turned, stretched, mirrored, twisted and inverted.  A step from a point of the ball
 * along its tangent is a step of the scene, which two points tell that each have gone the same way.
 */
#include "tests/oracle/product.h"

#include <stdio.h>

#define RADIUS 0.5
#define DEGREE (M_PI / 180)

/* From the ball's own space to the scene. */
typedef Vec Follow(Vec q);

static Vec stay(Vec q) { return q; }

static Vec place(Vec q)
{
    q = vec(2 * q.x, 0.5 * q.y, q.z);
    return vec_add(vec_rotate(q, vec(1, 2, 3), 50 * DEGREE), vec(1, -2, 3));
}

static Vec mirror(Vec q)
{
    const Vec normal = vec_unit(vec(1, 1, 0));
    q                = vec_add(vec_rotate(q, vec(0, 1, 0), 1), vec(-2, 0, 0));
    return vec_sub(q, vec_scale(2 * vec_dot(q, normal), normal));
}

static Vec twist(Vec q)
{
    q = vec_add(q, vec(0.7, 0.3, 0));
    return vec_rotate(q, vec(0, 1, 0), 0.6 * q.y);
}

static Vec invert(Vec q)
{
    q = vec_add(q, vec(0, 2, 0));
    return vec_scale(1 / vec_dot(q, q), q);
}

/* Returns the first kernel's image behind both mirrors of SEQUENCE. */
static Vec reflect_twice(Vec q)
{
    q = vec_add(q, vec(-1, 0, 0));
    q = vec(-q.x, q.y, q.z);
    q = vec_add(vec_rotate(q, vec(0, 0, 1), 30 * DEGREE), vec(0, -1.5, 0));
    return vec(q.x, -q.y, q.z);
}

#define SEQUENCE                                                               \
    "krs { kernel sphere(0.5).move([-1, 0, 0]); reflect plane([1, 0, 0], 0); " \
    "mobius translate([0, -1.5, 0]) * rotate([0, 0, 1], 30deg); "              \
    "reflect plane([0, 1, 0], 0); }"

/* Returns one of so many that they are an instance group (compiler/lower/instance_groups.h). */
static Vec turn_of_loop(Vec q)
{
    return vec_add(vec_rotate(q, vec(0, 0, 1), 7 * 0.4), vec(3 * 7, 0, 0));
}

#define LOOP "[sphere(0.5).paint(m).rotate([0, 0, 1], i * 0.4).move([3 * i, 0, 0]) for i in 0..80]"

static const struct {
    const char *name, *shape;
    Follow     *follow;
} cases[] = {
    {"a ball", "sphere(0.5).paint(m)", stay},
    {"placed", "sphere(0.5).paint(m).scale([2, 0.5, 1]).rotate([1, 2, 3], 50deg).move([1, -2, 3])",
     place},
    {"mirrored",
     "sphere(0.5).paint(m).rotate([0, 1, 0], 1).move([-2, 0, 0]).mirror(plane([1, 1, 0], 0))",
     mirror},
    {"twisted", "sphere(0.5).paint(m).move([0.7, 0.3, 0]).twist(axis: [0, 1, 0], rate: 0.6)",
     twist},
    {"inverted", "sphere(0.5).paint(m).move([0, 2, 0]).transform(invert())", invert},
    {"in a sequence", SEQUENCE, reflect_twice},
    {"in a loop", "union(" LOOP ")", turn_of_loop},
    {"in a loop that blends", "union(" LOOP ", blend: 0.3)", turn_of_loop},
    {"in a loop, placed",
     "union(" LOOP ").scale([2, 0.5, 1]).rotate([1, 2, 3], 50deg).move([1, -2, 3])", NULL},
    {"in a loop that blends, placed",
     "union(" LOOP ", blend: 0.3).scale([2, 0.5, 1]).rotate([1, 2, 3], 50deg).move([1, -2, 3])",
     NULL},
};

static Vec loop_placed(Vec q) { return place(turn_of_loop(q)); }

/* How the tangent is given, and what it is on the ball. */
typedef Vec Tangent(Vec q);

static Vec of_expression(Vec q) { return vec(q.y + 2, q.z, 1 - q.x); }
static Vec of_longitude(Vec q) { return vec(-q.z, 0, q.x); }

static Vec probe_tangent(const Product *product, Vec point)
{
    const KrsHit hit = product_probe(product, point);
    return vec(hit.tangent[0], hit.tangent[1], hit.tangent[2]);
}

static size_t compare(const char *name, const Product *product, Follow *follow, Tangent *tangent)
{
    enum { POINTS = 40 };
    const double step   = 1e-5;
    Random       random = {5};
    size_t       wrong  = 0;
    for (int i = 0; i < POINTS; i++) {
        const Vec q     = vec_scale(RADIUS, random_unit(&random));
        const Vec along = vec_scale(step, vec_unit(tangent(q)));
        const Vec right = vec_unit(vec_sub(follow(vec_add(q, along)), follow(vec_sub(q, along))));
        const Vec found = probe_tangent(product, follow(q));
        /* Which way it points is of no interest, but it has length 1. */
        if (!(fabs(fabs(vec_dot(found, right)) - 1) < 1e-6 && fabs(vec_length(found) - 1) < 1e-6)) {
            print_message("# %s: [%g, %g, %g] instead of [%g, %g, %g]\n", name, found.x, found.y,
                          found.z, right.x, right.y, right.z);
            wrong++;
        }
    }
    return wrong;
}

static size_t compare_all(const char *material, Tangent *tangent)
{
    size_t wrong = 0;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const bool painted = cases[i].follow != reflect_twice;
        Product    product = product_format("%s show (%s)%s;", material, cases[i].shape,
                                         painted ? "" : ".paint(m)");
        /* A sequence's own space is that of its outside, so that only `u` follows its mirrors. */
        if (painted || tangent == of_longitude)
            wrong += compare(cases[i].name, &product,
                             cases[i].follow ? cases[i].follow : loop_placed, tangent);
        product_free(&product);
    }
    return wrong;
}

static void expressions_follow_maps(void **state)
{
    (void)state;
    assert_int_equal(compare_all("material m { specular_roughness_anisotropy: 0.5,"
                                 " tangent: 3 * [y + 2, z, 1 - x] }",
                                 of_expression),
                     0);
}

static void longitudes_follow_maps(void **state)
{
    (void)state;
    assert_int_equal(compare_all("material m { specular_roughness_anisotropy: 0.5 }", of_longitude),
                     0);
}

static void tangents_go_around_a_column_and_on_its_lids(void **state)
{
    (void)state;
    Product product = product_compile("material m { specular_roughness_anisotropy: 0.5 } "
                                      "show cylinder(radius: 1, height: 2).paint(m);");
    for (int i = 0; i < 12; i++) {
        const Vec out = vec(cos(i + 0.5), 0, sin(i + 0.5)), right = vec(-out.z, 0, out.x);
        const Vec side = vec_add(out, vec(0, 0.3, 0)),
                  lid  = vec_add(vec_scale(0.4, out), vec(0, 1, 0));
        assert_true(fabs(vec_dot(probe_tangent(&product, side), right)) > 1 - 1e-6);
        assert_true(fabs(vec_dot(probe_tangent(&product, lid), right)) > 1 - 1e-6);
    }
    product_free(&product);
}

/* Across a blend it is between both. */
static void tangents_blend(void **state)
{
    (void)state;
    Product product = product_compile(
        "material a { specular_roughness_anisotropy: 0.8, tangent: [1, 0, 0] }"
        "material b { specular_roughness_anisotropy: 0.4, tangent: [0, 0, 1] }"
        "show union(sphere(1).paint(a).move([0, 0.8, 0]), sphere(1).paint(b).move([0, -0.8, 0]), "
        "blend: 0.5);");
    const KrsHit hit = product_probe(&product, vec(0.9, 0, 0));
    assert_true(fabs(hit.specular_roughness_anisotropy - 0.6) < 1e-9);
    assert_true(fabs(hit.tangent[0] - hit.tangent[2]) < 1e-9 && hit.tangent[0] > 0.1);
    product_free(&product);
}

/* Where nothing is anisotropic there is no tangent, unless one is given. */
static void others_have_none(void **state)
{
    (void)state;
    Product product = product_compile("material m { roughness: 0.2 } show sphere(1).paint(m);");
    assert_true(vec_length(probe_tangent(&product, vec(1, 0, 0))) == 0);
    product_free(&product);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(expressions_follow_maps),
        cmocka_unit_test(longitudes_follow_maps),
        cmocka_unit_test(tangents_go_around_a_column_and_on_its_lids),
        cmocka_unit_test(tangents_blend),
        cmocka_unit_test(others_have_none),
    };
    return cmocka_run_group_tests_name("tangents", tests, NULL, NULL);
}
