/*
 * bump.h: normals of a surface that seems to be higher in some places.
 */
#ifndef KRS_BUMP_H
#define KRS_BUMP_H

#include "compiler/graph/graph.h"

/* Returns the normal of a surface as if each point of it were moved outwards by a height.  The
   height, the point in the space of the material and the unit normal there are lowered to the point
   of the scene or of an instance group's call. */
Node bumped_normal(Graph *graph, Node height, Node point, Node normal, Arena *scratch);

#endif
