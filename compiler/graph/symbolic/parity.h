/*
 * parity.h: what a reflection of the point does to an expression.
 */
#ifndef KRS_PARITY_H
#define KRS_PARITY_H

#include "compiler/graph/graph.h"

/* The parity of an operation by those of its operands: a column of ops.def.  If all of them are
   even, so is any result. */
typedef enum ParityRule {
    PARITY_NONE,
    PARITY_ODD,     /* f(-a) = -f(a) */
    PARITY_EVEN,    /* f(-a) = f(a) */
    PARITY_SUM,     /* a + b or a - b */
    PARITY_PRODUCT, /* a b or a / b; up to here arithmetic */
    PARITY_COMPONENT,
    PARITY_VECTOR, /* of what BUILDS */
    PARITY_DOT,
    PARITY_LENGTH,
    PARITY_ROTATE
} ParityRule;

ParityRule op_parity(Op op);

/* Tells whether `root` (a FLOAT) has the same value at the point mirrored in the plane where
   coordinate `axis` is 0: proven by the parity of its parts, so "no" may mean "not seen". */
bool graph_is_even(const Graph *graph, Node root, uint32_t axis, Arena *scratch);

#endif
