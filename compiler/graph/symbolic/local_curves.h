/*
 * local_curves.h: smooth functions f of one number u in the ball around the point (local.c).
 */
#ifndef KRS_LOCAL_CURVES_H
#define KRS_LOCAL_CURVES_H

#include "compiler/graph/symbolic/local_terms.h"

/* f'(u) and M, the largest |f''| in the ball. */
typedef struct Curve {
    Node slope, bend;
} Curve;

/* Finds a curve from u, f(u) and how far u may go in the ball; without a radius there is no
   `bend`. */
typedef Curve CurveOf(BallContext *x, BallTerm u, Node value, Node reach);

CurveOf curve_square, curve_sin, curve_cos, curve_atan, curve_tanh, curve_exp, curve_exp2,
    curve_sinh, curve_cosh, curve_log, curve_sqrt, curve_inversesqrt;
/* 1 / u */
CurveOf curve_inverse;

/* Returns the term of `value`, which is f(u). */
BallTerm curved_term(BallContext *x, CurveOf *curve_of, Node value, BallTerm u);
/* Returns the same for a curve that is known. */
BallTerm bend_term(const BallContext *x, Node value, BallTerm u, Curve curve);
/* Makes the term of |u|^n for a constant n >= 2. */
BallTerm even_power_term(BallContext *x, Node value, BallTerm u, double n);
/* Makes the term of u^n for another constant n, u >= 0. */
BallTerm power_term(BallContext *x, Node value, BallTerm u, double n);

#endif
