/*
 * Boxes of iterations: of random shapes whose numbers depend on `i`, they are the boxes of the same text
 * with a constant in the place of `i`: never smaller, and larger by roundings only.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/inspect.h"
#include "compiler/shape/iteration_boxes.h"
#include "tests/support/random.h"

enum { SHAPES = 200, ITERATIONS = 3, LONGEST = 4000 };

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

/* ---- texts ---- */

typedef struct Written {
    char   text[LONGEST];
    Random random;
} Written;

static void write(Written *w, const char *what)
{
    assert_true(strlen(w->text) + strlen(what) < LONGEST - 1);
    strcat(w->text, what);
}

static const char *one_of(Written *w, const char *const *words, int count)
{
    return words[random_below(&w->random, count)];
}

static void write_positive(Written *w)
{
    static const char *const numbers[] = {"0.5",
                                          "(1.2 + sin(i))",
                                          "(0.3 + 0.07 * i)",
                                          "(0.2 + abs(cos(3 * i)))",
                                          "[1, 2, 0.7][floor(clamp(i, 0, 2))]",
                                          "max(0.1, 2 - 0.3 * i)"};
    write(w, one_of(w, numbers, COUNT(numbers)));
}

static void write_number(Written *w)
{
    static const char *const numbers[] = {"(i - 3)", "0",        "1.5 * cos(i)",
                                          "-0.4",    "(30 * i)", "(i % 3)"};
    write(w, one_of(w, numbers, COUNT(numbers)));
}

static void write_vector(Written *w, void part(Written *w))
{
    for (int i = 0; i < 3; i++) {
        write(w, i ? ", " : "[");
        part(w);
    }
    write(w, "]");
}

/* `%` stands for a positive number, `#` for any, `^` and `&` for vectors of these, `*` for a shape. */
static void write_shape(Written *w, int depth);

static void write_form(Written *w, const char *form, int depth)
{
    for (; *form; form++)
        if (*form == '%')
            write_positive(w);
        else if (*form == '#')
            write_number(w);
        else if (*form == '^')
            write_vector(w, write_positive);
        else if (*form == '&')
            write_vector(w, write_number);
        else if (*form == '*')
            write_shape(w, depth);
        else
            write(w, (char[]){*form, '\0'});
}

static void write_shape(Written *w, int depth)
{
    static const char *const solids[] = {"sphere(%)",
                                         "box(^)",
                                         "cylinder(%, %)",
                                         "capsule(&, [0.1, 0.2, 0.3], %)",
                                         "torus(1 + %, 0.2)",
                                         "ellipsoid(^)",
                                         "cone(%, %)",
                                         "rectangle([%, %]).extrude(%)",
                                         "circle(%).revolve(#)",
                                         "polygon([[0, 0], [%, 0], [0, %]]).extrude(%)",
                                         "octahedron(%)",
                                         "plane([0, 1, 0], #)",
                                         "round_cone([0, 0, 0], [0, 1, #], %, 0.1)",
                                         "box([%, 1, 2])",
                                         "sphere(1)",
                                         "box([1 + k, 2, 1])",
                                         "shape_of(%)",
                                         "inside(%)"};
    static const char *const others[] = {"*.move(&)",
                                         "*.rotate([0, 1, 0], 90deg * i)",
                                         "*.rotate([1, 2, #], #)",
                                         "*.scale(%)",
                                         "*.scale(^)",
                                         "*.offset(%)",
                                         "*.offset(-0.1)",
                                         "*.shell(%)",
                                         "*.elongate(^)",
                                         "*.mirror(plane([1, 0, 0], #))",
                                         "*.mirror(plane([0, sin(i), cos(i)], 0.1))",
                                         "*.repeat([100000, 200000, 0], count: [3, 4, 1])",
                                         "*.repeat_polar(5)",
                                         "*.paint(tomato)",
                                         "(* | *)",
                                         "(* & *)",
                                         "(* - *)",
                                         "union(*, *, *, blend: 0.2 * %)",
                                         "union(*, *, *, *, blend: %, kind: \"chamfer\")",
                                         "intersection(*, *, blend: %)",
                                         "difference(*, *, blend: 0.1)",
                                         "xor(*, *)",
                                         "morph(*, *, 0.5 + 0.5 * sin(i))",
                                         "(if i % 2 < 1 then * else *)",
                                         "sphere(%).round(%)",
                                         "box([2, 2, 2]).round(0.1)",
                                         "sphere(1).move([1, 0, 0]).within(box(^))",
                                         "*.smooth_mirrors(0.1)",
                                         "meta([sphere(%), box(^)], reach: %)",
                                         "*.move([5, 0, 0]).rotate([0, 1, 0], 90deg * i)"};
    if (depth == 0 || random_below(&w->random, 6) == 0)
        write_form(w, one_of(w, solids, COUNT(solids)), depth);
    else
        write_form(w, one_of(w, others, COUNT(others)), depth - 1);
}

/* ---- boxes ---- */

