/*
 * refute.c: the attempt to refute a scene: what is wrong is blamed on the right shape; what is true
 * is not refuted; the same search does the same each time.
 *
 * Whole scenes whose claims are false where 400 samples do not see it.  That a wrong rule of the
 * compiler is found, too, was tried by hand: with the factor of a chamfer, the least factor of
 * `.scale`, the neighbours of `.repeat` and the scale of a sequence spoilt, `krs validate` named
 * the union, the scale, the repetition and the sequence.  So were, of what marches instead of a
 * distance, a wrong Bernstein coefficient, a series along lines with a term left out, distances to
 * levels that are too long.  Boxes of levels, boxes of shapes and constants are broken here,
 * between compiling and searching.
 */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "compiler/refute/refute.h"

typedef struct Said {
    uint32_t line, count;
    char     code[8], text[4000];
} Said;

static void take(void *user, const KrsDiagnostic *diagnostic)
{
    Said *said = user;
    said->count++;
    said->line = diagnostic->line;
    snprintf(said->code, sizeof said->code, "%s", diagnostic->code);
    snprintf(said->text, sizeof said->text, "%s", diagnostic->text);
}

static void write_scene(char *path, const char *text)
{
    int file = mkstemp(path);
    assert_true(file >= 0 && write(file, text, strlen(text)) == (ssize_t)strlen(text));
    close(file);
}

static KrsStatus refute(const char *text, double seconds, Said *said, KrsRefutation *result)
{
    char path[] = "/tmp/krs-refute-XXXXXX";
    write_scene(path, text);
    *said                    = (Said){0};
    KrsOptions       options = {.diagnostic = take, .user = said};
    KrsRefuteOptions how     = {.seconds = seconds, .seed = 3};
    KrsStatus        status  = krs_refute(NULL, 0, path, &options, &how, result);
    unlink(path);
    return status;
}

/* Wrong at `line`: that shape is to blame. */
static void assert_blamed(const char *text, uint32_t line, const char *words)
{
    Said          said;
    KrsRefutation result;
    assert_int_equal(refute(text, 1, &said, &result), KRS_BAD_SCENE);
    assert_true(result.refuted);
    assert_int_equal(said.count, 1);
    assert_string_equal(said.code, "E0411");
    assert_int_equal(said.line, line);
    assert_non_null(strstr(said.text, words));
}

static void a_false_claim_of_exactness_is_blamed(void **state)
{
    (void)state;
    assert_blamed("shape dented() {\n"
                  "  distance: length(p) - 1 +\n"
                  "    0.02 * exp(-40000 * length(p - [0.6, 0.48, 0.64]) ^ 2),\n"
                  "  exact: true, within: box([3, 3, 3])\n"
                  "}\n"
                  "let part =\n"
                  "  dented();\n"
                  "show (part.scale(0.5).move([1, 2, 3]) | sphere(0.2))\n"
                  "  .mirror(plane([0, 1, 0], 4));\n",
                  7, "`exact` is claimed");
}

static void a_false_slope_is_blamed(void **state)
{
    (void)state;
    assert_blamed("param k = 2 in [1, 9];\n"
                  "shape waves(k) { distance: y + 0.3 * sin(k * x), slope: 1.5 }\n"
                  "show sphere(2) &\n"
                  "  waves(k);\n",
                  4, "with k = ");
}

static void a_false_box_is_blamed(void **state)
{
    (void)state;
    assert_blamed("shape horned() {\n"
                  "  distance: min(length(p) - 1, length(p - [0.3, 0.41, 1.06]) - 0.02),\n"
                  "  exact: true, within: box([2, 2, 2])\n"
                  "}\n"
                  "show box([1, 1, 1]).move([4, 0, 0]);\n"
                  "show horned();\n",
                  6, "outside of its box");
}

/* Claims beside the distance, true at the default of the parameter and false for others; each
   also as it is true for all. */
