/*
 * outline_truth.c: lines, and how many times they go around points.
 */
#include "tests/oracle/outline_truth.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

/* Returns how many times the lines go around a point. */
static int winding_at(const Truth *truth, const double p[2])
{
    int winding = 0;
    for (size_t i = 0; i < truth->count; i++) {
        const double *a = truth->lines[i].a, *b = truth->lines[i].b;
        if ((a[1] > p[1]) == (b[1] > p[1]))
            continue;
        double left = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        if ((left > 0) == (b[1] > a[1]))
            winding += b[1] > a[1] ? 1 : -1;
    }
    return winding;
}

static bool is_inside(const Truth *truth, const double p[2])
{
    int winding = winding_at(truth, p);
    return truth->rule == FILL_NONZERO ? winding != 0 : winding % 2 != 0;
}

static bool on_outline(const Truth *truth, const Line *line)
{
    double x = line->b[0] - line->a[0], y = line->b[1] - line->a[1], length = hypot(x, y);
    double m[2] = {0.5 * (line->a[0] + line->b[0]), 0.5 * (line->a[1] + line->b[1])};
    double step = 1e-7 / length;
    return is_inside(truth, (double[]){m[0] - y * step, m[1] + x * step}) !=
           is_inside(truth, (double[]){m[0] + y * step, m[1] - x * step});
}

static void add_line(Truth *truth, const double a[2], const double b[2])
{
    Line line = {{a[0], a[1]}, {b[0], b[1]}};
    assert_true(truth->count < MAX_LINES);
    truth->lines[truth->count++] = line;
}

static void add_lines(Truth *truth, const Curve *curve)
{
    int parts = curve->straight ? 1 : PARTS;
    for (int i = 0; i < parts; i++) {
        double a[2], b[2];
        curve_point(curve, (double)i / parts, a);
        curve_point(curve, (double)(i + 1) / parts, b);
        add_line(truth, a, b);
    }
}

/* Returns where a line meets another one: how far along it, else 2. */
static double meets_at(const Line *line, const Line *other)
{
    double x = line->b[0] - line->a[0], y = line->b[1] - line->a[1];
    double u = other->b[0] - other->a[0], v = other->b[1] - other->a[1];
    double s = other->a[0] - line->a[0], t = other->a[1] - line->a[1], turn = x * v - y * u;
    double along = (s * v - t * u) / turn, across = (s * y - t * x) / turn;
    return turn != 0 && along > 0 && along < 1 && across >= 0 && across <= 1 ? along : 2;
}

/* Cuts a line at the first place where it meets another; the rest is cut later. */
static void cut_line(Truth *truth, size_t i)
{
    double least = 2, at[2];
    for (size_t k = 0; k < truth->count; k++) {
        double t = k == i ? 2 : meets_at(&truth->lines[i], &truth->lines[k]);
        least    = t > 1e-9 && t < 1 - 1e-9 ? fmin(least, t) : least;
    }
    if (least > 1)
        return;
    for (int k = 0; k < 2; k++)
        at[k] = truth->lines[i].a[k] + least * (truth->lines[i].b[k] - truth->lines[i].a[k]);
    add_line(truth, at, truth->lines[i].b);
    memcpy(truth->lines[i].b, at, sizeof at);
}

void find_truth(Truth *truth, const Curves *curves, FillRule rule)
{
    static bool on[MAX_LINES];
    truth->count = truth->outline = 0;
    truth->rule                   = rule;
    for (size_t i = 0; i < curves->count; i++)
        add_lines(truth, &curves->items[i]);
    for (size_t i = 0; i < truth->count; i++)
        cut_line(truth, i);
    for (size_t i = 0; i < truth->count; i++)
        on[i] = on_outline(truth, &truth->lines[i]);
    for (size_t i = 0; i < truth->count; i++)
        if (on[i]) {
            Line line                      = truth->lines[i];
            truth->lines[i]                = truth->lines[truth->outline];
            truth->lines[truth->outline++] = line;
        }
}

static double to_line(const Line *line, const double p[2])
{
    double x = line->b[0] - line->a[0], y = line->b[1] - line->a[1];
    double t = ((p[0] - line->a[0]) * x + (p[1] - line->a[1]) * y) / (x * x + y * y);
    t        = fmin(fmax(t, 0), 1);
    return hypot(p[0] - line->a[0] - t * x, p[1] - line->a[1] - t * y);
}

double true_distance(const Truth *truth, const double p[2])
{
    double least = INFINITY;
    for (size_t i = 0; i < truth->outline; i++)
        least = fmin(least, to_line(&truth->lines[i], p));
    return is_inside(truth, p) ? -least : least;
}
