/*
 * along.c: how far rays may go, against the first zero along them.
 *
 * The scenes are solids of known formulas; the test looks for the first change of sign along random
 * rays by itself, in small steps, and then by bisection.  No step may go beyond it, and marching
 * by such steps must arrive there soon.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#include "compiler/scene/program.h"

typedef double Formula(const double p[3]);

static double sextic(const double p[3])
{
    double g = 2.6180339887498949, x = p[0] * p[0], y = p[1] * p[1], z = p[2] * p[2];
    double r = x + y + z - 1;
    return 4.2360679774997898 * r * r - 4 * (g * x - y) * (g * y - z) * (g * z - x);
}

static double ball(const double p[3], double x, double y, double z, double r)
{
    return sqrt((p[0] - x) * (p[0] - x) + (p[1] - y) * (p[1] - y) + (p[2] - z) * (p[2] - z)) - r;
}

static double cut_sextic(const double p[3]) { return fmax(sextic(p), ball(p, 0, 0, 0, 1.5)); }

/* Turned by a quarter about y, twice as large, moved: x' = (z - 1) / 2 and so on. */
static double moved_sextic(const double p[3])
{
    double q[3] = {-(p[2] - 0.5) / 2, p[1] / 2, (p[0] + 1) / 2};
    return fmin(fmax(sextic(q), ball(q, 0, 0, 0, 1.5)), ball(p, 1, 1, 1, 0.7));
}

static double quartic(const double p[3])
{
    double x = p[0] / 1.5, y = p[1], z = p[2] / 0.5;
    return x * x * x * x + y * y * y * y + z * z * z * z - (x * x + y * y + z * z) + 0.4;
}

static double less_ball(const double p[3])
{
    return fmax(fmax(quartic(p), ball(p, 0, 0, 0, 2)), -ball(p, 0.3, 0.4, 0, 0.5));
}

#define SEXTIC                                                                               \
    "let g = (1 + sqrt(5)) / 2;\nlet s = algebraic((1 + 2 * g) * (x^2 + y^2 + z^2 - 1)^2 ==" \
    " 4 * (g^2 * x^2 - y^2) * (g^2 * y^2 - z^2) * (g^2 * z^2 - x^2)).within(sphere(1.5));\n"

static const struct Case {
    const char *name, *text;
    Formula    *formula;
} cases[] = {
    {"a sextic in a ball", SEXTIC "show s;", cut_sextic},
    {"moved, turned, larger, and a ball",
     SEXTIC "show s.scale(2).rotate([0, 1, 0], 90deg).move([-1, 0, 0.5]) |"
            " sphere(0.7).move([1, 1, 1]);",
     moved_sextic},
    {"stretched, less a ball",
     "show algebraic(x^4 + y^4 + z^4 - (x^2 + y^2 + z^2) + 0.4 == 0).scale([1.5, 1, 0.5])"
     ".within(sphere(2)) - sphere(0.5).move([0.3, 0.4, 0]);",
     less_ball},
};

static double uniform(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

static void context_at(const double o[3], const double v[3], double t, double p[3])
{
    for (int i = 0; i < 3; i++)
        p[i] = o[i] + t * v[i];
}

/* The first change of sign after `from`, or `most`. */
static double first_change(Formula *f, const double o[3], const double v[3], double from,
                           double most)
{
    double p[3], step = 1e-3;
    context_at(o, v, from, p);
    bool inside = f(p) < 0;
    for (double t = from; t < most; t += step) {
        context_at(o, v, t + step, p);
        if ((f(p) < 0) == inside)
            continue;
        double low = t, high = t + step;
        for (int i = 0; i < 60; i++) {
            double middle = 0.5 * (low + high);
            context_at(o, v, middle, p);
            *((f(p) < 0) == inside ? &low : &high) = middle;
        }
        return low;
    }
    return most;
}

static double along_at(KrsState *state, const Tape *tape, Node root, const double p[3],
                       const double v[3])
{
    tape_run_surface(tape, p, v, 0, state->values);
    return state->values[root].v[0];
}

/* So far behind a surface, and the longest that a length may be there; bodies are ten times as wide. */
static const double BEHIND = 1e-5, MAX_BEHIND = 0.2;

static void steps_stay_before_the_surface(void **context)
{
    const struct Case *c = *context;
    KrsScene          *scene;
    KrsState          *state;
    uint32_t           seed = 3;
    assert_int_equal(krs_compile_text(c->text, strlen(c->text), c->name, NULL, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_true(krs_scene_program(scene)->along);
    Node root = roots_of(&scene->roots, ROOTS_ALONG).items[0];
    Tape tape = tape_new(scene->graph, &root, 1, &scene->arena);
    state_refresh(state);
    tape_run_frame(&tape, state->parameters, state->values);
    int evaluations = 0, hits = 0;
    for (int ray = 0; ray < 250; ray++) {
        double o[3], v[3], length = 0, p[3], aim[3];
        for (int i = 0; i < 3; i++) {
            o[i]   = 8 * uniform(&seed) - 4;
            aim[i] = 3 * uniform(&seed) - 1.5;
            v[i]   = aim[i] - o[i];
            length += v[i] * v[i];
        }
        for (int i = 0; i < 3; i++)
            v[i] /= sqrt(length);
        double t = 0, end = 9, truth = first_change(c->formula, o, v, 0, end), step = 1;
        double side = c->formula(o) < 0 ? -1 : 1; /* which rounding at the zero may change */
        for (int i = 0; i < 200 && t < end && fabs(step) > 1e-9; i++) {
            context_at(o, v, t, p);
            step = fmax(side * along_at(state, &tape, root, p, v), 0);
            t += step;
            evaluations++;
            if (t > truth + 1e-7 && truth < end)
                fail_msg("%s: ray %d goes to %.12g, the surface is at %.12g", c->name, ray, t,
                         truth);
        }
        if (truth < end) {
            hits++;
            if (fabs(t - truth) > 1e-6)
                fail_msg("%s: ray %d ends at %.9g, the surface is at %.9g", c->name, ray, t, truth);
            /* Just behind it lengths are short: chords from before it cross 0 there. */
            context_at(o, v, truth + BEHIND, p);
            double behind = along_at(state, &tape, root, p, v);
            if (fabs(behind) > MAX_BEHIND)
                fail_msg("%s: ray %d has %g ahead behind its surface", c->name, ray, behind);
        }
    }
    assert_true(hits > 60);
    assert_true(evaluations < 250 * 20);
    krs_state_free(state);
    krs_scene_free(scene);
}

int main(void)
{
    enum { CASES = sizeof cases / sizeof *cases };
    struct CMUnitTest tests[CASES];
    for (size_t i = 0; i < CASES; i++)
        tests[i] = (struct CMUnitTest){cases[i].name, steps_stay_before_the_surface, NULL, NULL,
                                       (void *)(uintptr_t)&cases[i]};
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return _cmocka_run_group_tests("along", tests, CASES, NULL, NULL);
}
