/*
 * Joining, blending, placing and shaping against what they mean for points.
 *
 * Two solids with textbook distances, a box and a ball, are put through every operation.  For
 * each one the test has its own answer to "is this point inside?", or its own closed form, and
 * the judge tries to refute the compiler's distance with it; then it shows that it would have
 * refuted a slightly larger one.
 */
#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

#include <stdio.h>

static const double PI = 3.14159265358979323846;

enum { POINTS = 1500 };

/* In every scene; `c` is a short rod beside the axis, without any symmetry of the axes. */
static const char prelude[] = "let a = box([1.2, 0.8, 1]).move([-0.2, 0.1, 0]);\n"
                              "let b = sphere(0.6).move([0.35, 0.25, 0.1]);\n"
                              "let c = capsule([0.5, -0.2, 0.1], [0.8, 0.3, -0.1], 0.15);\n";

static double box_distance(Vec p, Vec sides)
{
    double x = fabs(p.x) - sides.x / 2, y = fabs(p.y) - sides.y / 2, z = fabs(p.z) - sides.z / 2;
    return vec_length(vec(fmax(x, 0), fmax(y, 0), fmax(z, 0))) + fmin(fmax(x, fmax(y, z)), 0);
}
static double rod_distance(Vec p, Vec from, Vec to, double radius)
{
    Vec    along = vec_sub(to, from);
    double t     = vec_dot(vec_sub(p, from), along) / vec_dot(along, along);
    return vec_distance(p, vec_mix(from, to, fmax(0, fmin(t, 1)))) - radius;
}
static double a_distance(Vec p)
{
    return box_distance(vec_sub(p, vec(-0.2, 0.1, 0)), vec(1.2, 0.8, 1));
}
static double b_distance(Vec p) { return vec_distance(p, vec(0.35, 0.25, 0.1)) - 0.6; }
static double c_distance(Vec p)
{
    return rod_distance(p, vec(0.5, -0.2, 0.1), vec(0.8, 0.3, -0.1), 0.15);
}
static bool in_a(Vec p) { return a_distance(p) <= 0; }
static bool in_b(Vec p) { return b_distance(p) <= 0; }
static bool in_c(Vec p) { return c_distance(p) <= 0; }

/* ---- what each operation means ---- */

static bool either(Vec p) { return in_a(p) || in_b(p); }
static bool both(Vec p) { return in_a(p) && in_b(p); }
static bool a_less_b(Vec p) { return in_a(p) && !in_b(p); }
static bool only_one(Vec p) { return in_a(p) != in_b(p); }
static bool any(Vec p) { return in_a(p) || in_b(p) || in_c(p); }
static bool all(Vec p) { return in_a(p) && in_b(p) && in_c(p); }
static bool a_less_others(Vec p) { return in_a(p) && !in_b(p) && !in_c(p); }
static bool precedence(Vec p) { return in_a(p) || (in_b(p) && !in_c(p)); }

