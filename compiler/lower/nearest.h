/*
 * nearest.h: distances of two operands and of many, joined as a blend does.
 */
#ifndef KRS_NEAREST_H
#define KRS_NEAREST_H

#include "compiler/shape/shape.h"

/* Joins two distances, sharply or blended. */
Node join_distances(Graph *g, Blend blend, Node a, Node b);

/* The nearest operands of a blend of many, as far as they count: of pairs the two nearest; else MAX_SHARERS
   in two vectors, in ascending order.  What is not there is NOWHERE. */
typedef struct Nearest {
    bool pairs;
    Node near, more;
} Nearest;

Nearest nearest_none(Graph *g, bool pairs);
Nearest nearest_add(Graph *g, Nearest nearest, Node distance);
/* Merges all that are in `others` as well. */
Nearest nearest_merge(Graph *g, Nearest nearest, Nearest others);
/* Returns the blend of those that are in it; by MANY_IN_ROW it has not all that count. */
Node nearest_end(Graph *g, Blend blend, Nearest nearest);
/* These return the threshold below which operands have a share, and the share of one, from 0 to 1:
   what surfaces are mixed by. */
Node nearest_threshold(Graph *g, Blend blend, Nearest nearest);
Node share_below(Graph *g, Blend blend, Node threshold, Node distance);
/* Returns what separate operands, at least one, are blended to, and their threshold. */
Node blend_distances(Graph *g, Blend blend, const Node *distances, uint32_t count);
Node blend_threshold(Graph *g, Blend blend, const Node *distances, uint32_t count);

#endif
