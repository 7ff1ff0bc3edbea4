/*
 * sides.h: which side points of the tetrahedra are on, where the mesh would have a handle that the solid has not.
 *
 * Along a knife edge the solid is thinner than tetrahedra, so its points there are inside by chance, and what they make has
 * holes.  Around such a place all points that are not deep go to one side.  Then one after the other goes back,
 * as long as the mesh stays of the same shape: that is so if those around it that are inside hang together, and those outside.
 */
#ifndef KRS_MESH_SIDES_H
#define KRS_MESH_SIDES_H

#include "mesh/contour/contour.h"

/* Moves points that are within the radius of a place to the other side, if they are no deeper than `deep`, such that the mesh has
   fewer handles there, or fewer parts that are no larger than that.  Their tetrahedra are fresh then. */
bool sides_tidy(Contour *contour, const double place[3], double radius, double deep);

#endif