static bool moved(Vec p) { return a_less_b(vec_sub(p, vec(0.3, -0.4, 0.5))); }
static bool turned(Vec p) { return a_less_b(vec_rotate(p, vec(1, 2, -0.5), -0.8)); }
static bool enlarged(Vec p) { return a_less_b(vec_scale(1 / 1.7, p)); }
static bool reduced(Vec p) { return a_less_b(vec_scale(1 / 0.4, p)); }
static bool stretched(Vec p) { return either(vec(p.x / 1.5, p.y / 0.5, p.z)); }
static bool placed(Vec p)
{
    Vec q = vec_rotate(vec_sub(p, vec(0.2, 0.1, -0.3)), vec(0, 1, 1), -0.5);
    return a_less_b(vec_sub(vec_scale(1 / 0.7, q), vec(0.4, 0, 0)));
}
/* The shortest turn from one direction to the other. */
static bool aligned(Vec p)
{
    Vec from = vec_unit(vec(0, 0.3, 1)), to = vec_unit(vec(1, -0.6, 0.2));
    return a_less_b(vec_rotate(p, vec_cross(from, to), -acos(vec_dot(from, to))));
}
static bool turned_over(Vec p) { return fabs(p.y) <= 0.5 && hypot(p.x, p.z) <= 0.7 * (0.5 + p.y); }
static bool mirrored(Vec p)
{
    Vec    normal = vec_unit(vec(1, 0.2, -0.1));
    double excess = vec_dot(normal, p) - 0.2 / vec_length(vec(1, 0.2, -0.1));
    return a_less_b(vec_sub(p, vec_scale(2 * fmax(excess, 0), normal)));
}
static bool repeated(Vec p)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 2; j++)
            if (a_less_b(vec_sub(p, vec(2.1 * (i - 1), 1.9 * (j - 0.5), 0))))
                return true;
    return false;
}
static bool repeated_for_ever(Vec p)
{
    for (int i = -4; i <= 4; i++)
        for (int k = -4; k <= 4; k++)
            if (either(vec_sub(p, vec(2.2 * i, 0, 1.7 * k))))
                return true;
    return false;
}
static bool around(Vec p, Vec axis, int n)
{
    for (int i = 0; i < n; i++)
        if (in_c(vec_rotate(p, axis, 2 * PI * i / n)))
            return true;
    return false;
}
static bool five_around(Vec p) { return around(p, vec(0, 1, 0), 5); }
static bool four_about_z(Vec p) { return around(p, vec(0, 0, 1), 4); }
/* The rod, which lies at the angle 0, turned by half of a copy's share: on the seam. */
static bool six_on_the_seam(Vec p)
{
    return around(vec_rotate(p, vec(0, 1, 0), -PI / 6), vec(0, 1, 0), 6);
}

static double pull(double x, double half) { return x - fmax(-half, fmin(x, half)); }
static bool   pulled_apart(Vec p)
{
    return a_less_b(vec(pull(p.x, 0.3), pull(p.y, 0), pull(p.z, 0.25)));
}
static bool grown(Vec p) { return a_distance(p) <= 0.25; }
static bool shrunk(Vec p) { return a_distance(p) <= -0.2; }
static bool rounded(Vec p) { return box_distance(p, vec(1.2 - 0.3, 0.8 - 0.3, 1 - 0.3)) <= 0.15; }
static bool hollow(Vec p) { return fabs(a_distance(p)) <= 0.05; }
static bool mixed(Vec p) { return 0.7 * a_distance(p) + 0.3 * b_distance(p) <= 0; }
static bool cut_to_b(Vec p) { return both(p); }
static bool nested(Vec p)
{
    Vec q = vec(fabs(p.x), p.y, p.z); /* mirrored where x <= 0 is kept */
    return a_less_b(vec_rotate(vec(-q.x, q.y, q.z), vec(0, 0, 1), -0.4)) ||
           in_c(vec(-q.x, q.y, q.z));
}

typedef struct Operation {
    const char *text;
    bool (*inside)(Vec p);
    bool   exact;  /* so that balls too refute a larger field */
    double region; /* half size */
} Operation;

