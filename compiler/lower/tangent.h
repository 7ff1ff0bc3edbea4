/*
 * tangent.h: the direction in which the highlights of a surface are drawn out.
 */
#ifndef KRS_TANGENT_H
#define KRS_TANGENT_H

#include "compiler/graph/graph.h"

/* Returns a direction at `point`, which is in the space of some shape, as a unit vector of the
   scene, or of the instance group that the expressions are of; 0 where it has none. */
Node tangent_outwards(Graph *graph, Node tangent, Node point, Arena *scratch);
/* Returns the direction in which `u` grows on the surface while `v` stays, likewise. */
Node tangent_of_uv(Graph *graph, Node uv, Arena *scratch);

#endif
