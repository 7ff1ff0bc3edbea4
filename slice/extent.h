/*
 * extent.h: the box around a solid, without the room that bounds of boxes leave.
 */
#ifndef KRS_SLICE_EXTENT_H
#define KRS_SLICE_EXTENT_H

#include "compiler/field/field.h"

/* Narrows a box around all that is solid.  A side becomes that of the outermost point that is found, if it is proven that
   none is farther out by more than a 500th of the box; else it is where nothing is beyond.  False: it is proven that
   nothing is solid. */
bool narrow_box(const MeshField *field, double low[3], double high[3]);

#endif
