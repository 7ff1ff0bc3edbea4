/*
 * closed_forms.c: random shapes whose surfaces have closed forms.
 */
#include "tests/unit/closed_forms.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"

/* ---- shapes ---- */

/* By Rodrigues' formula, the other way around. */
static void find_rows(Body *b)
{
    double c = cos(b->angle * (M_PI / 180)), s = sin(b->angle * (M_PI / 180)), u[3];
    double length = hypot(hypot(b->axis[0], b->axis[1]), b->axis[2]);
    for (int k = 0; k < 3; k++)
        u[k] = b->axis[k] / length;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            b->rows[i][k] = (1 - c) * u[i] * u[k] + (i == k ? c : 0);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        b->rows[j][k] += s * u[i];
        b->rows[k][j] -= s * u[i];
    }
}

static Body random_body(Random *random, Form form)
{
    Body body = {.form = form, .angle = random_between(random, 0, 360)};
    for (int k = 0; k < 3; k++) {
        body.size[k] = random_between(random, 0.3, 0.9);
        body.axis[k] = random_between(random, -1, 1);
        body.move[k] = random_between(random, -0.2, 0.2);
    }
    if (form == RING)
        body.size[1] = body.size[0] * random_between(random, 0.2, 0.7);
    find_rows(&body);
    return body;
}

Subject random_subject(Random *random, const Kind *kind)
{
    Subject subject = {.csg_node = kind->csg_nodes[random_below(random, kind->csg_node_count)],
                       .width    = random_between(random, 0.1, 0.5)};
    for (int i = 0; i < 2; i++)
        subject.bodies[i] = random_body(random,
                                        kind->forms[random_below(random, kind->form_count)]);
    if (subject.csg_node != DIFFERENCE && random_below(random, 2) == 0) {
        subject.bodies[1] = subject.bodies[0];
        for (int k = 0; k < 3; k++)
            subject.bodies[1].move[k] += random_between(random, -0.05, 0.05);
    }
    return subject;
}

static size_t print_body(const Body *b, char *text, size_t room)
{
    static const char *const forms[FORMS] = {
        [BALL]     = "sphere(%.17g)",
        [RING]     = "torus(%.17g, %.17g)",
        [CAN]      = "cylinder(%.17g, %.17g)",
        [CONE]     = "cone(%.17g, %.17g)",
        [BLOCK]    = "box([%.17g, %.17g, %.17g])",
        [EQUATION] = "(field(x^2 + y^2 + z^2 - %.17g^2) & sphere(2))"};
    size_t used = (size_t)snprintf(text, room, forms[b->form], b->size[0], b->size[1], b->size[2]);
    return used + (size_t)snprintf(text + used, room - used,
                                   ".rotate([%.17g, %.17g, %.17g], %.17gdeg)"
                                   ".move([%.17g, %.17g, %.17g])",
                                   b->axis[0], b->axis[1], b->axis[2], b->angle, b->move[0],
                                   b->move[1], b->move[2]);
}

KrsState *state_of_subject(const Subject *subject, KrsScene **scene)
{
    static const char *const csg_nodes[CSG_NODES] = {"union", "union", "intersection", "difference",
                                                     "union"};
    char                     text[2000], own[600], other[600];
    KrsState                *state;
    print_body(&subject->bodies[0], own, sizeof own);
    print_body(&subject->bodies[1], other, sizeof other);
    if (subject->csg_node == ALONE)
        snprintf(text, sizeof text, "show %s;", own);
    else if (subject->csg_node == BLEND)
        snprintf(text, sizeof text, "show union(%s, %s, blend: %.17g);", own, other,
                 subject->width);
    else
        snprintf(text, sizeof text, "show %s(%s, %s);", csg_nodes[subject->csg_node], own, other);
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, scene), KRS_OK);
    assert_int_equal(krs_state_new(*scene, &state), KRS_OK);
    return state;
}

/* ---- their surfaces ---- */

static void own_point(const Body *b, const double point[3], double own[3])
{
    for (int i = 0; i < 3; i++) {
        own[i] = 0;
        for (int k = 0; k < 3; k++)
            own[i] += b->rows[i][k] * (point[k] - b->move[k]);
    }
}

static double body_value(const Body *b, const double point[3])
{
    double p[3], across;
    own_point(b, point, p);
    across = hypot(p[0], p[2]);
    switch (b->form) {
    case RING: return hypot(across - b->size[0], p[1]) - b->size[1];
    case CAN: return fmax(across - b->size[0], fabs(p[1]) - b->size[1] / 2);
    case CONE:
        return fmax((across * b->size[1] + (p[1] - b->size[1] / 2) * b->size[0]) /
                        hypot(b->size[0], b->size[1]),
                    -p[1] - b->size[1] / 2);
    case BLOCK:
        return fmax(fabs(p[0]) - b->size[0] / 2,
                    fmax(fabs(p[1]) - b->size[1] / 2, fabs(p[2]) - b->size[2] / 2));
    default: return hypot(hypot(p[0], p[1]), p[2]) - b->size[0];
    }
}

double subject_value(const Subject *subject, const double point[3])
{
    double a = body_value(&subject->bodies[0], point), b = body_value(&subject->bodies[1], point);
    double h = fmax(subject->width - fabs(a - b), 0);
    switch (subject->csg_node) {
    case UNION: return fmin(a, b);
    case INTERSECTION: return fmax(a, b);
    case DIFFERENCE: return fmax(a, -b);
    case BLEND: return fmin(a, b) - h * h / (4 * subject->width);
    default: return a;
    }
}

void subject_gradient(const Subject *subject, const double point[3], double gradient[3])
{
    static const double STEP = 1e-6;
    for (int k = 0; k < 3; k++) {
        double low[3] = {point[0], point[1], point[2]}, high[3] = {point[0], point[1], point[2]};
        low[k] -= STEP;
        high[k] += STEP;
        gradient[k] = (subject_value(subject, high) - subject_value(subject, low)) / (2 * STEP);
    }
}

bool random_surface_point(Random *random, const Subject *subject, double p[3])
{
    enum { TRIES = 100, STEPS = 6 };
    for (int i = 0; i < TRIES; i++) {
        random_vector(random, 1, p);
        for (int step = 0; step < STEPS; step++) {
            double gradient[3];
            subject_gradient(subject, p, gradient);
            double value = subject_value(subject, p);
            for (int k = 0; k < 3; k++)
                p[k] -= value * gradient[k];
        }
        if (fabs(subject_value(subject, p)) < 1e-6)
            return true;
    }
    return false;
}
