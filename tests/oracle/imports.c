/*
 * imports.c: surfaces of SURFER and tapes of operations that a random generator writes: what the
 * import accepts compiles, and has the sign of the tape; all else is refused with its line.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "tests/oracle/imported.h"

enum { SURFACES = 32, TAPES = 24, MAX_STEPS = 16, POINTS = 40 };

static Random randomness = {15};

static double between(double low, double high) { return random_between(&randomness, low, high); }
static int    below(int count) { return random_below(&randomness, count); }

/* ---- equations ---- */

static void add(char *text, size_t size, const char *piece)
{
    assert_true(strlen(text) + strlen(piece) < size);
    strcat(text, piece);
}

static void add_equation(char *text, size_t size, int depth)
{
    static const char *const leaves[]    = {"x", "y", "z", "x", "y", "z", "a", "0.5", "2", "1"};
    static const char *const functions[] = {"sin", "cos",  "tan",  "asin",  "acos", "atan", "exp",
                                            "log", "sqrt", "ceil", "floor", "abs",  "sign"};
    static const char *const signs[]     = {"+", "-", "*", "*", "/"};
    static const char *const powers[]    = {"^2", "^3", "^4", "^0.5", "^a", "^-1", "^30"};
    int                      kind        = depth == 0 ? 0 : below(12);
    if (kind < 2) {
        add(text, size, leaves[below(sizeof leaves / sizeof *leaves)]);
        return;
    }
    if (kind == 2)
        add(text, size, functions[below(sizeof functions / sizeof *functions)]);
    add(text, size, "(");
    add_equation(text, size, depth - 1);
    if (kind > 4) {
        add(text, size, signs[below(sizeof signs / sizeof *signs)]);
        add_equation(text, size, depth - 1);
    }
    add(text, size, ")");
    if (kind == 3 || kind == 4)
        add(text, size, powers[below(below(3) > 0 ? 3 : sizeof powers / sizeof *powers)]);
}

static void random_surfaces(void **state)
{
    int polynomials = 0, fields = 0;
    (void)state;
    for (int i = 0; i < SURFACES; i++) {
        char text[4096] = "surface_parameter_a=0.7\nsurface_equation=";
        add_equation(text, sizeof text, 1 + below(4));
        if (!assert_scene_or_line("random.jsurf", text))
            continue;
        bool field = strstr(imported("random.jsurf", text).scene, "field(") != NULL;
        fields += field;
        polynomials += !field;
    }
    assert_true(polynomials > SURFACES / 8);
    assert_true(fields > 0);
}

static void what_is_no_polynomial_is_a_field_or_refused(void **state)
{
    (void)state;
    assert_non_null(strstr(imported("a.jsurf", "surface_equation=x^2+y^2-z").scene, "algebraic("));
    assert_non_null(strstr(imported("a.jsurf", "surface_equation=sin(x)+y").scene, "field("));
    assert_refused("a.jsurf", "\nsurface_equation=floor(x)+y", "a.jsurf:2: what this becomes");
    assert_refused("a.jsurf", "\n\nsurface_equation=1/x", "a.jsurf:3: what this becomes");
    assert_refused("a.vm", "_0 var-x\n_1 const 2\n_2 floor _0\n_3 mul _2 _1\n",
                   "a.vm:3: `floor` jumps");
}

/* ---- tapes ---- */

static double plus(double a, double b) { return a + b; }
static double minus(double a, double b) { return a - b; }
static double times(double a, double b) { return a * b; }
static double over(double a, double b) { return a / b; }
static double less(double a, double b) { return a < b ? a : b; }
static double more(double a, double b) { return a > b ? a : b; }
static double sine(double a, double b) { return sin(a + 0 * b); }
static double cosine(double a, double b) { return cos(a + 0 * b); }
static double power(double a, double b) { return a * a + 0 * b; }
static double size(double a, double b) { return fabs(a) + 0 * b; }
static double root(double a, double b) { return sqrt(a) + 0 * b; }
static double whole(double a, double b) { return floor(a) + 0 * b; }