static void other_claims_are_searched(void **state)
{
    (void)state;
    static const struct {
        const char *shape, *use, *wrong, *right, *words;
    } claims[] = {
        {"distance: y - k, exact: true, plane: [[0, 1, 0], %s]", "show a(k) & box([3, 3, 3]);",
         "k ^ 2", "k", "`plane` of `a`"},
        {"distance: y - k, exact: true, plane: [[0, %s, 0], 2 * k]", "show sphere(1).mirror(a(k));",
         "2 * k", "2", "`plane` of `a`"},
        {"distance: y - k, exact: true, plane: [[0, 1, 0], k + %s]", /* a thousandth */
         "show krs { kernel sphere(1); reflect a(k); };", "0.001 * (k - 1)", "0", "`plane` of `a`"},
        {"distance: length([x, y + %s * z]) - 1, figure: true, within: [[-9, -9, 0], [9, 9, 0]]",
         "show a(k).extrude(1);", "0.01 * (k - 1)", "0", "its `distance` changes with z"},
        {"distance: length([x, y]) - 1, figure: true, within: [[-1, -1, 0], [1, 1, 0]],\n"
         "uv: [x, y + %s * z]",
         "show a(k).revolve(2);", "(k - 1)", "(k - k)", "its `uv` changes with z"},
        {"distance: length(p) - 1, exact: true, within: sphere(1), core: ball(1 - %s * rounding)",
         "show a(k).move([1, 2, 3]).round(0.2);", "k", "1", "grown by `rounding`"},
        {"distance: length(p) - k, exact: true, within: sphere(2), core: ball(%s - rounding)",
         "show a(k).scale(2).round(0.1 * k);", "sqrt(k)", "k", "`core` of `a`"},
        {"distance: 0.5 * (length(p) - k), slope: 1, within: sphere(2), bound: length(p) - %s",
         "show a(k) | sphere(0.1);", "k ^ 0.9", "k", "`bound` of `a`"},
        {"distance: 0.5 * (length(p) - 1), slope: 1, within: sphere(2), bound: %s * (length(p) - "
         "1)",
         "show a(k) | sphere(0.1);", "k", "1", "the distance of `a`"},
    };
    for (size_t i = 0; i < sizeof claims / sizeof *claims; i++)
        for (int wrong = 0; wrong < 2; wrong++) {
            char          claim[300], text[700];
            Said          said;
            KrsRefutation result;
            snprintf(claim, sizeof claim, claims[i].shape,
                     wrong ? claims[i].wrong : claims[i].right);
            snprintf(text, sizeof text,
                     "param k = 1 in [0.5, 2];\n"
                     "shape ball(r) { distance: length(p) - r, exact: true, within: sphere(r) }\n"
                     "shape a(k) { %s }\n%s\n",
                     claim, claims[i].use);
            KrsStatus status = refute(text, 0.2, &said, &result);
            if (status != (wrong ? KRS_BAD_SCENE : KRS_OK))
                print_message("%s%s\n", text, said.text);
            assert_int_equal(status, wrong ? KRS_BAD_SCENE : KRS_OK);
            if (wrong && !strstr(said.text, claims[i].words))
                fail_msg("%s%s\n", text, said.text);
            assert_int_equal(result.refuted, wrong);
        }
}

/* At other sizes than those of a test picture, too. */
static void claims_of_the_library_are_true(void **state)
{
    (void)state;
    static const char *const scenes[] = {
        "param k = 1 in [0.5, 2]; show box([k, 1, 2]).round(0.1 * k); show sphere(k).round(0.3);\n"
        "show cylinder(k, 1).round(0.2); show torus(k, 0.3).round(0.1);\n"
        "show link(k, 0.5, 0.2).round(0.1);",
        "param k = 1 in [0.5, 2]; show octahedron(k).round(0.1 * k); show "
        "tetrahedron(k).round(0.05);\n"
        "show dodecahedron(k).round(0.1); show icosahedron(k).round(0.1);\n"
        "show prism(5, k, 2).round(0.1);",
        "param k = 1 in [0.5, 2]; show circle(k).round(0.1).extrude(1); show ellipsoid([k, 2, "
        "0.3]);\n"
        "show rectangle([1, k]).round(0.1).extrude(1); show regular(7, k).round(0.1).revolve(3);\n"
        "show star(5, k).extrude(1); show polygon().extrude(k); show segment().extrude(k);\n"
        "show arc(k, 100deg).extrude(1); show bezier().extrude(k);",
        "param k = 1 in [0.5, 2]; show half_space([1, k, 2], k) & sphere(2);\n"
        "show plane([k, 1, 0], 0.5) & sphere(2);",
    };
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        Said          said;
        KrsRefutation result;
        KrsStatus     status = refute(scenes[i], 0.5, &said, &result);
        if (status != KRS_OK)
            print_message("%s\n", said.text);
        assert_int_equal(status, KRS_OK);
    }
}

/* Two parts, of which one may not be shown at all: it is looked at by itself. */
static void a_part_that_is_hidden_is_found(void **state)
{
    (void)state;
    assert_blamed("shape steep() { distance: if x < 9 then length(p) - 1 else 3 * length(p) - 1,\n"
                  "  exact: true, within: box([2, 2, 2]) }\n"
                  "show box([40, 40, 40]) |\n"
                  "  steep();\n",
                  4, "this shape is to blame");
}

