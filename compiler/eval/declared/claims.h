/*
 * claims.h: the claims of a declaration, put to the test.
 */
#ifndef KRS_CLAIMS_H
#define KRS_CLAIMS_H

#include "compiler/eval/elaborate.h"

/* Samples the claims of a declared shape at its sizes; `slope` is claimed, 0: none is.  False:
   reported. */
bool check_claims(Elaboration *e, const Shape *shape, double slope);
/* Does the same of the `core` of a declared shape, for this `rounding`. */
bool check_core(Elaboration *e, const Shape *shape, const Shape *core, Node rounding);
/* Samples whether nothing of a declared shape is outside of this hull. */
bool check_hull(Elaboration *e, const Shape *shape, const Shape *hull);

#endif
