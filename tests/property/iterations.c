/*
 * iterations.c: loops that are evaluated once are what their iterations are, evaluated one by one: distances,
 * surfaces, tables and text; and those that must be evaluated iteration by iteration are.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/vec.h"
#include "compiler/passes/inspect.h"
#include "compiler/scene/program.h"
#include "tests/support/random.h"

enum { POINTS = 300, LEAST = 16, SEEDS = 3 };

static const char prelude[] =
    "let seed = %d;\n"
    "def within(i, k) = 2 * random(seed + 3 * i + k) - 1;\n"
    "def spot(i) = 3 * [within(i, 0), within(i, 1), within(i, 2)];\n"
    "def size(i) = 0.2 + 0.2 * random(seed + 0.5 + i);\n"
    "def hue(i) = random(seed + 0.25 + i);\n"
    "let colors = [#d8433b, #f08a24, #f4c430, #4f9d4a, #2f7fc1];\n"
    "def pick(i) = colors[floor(len(colors) * hue(i))];\n"
    "def ball(i) = sphere(size(i)).move(spot(i));\n"
    "def brick(i) = box(size(i) * [1, 2, 3]).round(0.03).rotate(random_direction(i), 6 * hue(i));\n"
    "def gable(w, h) = polygon([[-w / 2, 0], [w / 2, 0], [0, h]]);\n"
    "shape egg(radius = 1) { distance: length([x, y, z]) - radius, exact: true }\n"
    "param wide = 0.3 in [0.1, 0.5];\n";

typedef struct Loop {
    const char *name, *text; /* what is shown, or a `for` that shows it */
} Loop;

static const Loop at_once[] = {
    {"balls", "union([ball(i) for i in 0..40])"},
    {"painted", "union([ball(i).paint(pick(i)) for i in 0..40])"},
    {"bricks", "union([brick(i).move(spot(i)).paint(pick(i)) for i in 0..40])"},
    {"filtered", "union([ball(i) for i in 0..60 if hue(i) < 0.6])"},
    {"filtered twice", "union([ball(i) for i in 0..90 if hue(i) < 0.6 if i % 7 != 3])"},
    {"chosen numbers", "union([box(if hue(i) < 0.5 then [1, 0.2, 0.2] else [0.2, 1, size(i)])"
                       ".move(spot(i)) for i in 0..40])"},
    {"loops within", "union([union([sphere(0.2).move(spot(i) + 0.2 * [k, 0, hue(i + k)]) "
                     "for k in 0..3]) for i in 0..40])"},
    {"blend within", "union([union([sphere(size(i)), sphere(0.2).move([0, size(i), 0])], "
                     "blend: 0.1).move(spot(i)) for i in 0..40])"},
    {"blended", "union([ball(i) for i in 0..40], blend: 0.05)"},
    {"extruded",
     "union([gable(0.3 + size(i), size(i)).extrude(0.5).move(spot(i)) for i in 0..40])"},
    {"repeated",
     "union([box([0.2, 0.2, 0.2]).repeat([0.4 + size(i), 1, 1], [3, 1, 1]).move(spot(i)) "
     "for i in 0..40])"},
    {"less", "union([(sphere(size(i)) - box([1, size(i), 0.2])).move(spot(i)) for i in 0..40])"},
    {"of its point", "union([ball(i).paint([0.5 + 0.5 * sin(9 * x + i), hue(i), 0.5]) "
                     "for i in 0..40])"},
    {"an index", "union([ball(i).paint(colors[floor(i / 10)]) for i in 0..40])"},
    {"from elsewhere", "union([ball(i) for i in 7..40.5])"},
    {"below an offset", "union([ball(i) for i in 0..40]).round(0.05)"},
    {"below a blend", "union(union([ball(i) for i in 0..40]), box([1, 1, 1]), blend: 0.1)"},
    {"less a loop", "box([2, 2, 2]) - union([ball(i) for i in 0..40])"},
    {"tools", "difference(box([3, 3, 3]), [ball(i) for i in 0..40])"},
    {"tools, painted",
     "difference(box([3, 3, 3]), ball(50), [ball(i).paint(pick(i)) for i in 0..40])"},
    {"tools, blended", "difference(box([3, 3, 3]), [ball(i) for i in 0..40], blend: 0.05)"},
    {"tools of a tool", "difference([sphere(4 - 0.1 * i).move(0.1 * spot(i)) for i in 0..40])"},
    {"tools in a plane", "difference(rectangle([3, 3]), [circle(size(i)).move([within(i, 0), "
                         "2 * within(i, 1)]) for i in 0..40]).extrude(1)"},
    {"in common", "intersection([sphere(4 + size(i)).move(0.3 * spot(i)) for i in 0..40])"},
    {"in common, painted", "intersection([sphere(4 + size(i)).move(0.3 * spot(i)).paint(pick(i)) "
                           "for i in 0..40])"},
    {"in common, blended", "intersection([sphere(4 + size(i)).move(0.3 * spot(i)) for i in 0..40], "
                           "blend: 0.2)"},
    {"in common with a box",
     "intersection(box([5, 5, 5]), [sphere(4 + size(i)).move(0.3 * spot(i)) "
     "for i in 0..40])"},
    {"shown", "[ball(i) for i in 0..40]"},
    {"shown and painted", "[brick(i).move(spot(i)).paint(pick(i)) for i in 0..60 if hue(i) < 0.8]"},
    {"statements", "for i in 0..40 { show ball(i); }"},
    {"statements, painted",
     "for i in 0..40 { let at = spot(i); show brick(i).move(at).paint(pick(i)); }"},
    {"several statements",
     "for i in 0..40 { let b = ball(i).paint(pick(i)); show b; let up = [0, 1, 0]; "
     "show brick(i).move(spot(i + 50)).paint(pick(i + 7)); show b.move(up); }"},
    {"statements that may show", "for i in 0..60 { if hue(i) < 0.6 { show ball(i); "
                                 "show ball(i + 100).paint(pick(i)); } }"},
    {"statements in two conditions",
     "for i in 0..90 { let h = hue(i); if seed > 0 { if h < 0.8 { let k = i % 7; "
     "if k != 3 { show ball(i).paint(pick(i)); } } } else { show ball(i); } }"},
    {"statements that show nothing at first",
     "for i in -10..40 { if i > 0 { show ball(i).paint(pick(i)); } }"},
    {"a hull", "hull(union([sphere(0.2).move(spot(i)) for i in 0..40]))"},
    {"a hull of some", "hull(union([ball(i) for i in 0..60 if hue(i) < 0.7]))"},
    {"a hull that is moved",
     "hull(union([ball(i) for i in 0..40]).move([1, 0, 0])).paint(pick(3))"},
    {"fillets",
     "union(box([6, 0.2, 6]), union([ball(i) for i in 0..40]), blend: 0.05, kind: \"fillet\")"},
    {"fillets, painted and moved",
     "union(box([6, 0.2, 6]), union([brick(i).move(spot(i)).paint(pick(i)) for i in 0..40])"
     ".rotate([0, 1, 0], 0.3), blend: 0.05, kind: \"fillet\")"},
    {"noise", "union([sphere(0.3).move(spot(i) + [noise(i + 0.3), 0, 0]) for i in 0..40])"},
};

