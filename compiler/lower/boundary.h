/*
 * boundary.h: the true boundary of figures that are joined sharply, or copied, or revolved.
 *
 * The least of the distances to parts that overlap or touch is not the distance inside of their union: it is
 * 0 along a seam.  Where the numbers of all parts are known, so are their outlines, and what is left of
 * these is the boundary.  The distance to that has the sign of the CSG node.  Likewise a side that lies on the axis about
 * which a figure is revolved is within the solid.
 */
#ifndef KRS_BOUNDARY_H
#define KRS_BOUNDARY_H

#include "compiler/lower/context.h"

/* Makes what is known of a CSG node's boundary, which is looked for when it is first needed. */
struct Boundary *boundary_new(Arena *arena);
/* Makes what is known of the boundary of a figure that is revolved about the line with this x. */
struct Boundary *boundary_about(Arena *arena, double axis);

/* Lowers a CSG node, copies, or what is revolved, by its parts.  Where distances are needed away from the outline, what the
   parts say is not the true one there, and the boundary is known, it gets the distance to that, with the sign of the parts.
   `point` is that of the context in the plane of the figure. */
Lowered lower_within_boundary(Lowering *l, const Shape *shape, LowerContext context, Node point,
                              LowerShape *by_parts);

#endif
