/*
 * hull.h: convex hulls of points, balls and rims.
 */
#ifndef KRS_HULL_H
#define KRS_HULL_H

#include "compiler/eval/hulls/hull_parts.h"

/* hull_triangles.c has the latter. */
BuiltinFunction builtin_hull, builtin_hull_triangles;
Value           method_hull(Elaboration *e, const Shape *shape, Call *call);
/* Returns the hull of parts; NULL: they are corners of a solid, too many, or more than can be
   said. */
const Shape *round_hull(Elaboration *e, const Call *call, const HullParts *parts);

#endif
