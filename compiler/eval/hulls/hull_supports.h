/*
 * hull_supports.h: the convex hull of balls of any radii, in space or in the plane.
 *
 * The signed distance to a convex set is the greatest of its supports: for each direction u the
 * height of the point above the plane across u that touches the set from outside.  Directions in
 * which one plane touches three balls or more are faces.  Planes that touch two balls turn about
 * both, along an arc of directions: an edge.  A ball touched alone is a corner (math.md, 5).
 */
#ifndef KRS_HULL_SUPPORTS_H
#define KRS_HULL_SUPPORTS_H

#include <stdbool.h>
#include <stddef.h>

#include "compiler/base/arena.h"

typedef struct HullBall {
    double centre[3], radius;
} HullBall;

/* The half-space dot(normal, q) <= offset, of a unit normal. */
typedef struct HullFace {
    double normal[3], offset;
} HullFace;

/* Directions sine * axis + cosine * w, w a unit vector across the axis with dot(w, middle) >= least. */
typedef struct HullEdge {
    HullBall ball;                  /* where it begins */
    double   axis[3], sine, cosine; /* unit vector towards the other ball */
    double   middle[3], least;
} HullEdge;

/* Directions u with dot(u, towards) <= longer. */
typedef struct HullLimit {
    double towards[3], longer;
} HullLimit;

typedef struct HullCorner {
    HullBall ball;
    struct {
        HullLimit *items;
        size_t     count, capacity;
    } limits;
} HullCorner;

typedef struct HullSupports {
    struct {
        HullFace *items;
        size_t    count, capacity;
    } faces;
    struct {
        HullEdge *items;
        size_t    count, capacity;
    } edges;
    struct {
        HullCorner *items;
        size_t      count, capacity;
    } corners;
} HullSupports;

/* Finds the supports of one ball at least.  `plane`: centres have z = 0, and directions as well; there are no
   edges then. */
HullSupports hull_supports(Arena *arena, const HullBall *balls, size_t count, bool plane);
/* Tells whether centres lie in one plane, or on one line for `plane`, but for rounding. */
bool balls_are_flat(const HullBall *balls, size_t count, bool plane);

#endif
