/*
 * parity.h: what a reflection of the point does to an expression.
 */
#ifndef KRS_PARITY_H
#define KRS_PARITY_H

#include "compiler/graph/graph.h"

/* Whether `root` (a FLOAT) has the same value at the point mirrored in the plane where
   coordinate `axis` is 0: proven by the parity of its parts, so "no" may mean "not seen". */
bool graph_is_even(const Graph *graph, Node root, uint32_t axis, Arena *scratch);

#endif
