/*
 * flat_proof.h: tells whether planes that approximate what is round are within an error of it.
 *
 * In a box the solid is made of half-spaces by intersections and unions.  The number that tells the
 * side of each approximates another one, which is less or more by its slack at most.  Let the shift
 * n be a vector, no longer than the error e, along which each number grows by at least its slack.
 * Let p be a point of the surface.  Each number is at least the exact one of p at the point p + n,
 * and at most that at p - n. So one of these points is outside of the planes' solid, and the other
 * inside of it: a face is between them, within e of p. In the same way the surface is within e of
 * each face.  A number that has the same sign all along the shift may grow less.
 *
 * Often there is no such shift, as where three solids meet in a short edge.  Then not all numbers
 * need to grow.  The solid's complement is a union of sets: p is in all complements of one set, and
 * a shift is enough along which these numbers grow.  Each set has a shift of its own, and so have
 * the sets of half-spaces whose union the solid is.  The two points are in the ball around p, so
 * the line between them is, too.  This alone would not distinguish two edges that cross at a small
 * distance from two that touch.  So what makes a difference in the box, and not only beside it,
 * must still have one shift.
 */
#ifndef KRS_MESH_FLAT_PROOF_H
#define KRS_MESH_FLAT_PROOF_H

#include "mesh/flat/flat_pieces.h"

typedef enum FlatNearness {
    FLAT_NEAR,     /* faces and surface are within the error of each other */
    FLAT_HARD,     /* they are, by more than one shift */
    FLAT_UNPROVEN, /* they may not be; they are with finer planes */
    FLAT_THIN,     /* there is no such shift, not even with exact planes */
    FLAT_SEAM,   /* nor can there be: a condition that is not exact chooses between two surfaces */
    FLAT_UNKNOWN /* there are too many planes */
} FlatNearness;

/* Proves what is in a box by shifts that are no longer than `error`; `pieces` are those of the box
   that is larger by that on all sides. */
FlatNearness flat_nearness(const FlatPieces *pieces, const Box *box, double error);

/* Returns by how much the number of any half-space may be off. */
double flat_largest_slack(const FlatPieces *pieces);

/* Returns the axis along which half-spaces change most. */
int flat_widest_axis(const FlatPieces *pieces, const Box *box);

#endif
