/*
 * vec.h: vectors of three doubles.
 */
#ifndef KRS_VEC_H
#define KRS_VEC_H

#include <math.h>
#include <stdbool.h>

#include "compiler/base/minmax.h"

static inline double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void cross3(const double a[3], const double b[3], double product[3])
{
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double length3(const double v[3]) { return sqrt(dot3(v, v)); }

/* Returns the maximum norm: the largest absolute value of a component. */
static inline double largest3(const double v[3])
{
    return max2(fabs(v[0]), max2(fabs(v[1]), fabs(v[2])));
}

static inline double distance3(const double a[3], const double b[3])
{
    const double offset[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return length3(offset);
}

/* Computes to = from + factor v; `to` may be one of the arguments. */
static inline void add_scaled3(double to[3], const double from[3], double factor, const double v[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = from[i] + factor * v[i];
}

/* Scales v to length 1; false when its length is 0 or not finite. */
static inline bool normalize3(double v[3])
{
    double length = length3(v);
    if (!(length > 0) || isinf(length))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return true;
}

/* Finds two unit vectors across a unit vector, and across each other: `along` is first x second. */
static inline void axes_across3(const double along[3], double first[3], double second[3])
{
    const bool   along_x = !(fabs(along[0]) < 0.6);
    const double side[3] = {!along_x, along_x, 0};
    cross3(along, side, first);
    normalize3(first);
    cross3(along, first, second);
}

#endif
