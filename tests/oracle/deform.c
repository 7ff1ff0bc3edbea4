/*
 * deform.c: deformed solids against what deformations mean for points: distances are never too
 * long, of hundreds of random chains, also within sequences and of sequences, and at several values
 * of their parameters.
 */
#include "tests/oracle/deformed.h"

#include <stdio.h>

static void check_chain(const Deformed *chain, uint64_t seed)
{
    SceneText text = {.length = 0};
    deformed_write(&text, chain, NULL);
    Product product = product_compile(text.bytes);
    Trial   near = deformed_trial(&product, chain, seed), far = near;
    far.half   = 30;
    far.points = 60;
    judge_acquits(&near, text.bytes);
    judge_acquits(&far, text.bytes);
    product_free(&product);
}

static void one_is_safe(void **state)
{
    (void)state;
    Random random = {101};
    for (int i = 0; i < 120; i++) {
        Deformed chain = deformed_random(&random, 1, 0);
        check_chain(&chain, (uint64_t)i);
    }
}

static void several_are_safe(void **state)
{
    (void)state;
    Random random = {102};
    for (int i = 0; i < 80; i++) {
        Deformed chain = deformed_random(&random, 2 + random_below(&random, 2), 0);
        check_chain(&chain, (uint64_t)i);
    }
}

static void sequences_are_safe(void **state)
{
    (void)state;
    Random random = {103};
    for (int i = 0; i < 80; i++) {
        Deformed chain = deformed_random(&random, 1 + random_below(&random, 2),
                                         1 + random_below(&random, MAX_MIRRORS));
        check_chain(&chain, (uint64_t)i);
    }
}

/* Around the axis more than once, forwards and backwards. */
static void long_bends_are_safe(void **state)
{
    (void)state;
    Random random = {104};
    for (int i = 0; i < 24; i++) {
        Deformed chain     = {.deed_count = 1, .before = 1};
        chain.solid        = (Solid){SOLID_BOX, {0, 0, 0}, {0.3, 3, 0.2}};
        chain.solid.kind   = random_below(&random, 2) ? SOLID_BOX : SOLID_ROD;
        chain.solid.centre = vec(0, random_between(&random, -3, 3), 0);
        double turn        = (i % 2 ? 1 : -1) * random_between(&random, 0.3, 2.5) * PI;
        chain.deeds[0]     = (Deed){DEED_BEND, {1, 0, 0}, turn / 6, 1, 1, 0, 1};
        if (chain.solid.kind == SOLID_ROD)
            chain.solid.half.z = chain.solid.half.x;
        check_chain(&chain, (uint64_t)i);
    }
}

/* The parts of a long bend have no walls between them: no surface is near the middle of a ring. */
static void rings_are_solid(void **state)
{
    (void)state;
    Product ring = product_compile("show cylinder(0.2, 6).bend([1, 0, 0], 1);");
    for (int i = 0; i <= 1000; i++) {
        double angle = -3 + 0.006 * i, depth = fmin(0.2, 3 - fabs(angle));
        Vec    p = vec(0, sin(angle), 1 - cos(angle));
        assert_true(product_distance(&ring, p) <= -0.5 * depth);
    }
    product_free(&ring);
}

static void states_are_safe(void **state)
{
    (void)state;
    Random random = {105};
    for (int i = 0; i < 30; i++) {
        Deformed chain = deformed_random(&random, 1, 0);
        while (chain.deeds[0].kind == DEED_TAPER)
            chain = deformed_random(&random, 1, 0);
        Deed     *deed = &chain.deeds[0];
        double    most = fabs(deed->rate);
        SceneText text = {.length = 0};
        scene_write(&text, "param k = 0 in [%.17g, %.17g];\n", -most, most);
        deformed_write(&text, &chain, "k * cos(time)");
        Product product = product_compile(text.bytes);
        for (int frame = 0; frame < 5; frame++) {
            double k    = frame ? random_between(&random, -most, most) : 0;
            double time = random_between(&random, -9, 9);
            assert_int_equal(krs_state_set(product.state, "k", &k, 1), KRS_OK);
            assert_int_equal(krs_state_set_time(product.state, time), KRS_OK);
            deed->rate  = frame ? k * cos(time) : 1e-9; /* the formulas here divide by it */
            Trial trial = deformed_trial(&product, &chain, (uint64_t)i);
            judge_acquits(&trial, text.bytes);
        }
        product_free(&product);
    }
}

