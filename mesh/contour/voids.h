/*
 * voids.h: closes tiny voids.
 *
 * Where solids touch, the gap between them becomes thinner than any error, and the mesh leaves a
 * string of bubbles there, which nobody wants in a print.
 */
#ifndef KRS_MESH_VOIDS_H
#define KRS_MESH_VOIDS_H

#include "mesh/contour/contour.h"

/* Drops components of the mesh that enclose what is outside, are thinner than the error and no
   longer than twice the error.  Returns how many; `at` becomes a point of the first. */
size_t voids_close(Contour *contour, double at[3]);

#endif
