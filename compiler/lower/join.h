/*
 * join.h: unions of what was lowered, and shapes that something moves.
 */
#ifndef KRS_JOIN_H
#define KRS_JOIN_H

#include "compiler/lower/context.h"

/* The union of two distances, sharp or blended. */
Lowered join_two(Lowering *l, Blend blend, Lowered a, Lowered b);
/* A shape whose distance is looked at where it is not 0: it is no less than that to the sides of the
   shape's box. */
Lowered lower_operand(Lowering *l, const Shape *shape, LowerContext context);

#endif
