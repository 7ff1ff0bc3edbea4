/*
 * iteration_boxes.h: boxes of a shape in each iteration of a loop.
 */
#ifndef KRS_ITERATION_BOXES_H
#define KRS_ITERATION_BOXES_H

#include "compiler/shape/builder.h"

/* The boxes that a shape would have, had it been made with each of these numbers in the place of a leaf
   of frame time: for all values of the other parameters, and a few roundings larger.  False: that is not
   known without making it, or some number is not finite. */
bool iteration_boxes(ShapeBuilder *builder, const Shape *shape, Node iteration,
                     const double *iterations, size_t count, Box *boxes);

#endif
