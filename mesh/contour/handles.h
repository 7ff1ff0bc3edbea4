/*
 * handles.h: holes and rods that are thinner than what is asked for.
 */
#ifndef KRS_MESH_HANDLES_H
#define KRS_MESH_HANDLES_H

#include "mesh/contour/contour.h"

/* Counts the places of a closed mesh where the connected part within the radius of a vertex is no disc, but all of a part, or goes
   around a rod or through a hole.  One that fits into half of the radius is not missed.  Rods and flaps that end are none.  `at`: the first
   place; unchanged where there is none. */
size_t handles_count(const Contour *contour, double radius, double at[3]);

/* The first places, up to so many, where the connected part within the radius of a vertex has a handle, or has no border.  Returns how
   many. */
size_t handles_places(const Contour *contour, double radius, double (*places)[3], size_t most);

#endif
