/*
 * build.h: short names for the arithmetic that expressions are built of.
 *
 * As in ops.def, vectors count component by component, and a FLOAT beside a vector is spread.
 * C does not say which argument it evaluates first, and nodes are numbered as they are made: of
 * two that are new, name one before.
 */
#ifndef KRS_BUILD_H
#define KRS_BUILD_H

#include "compiler/graph/graph.h"

static inline Node add(Graph *g, Node a, Node b) { return graph_op2(g, OP_add, a, b); }
static inline Node sub(Graph *g, Node a, Node b) { return graph_op2(g, OP_sub, a, b); }
static inline Node mul(Graph *g, Node a, Node b) { return graph_op2(g, OP_mul, a, b); }
static inline Node over(Graph *g, Node a, Node b) { return graph_op2(g, OP_div, a, b); }
static inline Node neg(Graph *g, Node a) { return graph_op1(g, OP_neg, a); }

/* Tells whether a node is this constant; of vectors only 0 is known. */
bool is_number(const Graph *g, Node node, double value);

/* These return a + b, a b and a vector times a number, without what is 0 or 1; a a is a square. */
Node plus(Graph *g, Node a, Node b);
Node times(Graph *g, Node a, Node b);
Node stretch(Graph *g, Node vector, Node by);

/* Returns max(node, least). */
Node at_least(Graph *g, Node node, double least);
/* Returns the binary logarithm of the k-th root of a number >= 0. */
Node log_of_root(Graph *g, Node number, uint32_t k);
/* Returns the k-th root of a number >= 0. */
Node root_of(Graph *g, Node number, uint32_t k);

#endif