/* Nor do factors of a taper that move. */
static void moving_tapers_are_safe(void **state)
{
    (void)state;
    Random random = {109};
    for (int i = 0; i < 10; i++) {
        Deformed chain = deformed_random(&random, 1, 0);
        Deed    *deed  = &chain.deeds[0];
        if (deed->kind != DEED_TAPER)
            continue;
        SceneText text = {.length = 0};
        scene_write(&text, "param a = 1 in [0.3, 1.5]; show ");
        solid_write(&text, &chain.solid);
        scene_write(&text, ".taper([%g, %g, %g], from: a, to: 0.9 + 0.3 * sin(a + time));",
                    deed->axis.x, deed->axis.y, deed->axis.z);
        Product product = product_compile(text.bytes);
        for (int frame = 0; frame < 5; frame++) {
            double time = random_between(&random, -9, 9);
            deed->from  = random_between(&random, 0.3, 1.5);
            deed->to    = 0.9 + 0.3 * sin(deed->from + time);
            assert_int_equal(krs_state_set(product.state, "a", &deed->from, 1), KRS_OK);
            assert_int_equal(krs_state_set_time(product.state, time), KRS_OK);
            Trial trial = deformed_trial(&product, &chain, (uint64_t)i);
            judge_acquits(&trial, text.bytes);
        }
        product_free(&product);
    }
}

/* No range is needed for a twist. */
static void a_twist_needs_no_range(void **state)
{
    (void)state;
    Deformed chain = {.solid = {SOLID_BOX, {0, 0, 0}, {0.4, 1, 0.3}}, .deed_count = 1, .before = 1};
    chain.deeds[0] = (Deed){DEED_TWIST, {0, 1, 0}, 0, 1, 1, 0, 1};
    SceneText text = {.length = 0};
    scene_write(&text, "param k = 0;\n");
    deformed_write(&text, &chain, "k + 0.3 * time");
    Product product = product_compile(text.bytes);
    for (int i = 0; i < 8; i++) {
        double k = i - 4, time = 0.7 * i;
        assert_int_equal(krs_state_set(product.state, "k", &k, 1), KRS_OK);
        assert_int_equal(krs_state_set_time(product.state, time), KRS_OK);
        chain.deeds[0].rate = k + 0.3 * time;
        Trial trial         = deformed_trial(&product, &chain, (uint64_t)i);
        judge_acquits(&trial, text.bytes);
    }
    product_free(&product);
}

/* ---- displacement ---- */

typedef struct Bumps {
    const char *text;
    double (*value)(Vec p);
    double amplitude;
    Solid  solid; /* a box or a ball, whose exact distance is the start */
} Bumps;

static double waves(Vec p) { return sin(3 * p.x) * cos(2 * p.y) + 0.3 * sin(5 * p.z); }

static double slope(Vec p) { return 0.5 * p.x - 0.2 * p.y * p.z; }

static double ripples(Vec p) { return cos(9 * vec_length(p)); }

static double solid_distance(const Solid *solid, Vec p)
{
    Vec q = vec_sub(p, solid->centre), h = solid->half;
    if (solid->kind == SOLID_BALL)
        return vec_length(q) - h.x;
    double x = fabs(q.x) - h.x, y = fabs(q.y) - h.y, z = fabs(q.z) - h.z;
    return vec_length(vec(fmax(x, 0), fmax(y, 0), fmax(z, 0))) + fmin(fmax(x, fmax(y, z)), 0);
}

static bool inside_bumps(const void *user, Vec p)
{
    const Bumps *bumps = user;
    return solid_distance(&bumps->solid, p) - bumps->amplitude * bumps->value(p) <= 0;
}