typedef struct Asked {
    const double *iterations; /* NULL: the box as it is */
    Box           boxes[ITERATIONS];
    bool          known;
} Asked;

static KrsStatus ask(void *user, const Inspected *what)
{
    Asked       *asked = user;
    const Shape *shape = what->scene->components.items[0].shape;
    if (!asked->iterations) {
        asked->boxes[0] = shape->box;
        return KRS_OK;
    }
    ShapeBuilder builder = {.arena   = what->arena,
                            .scratch = what->scratch,
                            .diags   = what->diags,
                            .graph   = what->scene->graph};
    const Node   leaf    = graph_parameter(what->scene->graph, TYPE_FLOAT, 1);
    asked->known         = iteration_boxes(&builder, shape, leaf, asked->iterations, ITERATIONS,
                                           asked->boxes, what->arena);
    return KRS_OK;
}

static bool find(const Written *w, const char *i, Asked *asked)
{
    static const char *const rest =
        "; param k = 0 in [-1, 1];"
        "shape shape_of(r) { distance: length(p) - r, within: [[-r, -r, -r], [r, 2, r]] }"
        "shape inside(r) { distance: length(p) - 0.1, within: box([r, 1, r + 1]).move([0, 0, r]) }"
        "show ";
    char      text[LONGEST + 1000];
    const int length = snprintf(text, sizeof text, "%s%s%s;", i, rest, w->text);
    return inspect_elaborated(text, (size_t)length, NULL, ask, asked) == KRS_OK;
}

/* How much larger than it must be, over the largest number in it; < 0: it is smaller somewhere. */
static double excess(const Box *box, const Box *least)
{
    double largest = 0, most = 0, inside = 0;
    if (box_is_empty(*box) || box_is_empty(*least))
        return box_is_empty(*box) == box_is_empty(*least) ? 0 : -HUGE_VAL;
    for (int i = 0; i < 3; i++) {
        const double ends[2] = {least->axis[i].low, least->axis[i].high};
        const double more[2] = {ends[0] - box->axis[i].low, box->axis[i].high - ends[1]};
        for (int k = 0; k < 2; k++) {
            largest = isfinite(ends[k]) ? fmax(largest, fabs(ends[k])) : largest;
            most    = isfinite(ends[k]) ? fmax(most, more[k]) : most;
            inside  = isfinite(ends[k]) ? fmin(inside, more[k])
                      : box->axis[i].low > ends[0] || box->axis[i].high < ends[1] ? -HUGE_VAL
                                                                                  : inside;
        }
    }
    return inside < 0 ? inside : largest > 0 ? most / largest : most;
}

/* Whether its boxes in these iterations are those of constants; their texts say `i` is more by `error`. */
typedef struct Verdict {
    int same, different, unknown;
} Verdict;

static void compare(const Written *w, const double *iterations, double error, Verdict *verdict)
{
    Asked iterated = {.iterations = iterations}, fixed = {0};
    if (!find(w, "param i = 0 in [0, 10]", &iterated))
        return; /* it is wrong for some number */
    verdict->unknown += !iterated.known;
    for (int t = 0; t < ITERATIONS && iterated.known; t++) {
        char constant[60];
        snprintf(constant, sizeof constant, "let i = %.17g", iterations[t] + error);
        assert_true(find(w, constant, &fixed));
        const double more = excess(&iterated.boxes[t], &fixed.boxes[0]);
        const bool   same = more >= 0 && more < 1e-12;
        if (!same && error == 0)
            print_message("# %s: in turn %g its box is larger by %g\n", w->text, iterations[t],
                          more);
        *(same ? &verdict->same : &verdict->different) += 1;
    }
}

static Verdict compare_all(double error, int count)
{
    Random  random  = {7};
    Verdict verdict = {0};
    for (int n = 0; n < count; n++) {
        Written      w                      = {.random = {random_bits(&random)}};
        const double iterations[ITERATIONS] = {n % 10, 2, 7.25};
        write_shape(&w, 1 + n % 4);
        compare(&w, iterations, error, &verdict);
    }
    print_message("# %d boxes are the same, %d are not; %d shapes are not known\n", verdict.same,
                  verdict.different, verdict.unknown);
    return verdict;
}

static void boxes_of_iterations_are_those_of_constants(void **state)
{
    (void)state;
    const Verdict verdict = compare_all(0, SHAPES);
    assert_true(verdict.same > SHAPES);
    assert_int_equal(verdict.different, 0);
    assert_int_equal(verdict.unknown, 0);
}

/* The test itself sees boxes that are wrong by a little; some depend on no number. */
static void other_boxes_are_found_out(void **state)
{
    (void)state;
    const Verdict verdict = compare_all(1e-7, SHAPES / 4);
    assert_true(verdict.different > verdict.same);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_of_iterations_are_those_of_constants),
        cmocka_unit_test(other_boxes_are_found_out),
    };
    return cmocka_run_group_tests_name("boxes of turns", tests, NULL, NULL);
}
