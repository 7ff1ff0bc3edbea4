/*
 * formulas.h: the surfaces of std/surfaces.krs, written a second time.
 *
 * Where a surface has two well-known forms the library has one and this file the other: planes
 * that are multiplied, a determinant, the corners of the 600-cell.  Signs are the library's,
 * negative inside, as there is nothing else to take them from.  Numbers are long, so that what
 * is found here decides about what the compiler finds in double precision.
 */
#ifndef ORACLE_FORMULAS_H
#define ORACLE_FORMULAS_H

#include "tests/oracle/brute.h"

typedef long double Real;
typedef Real        Formula(const Real p[3]);

typedef struct Surface {
    const char *name;
    const char *before; /* a declaration that the call needs, or "" */
    const char *call;   /* with ")" missing: `within` and `open` can be added */
    Formula    *formula;
    double      radius; /* of the ball that the library cuts it by */
} Surface;

enum { SURFACES = 22 };
extern const Surface surfaces[SURFACES];

/* Returns the one of this name. */
const Surface *surface_named(const char *name);

/* By differences, whose error is some 1e-12 of the gradient's size nearby. */
void surface_gradient(Formula *formula, const Real p[3], Real gradient[3]);
Vec  surface_slope(Formula *formula, Vec p);

/* The closest point of {f = 0}, about: down the gradient of |f|.  False when that leads nowhere. */
bool surface_near(Formula *formula, Vec p, Vec *found);

/* Where a ray from outside first enters the solid f <= 0 within the ball around the origin. */
typedef enum Fate {
    RAY_MISSES,
    RAY_HITS,
    RAY_DOUBTFUL /* a hair more or less of the ray decides */
} Fate;

typedef struct Entry {
    Fate fate;
    Real t;
    bool on_ball; /* it enters through the ball, not through {f = 0} */
} Entry;

Entry surface_entry(Formula *formula, Real radius, Vec origin, Vec direction);

/* Returns the first t in the ball at which f changes its sign, in either direction. */
Entry surface_crossing(Formula *formula, Real radius, Vec origin, Vec direction);

/* How far from a root at p double precision may end, which knows f to some 1e-15 of what it is
   nearby: the farther, the smaller the angle at which the ray meets the surface. */
double surface_leeway(Formula *formula, double radius, Vec p, Vec direction);

/* A ray from a few radii away to somewhere in the ball. */
void random_ray(Random *random, double radius, Vec *origin, Vec *direction);

#endif