static const Operation operations[] = {
    {"a | b", either, true, 1.5},
    {"a & b", both, false, 1.5},
    {"a - b", a_less_b, false, 1.5},
    {"xor(a, b)", only_one, false, 1.5},
    {"union([a, b, c])", any, true, 1.5},
    {"union(a, b, c)", any, true, 1.5},
    {"intersection(a, b, c)", all, false, 1.5},
    {"difference(a, b, c)", a_less_others, false, 1.5},
    {"a | b - c", precedence, false, 1.5},
    {"(a - b).move([0.3, -0.4, 0.5])", moved, false, 1.5},
    {"(a - b).rotate([1, 2, -0.5], 0.8)", turned, false, 1.5},
    {"(a - b).scale(1.7)", enlarged, false, 2},
    {"(a - b).scale(0.4)", reduced, false, 1},
    {"(a | b).scale([1.5, 0.5, 1])", stretched, false, 2},
    {"(a - b).move([0.4, 0, 0]).scale(0.7).rotate([0, 1, 1], 0.5).move([0.2, 0.1, -0.3])", placed,
     false, 1.5},
    {"(a - b).transform(translate([0.2, 0.1, -0.3]) * rotate([0, 1, 1], 0.5) * scale(0.7)"
     " * translate([0.4, 0, 0]))",
     placed, false, 1.5},
    {"(a - b).align([0, 0.3, 1], [1, -0.6, 0.2])", aligned, false, 1.5},
    {"cone(0.7, 1).align([0, 1, 0], [0, -1, 0])", turned_over, true, 1.5},
    {"(a - b).mirror(plane([1, 0.2, -0.1], 0.2))", mirrored, false, 1.8},
    {"(a - b).repeat([2.1, 1.9, 1.5], [3, 2, 1])", repeated, false, 3},
    {"(a | b).repeat([2.2, 0, 1.7])", repeated_for_ever, false, 4},
    {"c.repeat_polar(5)", five_around, true, 1.5},
    {"c.repeat_polar(4, [0, 0, 1])", four_about_z, true, 1.5},
    {"c.rotate([0, 1, 0], 30deg).repeat_polar(6)", six_on_the_seam, false, 1.5},
    {"(a - b).elongate([0.6, 0, 0.5])", pulled_apart, false, 1.8},
    {"a.offset(0.25)", grown, true, 1.5},
    {"a.offset(-0.2)", shrunk, false, 1.5},
    {"box([1.2, 0.8, 1]).round(0.15)", rounded, true, 1.5},
    {"a.shell(0.1)", hollow, false, 1.5},
    {"morph(a, b, 0.3)", mixed, false, 1.5},
    {"a.within(b)", cut_to_b, false, 1.5},
    {"((a - b).rotate([0, 0, 1], 0.4) | c).mirror(plane([1, 0, 0], 0))", nested, false, 1.8},
};
enum { OPERATIONS = sizeof operations / sizeof *operations };

static bool inside_operation(const void *operation, Vec p)
{
    return ((const Operation *)operation)->inside(p);
}

static void operation_means_what_it_says(void **state)
{
    const Operation *operation = *state;
    Product          product   = product_format("%sshow %s;\n", prelude, operation->text);
    Trial            trial     = {product_field, &product,          inside_operation, operation,
                                  vec(0, 0, 0),  operation->region, POINTS,           21};
    judge_acquits(&trial, operation->text);
    product_keeps_claim(&product, operation->text, operation->region, 22);
    if (operation->exact)
        judge_refutes_larger(&trial, 1.15, operation->text);
    else
        judge_refutes_steeper(&trial, 1.15, operation->text);
    product_free(&product);
}

/* ---- blends ---- */

static double quadratic(double a, double b, double k)
{
    double h = fmax(k - fabs(a - b), 0) / k;
    return fmin(a, b) - h * h * k / 4;
}
static double cubic(double a, double b, double k)
{
    double h = fmax(k - fabs(a - b), 0) / k;
    return fmin(a, b) - h * h * h * k / 6;
}
static double exponential(double a, double b, double k)
{
    return fmin(a, b) - k * log1p(exp(-fabs(a - b) / k));
}
static double circular(double a, double b, double k)
{
    return fmax(k, fmin(a, b)) - hypot(fmax(k - a, 0), fmax(k - b, 0));
}
static double chamfer(double a, double b, double k)
{
    return fmin(fmin(a, b), (a - k + b) * sqrt(0.5));
}
/* hg_sdf's stairs, four of them. */
static double stairs(double a, double b, double k)
{
    double step = k / 4, u = b - k, run = u - a + step;
    double turn = run - 2 * step * floor(run / (2 * step));
    return fmin(fmin(a, b), 0.5 * (u + a + fabs(turn - step)));
}

typedef struct Blend {
    const char *kind;
    double (*join)(double a, double b, double k);
    double slope; /* the compiler may divide by as much */
} Blend;

