/*
 * search_targets.h: where an operation branches, jumps or is steepest, and the way there.
 */
#ifndef KRS_SEARCH_TARGETS_H
#define KRS_SEARCH_TARGETS_H

#include "compiler/refute/search_types.h"

/* Adds what is worth looking at in one operation. */
void   add_targets(Search *s, Arena *arena, const Graph *g, const Expr *e);
double target_at(Search *s, const Target *t, double p[3]);
/* Returns the gradient of a target by differences, and its length; `at` is its value at p. */
double target_slope(Search *s, const Target *t, const double p[3], double at, double gradient[3]);
/* Goes from p to where a target is 0, by Newton's steps, and between two steps by halving. */
void drive_to_zero(Search *s, const Target *t, double p[3], double axis[3]);
/* Goes uphill from p, by steps that grow where they help. */
void drive_up(Search *s, const Target *t, double p[3], double axis[3]);

#endif
