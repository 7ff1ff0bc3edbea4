/*
 * slope.h: how fast expressions change, and distances that follow from that.
 */
#ifndef KRS_SLOPE_H
#define KRS_SLOPE_H

#include "compiler/shape/builder.h"

typedef struct Steepness {
    double bound;  /* of all states; with a slot, of the first: time 0, defaults */
    Node   slot;   /* the slope in the state; NODE_NONE: the bound is a constant */
    Box    region; /* over which; infinite: all space */
    Blame  blame;  /* what changes fastest */
} Steepness;
/* Finds the slope over the first of these regions where that of an expression has a bound; false:
   it has none.  `span` is its place. */
bool find_slope(ShapeBuilder *builder, Node formula, const Box *regions, int count, Span span,
                Steepness *found);
/* Returns the slope of an expression over all space and in all states; infinite: it has no bound. */
double slope_everywhere(ShapeBuilder *builder, Node formula);
/* Says in a diagnostic why an operation has no bound on its slope, and what to write instead. */
void explain_steep(ShapeBuilder *builder, Diag *diag, Blame blame);
Node steepness_node(Graph *graph, const Steepness *slope);
/* Makes what grows so fast safe. */
Node divide_by_steepness(Graph *graph, Node distance, const Steepness *slope);

/* Makes what grows `slope` times as fast as distance safe. */
Node divide_by_slope(Graph *graph, Node distance, double slope);

/* The slot has a number of single precision that is no less than the slope; infinite: there is no
   bound. */
double state_slope_upward(double slope);
/* Returns the number of cells into which the region is cut at most. */
uint32_t state_slope_cells(Box region);

#endif