static const Loop by_iterations[] = {
    {"few", "union([ball(i) for i in 0..15])"},
    {"few are left", "union([ball(i) for i in 0..40 if i % 4 == 1])"},
    {"two variables", "union([ball(i + 9 * k) for i in 0..20 for k in 0..2])"},
    {"of a list", "union([ball(i) for i in [3, 1, 4, 1, 5, 9, 2, 6, 5, 3, 5, 8, 9, 7, 9, 3, 2]])"},
    {"a shape is chosen", "union([if hue(i) < 0.5 then ball(i) else brick(i) for i in 0..40])"},
    {"a number of parts", "union([union([ball(i + k) for k in 0..1 + floor(3 * hue(i))]) "
                          "for i in 0..40])"},
    {"by the time", "union([ball(i).move([sin(time + i), 0, 0]) for i in 0..40])"},
    {"by a param", "union([sphere(wide * size(i)).move(spot(i)) for i in 0..40])"},
    {"with a param", "union([capsule([0, 0, 0], [0, size(i), 0], wide).move(spot(i)) "
                     "for i in 0..40])"},
    {"declared", "union([egg(size(i)).move(spot(i)) for i in 0..40])"},
    {"large joints within", "union([union([ball(i + 100 * k) for k in [0, 1, 2, 3, 4, 5, 6, 7, 8, "
                            "9, 10, 11, 12, 13, 14, 15, 16]]) for i in 0..20])"},
    {"a deformation", "union([box([0.2, 1, 0.2]).twist([0, 1, 0], size(i)).move(spot(i)) "
                      "for i in 0..40])"},
    {"not finite", "union([sphere(if i == 3 then 0.3 else 1 / (4 + abs(i - 3))).move([1 / "
                   "(if i == 3 then 1 else i - 3), 0, 0]) for i in 0..40])"},
    {"some are empty", "union([sphere(hue(i) - 0.5).move(spot(i)) for i in 0..40])"},
    {"degrees forgotten", "union([ball(i).rotate([0, 1, 0], 90 * i) for i in 0..40])"},
    {"asserted", "union([assert(hue(i) < 2) in ball(i) for i in 0..40])"},
    {"shown, and may be empty", "[(ball(i) & box([5, 5, 5])) for i in 0..40]"},
    {"few statements", "for i in 0..15 { show ball(i); }"},
    {"statements in two loops", "for i in 0..20 { for k in 0..2 { show ball(i + 30 * k); } }"},
    {"statements that show lists", "for i in 0..40 { show [ball(i), ball(i + 50)]; }"},
    {"either of two statements",
     "for i in 0..40 { if hue(i) < 0.5 { show ball(i); } else { show brick(i).move(spot(i)); } }"},
    {"a statement before a condition",
     "for i in 0..40 { show ball(i); if hue(i) < 0.5 { show brick(i).move(spot(i + 50)); } }"},
    {"a statement behind a condition",
     "for i in 0..40 { if hue(i) < 0.5 { let a = 1; } show ball(i); }"},
    {"statements by the time", "for i in 0..40 { show ball(i).move([sin(time + i), 0, 0]); }"},
};

