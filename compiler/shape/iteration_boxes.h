/*
 * iteration_boxes.h: boxes of a shape in each iteration of a loop.
 */
#ifndef KRS_ITERATION_BOXES_H
#define KRS_ITERATION_BOXES_H

#include "compiler/shape/builder.h"

/* Finds the boxes that a shape would have, had it been made with each of these numbers in the place
   of a leaf of frame time, a few roundings larger.  What depends on the leaf depends on no other
   parameter.  False: that is not known without making it, or some number is not finite.  `arena`
   keeps what it was found with. */
bool iteration_boxes(ShapeBuilder *builder, const Shape *shape, Node leaf, const double *iterations,
                     size_t count, Box *boxes, Arena *arena);

#endif
