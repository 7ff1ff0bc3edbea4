/*
 * path.h: contours in the plane, as they are drawn: lines, arcs of circles, quadratic and cubic Bezier
 * curves.
 *
 * Cubic curves become quadratic ones that leave them by no more than a tolerance.
 */
#ifndef KRS_PATH_H
#define KRS_PATH_H

#include <stdbool.h>
#include <stddef.h>

#include "compiler/base/arena.h"

/* (1 - t)^2 from + 2 (1 - t) t via + t^2 to, 0 <= t <= 1; of a line `via` is its middle.  An arc of a circle
   turns by less than half of it; its tangents meet in `via`, which has the weight radius / |via - centre|. */
typedef struct Curve {
    double from[2], via[2], to[2];
    bool   straight;
    double centre[2], radius; /* of an arc; of other curves the radius is 0 */
} Curve;

typedef struct Curves {
    Curve *items;
    size_t count, capacity;
} Curves;

typedef struct Path {
    Arena *arena;
    Curves curves;
    double start[2], at[2]; /* of the contour at hand */
    double tolerance;       /* of cubic curves */
} Path;

static inline double cross2(const double a[2], const double b[2])
{
    return a[0] * b[1] - a[1] * b[0];
}

static inline double dot2(const double a[2], const double b[2])
{
    return a[0] * b[0] + a[1] * b[1];
}

/* Each of these begins where the one before ended.  Contours end where they began: what is left
   open when the next begins is closed by a line. */
void path_move(Path *path, const double to[2]);
void path_line(Path *path, const double to[2]);
void path_quadratic(Path *path, const double via[2], const double to[2]);
void path_cubic(Path *path, const double first[2], const double second[2], const double to[2]);
/* Draws an arc; `bulge` is the tangent of a quarter of the angle that it turns by, above 0 to the
   left. */
void path_arc(Path *path, const double to[2], double bulge);
void path_close(Path *path);

Curve line_between(const double from[2], const double to[2]);
/* These find the point and half of the derivative at t. */
void curve_point(const Curve *curve, double t, double point[2]);
void curve_tangent(const Curve *curve, double t, double tangent[2]);
/* Returns the part with parameters from t to u. */
Curve curve_part(const Curve *curve, double t, double u);
/* Returns the same backwards. */
Curve curve_reversed(const Curve *curve);
/* Returns the nearest point's parameter. */
double curve_nearest(const Curve *curve, const double point[2]);

#endif
