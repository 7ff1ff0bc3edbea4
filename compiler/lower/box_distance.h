/*
 * box_distance.h: bounds for the distance to a shape, from a box around it.
 */
#ifndef KRS_BOX_DISTANCE_H
#define KRS_BOX_DISTANCE_H

#include "compiler/graph/graph.h"
#include "compiler/shape/box.h"

/* Returns the distance to a finite box, 0 inside. */
Node box_distance(Graph *graph, Node point, Box box);
/* Returns the greatest of how far outside of its sides a point is, negative inside: with the same
   numbers as the distance, and as the box itself has. */
Node box_excess(Graph *graph, Node point, Box box);
/* Tells how far outside of a box a point is along an axis, at most; negative inside.  Axes along which
   the box is infinite do not count; NODE_NONE when these are all. */
Node sides_excess(Graph *graph, Node point, Box box);

#endif