static const Blend blends[] = {
    {"quadratic", quadratic, 1},    {"cubic", cubic, 1},          {"exponential", exponential, 1},
    {"circular", circular, 1.4143}, {"chamfer", chamfer, 1.4143}, {"stairs", stairs, 1.4143},
};
enum { BLENDS = sizeof blends / sizeof *blends };

/* Intersection and difference are unions of complements. */
typedef struct CsgNode {
    const char  *function;
    double       sign_a, sign_b, sign;
    const Blend *blend;
    double       width;
} CsgNode;

static const CsgNode csg_nodes[] = {
    {"union", 1, 1, 1, NULL, 0},
    {"intersection", -1, -1, -1, NULL, 0},
    {"difference", -1, 1, -1, NULL, 0},
};
enum { CSG_NODES = sizeof csg_nodes / sizeof *csg_nodes };

static double csg_node_value(const CsgNode *csg_node, Vec p)
{
    double a = csg_node->sign_a * a_distance(p), b = csg_node->sign_b * b_distance(p);
    return csg_node->sign * csg_node->blend->join(a, b, csg_node->width);
}
static bool inside_csg_node(const void *csg_node, Vec p)
{
    return csg_node_value(csg_node, p) <= 0;
}

static void check_csg_node(const CsgNode *csg_node)
{
    char         name[80];
    const Blend *blend = csg_node->blend;
    snprintf(name, sizeof name, "%s(a, b, blend: %.17g, kind: \"%s\")", csg_node->function,
             csg_node->width, blend->kind);
    Product product = product_format("%sshow %s;\n", prelude, name);
    Trial   trial   = {product_field, &product, inside_csg_node, csg_node,
                       vec(0, 0, 0),  1.5,      POINTS,          31};
    judge_acquits(&trial, name);
    judge_refutes_steeper(&trial, 1.15 * blend->slope, name);

    Random random = {32};
    for (int i = 0; i < POINTS; i++) {
        Vec    point = random_in_cube(&random, 1.5);
        double value = product_distance(&product, point), truth = csg_node_value(csg_node, point);
        bool   between_bounds = fabs(value) <= fabs(truth) + 1e-9 &&
                              fabs(value) >= fabs(truth) / blend->slope - 1e-9;
        if (!between_bounds)
            fail_msg("%s at (%g, %g, %g): %.9g, by the formula %.9g", name, point.x, point.y,
                     point.z, value, truth);
    }
    product_free(&product);
}

static void blend_follows_its_formula(void **state)
{
    const double widths[] = {0.3, 0.05};
    for (int j = 0; j < CSG_NODES; j++)
        for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
            CsgNode csg_node = csg_nodes[j];
            csg_node.blend   = *state;
            csg_node.width   = widths[w];
            check_csg_node(&csg_node);
        }
}

static void blends_are_quadratic_by_default(void **state)
{
    (void)state;
    Product named = product_format("%sshow union(a, b, blend: 0.3, kind: \"quadratic\");", prelude);
    Product silent = product_format("%sshow union(a, b, blend: 0.3);", prelude);
    Random  random = {33};
    for (int i = 0; i < 500; i++) {
        Vec    point    = random_in_cube(&random, 1.5);
        double at_named = product_distance(&named, point);
        assert_true(at_named == product_distance(&silent, point));
    }
    product_free(&named);
    product_free(&silent);
}

/* ---- parameters and time ---- */

