/*
 * extents.h: how far a shape reaches, in numbers of the frame, and which ways its faces look.
 *
 * A shape is within the convex hull of some balls, of balls that go around a circle (rims, as those of
 * hull_parts.h), and of half-spaces.  It is that hull where the language knows it; of other shapes it is
 * the box.
 */
#ifndef KRS_EXTENTS_H
#define KRS_EXTENTS_H

#include "compiler/eval/elaborate.h"

/* A ball, with its centre at a point or, with a rim, on a circle: `rim` is along the axis of the circle
   and as long as its radius.  NODE_NONE: it stays. */
typedef struct Extent {
    Node centre, radius, rim;
} Extent;

/* A point and a unit vector: a line, or the half-space dot(along, q) <= dot(along, on). */
typedef struct ExtentLine {
    Node on, along;
} ExtentLine;

typedef struct ExtentLines {
    ExtentLine *items;
    size_t      count, capacity;
} ExtentLines;

typedef struct Extents {
    Extent *items;
    size_t  count, capacity;
    struct {
        Node  *items;
        size_t count, capacity;
    } faces,                 /* unit normals of faces; their opposites count as well */
        centres;             /* of round solids */
    ExtentLines axes;        /* of what is round about one */
    ExtentLines half_spaces; /* of which it is made, beside balls and rims */
    bool        figure;      /* in the plane z = 0 */
    bool        endless;     /* nothing that it is within is known */
} Extents;

/* Adds those of a shape. */
void extents_add(Elaboration *e, const Shape *shape, Extents *extents);

Extents extents_of_both(Elaboration *e, const Extents *a, const Extents *b);

/* Finds the least and the greatest coordinates of all of it; false: it has none. */
bool extents_box(Elaboration *e, const Extents *extents, Node corners[2]);
/* Returns the greatest of dot(along, q) over all of it; NODE_NONE: there is none. */
Node extents_along(Elaboration *e, const Extents *extents, Node along);
/* Returns no less than the greatest distance from a line, or from a point; there are no
   half-spaces. */
Node extents_about(Elaboration *e, const Extents *extents, ExtentLine axis);
Node extents_from(Elaboration *e, const Extents *extents, Node centre);

#endif
