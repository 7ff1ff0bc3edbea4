/*
 * flat_outlines.h: makes the inside of an outline, whose curves become as many chords as the error
 * needs.
 */
#ifndef KRS_MESH_FLAT_OUTLINES_H
#define KRS_MESH_FLAT_OUTLINES_H

#include "mesh/flat/flat_joins.h"

/* Returns the solid where the distance to an outline, a step that is a call, is below 0. */
int flat_solid_of_outline(Finding *f, uint32_t value);

#endif
