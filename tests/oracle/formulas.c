/*
 * formulas.c: twenty-two polynomials, and their first roots along rays.
 *
 * Roots are found by looking: values at many places of a ray, every change of sign and every place
 * where |f| has a minimum, the latter by golden section.
 */
#include "tests/oracle/formulas.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <string.h>
#include <cmocka.h>

static const Real GOLDEN = 1.61803398874989484820458683436563811L;
static const Real TURN   = 6.28318530717958647692528676655900577L;

static Real sq(Real a) { return a * a; }
static Real cube(Real a) { return a * a * a; }
static Real squares(const Real p[3]) { return sq(p[0]) + sq(p[1]) + sq(p[2]); }

/* Returns the product of n planes around the z axis: cos(2 pi k / n) x + sin(2 pi k / n) y - w. */
static Real planes(const Real p[3], int n, Real w)
{
    static Real cosines[9][8], sines[9][8]; /* those of n, once they are needed */
    Real        product = 1;
    if (cosines[n][0] == 0)
        for (int k = 0; k < n; k++) {
            cosines[n][k] = cosl(TURN * k / n);
            sines[n][k]   = sinl(TURN * k / n);
        }
    for (int k = 0; k < n; k++)
        product *= cosines[n][k] * p[0] + sines[n][k] * p[1] - w;
    return product;
}

/* ---- cubics ---- */

/* By power sums: x^2 (y + z) + ... = p1 p2 - p3, and 2 (x y + ...) = p1^2 - p2. */
static Real clebsch(const Real p[3])
{
    Real p1 = p[0] + p[1] + p[2], p2 = squares(p), p3 = cube(p[0]) + cube(p[1]) + cube(p[2]);
    return 270 * p3 - 189 * p1 * p2 + 54 * p[0] * p[1] * p[2] + 63 * sq(p1) - 72 * p2 - 9 * p1 + 1;
}

/* Minus the determinant of the symmetric matrix of 1 and -2 x, -2 y, -2 z. */
static Real cayley(const Real p[3])
{
    Real a = -2 * p[0], b = -2 * p[1], c = -2 * p[2];
    return -((1 - c * c) - a * (a - b * c) + b * (a * c - b));
}

static Real ding_dong(const Real p[3]) { return sq(p[0]) + sq(p[2]) - sq(p[1]) + cube(p[1]); }
static Real umbrella(const Real p[3]) { return sq(p[0]) - p[1] * sq(p[2]); }
static Real monkey(const Real p[3])
{
    Real r = sqrtl(sq(p[0]) + sq(p[2])), angle = atan2l(p[2], p[0]);
    return p[1] - cube(r) * cosl(3 * angle);
}

/* ---- quartics ---- */

/* Its four tropes are planes. */
static Real kummer_of(const Real p[3], Real m)
{
    Real s = sqrtl(2), x = s * p[0], y = s * p[1], z = p[2], l = (3 * m - 1) / (3 - m);
    return sq(squares(p) - m) - l * (1 - z - x) * (1 - z + x) * (1 + z - y) * (1 + z + y);
}
static Real kummer(const Real p[3]) { return kummer_of(p, 1.3L); }
static Real kummer_two(const Real p[3]) { return kummer_of(p, 2); }

static Real tanglecube(const Real p[3])
{
    return sq(sq(p[0]) - 2.5L) + sq(sq(p[1]) - 2.5L) + sq(sq(p[2]) - 2.5L) - 18.75L + 11.8L;
}

static Real roman(const Real p[3])
{
    return sq(p[0] * p[1]) + sq(p[1] * p[2]) + sq(p[2] * p[0]) + p[0] * p[1] * p[2];
}

/* Returns the other of the two forms of a cyclide. */
static Real cyclide(const Real p[3])
{
    Real a = 2, b = 1.94L, d = 0.7L, c = sqrtl(sq(a) - sq(b));
    return sq(squares(p) - sq(b) - sq(d)) - 4 * sq(c * p[0] - a * d) + 4 * sq(b * p[1]);
}

static Real octdong(const Real p[3]) { return sq(p[0]) + sq(p[2]) - sq(p[1]) * (1 - sq(p[1])); }

/* ---- of higher degree ---- */

static Real togliatti(const Real p[3])
{
    Real k = sqrtl(5 - sqrtl(5)), q = 4 * (sq(p[0]) + sq(p[1]) - sq(p[2])) + 1 + 3 * sqrtl(5);
    return 5 * k * (2 * p[2] - k) * sq(q) - 1024 * planes(p, 5, 1);
}

static Real sextic(const Real p[3])
{
    Real product = 1;
    for (int i = 0; i < 3; i++)
        product *= (GOLDEN * p[i] - p[(i + 1) % 3]) * (GOLDEN * p[i] + p[(i + 1) % 3]);
    return (1 + 2 * GOLDEN) * sq(squares(p) - 1) - 4 * product;
}

