/*
 * op_values.h: what single operations are, as the rows of ops.def and blends.def name it.
 *
 * evaluate.c runs MAP rows, leaves and guards by itself; op_evaluate of graph.h does any operation.
 */
#ifndef KRS_OP_VALUES_H
#define KRS_OP_VALUES_H

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/graph.h"

/* The value of a MAP row for `size` components of its operands; zero has no sign.  NULL: it is no such row. */
typedef void MapValue(const double *a, const double *b, const double *c, uint32_t size, double *to);
extern MapValue *const map_values[OP_COUNT];

static inline NodeValue number(double a) { return (NodeValue){{a}}; }
static inline NodeValue vector3(double x, double y, double z) { return (NodeValue){{x, y, z}}; }

/* Tells whether the bound of a guard decides.  At 0 the point may be anywhere inside: there, inside
   of something else, only the rest can tell how deep. */
static inline bool guard_decides(double bound, double least, double far)
{
    return bound >= fmin(least, far) && bound > fmin(far, 0);
}

/* Mixes the bits of a number, as print/glsl/identity.glsl does; every input gives another output. */
static inline uint32_t scramble(uint32_t x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

/* ---- the `value` column of MAP rows ---- */

static inline double value_sign(double a) { return (a > 0) - (a < 0); }
static inline double value_unit(double a) { return fmin(fmax(a, -1), 1); }

/* Returns a modulo b exactly, unlike a - b * floor(a / b), so that it never leaves [0, b). */
static inline double value_mod(double a, double b)
{
    double rest = fmod(a, b);
    return rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest;
}

/* The sign of a zero means nothing in these two. */
static inline double value_pow(double a, double b) { return real_pow(a + 0.0, b); }
static inline double value_atan2(double a, double b) { return real_atan2(a + 0.0, b + 0.0); }

static inline double value_smoothstep(double a, double b, double c)
{
    double t = a == b ? !(c < a) : fmin(fmax((c - a) / (b - a), 0), 1);
    return t * t * (3 - 2 * t);
}

/* ---- the `value` column of blends.def ---- */

/* Returns hg_sdf's fOpUnionStairs: a triangle wave turns the line a + b = k into steps along which
   either a or b alone decides; that is why its slope is that of the steeper of them. */
static inline double value_stairs(double a, double b, double k, double n)
{
    if (isinf(a) || isinf(b))
        return fmin(a, b);
    double s = k / fmax(n, 1), u = b - k;
    double wave = fabs(value_mod(u - a + s, 2 * s) - s);
    return fmin(fmin(a, b), 0.5 * (u + a + wave));
}

#endif