/* Setting a parameter or the time is the same as writing the number. */
static void states_are_scenes(void **state)
{
    (void)state;
    Product moving = product_format("%sparam r = 0.1 in [0.05, 0.6]; param shift = [0, 0, 0];\n"
                                    "show union(a.move(shift), b.rotate([0, 1, 0], time),"
                                    " blend: r);",
                                    prelude);
    Random  random = {41};
    for (int set = 0; set < 6; set++) {
        double r = random_between(&random, 0.05, 0.6), time = random_between(&random, -4, 4);
        Vec    v = random_in_cube(&random, 1);
        assert_int_equal(krs_state_set(moving.state, "r", &r, 1), KRS_OK);
        const double shift[3] = {v.x, v.y, v.z};
        assert_int_equal(krs_state_set(moving.state, "shift", shift, 3), KRS_OK);
        assert_int_equal(krs_state_set_time(moving.state, time), KRS_OK);
        Product still = product_format("%sshow union(a.move([%.17g, %.17g, %.17g]),"
                                       " b.rotate([0, 1, 0], %.17g), blend: %.17g);",
                                       prelude, v.x, v.y, v.z, time, r);
        for (int i = 0; i < 300; i++) {
            Vec    point    = random_in_cube(&random, 2);
            double moved_to = product_distance(&moving, point);
            assert_true(fabs(moved_to - product_distance(&still, point)) <= 1e-12);
        }
        product_free(&still);
    }
    double too_large = 0.7;
    assert_int_equal(krs_state_set(moving.state, "r", &too_large, 1), KRS_BAD_ARGUMENT);
    assert_int_equal(krs_state_set(moving.state, "s", &too_large, 1), KRS_BAD_ARGUMENT);
    product_free(&moving);
}

/* The scene is the union of its components, and a point knows the nearest. */
static void components_are_joined(void **state)
{
    (void)state;
    Product product = product_format("%sshow a.move([-1, 0, 0]); show b; show c.move([1, 0, 0]);",
                                     prelude);
    assert_int_equal(krs_component_count(product.scene), 3);
    Random random = {51};
    for (int i = 0; i < 1000; i++) {
        Vec      p            = random_in_cube(&random, 3);
        double   distances[3] = {a_distance(vec_add(p, vec(1, 0, 0))), b_distance(p),
                                 c_distance(vec_sub(p, vec(1, 0, 0)))};
        uint32_t nearest      = 0;
        for (uint32_t k = 1; k < 3; k++)
            if (distances[k] < distances[nearest])
                nearest = k;
        KrsHit hit = product_probe(&product, p);
        assert_true(fabs(hit.distance - distances[nearest]) <= 1e-9);
        assert_int_equal(hit.component, nearest + 1);
    }
    product_free(&product);
}

/* What is grown or blended may be where a bound is small, far from its shape: not outside a box. */
static void boxes_hold_what_is_grown(void **state)
{
    static const char *const solids[] = {
        "sphere(1).scale([1, 1, 4]).offset(0.5)",
        "(plane([1, 8, 0], 0) & plane([1, -8, 0], 0) & sphere(2)).offset(0.3)",
        "(box([3, 3, 3]) & sphere(1.6).move([1.6, 1.6, 0])).shell(0.4)",
        "union(sphere(1).scale([0.5, 3, 0.5]), sphere(0.7), blend: 0.6)",
        "krs { kernel box([1, 0.2, 0.2]); reflect plane([1, 2, 0], 0.1);"
        " reflect plane([-1, 1, 1], 0.2); }.offset(0.4)",
    };
    (void)state;
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
        Product      product = product_format("show %s;", solids[i]);
        Random       random  = {71};
        KrsComponent component;
        int          inside = 0;
        assert_int_equal(krs_component(product.scene, 0, &component), KRS_OK);
        for (int k = 0; k < 20000; k++) {
            Vec  p    = random_in_cube(&random, 6);
            bool held = p.x >= component.low[0] && p.x <= component.high[0] &&
                        p.y >= component.low[1] && p.y <= component.high[1] &&
                        p.z >= component.low[2] && p.z <= component.high[2];
            bool solid = product_distance(&product, p) < 0;
            inside += solid;
            if (solid && !held)
                fail_msg("%s: [%g, %g, %g] is inside, and not in the box", solids[i], p.x, p.y,
                         p.z);
        }
        assert_true(inside > 5);
        product_free(&product);
    }
}

