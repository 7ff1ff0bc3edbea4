/*
 * declare.h: shapes declared in the language, and their properties.
 */
#ifndef KRS_DECLARE_H
#define KRS_DECLARE_H

#include "compiler/eval/elaborate.h"

/* Tells whether a declaration or property has not been put to the test yet; it counts as tested from
   here on. */
bool needs_check(Elaboration *e, const Syntax *syntax);

/* Returns the `core` for this `rounding`; NULL: reported. */
const Shape *declared_core(Elaboration *e, const Shape *shape, Node rounding);
/* Returns the value of `hull`. */
Value declared_hull(Elaboration *e, const Shape *shape);
/* Finds the corners of all figures below a sharp CSG node. */
void find_borders(Elaboration *e, const Shape *csg_node);
/* Returns the value of shapes that are joined or copied, or of NULL; of figures one knows then
   where the boundary is. */
Value value_of_csg_node(Elaboration *e, const Shape *csg_node);

#endif
