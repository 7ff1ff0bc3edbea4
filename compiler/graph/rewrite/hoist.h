/*
 * hoist.h: constants that change with the numbers of a scene leave the text of its shaders.
 */
#ifndef KRS_HOIST_H
#define KRS_HOIST_H

#include "compiler/graph/graph.h"

/* A copy in which constants of operations at points are numbers of the frame (OP_HOISTED), counted
   from `first` on in the order of the nodes.  So scenes that differ in such constants alone have one
   graph but for these numbers.  Roots become those of the copy. */
Graph *graph_hoist(const Graph *graph, Node *roots, size_t root_count, uint32_t first,
                   Arena *arena);

#endif
