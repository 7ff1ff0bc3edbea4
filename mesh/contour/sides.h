/*
 * sides.h: moves points of tetrahedra to the other side, where the mesh would have a handle that
 * the solid has not.
 *
 * Along a knife edge the solid is thinner than tetrahedra, so points there are inside by chance,
 * and the mesh has holes.  Around these all points that are not deep go to one side.  Then one
 * after the other goes back, as long as the topology of the mesh stays: that is so if its
 * neighbours inside are connected, and those outside.
 */
#ifndef KRS_MESH_SIDES_H
#define KRS_MESH_SIDES_H

#include "mesh/contour/contour.h"

/* Moves points within the radius to the other side, if they are no deeper than `deep`, so that the
   mesh has fewer handles there, or fewer components within the radius; returns whether any was
   moved.  Their tetrahedra are fresh then. */
bool sides_tidy(Contour *contour, const double center[3], double radius, double deep);

#endif
