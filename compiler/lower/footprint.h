/*
 * footprint.h: how far what a material computes changes within a pixel.
 */
#ifndef KRS_FOOTPRINT_H
#define KRS_FOOTPRINT_H

#include "compiler/graph/graph.h"

/* The pixel where an expression is evaluated, as leaves: of the scene, or of the instance group
   that it is of. */
typedef struct Pixel {
    Node point, normal, view, radius;
} Pixel;
Pixel pixel_of(Graph *graph, Node expression, Arena *scratch);

/* Returns a copy of a root of a material, lowered to the point of the scene or of an instance
   group's call, in which each OP_footprint is what it stands for. */
Node lower_footprints(Graph *graph, Node root, Arena *scratch);

#endif
