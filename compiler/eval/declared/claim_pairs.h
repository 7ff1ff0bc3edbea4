/*
 * claim_pairs.h: what a declaration claims of its shape beside the slope and the box.
 *
 * Each claim says that two numbers are nowhere above 0 both.  The compiler samples it when the
 * declaration is first used (claims.c), and `krs validate` searches for a point that refutes it.
 */
#ifndef KRS_CLAIM_PAIRS_H
#define KRS_CLAIM_PAIRS_H

#include "compiler/shape/shape.h"

typedef struct ShapeClaim {
    const char  *property; /* of the declaration */
    const char  *wrong;    /* what is so at a point where both numbers are above 0 */
    Node         a, b;
    const Shape *shape; /* of the declaration */
    Span         span;  /* of the property's value */
} ShapeClaim;

enum { MAX_SHAPE_CLAIMS = 8 };

typedef struct ShapeClaims {
    ShapeClaim items[MAX_SHAPE_CLAIMS];
    uint32_t   count;
} ShapeClaims;

/* Returns the claims `figure`, `plane` and `bound` of a declared shape, and `core` of one that was
   rounded by it; none of any other shape. */
ShapeClaims claims_of(Graph *graph, const Shape *shape, Arena *scratch);

/* Claims that a core is all that is deeper in a shape than `rounding`. */
ShapeClaims core_claims(Graph *graph, const Shape *shape, const Shape *core, Node rounding,
                        Arena *scratch);
/* Claims that nothing of a shape is outside of its hull. */
ShapeClaims hull_claims(Graph *graph, const Shape *shape, const Shape *hull, Arena *scratch);

#endif