static void displacements_are_safe(void **state)
{
    static const struct {
        const char *text;
        double (*value)(Vec p);
    } fields[] = {{"sin(3 * x) * cos(2 * y) + 0.3 * sin(5 * z)", waves},
                  {"0.5 * x - 0.2 * y * z", slope},
                  {"cos(9 * length(p))", ripples}};
    (void)state;
    Random random = {106};
    for (int i = 0; i < 60; i++) {
        int       field  = i % 3;
        Bumps     bumps  = {fields[field].text, fields[field].value, 0, solid_random(&random)};
        SceneText text   = {.length = 0};
        bumps.solid.kind = i % 2 ? SOLID_BALL : SOLID_BOX;
        scene_write(&text, "param a = 0 in [-0.5, 0.5]; show ");
        solid_write(&text, &bumps.solid);
        scene_write(&text, ".displace(%s, amplitude: a);", bumps.text);
        Product product = product_compile(text.bytes);
        for (int frame = 0; frame < 3; frame++) {
            bumps.amplitude = random_between(&random, -0.5, 0.5);
            assert_int_equal(krs_state_set(product.state, "a", &bumps.amplitude, 1), KRS_OK);
            Trial trial = {product_field, &product, inside_bumps, &bumps,
                           vec(0, 0, 0),  3,        250,          (uint64_t)i};
            judge_acquits(&trial, text.bytes);
            trial.half   = 30;
            trial.points = 60;
            if (bumps.value != slope) /* far away, where it is large, it is cut off */
                judge_acquits(&trial, text.bytes);
        }
        product_free(&product);
    }
}

/* What has no closed form is safe for what its sign says (of noise: property/noise.c). */
static bool is_negative(const void *product, Vec p) { return product_distance(product, p) <= 0; }

static void others_are_safe(void **state)
{
    static const char *const shapes[] = {
        "sphere(1).displace(noise(3 * p), 0.3)",
        "box([1, 2, 1]).displace(fbm(2 * p, 4), 0.5)",
        "plane([0, 1, 0], 0).displace(fbm([x, z], 3, gain: 0.4), 0.4)",
        "torus(1, 0.3).displace(fbm(p + [0, 3 * time, 0], 3, lacunarity: 2.3), 0.3)",
        "sphere(1).displace(noise(4 * p), 0.2).twist([0, 1, 0], 1).bend([1, 0, 0], 0.4)",
        "sphere(0.5).scale([1, 1, 3]).displace(noise(2 * p), 0.6)",
        "box([1, 1, 1]).twist([0, 1, 0], 2).displace(noise([x, 2 * y]), 0.4)",
        "ellipsoid([0.3, 1, 0.2]).displace(cos(3 * x) + 1, 0.4)",
        "union(sphere(0.6), box([1, 1, 1]).move([0.5, 0.4, 0]), blend: 0.6, kind: \"chamfer\")"
        ".twist([0, 1, 0], 0.3)",
        "union(sphere(0.6), box([1, 1, 1]).move([0.5, 0.4, 0]), blend: 0.6, kind: \"chamfer\")"
        ".displace(x, 0.01)"};
    (void)state;
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        Product product = product_format("show %s;", shapes[i]);
        Trial   trial   = {product_field, &product, is_negative, &product, vec(0, 0, 0), 2, 400, i};
        assert_int_equal(krs_state_set_time(product.state, 7), KRS_OK);
        judge_acquits(&trial, shapes[i]);
        product_free(&product);
    }
}

/* Below a ball, far from it, and where the taper narrows towards it: all that makes its bound steep
   comes together, which is rare. */
static void narrowing_is_safe(void **state)
{
    static const char text[] = "show (sphere(0.05).move([0, 0.85, 0]) |"
                               "      sphere(0.05).move([0.95, 0, 0]) |"
                               "      sphere(0.05).move([0, 2.8, 0]))"
                               "    .taper([0, 1, 0], from: 1, to: 0.3);";
    (void)state;
    Product product = product_compile(text);
    Trial   trial   = {product_field, &product, is_negative, &product, vec(0, 0, 0), 0.08, 300, 5};
    judge_acquits(&trial, text);
    product_free(&product);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_is_safe),
        cmocka_unit_test(several_are_safe),
        cmocka_unit_test(sequences_are_safe),
        cmocka_unit_test(long_bends_are_safe),
        cmocka_unit_test(rings_are_solid),
        cmocka_unit_test(states_are_safe),
        cmocka_unit_test(moving_tapers_are_safe),
        cmocka_unit_test(a_twist_needs_no_range),
        cmocka_unit_test(displacements_are_safe),
        cmocka_unit_test(others_are_safe),
        cmocka_unit_test(narrowing_is_safe),
    };
    return cmocka_run_group_tests_name("deformations", tests, NULL, NULL);
}
