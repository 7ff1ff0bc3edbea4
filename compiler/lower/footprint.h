/*
 * footprint.h: how far what a material computes changes within a pixel.
 */
#ifndef KRS_FOOTPRINT_H
#define KRS_FOOTPRINT_H

#include "compiler/graph/graph.h"

/* A copy of a root of a material, lowered to the point of the scene or of a crowd's call, in which
   each OP_footprint is what it stands for. */
Node lower_footprints(Graph *graph, Node root, Arena *scratch);

#endif
