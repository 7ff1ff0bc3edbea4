/*
 * fractal.c: Julia sets of quaternions and Mandelbulbs, in double precision.
 *
 * The bound of a Julia set.  f(z) = z^p + c is steep: |f(z + h) - f(z)| <= (|z| + |h|)^p - |z|^p
 * in every algebra with |ab| = |a||b|.  So the ball of radius x around f(z) holds the image of the
 * ball around z whose radius is
 *     step back:  (|z|^p + x)^(1/p) - |z|.
 * An iterate z_n beyond the escape radius R has a ball of radius |z_n| - R of points that escape;
 * stepped back n times it is a ball around the point outside of the solid.  The best n counts, and
 * beyond 2 R a further iterate is never better: |z_{n+1}| - R stepped back is at most |z_n| - R
 * where 2 |z_n|^p + R^p - 2 R <= (2 |z_n| - R)^p, which holds from 2 R on for p >= 2.  Inside,
 * the last iterate has the ball R - |z_n|.
 * Stepping back keeps the slope: with t = (|z| / (|z| + x'))^(p - 1), x' the radius stepped back,
 * the new slope is at most t times the old one plus (1 - t), so all are 1-Lipschitz, and so is
 * the greatest of them.  The proof needs no calculus of complex functions; it holds for sets that
 * are connected or not, and for slices.
 *
 * The Mandelbulb's triplex power stretches space by e = p |w|^(p - 1) along the meridians and away
 * from the origin, and around the poles' axis by e |s|, s = sin p t / sin t, t the angle from the
 * poles; nothing like the above is proven.  1/2 |w| ln(|w| / R) / |w'| is an estimate, where |w'|
 * is how much lengths are stretched after all steps.  By e alone, as it is often seen, it is up to
 * 50 times too long near the poles' axis; by the most, e max(1, |s|), it is half of what it can be,
 * since what one step stretches most is rotated away before the next.  The root of the mean
 * square over all directions, e^2 (2 + s^2) / 3, it is too long in one place of some thousands;
 * where that counts as 0.85 e^2 at least, so that many steps of small s do not add up, it was
 * never found to be.
 * Inside, d is chosen so that what it becomes keeps below the margin R - |w|, taking it to be
 *     x = |w'| d / (1 - g d),  as  (|w| + x)^p - |w|^p <= e x / (1 - (p - 1) x / (2 |w|))
 * coefficient by coefficient, by which each step adds (p - 1) |w'| / (2 |w|) to g.  What is nearer
 * to the origin than `least` counts as so near there.
 */
#include "compiler/graph/fractal.h"

#include <math.h>

#include "compiler/base/elementary.h"

double julia_radius(double c, uint32_t power)
{
    double r = fmax(real_exp2(1.0 / (power - 1)), real_pow(2 * c, 1.0 / power));
    for (int i = 0; i < 60; i++) /* Newton's steps come down to the root, as R^p is convex */
        r = ((power - 1) * real_pow(r, power) + c) / (power * real_pow(r, power - 1) - 1);
    return r;
}

double mandelbulb_radius(uint32_t power) { return real_exp2(1.0 / (power - 1)); }

uint32_t fractal_loops(Op op, double iterations)
{
    if (op == OP_julia)
        return iterations > UNROLLED_JULIA ? 2 * (uint32_t)iterations : 0;
    return (uint32_t)iterations;
}

/* Returns the greatest |c| with |w|^p + |c| <= |w| for some |w|. */
double mandelbulb_core(double power)
{
    double r = real_pow(power, -1 / (power - 1));
    return r - real_pow(r, power);
}

/* ---- orbits ---- */

static double norm(const double *v, int size)
{
    double sum = 0;
    for (int i = 0; i < size; i++)
        sum += v[i] * v[i];
    return sqrt(sum);
}

/* Computes (a + b s) (c + d s), where s * s = -square. */
static void multiply(double result[2], const double a[2], const double b[2], double square)
{
    double real = a[0] * b[0] - square * a[1] * b[1];
    result[1]   = a[0] * b[1] + a[1] * b[0];
    result[0]   = real;
}

static void raise(double result[2], const double base[2], int power, double square)
{
    double factor[2] = {base[0], base[1]};
    result[0]        = 1;
    result[1]        = 0;
    for (; power > 0; power >>= 1) {
        if (power & 1)
            multiply(result, result, factor, square);
        multiply(factor, factor, factor, square);
    }
}

/* Computes z^power + c: a power of a + v is A + B v. */
static void julia_step(double z[4], const double c[4], int power)
{
    double raised[2], square = z[1] * z[1] + z[2] * z[2] + z[3] * z[3];
    raise(raised, (double[]){z[0], 1}, power, square);
    z[0] = raised[0] + c[0];
    for (int i = 1; i < 4; i++)
        z[i] = raised[1] * z[i] + c[i];
}

/* Computes White and Nylander's power, its poles on the y axis: the angles from the axis and about
   it times `power`, by powers of complex numbers.  Returns |sin(power t) / sin t| |w|^(power - 1). */
static double triplex_step(double w[3], const double c[3], int power)
{
    double across   = real_hypot(w[0], w[2]), tilt[2], turn[2];
    double about[2] = {across > 0 ? w[2] / across : 1, across > 0 ? w[0] / across : 0};
    raise(tilt, (double[]){w[1], 1}, power, across * across);
    raise(turn, about, power, 1);
    w[0] = tilt[1] * across * turn[1] + c[0];
    w[1] = tilt[0] + c[1];
    w[2] = tilt[1] * across * turn[0] + c[2];
    return fabs(tilt[1]);
}