static Real heart(const Real p[3])
{
    Real x = sq(p[0]), y = p[1], z = sq(p[2]);
    return cube(x + sq(y) + 2.25L * z - 1) - cube(y) * (x + 0.1125L * z);
}

static Real zitrus(const Real p[3]) { return sq(p[0]) + sq(p[2]) - cube(0.25L - sq(p[1])); }

/* By the symmetric functions of the squares. */
static Real distel(const Real p[3])
{
    Real x = sq(p[0]), y = sq(p[1]), z = sq(p[2]), e1 = x + y + z, e2 = x * y + y * z + z * x;
    return e1 - 1 + 1000 * (e1 * e2 - x * y * z);
}

static Real septic(const Real p[3])
{
    Real s = cbrtl(sqrtl(1.0L / 196 + 1.0L / 27) - 1.0L / 14), a = s - 1 / (3 * s); /* Cardano */
    Real a1 = (-84 * a * a - 384 * a - 56) / 49, a2 = (-224 * a * a + 24 * a - 196) / 49;
    Real a3 = (-196 * a * a + 24 * a - 196) / 49, a4 = (-56 * a * a + 8 * a - 56) / 49;
    Real a5 = 49 * a * a - 7 * a + 50, z = p[2];
    Real q = (z + 1) * (sq(p[0]) + sq(p[1])) + ((a1 * z + a2) * z + a3) * z + a4;
    return (z + a5) * sq(q) - 64 * planes(p, 7, z);
}

static Real octic(const Real p[3])
{
    Real s = sqrtl(2), r = sq(p[0]) + sq(p[1]), z = sq(p[2]);
    Real q = -4 * (1 + s) * r * r + (8 * (2 + s) * z + 2 * (2 + 7 * s)) * r - 16 * z * z +
             8 * (1 - 2 * s) * z - (1 + 12 * s);
    return sq(q) - 256 * planes(p, 8, 1);
}

/* Heron's formula makes four planes of the factor of degree 4. */
static Real decic(const Real p[3])
{
    Real x = p[0], y = p[1], z = p[2], g = GOLDEN + 1, r = squares(p), product = 8;
    for (int i = 0; i < 3; i++)
        product *= (p[i] - g * p[(i + 1) % 3]) * (p[i] + g * p[(i + 1) % 3]);
    product *= (x + y + z) * (x + y - z) * (x - y + z) * (x - y - z);
    return product + (3 + 5 * GOLDEN) * sq((r - 1) * (r - 2 + GOLDEN));
}

/* Returns the sum of (v q)^12 over the 60 pairs of corners of the 600-cell, less c |q|^12, at q =
   (y, x, z, 1): of 120 corners each counts half. */
static Real power12(Real a) { return cube(sq(sq(a))); }
static Real dodecic(const Real p[3])
{
    Real             q[4] = {p[1], p[0], p[2], 1}, sum = 0, half[4];
    static const int even[12][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 0, 3, 2},
                                    {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 0, 1, 3}, {2, 1, 3, 0},
                                    {2, 3, 0, 1}, {3, 0, 2, 1}, {3, 1, 0, 2}, {3, 2, 1, 0}};
    for (int i = 0; i < 4; i++) {
        sum += power12(q[i]);
        half[i] = q[i] / 2;
    }
    for (int k = 0; k < 8; k++)
        sum += power12(half[3] + (k & 1 ? 1 : -1) * half[0] + (k & 2 ? 1 : -1) * half[1] +
                       (k & 4 ? 1 : -1) * half[2]);
    for (int i = 0; i < 12; i++)
        for (int k = 0; k < 4; k++) {
            Real a = half[even[i][0]] * GOLDEN, b = half[even[i][1]] * (k & 1 ? 1 : -1);
            Real c = half[even[i][2]] / GOLDEN * (k & 2 ? 1 : -1);
            sum += power12(a + b + c);
        }
    return sum - 160055.0L / 82944 * cube(sq(squares(p) + 1));
}

static Real chebyshev(int n, Real t)
{
    Real before = 1, now = t;
    for (int i = 1; i < n; i++) {
        Real next = 2 * t * now - before;
        before    = now;
        now       = next;
    }
    return now;
}
static Real chmutov(const Real p[3], int n)
{
    return chebyshev(n, p[0]) + chebyshev(n, p[1]) + chebyshev(n, p[2]) + 1;
}
static Real chmutov6(const Real p[3]) { return chmutov(p, 6); }
static Real chmutov14(const Real p[3]) { return chmutov(p, 14); }

