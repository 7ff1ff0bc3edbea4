/*
 * simplify.h: algebra that makes a graph smaller without changing values.
 */
#ifndef KRS_SIMPLIFY_H
#define KRS_SIMPLIFY_H

#include "compiler/graph/graph.h"

/* Simplifies everything that `roots` need, into a new graph (same parameters): the roots are
   renumbered in place.  Rules keep values: x+0, x*1, x*0 (x finite), --x, min(x,x), component of a
   built vector, a built vector of all components of one vector, select with equal branches or known
   condition, constants gathered.  Dead nodes are gone. */
Graph *graph_simplify(const Graph *graph, Node *roots, size_t root_count, Arena *arena);

#endif
