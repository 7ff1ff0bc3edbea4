/*
 * flat_proof.h: whether planes that stand for what is round are within an error of it.
 *
 * In a box the solid is made of half-spaces by intersections and unions, and each number that one stands for is between
 * bounds that are its slack apart.  Let all grow by at least that along a way e n.  Then at p + e n none is less than any of its bounds at
 * p, and at p - e n none is more.  So where p is on the surface p + e n is outside of the planes' solid or on it, and p - e n
 * inside: its faces meet that way.  The same holds for faces and the surface.  What has the same sign all along need not grow.
 */
#ifndef KRS_MESH_FLAT_PROOF_H
#define KRS_MESH_FLAT_PROOF_H

#include "compiler/mesh/flat_pieces.h"

typedef enum FlatNearness {
    FLAT_NEAR,   /* faces and surface are within the error of each other */
    FLAT_ROUGH,  /* they may not be: with planes that are nearer to what they stand for they are */
    FLAT_THIN,   /* there is no direction along which all grow, not even where planes are exact */
    FLAT_UNKNOWN /* there are too many planes */
} FlatNearness;

/* In a box; `pieces` are those of a box that is larger by the error on all sides. */
FlatNearness flat_nearness(const FlatPieces *pieces, const Box *box, double error);

/* The axis along which half-spaces change most. */
int flat_widest_axis(const FlatPieces *pieces, const Box *box);

#endif
