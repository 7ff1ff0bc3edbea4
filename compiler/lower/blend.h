/*
 * blend.h: lowering of blends of any number of parts, some of which may be groups.
 */
#ifndef KRS_LOWER_BLEND_H
#define KRS_LOWER_BLEND_H

#include "compiler/lower/instance_groups.h"

/* Lowers the blend of the parts, or of their complements, none of which may then be nowhere: where
   one is, `nowhere` is set, and the result is not all. */
Lowered lower_blend(Lowering *l, PartJoin join, LowerContext context, bool *nowhere);

#endif