static const struct {
    const char *name;
    double (*value)(double a, double b);
    int arguments;
} steps[] = {{"add", plus, 2},    {"sub", minus, 2}, {"min", less, 2},   {"max", more, 2},
             {"mul", times, 2},   {"sin", sine, 1},  {"cos", cosine, 1}, {"square", power, 1},
             {"abs", size, 1},    {"add", plus, 2},  {"max", more, 2},   {"sqrt", root, 1},
             {"floor", whole, 1}, {"div", over, 2}};
enum { STEPS = sizeof steps / sizeof *steps };

typedef struct Step {
    int    kind, arguments[2];
    double number;
} Step;

/* x, y and z, a number, and then steps of the table. */
static int write_tape(Step *tape, char *text, size_t size_of_text)
{
    int    count = 4 + 2 + below(8), kinds = below(4) > 0 ? STEPS - 3 : STEPS;
    char   line[80];
    double number  = round(between(-2, 2) * 8) / 8;
    tape[3].number = number;
    snprintf(text, size_of_text, "_0 var-x\n_1 var-y\n_2 var-z\n_3 const %g\n", number);
    for (int i = 4; i < count; i++) {
        Step *step = &tape[i];
        step->kind = below(kinds);
        for (int k = 0; k < 2; k++)
            step->arguments[k] = below(3) == 0 ? below(4) : i - 1 - below(i < 6 ? i : 3);
        if (steps[step->kind].arguments == 2)
            snprintf(line, sizeof line, "_%d %s _%d _%d\n", i, steps[step->kind].name,
                     step->arguments[0], step->arguments[1]);
        else
            snprintf(line, sizeof line, "_%d %s _%d\n", i, steps[step->kind].name,
                     step->arguments[0]);
        add(text, size_of_text, line);
    }
    return count;
}

static double tape_value(const Step *tape, int count, const double p[3])
{
    double values[MAX_STEPS] = {p[0], p[1], p[2], tape[3].number};
    for (int i = 4; i < count; i++)
        values[i] = steps[tape[i].kind].value(values[tape[i].arguments[0]],
                                              values[tape[i].arguments[1]]);
    return values[count - 1];
}

static void random_tapes(void **state)
{
    int accepted = 0;
    (void)state;
    for (int i = 0; i < TAPES; i++) {
        Step   tape[MAX_STEPS];
        char   text[4096];
        double points[POINTS][3], distances[POINTS];
        int    count = write_tape(tape, text, sizeof text);
        if (imported("random.vm", text).status != KRS_OK) {
            assert_false(assert_scene_or_line("random.vm", text));
            continue;
        }
        accepted++;
        for (int k = 0; k < POINTS; k++)
            random_vector(&randomness, 0.95, points[k]);
        imported_distances("random.vm", text, points, POINTS, distances);
        for (int k = 0; k < POINTS; k++) {
            double value = tape_value(tape, count, points[k]);
            if (fabs(value) > 1e-4 && isfinite(value) && (value < 0) != (distances[k] < 0))
                fail_msg("%g at %g %g %g, but distance %g, of\n%s", value, points[k][0],
                         points[k][1], points[k][2], distances[k], text);
        }
    }
    assert_true(accepted > TAPES / 4);
}

/* Quotients of random steps by what is at least a number above 0. */
static int write_quotients(Step *tape, char *text, size_t size_of_text)
{
    int    count = 4;
    char   line[80];
    double number  = between(0.3, 2);
    tape[3].number = number;
    snprintf(text, size_of_text, "_0 var-x\n_1 var-y\n_2 var-z\n_3 const %.17g\n", number);
    /* square, add and div, by their places in the table, between steps without poles */
    static const int kinds[] = {-1, 7, 0, 13};
    for (int round = 0; round < 3; round++)
        for (int k = 0; k < 4; k++, count++) {
            Step *step         = &tape[count];
            step->kind         = k == 0 ? below(9) : kinds[k];
            step->arguments[0] = k == 2 ? count - 1 : k == 3 ? below(count - 2) : below(count);
            step->arguments[1] = k == 2 ? 3 : k == 3 ? count - 1 : below(count);
            if (steps[step->kind].arguments == 2)
                snprintf(line, sizeof line, "_%d %s _%d _%d\n", count, steps[step->kind].name,
                         step->arguments[0], step->arguments[1]);
            else
                snprintf(line, sizeof line, "_%d %s _%d\n", count, steps[step->kind].name,
                         step->arguments[0]);
            add(text, size_of_text, line);
        }
    return count;
}

