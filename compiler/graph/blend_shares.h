/*
 * blend_shares.h: smooth minima of several numbers that share the result (blends.def, math.md section 4).
 */
#ifndef KRS_BLEND_SHARES_H
#define KRS_BLEND_SHARES_H

#include "compiler/graph/graph.h"

/* The operands that may have shares: the nearest ones. */
enum { MAX_SHARERS = 8 };

/* The result of a blend, and the threshold below which operands have a share. */
typedef struct BlendShares {
    double result, threshold;
} BlendShares;

/* Finds the shares of up to MAX_SHARERS distances, at least one, in any order, over a width.  A width of 0 or
   less leaves the least. */
typedef BlendShares FindShares(const double *distances, uint32_t count, double width);
FindShares          shares_quadratic, shares_cubic;

/* The properties of an operation that is such a minimum of vectors: the same of two numbers, of one
   vector and of two, and how its shares are found.  Other operations have zeros. */
typedef struct SharingOp {
    Op          of_two, of_four, of_eight;
    FindShares *find;
} SharingOp;
SharingOp sharing_op(Op op);

#endif
