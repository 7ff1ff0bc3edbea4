/*
 * rebase.h: the same values near a place that is far from the origin.
 *
 * Single precision has seven digits: a hundred thousand units away it knows a point to a
 * hundredth.  So the point is relative to an origin near it, where it needs few digits, and what
 * maps of space do to that origin is found once per frame, by the host, in double precision.
 */
#ifndef KRS_REBASE_H
#define KRS_REBASE_H

#include "compiler/graph/graph.h"

/* Replaces the roots by ones that have the same values when OP_POINT is the point less
   `rebase_origin`, a frame-time VEC3.  What the host has to find stands in OP_precise. */
void graph_rebase(Graph *graph, Node *roots, size_t count, Node rebase_origin, Arena *scratch);

#endif
