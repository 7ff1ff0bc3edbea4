/*
 * local_terms.h: what is known of a number in the ball around the point (local.c).
 */
#ifndef KRS_LOCAL_TERMS_H
#define KRS_LOCAL_TERMS_H

#include "compiler/graph/bounds/facts.h"

/* A number in the ball. */
typedef struct BallTerm {
    Node value, gradient, first, second;
    Node steep; /* slope in the ball, where more is known than the others say, or NODE_NONE */
} BallTerm;

typedef struct BallContext {
    Graph *graph;
    Arena *scratch;
    Box    box;
    Node   radius; /* NODE_NONE: gradients only, and slopes without what needs a radius */
    Node   limit;  /* the radius ends there as well */
    bool   bounded;
} BallContext;

/* Keeps quotients finite; what is smaller has no digits left in single precision. */
static const double TINY = 1e-30, SMALL = 1e-6;

bool has_radius(const BallContext *x);
/* Returns the slope at the point. */
Node slope_here(const BallContext *x, const BallTerm *a);
/* Returns the slope in the ball. */
Node steepness(const BallContext *x, const BallTerm *a);

/* Makes the term of a number that is the same all over the ball. */
BallTerm constant_term(const BallContext *x, Node value);
/* Makes the term of a value of which nothing is known but its slope over the box. */
BallTerm opaque_term(BallContext *x, Node value);
BallTerm add_terms(const BallContext *x, Node value, BallTerm a, BallTerm b);
BallTerm negate_term(const BallContext *x, Node value, BallTerm a);
/* Returns `factor` times the term, for a rule that adds the rest. */
BallTerm scale_term(const BallContext *x, Node value, BallTerm a, Node factor);
BallTerm multiply_terms(const BallContext *x, Node value, BallTerm a, BallTerm b);

#endif
