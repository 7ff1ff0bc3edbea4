/*
 * join.h: unions of lowered shapes, and operands whose distances are used away from the surface.
 */
#ifndef KRS_JOIN_H
#define KRS_JOIN_H

#include "compiler/lower/context.h"
#include "compiler/lower/nearest.h"

/* Joins two lowered shapes, sharply or by a blend. */
Lowered join_two(Lowering *l, Blend blend, Lowered a, Lowered b);

/* Lowers an operand of a shape, such as a blend, that needs distances other than 0.  They are at
   least the distance to the sides of the operand's box.  How far from the surface they must be
   right, the context says. */
Lowered lower_operand(Lowering *l, const Shape *shape, LowerContext context);

#endif
