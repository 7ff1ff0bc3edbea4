/*
 * field_touching.h: faces that lie on each other.
 *
 * Where two solids that are united touch in a face, the distance is 0 inside of their union.  It is nowhere above 0
 * there, so that there is no surface.
 */
#ifndef KRS_FIELD_TOUCHING_H
#define KRS_FIELD_TOUCHING_H

#include "compiler/field/field.h"

/* Leaves out pieces of which the sign never depends, since they are opposite to all that they are compared with.  `operands`:
   of the values of each piece, on the tape, of which a run of ranges was over the box. */
void field_drop_touching(const LaneTape *tape, const LaneRanges *ranges, FieldPieces *pieces,
                         uint32_t operands[MAX_PIECES][PIECE_VALUES]);

#endif