/* The powers are constants from 2 to MAX_POWER in every scene; random graphs have anything. */
static int power_of(const NodeValue *range) { return (int)fmin(fmax(range->v[0], 1), MAX_POWER); }

static int iterations_of(const NodeValue *range, const NodeValue *settings)
{
    double count = fmin(fmin(settings->v[0], range->v[1]), MAX_ITERATIONS);
    return count > 0 ? (int)count : 0;
}

/* The least distance of the iterates from the origin (at most 1), and which of them it is, as a
   share of all. */
typedef struct Trap {
    double nearest, which;
} Trap;

static void trap_add(Trap *trap, double modulus, int iterate, int count)
{
    if (modulus < trap->nearest)
        *trap = (Trap){modulus, (double)iterate / count};
}

static NodeValue trap_value(Trap trap) { return (NodeValue){{trap.nearest, trap.which}}; }

/* ---- Julia sets ---- */

/* Returns the radius around z whose image f keeps within x: (|z|^p + x)^(1/p) - |z| without loss. */
static double step_back(double size, double x, int power)
{
    double sum = 1, lower = 1, root = real_pow(real_pow(size, power) + x, 1.0 / power);
    for (int i = 1; i < power; i++) {
        lower *= size;
        sum = sum * root + lower;
    }
    return sum > 0 ? x / sum : 0;
}

NodeValue evaluate_julia(const NodeValue *o, uint32_t size)
{
    (void)size;
    int    power = power_of(&o[2]), last = iterations_of(&o[2], &o[3]), n = 0;
    double radius = o[3].v[1], sizes[MAX_ITERATIONS + 1];
    double z[4]   = {o[0].v[0], o[0].v[1], o[0].v[2], 0};
    for (sizes[0] = norm(z, 4); n < last && sizes[n] <= 2 * radius; sizes[++n] = norm(z, 4))
        julia_step(z, o[1].v, power);
    bool   outside = sizes[n] > radius;
    double x       = fabs(sizes[n] - radius);
    while (n-- > 0)
        x = fmax(step_back(sizes[n], x, power), sizes[n] - radius);
    return (NodeValue){{outside ? x : -x}};
}

NodeValue evaluate_julia_trap(const NodeValue *o, uint32_t size)
{
    (void)size;
    int    power = power_of(&o[2]), last = iterations_of(&o[2], &o[3]);
    double z[4] = {o[0].v[0], o[0].v[1], o[0].v[2], 0}, modulus = norm(z, 4);
    Trap   trap = {1, 1};
    for (int n = 1; n <= last && modulus <= 2 * o[3].v[1]; n++) {
        julia_step(z, o[1].v, power);
        modulus = norm(z, 4);
        trap_add(&trap, modulus, n, last);
    }
    return trap_value(trap);
}

/* ---- Mandelbulbs ---- */

/* The orbit is followed until it is as far away as single precision can raise to the power. */
static double bailout(double power) { return fmin(16, real_exp2(32 / power)); }

/* The least that the mean square of the stretch counts as. */
#define MIN_STRETCH 0.85

/* A step from there stretches by a quarter: nothing beside the 1 that each adds. */
static double min_size(double power) { return real_pow(4 * power, -1 / (power - 1)); }

NodeValue evaluate_mandelbulb(const NodeValue *o, uint32_t size)
{
    (void)size;
    int           last  = iterations_of(&o[1], &o[2]);
    const double *c     = o[0].v;
    double        power = o[1].v[0], radius = o[2].v[1], core = mandelbulb_core(power);
    double        least = min_size(power), w[3] = {c[0], c[1], c[2]}, from_origin = norm(c, 3);
    double        modulus = from_origin, steep = 1, sum = 0, distance;
    if (from_origin > MANDELBULB_NEAR * radius)
        return (NodeValue){{from_origin - radius}};
    for (int n = 0; n < last && modulus <= bailout(power); n++) {
        double radial  = real_pow(fmax(modulus, least), power - 1);
        double lateral = triplex_step(w, c, power_of(&o[1]));
        double mean    = (2 * radial * radial + lateral * lateral) / 3;
        sum += steep;
        steep   = power * sqrt(fmax(mean, MIN_STRETCH * radial * radial)) * steep + 1;
        modulus = norm(w, 3);
    }
    double margin = radius - modulus;
    if (margin < 0)
        distance = fmin(0.5 * modulus * real_log(modulus / radius) / steep,
                        fmax(from_origin - core, 0));
    else
        distance = -0.5 * margin / (steep + (power - 1) / (2 * least) * sum * margin);
    return (NodeValue){{fmax(distance, from_origin - radius)}};
}

NodeValue evaluate_mandelbulb_trap(const NodeValue *o, uint32_t size)
{
    (void)size;
    int    last = iterations_of(&o[1], &o[2]);
    double w[3] = {o[0].v[0], o[0].v[1], o[0].v[2]}, modulus = norm(w, 3);
    Trap   trap = {1, 1};
    for (int n = 1; n <= last && modulus <= 2 * o[2].v[1]; n++) {
        triplex_step(w, o[0].v, power_of(&o[1]));
        modulus = norm(w, 3);
        trap_add(&trap, modulus, n, last);
    }
    return trap_value(trap);
}
