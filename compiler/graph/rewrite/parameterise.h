/*
 * parameterise.h: constants that change with the numbers of a scene leave the text of its shaders.
 */
#ifndef KRS_PARAMETERISE_H
#define KRS_PARAMETERISE_H

#include "compiler/graph/graph.h"

/* Returns a copy in which constants of operations at points are numbers of the frame
   (OP_PARAMETERISED), counted from `first` on in the order of the nodes.  So scenes that differ in
   such constants alone have one graph but for these numbers.  Roots become those of the copy. */
Graph *graph_parameterise(const Graph *graph, Node *roots, size_t root_count, uint32_t first,
                          Arena *arena);

#endif