static void honest_scenes_pass(void **state)
{
    (void)state;
    static const char *const scenes[] = {
        "show torus(1, 0.3) | box([1, 1, 1]).rotate([1, 2, 3], 40deg) - sphere(0.6);",
        "show union(sphere(1), box([1, 1, 1]).move([1, 0, 0]), blend: 0.2, kind: \"chamfer\");",
        "show krs { kernel sphere(0.3).move([-0.5, -0.6, 0]); reflect plane([1, 0, 0], 0.1);\n"
        "           reflect plane([0, 1, 0.2], -0.2); }.shell(0.1);",
        "param a = 0.3 in [0.1, 1]; show cone(0.3, 1).repeat([2, 2, 0], [3, 3, 1]).offset(a / 4);",
        "shape knot() { distance: (x ^ 2 + y ^ 2 + z ^ 2) ^ 2 - x, within: box([2.4, 2.4, 2.4]) }\n"
        "show knot().offset(0.3);", /* of a slope that has no bound outside of the box */
        "show field(sin(5 * x) * cos(5 * y) + sin(5 * y) * cos(5 * z) + sin(5 * z) * cos(5 * x))"
        ".within(sphere(2)).offset(0.01);", /* solid beyond the sides of its region */
        "show ellipsoid([0.5, 0.02, 0.12]).shell(0.2) | torus(1, 0.3).scale([1, 3, 1]).offset(0.4);"
        "param twist = 1 in [0, 3];"
        "show box([1, 2, 1]).twist([0, 1, 0], twist).taper([0, 1, 0], 1, 0.4);",
    };
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        Said          said;
        KrsRefutation result;
        KrsStatus     status = refute(scenes[i], 0.3, &said, &result);
        if (status != KRS_OK)
            print_message("%s\n", said.text);
        assert_int_equal(status, KRS_OK);
        assert_true(!result.refuted && result.shapes > 0 && result.evaluations > 1000);
        assert_true(result.steepest > 0.9 && result.steepest <= 1.000001);
    }
}

static void an_estimate_is_only_measured(void **state)
{
    (void)state;
    Said          said;
    KrsRefutation result;
    assert_int_equal(refute("show mandelbulb(8);", 0.2, &said, &result), KRS_OK);
    assert_int_equal(result.estimates, 1);
    assert_true(result.longest > 0.3 && result.longest <= 1);
    assert_true(result.steepest == 0);
}

static void the_search_is_the_same_each_time(void **state)
{
    (void)state;
    Said          said;
    KrsRefutation first, second;
    const char   *text = "param a = 1 in [0.5, 2]; show torus(a, 0.3) | box([1, 1, 1]);";
    assert_int_equal(refute(text, 0.1, &said, &first), KRS_OK);
    assert_int_equal(refute(text, 0.1, &said, &second), KRS_OK);
    assert_true(first.steepest == second.steepest && first.evaluations == second.evaluations);
    assert_int_equal(first.settings, 6);
}

static bool stop(void *user, double fraction)
{
    (void)user, (void)fraction;
    return false;
}

static void a_search_can_be_stopped(void **state)
{
    (void)state;
    KrsRefutation    result;
    KrsRefuteOptions how = {.seconds = 1e6, .progress = stop};
    assert_int_equal(krs_refute(NULL, 0, "examples/01-hello.krs", NULL, &how, &result),
                     KRS_INTERRUPTED);
    assert_int_equal(krs_refute(NULL, 0, "no-such-scene.krs", NULL, &how, &result), KRS_IO_ERROR);
}

/* ---- broken between compiling and searching ---- */

typedef struct Breaking Breaking;

struct Breaking {
    void (*how)(const Breaking *b, Shape *shape);
    uint32_t      stage; /* of a sequence */
    double        by;    /* part of a box's size that is taken away on all sides */
    KrsRefutation result;
};

static KrsStatus break_and_refute(void *user, const Inspected *in)
{
    Breaking        *b   = user;
    KrsRefuteOptions how = {.seconds = 0.3, .seed = 1};
    b->how(b, (Shape *)(uintptr_t)in->scene->components.items[0].shape);
    return refute_inspected(in, &how, &b->result);
}

