/*
 * handles.h: finds holes and rods that are thinner than a radius.
 */
#ifndef KRS_MESH_HANDLES_H
#define KRS_MESH_HANDLES_H

#include "mesh/contour/contour.h"

/* Counts regions of a closed mesh, the connected parts within the radius of a vertex, that are no
   disc, but a whole component, or go around a rod or through a hole.  One that fits into half of
   the radius is not missed.  Rods and flaps that end do not count.  `at` becomes the vertex of the
   first, if there is one. */
size_t handles_count(const Contour *contour, double radius, double at[3]);

/* Finds the vertices of up to `most` regions that have a handle, or no border; returns how many. */
size_t handles_find(const Contour *contour, double radius, double (*locations)[3], size_t most);

#endif