/* The field is divided by a bound of its slope: no difference of distances is above the way between
   the points, and over all trials some are a good part of it. */
static void quotients_have_bounds(void **state)
{
    double steepest = 0, sum = 0;
    int    accepted = 0;
    (void)state;
    for (int i = 0; i < TAPES; i++) {
        Step   tape[MAX_STEPS];
        char   text[4096];
        double points[2 * POINTS][3], distances[2 * POINTS], steep = 0;
        int    count    = write_quotients(tape, text, sizeof text);
        double constant = tape_value(tape, count, (double[]){0.1, 0.2, 0.3});
        if (tape_value(tape, count, (double[]){-0.3, 0.5, 0.7}) == constant)
            continue; /* nothing depends on the point, which is refused */
        for (int k = 0; k < 2 * POINTS; k += 2) {
            random_vector(&randomness, 0.95, points[k]);
            for (int a = 0; a < 3; a++)
                points[k + 1][a] = points[k][a] + between(-1e-3, 1e-3);
        }
        accepted++;
        imported_distances("quotients.vm", text, points, 2 * POINTS, distances);
        for (int k = 0; k < 2 * POINTS; k++) {
            double value = tape_value(tape, count, points[k]);
            if (fabs(value) > 1e-6 && (value < 0) != (distances[k] < 0))
                fail_msg("%g at %g %g %g, but distance %g, of\n%s", value, points[k][0],
                         points[k][1], points[k][2], distances[k], text);
        }
        for (int k = 0; k < 2 * POINTS; k += 2) {
            double way = sqrt(pow(points[k][0] - points[k + 1][0], 2) +
                              pow(points[k][1] - points[k + 1][1], 2) +
                              pow(points[k][2] - points[k + 1][2], 2));
            steep      = fmax(steep, fabs(distances[k] - distances[k + 1]) / way);
        }
        if (steep > 1 + 1e-6)
            fail_msg("the distance changes by %g in a unit, of\n%s", steep, text);
        steepest = fmax(steepest, steep);
        sum += steep;
    }
    print_message("# of %d quotients the steepest is %.2f, the mean %.2f\n", accepted, steepest,
                  sum / accepted);
    assert_true(accepted > TAPES / 2 && steepest > 0.8);
}

static void poles_are_refused_with_their_line(void **state)
{
    (void)state;
    assert_refused("a.vm", "_0 var-x\n_1 var-y\n_2 div _0 _1\n_3 add _2 _0\n",
                   "a.vm:3: `div` divides by what can be 0");
    assert_refused("a.vm", "_0 var-x\n_1 recip _0\n", "a.vm:2: `recip` divides by what can be 0");
    assert_refused("a.vm",
                   "_0 var-x\n_1 var-y\n_2 const 0.5\n_3 add _1 _2\n\n_4 div _0 _3\n_5 neg _4\n",
                   "a.vm:6: `div` divides by what can be 0");
    assert_refused("a.vm", "_0 var-x\n_1 floor _0\n", "a.vm:2: `floor` jumps");
    assert_refused("a.vm", "_0 var-x\n_1 sqrt _0\n", "a.vm:2: `sqrt` has no greatest slope");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_no_polynomial_is_a_field_or_refused),
        cmocka_unit_test(random_surfaces),
        cmocka_unit_test(random_tapes),
        cmocka_unit_test(quotients_have_bounds),
        cmocka_unit_test(poles_are_refused_with_their_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
