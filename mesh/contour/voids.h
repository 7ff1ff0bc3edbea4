/*
 * voids.h: tiny voids are closed.
 *
 * Where solids touch, the gap between them becomes thinner than any error, and the mesh leaves a
 * string of bubbles there.  Nobody wants them in a print.
 */
#ifndef KRS_MESH_VOIDS_H
#define KRS_MESH_VOIDS_H

#include "mesh/contour/contour.h"

/* Drops parts of the mesh that enclose what is outside, are thinner than the error and nowhere longer than twice
   of it.  Returns how many; `at` is a place of the first. */
size_t voids_close(Contour *contour, double at[3]);

#endif
