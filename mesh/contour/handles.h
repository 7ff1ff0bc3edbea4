/*
 * handles.h: holes and rods that are thinner than what is asked for.
 */
#ifndef KRS_MESH_HANDLES_H
#define KRS_MESH_HANDLES_H

#include "mesh/contour/contour.h"

/* Counts the places of a closed mesh where the connected part within the radius of a vertex is no disc, but goes around a rod or
   through a hole.  One that fits into half of the radius is not missed.  `at`: the first place; unchanged where there is none. */
size_t handles_count(const Contour *contour, double radius, double at[3]);

#endif
