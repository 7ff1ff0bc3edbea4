/*
 * estimates.c: the usual estimates of the distance to f = 0, from derivatives at one point:
 *     linear      |f| / |f'|, Newton's step
 *     quadratic   the r with |f'| r + |f''| r^2 / 2 = |f|
 * Neither is a bound.  They are marched on the host, in long double precision, one ray in 1024, for
 * what they take and what they get wrong; derivatives by differences.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "bench/algebraic/judge.h"
#include "tests/oracle/formulas.h"

enum { SPARSE = 32, MAX_STEPS = 4096, ORDERS = 2 };

typedef struct Tally {
    size_t    rays, evaluations, unresolved;
    Judgement judgement;
} Tally;

static Real size_of(const Real v[3]) { return sqrtl(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/* Bounds the largest eigenvalue of the second derivatives by the root of the sum of their squares. */
static Real bend_of(Formula *formula, const Real p[3])
{
    const Real step = 1e-4L;
    Real       sum  = 0;
    for (int i = 0; i < 3; i++) {
        Real sides[2][3];
        for (int side = 0; side < 2; side++) {
            Real at[3] = {p[0], p[1], p[2]};
            at[i] += side ? step : -step;
            surface_gradient(formula, at, sides[side]);
        }
        for (int k = 0; k < 3; k++) {
            Real second = (sides[1][k] - sides[0][k]) / (2 * step);
            sum += second * second;
        }
    }
    return sqrtl(sum);
}

static Real estimate(Formula *formula, const Real p[3], Real f, int order)
{
    Real gradient[3];
    surface_gradient(formula, p, gradient);
    Real slope = size_of(gradient);
    if (order == 1)
        return f / fmaxl(slope, 1e-12L);
    Real bend = fmaxl(bend_of(formula, p), 1e-12L);
    return (sqrtl(slope * slope + 2 * bend * f) - slope) / bend;
}

/* Tells whether a ray from outside gets inside within the ball; steps are a 64th of a pixel at least. */
static bool march(const Subject *subject, Vec origin, Vec direction, Real least, int order,
                  Tally *tally)
{
    Formula *formula = surface_named(subject->oracle)->formula;
    Real     middle  = -(origin.x * direction.x + origin.y * direction.y + origin.z * direction.z);
    Real     square  = vec_dot(origin, origin) - middle * middle;
    Real     half    = (Real)subject->radius * subject->radius - square;
    if (half <= 0)
        return false;
    half   = sqrtl(half);
    Real t = middle - half;
    for (int step = 0; step < MAX_STEPS; step++) {
        Real p[3] = {origin.x + t * direction.x, origin.y + t * direction.y,
                     origin.z + t * direction.z};
        Real f    = formula(p);
        tally->evaluations++;
        if (f <= 0)
            return true;
        t += fmaxl(estimate(formula, p, f, order), least);
        if (t > middle + half)
            return false;
    }
    tally->unresolved++;
    return false;
}

static Tally march_all(const Subject *subject, const View *view, int order)
{
    Tally tally = {0};
    Real  least = view->height / HEIGHT / 64;
    for (int y = 0; y < HEIGHT; y += SPARSE)
        for (int x = 0; x < WIDTH; x += SPARSE) {
            Vec origin, direction;
            find_ray(view, x, y, &origin, &direction);
            bool seen = march(subject, origin, direction, least, order, &tally);
            tally.rays++;
            judge_one(subject, view, CUT_SOLID, x, y, seen, &tally.judgement);
        }
    return tally;
}

void estimates_print(const Subject *subject, const View *view)
{
    static const char *const names[ORDERS] = {"linear", "quadratic"};
    for (int order = 1; order <= ORDERS; order++) {
        Tally t = march_all(subject, view, order);
        say("| %s | %d | %s, 1 ray of 64 | | | | | %.1f | %zu / %zu / %zu | %zu |\n", subject->name,
            subject->degree, names[order - 1], (double)t.evaluations / (double)t.rays,
            t.judgement.missed, t.judgement.extra, t.judgement.apart, t.unresolved);
    }
}
