/*
 * handles.h: holes and rods that are thinner than what is asked for.
 */
#ifndef KRS_MESH_HANDLES_H
#define KRS_MESH_HANDLES_H

#include "compiler/mesh/contour.h"

/* Counts the places where what is within the radius of a vertex, of a closed mesh that hangs together there, is no disc but goes
   around a rod, or through a hole.  None is missed around which it goes within half of the radius.  `at`: the first of them. */
size_t handles_count(const Contour *contour, double radius, double at[3]);

#endif