const Surface surfaces[SURFACES] = {
    {"clebsch", "", "clebsch(", clebsch, 3},
    {"cayley", "", "cayley(", cayley, 1.5},
    {"ding_dong", "", "ding_dong(", ding_dong, 1.6},
    {"whitney_umbrella", "", "whitney_umbrella(", umbrella, 1.5},
    {"monkey_saddle", "", "monkey_saddle(", monkey, 1.5},
    {"kummer", "", "kummer(", kummer, 2.2},
    {"kummer of a param", "param m = 2 in [1.1, 2.5];\n", "kummer(m, ", kummer_two, 2.2},
    {"tanglecube", "", "tanglecube(", tanglecube, 4},
    {"roman", "", "roman(", roman, 0.75},
    {"dupin_cyclide", "", "dupin_cyclide(", cyclide, 4},
    {"octdong", "", "octdong(", octdong, 1.3},
    {"togliatti", "", "togliatti(", togliatti, 5},
    {"barth_sextic", "", "barth_sextic(", sextic, 2.2},
    {"heart", "", "heart(", heart, 1.5},
    {"zitrus", "", "zitrus(", zitrus, 0.8},
    {"distel", "", "distel(", distel, 1.1},
    {"labs_septic", "", "labs_septic(", septic, 2.5},
    {"endrass_octic", "", "endrass_octic(", octic, 1.9},
    {"barth_decic", "", "barth_decic(", decic, 1.75},
    {"sarti_dodecic", "", "sarti_dodecic(", dodecic, 3},
    {"chmutov of degree 6", "", "chmutov(6, ", chmutov6, 1.7},
    {"chmutov of degree 14", "", "chmutov(14, ", chmutov14, 1.7},
};

const Surface *surface_named(const char *name)
{
    for (size_t i = 0; i < SURFACES; i++)
        if (strcmp(surfaces[i].name, name) == 0)
            return &surfaces[i];
    fail_msg("there is no surface %s", name);
    return NULL;
}

/* ---- near the surface ---- */

void surface_gradient(Formula *formula, const Real p[3], Real gradient[3])
{
    Real h = 1e-4L * (1 + sqrtl(squares(p)));
    for (int i = 0; i < 3; i++) {
        Real values[4];
        for (int k = 0; k < 4; k++) {
            Real q[3] = {p[0], p[1], p[2]};
            q[i] += h * (k < 2 ? k - 2 : k - 1);
            values[k] = formula(q);
        }
        gradient[i] = (values[0] - 8 * values[1] + 8 * values[2] - values[3]) / (12 * h);
    }
}

Vec surface_slope(Formula *formula, Vec p)
{
    Real gradient[3];
    surface_gradient(formula, (const Real[3]){p.x, p.y, p.z}, gradient);
    return vec((double)gradient[0], (double)gradient[1], (double)gradient[2]);
}

bool surface_near(Formula *formula, Vec p, Vec *found)
{
    Real q[3] = {p.x, p.y, p.z}, gradient[3];
    for (int i = 0; i < 60; i++) {
        Real value = formula(q);
        surface_gradient(formula, q, gradient);
        Real squared = squares(gradient);
        if (fabsl(value) <= 1e-10L * (1 + sqrtl(squared))) {
            *found = vec((double)q[0], (double)q[1], (double)q[2]);
            return true;
        }
        if (!(squared > 1e-12L))
            return false;
        for (int k = 0; k < 3; k++)
            q[k] -= value / squared * gradient[k];
    }
    return false;
}

/* ---- along rays ---- */

/* The formula along a ray. */
typedef struct Chord {
    Formula *formula;
    Real     origin[3], direction[3];
    Real     from, to; /* within the ball */
    Real     scale;    /* the greatest |f| on it */
} Chord;

static Real chord_value(const Chord *chord, Real t)
{
    Real p[3];
    for (int i = 0; i < 3; i++)
        p[i] = chord->origin[i] + t * chord->direction[i];
    return chord->formula(p);
}

/* False when the ray misses the ball. */
static bool chord_new(Chord *chord, Formula *formula, Real radius, Vec origin, Vec direction)
{
    Vec v  = vec_unit(direction);
    *chord = (Chord){
        .formula = formula, .origin = {origin.x, origin.y, origin.z}, .direction = {v.x, v.y, v.z}};
    Real middle = -(Real)vec_dot(origin, v), nearest = 0;
    for (int i = 0; i < 3; i++)
        nearest += sq(chord->origin[i] + middle * chord->direction[i]);
    if (nearest >= sq(radius))
        return false;
    Real half   = sqrtl(sq(radius) - nearest);
    chord->from = fmaxl(middle - half, 0);
    chord->to   = middle + half;
    return true;
}

/* Between `low`, where f has the sign of `side`, and `high`, where it has not. */
static Real bisect(const Chord *chord, Real low, Real high, Real side)
{
    for (int i = 0; i < 70; i++) {
        Real middle                                             = 0.5L * (low + high);
        *(chord_value(chord, middle) * side > 0 ? &low : &high) = middle;
    }
    return high;
}

