/*
 * intern.h: equal expressions are one node.
 */
#ifndef KRS_INTERN_H
#define KRS_INTERN_H

#include "compiler/graph/graph.h"

/* The node of this expression, new if there is none. */
Node node_intern(Graph *graph, Expr e);

#endif
