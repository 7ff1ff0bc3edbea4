/*
 * boundary.h: the true boundary of figures that are joined sharply.
 *
 * The least of the distances to parts that overlap or touch is not the distance inside of their union: it is
 * 0 along a seam.  Where the numbers of all parts are known, so are their outlines, and what is left of
 * these is the boundary.  The distance to that has the sign of the joint.
 */
#ifndef KRS_BOUNDARY_H
#define KRS_BOUNDARY_H

#include "compiler/lower/context.h"

/* Makes what is known of a joint's boundary, which is looked for when it is first needed. */
struct Boundary *boundary_new(Arena *arena);

/* Whether distances are needed away from the outline of a joint, what its parts say is not the true one there,
   and its boundary is known. */
bool boundary_counts(Lowering *l, const Shape *joint, LowerContext context);
/* Then: the distance to the boundary, with the sign of `joined`. */
Node boundary_distance(Lowering *l, const Shape *joint, LowerContext context, Node joined);

#endif
