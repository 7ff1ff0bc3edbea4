/*
 * local.h: how fast an expression can change near a point, as an expression of the point.
 *
 * One slope for a whole region is too much wherever the expression is flatter.  A table of slopes
 * by cells would be looked up, which costs more than most formulas; so the bound is computed at
 * the point, from numbers that the formula needs anyway.
 */
#ifndef KRS_LOCAL_H
#define KRS_LOCAL_H

#include "compiler/graph/bounds/facts.h"

/* A bound for p and p + r v in the box, v of length 1, and 0 <= r <= radius:
       |root(p + r v) - root(p)| <= first r + second r^2.
   All three are FLOAT nodes of the point. */
typedef struct LocalBound {
    Node radius, first, second;
} LocalBound;

/* The radius is as long as a step can be: |root| over the slope at the point, which is taken to
   be at least `least`, a number above 0.  False: an operand in `root` has no slope over the box. */
bool graph_local_bound(Graph *graph, Node root, Box box, double least, LocalBound *bound,
                       Arena *scratch);

/* Returns the r <= radius within which |root| cannot become 0, or a little less. */
Node local_radius(Graph *graph, Node root, const LocalBound *bound);

#endif