typedef struct Asked {
    KrsScene *scene;
    KrsState *state;
    double    distances[POINTS];
    KrsHit    hits[POINTS];
} Asked;

static void open_loop(Asked *asked, const Loop *loop, int seed, KrsSpecialize specialize,
                      bool iterations)
{
    char       text[4096];
    KrsOptions options = {.specialize = specialize};
    size_t     length  = (size_t)snprintf(text, sizeof text, prelude, seed);
    length += (size_t)snprintf(text + length, sizeof text - length,
                               strncmp(loop->text, "for ", 4) == 0 ? "%s\n" : "show %s;\n",
                               loop->text);
    assert_true(length < sizeof text);
    KrsStatus status = iterations
                           ? compile_iteration_by_iteration(text, length, LEAST, &options,
                                                            &asked->scene)
                           : compile_with_instances(text, length, LEAST, &options, &asked->scene);
    if (status != KRS_OK)
        fail_msg("%s does not compile:\n%s", loop->name, text);
    assert_int_equal(krs_state_new(asked->scene, &asked->state), KRS_OK);
}

static void close_loop(Asked *asked)
{
    krs_state_free(asked->state);
    krs_scene_free(asked->scene);
}

static void ask(Asked *asked, const double points[POINTS][3])
{
    assert_int_equal(krs_distance(asked->state, points, POINTS, asked->distances), KRS_OK);
    assert_int_equal(krs_probe(asked->state, points, POINTS, asked->hits), KRS_OK);
}

static bool is_near(double a, double b) { return a == b || fabs(a - b) < 1e-9; }

/* Users see each iteration of what is shown. */
static void compare_components(const Loop *loop, const KrsScene *a, const KrsScene *b)
{
    assert_int_equal(krs_component_count(a), krs_component_count(b));
    for (size_t i = 0; i < krs_component_count(a); i++) {
        KrsComponent x, y;
        assert_int_equal(krs_component(a, i, &x), KRS_OK);
        assert_int_equal(krs_component(b, i, &y), KRS_OK);
        bool same = strcmp(x.name, y.name) == 0 && x.exact == y.exact && x.estimate == y.estimate;
        for (int k = 0; k < 3; k++)
            same = same && is_near(x.low[k], y.low[k]) && is_near(x.high[k], y.high[k]);
        if (!same)
            fail_msg("%s: component %zu: %s and %s", loop->name, i + 1, x.name, y.name);
    }
}

/* In the order of blends, and where numbers are rounded otherwise, both may differ a little. */
static void compare(const Loop *loop, const Asked *a, const Asked *b)
{
    if (a->scene->program.table_count != b->scene->program.table_count)
        fail_msg("%s: %zu and %zu tables", loop->name, (size_t)a->scene->program.table_count,
                 (size_t)b->scene->program.table_count);
    for (int k = 0; k < 3; k++)
        assert_true(is_near(a->scene->program.low[k], b->scene->program.low[k]) &&
                    is_near(a->scene->program.high[k], b->scene->program.high[k]));
    for (int i = 0; i < POINTS; i++) {
        const KrsHit *x = &a->hits[i], *y = &b->hits[i];
        if (!(fabs(a->distances[i] - b->distances[i]) <= 1e-12) ||
            !(distance3(x->color, y->color) <= 1e-9) || x->component != y->component ||
            x->level != y->level || x->instance != y->instance ||
            !(distance3(x->normal, y->normal) <= 1e-5))
            fail_msg("%s: point %d: %.17g and %.17g", loop->name, i, a->distances[i],
                     b->distances[i]);
    }
}