static KrsStatus refute_broken(const char *text, Breaking *b, Said *said)
{
    char path[] = "/tmp/krs-refute-XXXXXX";
    write_scene(path, text);
    *said              = (Said){0};
    KrsOptions options = {.diagnostic = take, .user = said};
    KrsStatus  status  = inspect_text(NULL, 0, path, &options, break_and_refute, b);
    unlink(path);
    return status;
}

static void shrink_level(const Breaking *b, Shape *shape)
{
    assert_int_equal(shape->kind, SHAPE_KRS);
    Box *box = (Box *)(uintptr_t)&shape->bounds[b->stage].box;
    for (int i = 0; i < 3; i++) {
        double less = b->by * (box->axis[i].high - box->axis[i].low);
        box->axis[i].low += less;
        box->axis[i].high -= less;
    }
}

/* Levels are left out after kernels and after the last stage. */
static void shrunken_boxes_of_levels_are_found(void **state)
{
    (void)state;
    static const char swarm[] =
        "show krs {\n"
        "  for i in 0..4 {\n"
        "    kernel sphere(0.2).move([0, 0.3 * i, 0]);\n"
        "    reflect plane([cos(2.2 * i), 0.2, sin(2.2 * i)], 0.4 * (i + 1));\n"
        "  }\n"
        "};\n";
    static const uint32_t stages[] = {0, 2, 4, 6, 7};
    for (size_t i = 0; i < sizeof stages / sizeof *stages; i++) {
        Said     said;
        Breaking b = {.how = shrink_level, .stage = stages[i], .by = 0.05};
        assert_int_equal(refute_broken(swarm, &b, &said), KRS_BAD_SCENE);
        assert_non_null(strstr(said.text, "the distance that leaves out what is far"));
        assert_non_null(strstr(said.text, "times as long as the way to the surface"));
    }
    Said     said;
    Breaking none = {.how = shrink_level};
    assert_int_equal(refute_broken(swarm, &none, &said), KRS_OK);
}

/* Times two it is infinite, which only the guard of the level sees. */
static void enlarge_ball(const Breaking *b, Shape *shape)
{
    (void)b;
    ((LevelBound *)(uintptr_t)shape->bounds)[0].ball.radius = DBL_MAX;
}

static void empty_box(const Breaking *b, Shape *shape)
{
    (void)b;
    shape->box = box_empty;
}

static void lose_a_side(const Breaking *b, Shape *shape)
{
    (void)b;
    shape->box.axis[1].low = NAN;
}

static void what_is_not_finite_is_not_passed_over(void **state)
{
    (void)state;
    static const char scaled[] = "show krs { kernel sphere(1); mobius scale(2);\n"
                                 "           reflect plane([1, 0, 0], 4); };\n";
    static const struct {
        void (*how)(const Breaking *b, Shape *shape);
        const char *words;
    } breaks[] = {
        {enlarge_ball, "the same at all points is not finite"},
        {empty_box, "outside of its box"},
        {lose_a_side, "a side of its box is not a number"},
    };
    for (size_t i = 0; i < sizeof breaks / sizeof *breaks; i++) {
        Said     said;
        Breaking b = {.how = breaks[i].how};
        assert_int_equal(refute_broken(scaled, &b, &said), KRS_BAD_SCENE);
        assert_string_equal(said.code, "E0411");
        assert_non_null(strstr(said.text, breaks[i].words));
    }
}

/* States refuse the end of the range; the others are searched. */
static void settings_that_cannot_be_had_are_no_mistake(void **state)
{
    (void)state;
    Said          said;
    KrsRefutation result;
    const char   *text = "param a = 1 in [0, 1];\n"
                         "show sphere(1) | field(x + y + z + 1 / a).within(sphere(2));";
    assert_int_equal(refute(text, 0.2, &said, &result), KRS_OK);
    assert_true(result.settings + result.refused == 6 && result.settings > 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_false_claim_of_exactness_is_blamed),
        cmocka_unit_test(a_false_slope_is_blamed),
        cmocka_unit_test(a_false_box_is_blamed),
        cmocka_unit_test(other_claims_are_searched),
        cmocka_unit_test(claims_of_the_library_are_true),
        cmocka_unit_test(a_part_that_is_hidden_is_found),
        cmocka_unit_test(honest_scenes_pass),
        cmocka_unit_test(an_estimate_is_only_measured),
        cmocka_unit_test(the_search_is_the_same_each_time),
        cmocka_unit_test(a_search_can_be_stopped),
        cmocka_unit_test(shrunken_boxes_of_levels_are_found),
        cmocka_unit_test(what_is_not_finite_is_not_passed_over),
        cmocka_unit_test(settings_that_cannot_be_had_are_no_mistake),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
