/*
 * field_bounds.h: bounds on the distance to where an expression is 0.
 */
#ifndef KRS_FIELD_BOUNDS_H
#define KRS_FIELD_BOUNDS_H

#include "compiler/shape/builder.h"

/* Bounds on the distance of points in the box to what is in it, both with the sign of the
   expression. */
typedef struct FieldBounds {
    Node lipschitz; /* 1-Lipschitz */
    Node sharp;     /* a longer one that is not, or NODE_NONE */
} FieldBounds;

/* Returns the bounds that cost rays least, of an expression that has this slope over the box.
   `uniform`: near the surface the distance shall be about right everywhere, if possible. */
FieldBounds field_bounds(ShapeBuilder *builder, Node formula, double slope, Box box, bool uniform);

#endif
