/*
 * extent.h: finds a tight box around a solid.
 */
#ifndef KRS_SLICE_EXTENT_H
#define KRS_SLICE_EXTENT_H

#include "compiler/field/field.h"

/* Narrows a box around all that is solid.  A side goes to the outermost solid point that is found,
   if it is proven that none is farther out by more than a 500th of the box; else to where nothing
   is beyond.  Returns false if it is proven that nothing is solid. */
bool narrow_box(const MeshField *field, double low[3], double high[3]);

#endif