/* Normals are gradients: what a small step in every direction says. */
static void normals_are_gradients(void **state)
{
    (void)state;
    Product      product = product_format("%sshow union(a, b, c, blend: 0.2).rotate([1, 1, 0], 1);",
                                          prelude);
    const double h       = 1e-5;
    Random       random  = {61};
    int          smooth  = 0;
    for (int i = 0; i < 500; i++) {
        Vec p = random_in_cube(&random, 1.5), axes[3] = {vec(h, 0, 0), vec(0, h, 0), vec(0, 0, h)};
        double rise[3], bend = 0, at_p = product_distance(&product, p);
        for (int k = 0; k < 3; k++) {
            double ahead  = product_distance(&product, vec_add(p, axes[k]));
            double behind = product_distance(&product, vec_sub(p, axes[k]));
            rise[k]       = ahead - behind;
            bend          = fmax(bend, fabs(ahead + behind - 2 * at_p));
        }
        KrsHit hit    = product_probe(&product, p);
        Vec    normal = vec(hit.normal[0], hit.normal[1], hit.normal[2]);
        Vec    slope  = vec(rise[0], rise[1], rise[2]);
        if (bend > 1e-8 || vec_length(slope) < h)
            continue; /* on a ridge, or nearly level */
        smooth++;
        assert_true(vec_distance(normal, vec_unit(slope)) <= 1e-3);
    }
    assert_true(smooth > 300);
    product_free(&product);
}

/* ---- copies of what is only bounded ---- */

static bool is_negative(const void *product, Vec p) { return product_distance(product, p) <= 0; }

/* Copies are compared with the nearer ones; which those are changes in the middles of cells and at their walls.
   Where a distance is far below the true one on one side only, it must not jump there: an offset would have a
   wall. */
static void copies_of_bounds_are_steady(void **state)
{
    static const char *const shapes[] = {
        "slab.repeat([2, 0, 0])",
        "slab.repeat([2, 0, 2], [3, 1, 2])",
        "slab.rotate([0, 1, 0], 90deg).repeat([2, 2.1, 2], [1, 2, 3])",
        "flat.repeat([2.4, 0, 0], [3, 1, 1])",
        "flat.repeat([2.4, 2.4, 2.4], [2, 3, 2])",
        "slab.scale(0.5).move([1.2, 0, 0.2]).repeat_polar(5)",
        "flat.move([3.5, 0, 0]).repeat_polar(4)",
        "flat.move([0, 0, 2.8]).rotate([0, 1, 0], 0.3).repeat_polar(3)",
    };
    static const double radii[] = {0, 0.8};
    (void)state;
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes * 2; i++) {
        Product product = product_format(
            "let slab = box([1.8, 1.8, 1.8]) - box([1.6, 2, 2]).move([-0.2, 0, 0]);"
            "let flat = sphere(1).scale([1, 0.2, 0.1]).rotate([0, 1, 1], 0.6)"
            "    .move([0.2, 0, -0.1]);"
            "show %s.offset(%g);",
            shapes[i / 2], radii[i % 2]);
        for (int size = 0; size < 2; size++) {
            Trial trial = {product_field, &product,      is_negative, &product,
                           vec(0, 0, 0),  size ? 12 : 4, 400,         i};
            judge_acquits(&trial, shapes[i / 2]);
        }
        product_free(&product);
    }
}

int main(void)
{
    struct CMUnitTest tests[OPERATIONS + BLENDS + 6];
    size_t            count = 0;
    for (size_t i = 0; i < OPERATIONS; i++)
        tests[count++] = (struct CMUnitTest){operations[i].text, operation_means_what_it_says, NULL,
                                             NULL, (void *)(uintptr_t)&operations[i]};
    for (size_t i = 0; i < BLENDS; i++)
        tests[count++] = (struct CMUnitTest){blends[i].kind, blend_follows_its_formula, NULL, NULL,
                                             (void *)(uintptr_t)&blends[i]};
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(blends_are_quadratic_by_default);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(states_are_scenes);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(components_are_joined);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(normals_are_gradients);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(boxes_hold_what_is_grown);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(copies_of_bounds_are_steady);
    return _cmocka_run_group_tests("operators", tests, count, NULL, NULL);
}