/* A loop that is evaluated once has a leaf, which takes a slot of the parameter block. */
static void hold_against_iterations(const Loop *loop, int seed, KrsSpecialize specialize,
                                    uint32_t more)
{
    static Asked once, iterations;
    double       points[POINTS][3];
    Random       random = {(uint64_t)seed};
    for (int i = 0; i < POINTS; i++)
        random_vector(&random, i % 8 ? 3.5 : 12, points[i]);
    open_loop(&once, loop, seed, specialize, false);
    open_loop(&iterations, loop, seed, specialize, true);
    if (once.scene->program.parameter_slots != iterations.scene->program.parameter_slots + more)
        fail_msg("%s: %s", loop->name, more ? "evaluated turn by turn" : "evaluated at once");
    ask(&once, (const double(*)[3])points);
    ask(&iterations, (const double(*)[3])points);
    compare(loop, &once, &iterations);
    compare_components(loop, once.scene, iterations.scene);
    close_loop(&once);
    close_loop(&iterations);
}

static void loops_are_as_their_iterations(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof at_once / sizeof *at_once; i++)
        for (int seed = 1; seed <= SEEDS; seed++) {
            hold_against_iterations(&at_once[i], seed, KRS_SPECIALIZE_NUMBERS, 1);
            hold_against_iterations(&at_once[i], seed, KRS_SPECIALIZE_STRUCTURE, 1);
        }
}

static void others_are_evaluated_by_iterations(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof by_iterations / sizeof *by_iterations; i++)
        hold_against_iterations(&by_iterations[i], 1, KRS_SPECIALIZE_NUMBERS, 0);
}

/* ---- mistakes ---- */

typedef struct Said {
    char   text[65536];
    size_t length;
} Said;

static void say(void *user, const KrsDiagnostic *diagnostic)
{
    Said *said = user;
    said->length += (size_t)snprintf(said->text + said->length, sizeof said->text - said->length,
                                     "%s", diagnostic->text);
    assert_true(said->length < sizeof said->text);
}

/* Mistakes in one iteration, also where that iteration shows nothing, and what is told of some. */
static const char *const remarks[] = {
    "let q = [1, 2, 3, -4];\n"
    "for i in 0..60 { let n = q[floor(i / 10)]; if n > 0 { show sphere(0.1).move([i, 0, 0]); } }",
    "for i in 0..60 { let n = 1 / (i - 50); if i < 45 { show sphere(0.1).move([i, 0, n]); } }",
    "show [sphere(0.1).move([i, 0, 0]) for i in 0..60 if [1, 2, 3, -4][floor(i / 10)] > 0];",
    "for i in 0..40 { show sphere(20 - i).move([9 * i, 0, 0]); }",
    "for i in 0..40 { print(i / 39); show sphere(1).move([9 * i, 0, 0]); }",
    "for i in 0..40 { show sphere(1).move([9 * i, 0, 0]) & sphere(1).move([8.6 * i, 0, 0]); }",
    "for i in 0..40 { show if i == 20 then 3 else sphere(1).move([9 * i, 0, 0]); }",
    "for i in 0..40 { show sphere(1).move([9 * i, 0, 0]).paint([i / 20, 0, 0]); }",
    "show union([sphere(1).move([9 * i, 0, 0]).paint((i / 20) * [1, 1, 1]) for i in 0..40]);",
};

static void messages_are_those_of_iterations(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof remarks / sizeof *remarks; i++) {
        static Said once, iterations;
        memset(&once, 0, sizeof once);
        memset(&iterations, 0, sizeof iterations);
        KrsScene  *scene = NULL;
        KrsOptions first = {.diagnostic = say, .user = &once};
        KrsOptions other = {.diagnostic = say, .user = &iterations};
        KrsStatus a = compile_with_instances(remarks[i], strlen(remarks[i]), LEAST, &first, &scene);
        krs_scene_free(scene);
        scene       = NULL;
        KrsStatus b = compile_iteration_by_iteration(remarks[i], strlen(remarks[i]), LEAST, &other,
                                                     &scene);
        krs_scene_free(scene);
        if (a != b || once.length == 0 || strcmp(once.text, iterations.text) != 0)
            fail_msg("%s\n%s\n%s", remarks[i], once.text, iterations.text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(loops_are_as_their_iterations),
                                       cmocka_unit_test(others_are_evaluated_by_iterations),
                                       cmocka_unit_test(messages_are_those_of_iterations)};
    return cmocka_run_group_tests_name("loops that are evaluated once", tests, NULL, NULL);
}