/* Where |f| has its least between low and high, by golden section; or any place beyond a zero. */
static Real min_between(const Chord *chord, Real low, Real high, Real side)
{
    Real part = GOLDEN - 1, a = high - part * (high - low), b = low + part * (high - low);
    Real at_a = chord_value(chord, a) * side, at_b = chord_value(chord, b) * side;
    for (int i = 0; i < 60 && at_a > 0 && at_b > 0; i++) {
        if (at_a < at_b) {
            high = b;
            b    = a;
            at_b = at_a;
            a    = high - part * (high - low);
            at_a = chord_value(chord, a) * side;
        } else {
            low  = a;
            a    = b;
            at_a = at_b;
            b    = low + part * (high - low);
            at_b = chord_value(chord, b) * side;
        }
    }
    return at_a < at_b ? a : b;
}

/* A little is enough to hide a root from anyone who counts in double precision. */
static const Real LITTLE = 1e-11L, SHORT = 1e-7L;

/* Returns the first place where f * side is no longer positive. */
static Entry chord_search(Chord *chord, Real side)
{
    enum { PIECES = 1200 };
    Real  values[PIECES + 1], step = (chord->to - chord->from) / PIECES;
    Entry entry = {.fate = RAY_MISSES};
    for (int i = 0; i <= PIECES; i++) {
        values[i]    = chord_value(chord, chord->from + i * step) * side;
        chord->scale = fmaxl(chord->scale, fabsl(values[i]));
    }
    for (int i = 1; i <= PIECES; i++) {
        Real t    = chord->from + i * step;
        bool dips = i < PIECES && values[i] <= values[i - 1] && values[i] <= values[i + 1];
        if (values[i] > 0 && !dips)
            continue;
        Real before = i > 1 || values[0] > 0 ? t - step : t;
        Real inside = values[i] > 0 ? min_between(chord, t - step, t + step, side) : t;
        Real value  = chord_value(chord, inside) * side;
        if (fabsl(value) < LITTLE * chord->scale && values[i] > 0)
            entry.fate = RAY_DOUBTFUL;
        if (value > 0)
            continue;
        entry.t    = bisect(chord, before, inside, side);
        bool whole = chord_value(chord, entry.t + SHORT * chord->to) * side < 0;
        if (entry.fate == RAY_MISSES && whole)
            entry.fate = RAY_HITS;
        else
            entry.fate = RAY_DOUBTFUL;
        return entry;
    }
    /* What begins where the ball ends. */
    if (chord_value(chord, chord->to + SHORT * chord->to) * side < 0)
        entry.fate = RAY_DOUBTFUL;
    return entry;
}

static bool is_doubtful(const Chord *chord, Real radius)
{
    return chord->to - chord->from < 1e-3L * radius;
}

Entry surface_entry(Formula *formula, Real radius, Vec origin, Vec direction)
{
    Chord chord;
    Entry entry = {.fate = RAY_MISSES};
    if (!chord_new(&chord, formula, radius, origin, direction))
        return entry;
    Real first = chord_value(&chord, chord.from);
    if (first > 0) {
        entry = chord_search(&chord, 1);
    } else {
        entry = (Entry){.fate = RAY_HITS, .t = chord.from, .on_ball = true};
        if (chord_value(&chord, chord.from + SHORT * chord.to) > 0)
            entry.fate = RAY_DOUBTFUL;
    }
    if (is_doubtful(&chord, radius))
        entry.fate = RAY_DOUBTFUL;
    return entry;
}

Entry surface_crossing(Formula *formula, Real radius, Vec origin, Vec direction)
{
    Chord chord;
    Entry entry = {.fate = RAY_MISSES};
    if (!chord_new(&chord, formula, radius, origin, direction))
        return entry;
    entry = chord_search(&chord, chord_value(&chord, chord.from) > 0 ? 1 : -1);
    if (is_doubtful(&chord, radius))
        entry.fate = RAY_DOUBTFUL;
    return entry;
}

double surface_leeway(Formula *formula, double radius, Vec p, Vec direction)
{
    Real   size = 0, half = radius / sqrtl(3);
    double fall = fabs(vec_dot(surface_slope(formula, p), direction));
    for (int i = 0; i < 8; i++) {
        Real corner[3] = {i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half};
        size           = fmaxl(size, fabsl(formula(corner)));
    }
    return 1e-8 * radius + 1e-13 * (double)size / fall;
}

void random_ray(Random *random, double radius, Vec *origin, Vec *direction)
{
    *origin    = vec_scale(random_between(random, 1.5, 4) * radius, random_unit(random));
    *direction = vec_unit(vec_sub(random_in_cube(random, 0.6 * radius), *origin));
}
