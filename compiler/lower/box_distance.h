/*
 * box_distance.h: what boxes say of the distance to what lies in them.
 */
#ifndef KRS_BOX_DISTANCE_H
#define KRS_BOX_DISTANCE_H

#include "compiler/graph/graph.h"
#include "compiler/shape/box.h"

/* Distance to a finite box, 0 inside. */
Node box_distance(Graph *graph, Node point, Box box);
/* How far outside of a box a point is along the axis where that is most; negative inside.
   NODE_NONE of a box that no axis bounds. */
Node sides_excess(Graph *graph, Node point, Box box);

#endif
