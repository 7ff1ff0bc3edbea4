/*
 * flat_proof.h: whether planes that stand for what is round are within an error of it.
 *
 * In a box the solid is made of half-spaces by intersections and unions.  The number that tells the side of each stands for
 * another one, which is less or more by its slack at most.  Let n be a direction along which each number grows by at least
 * its slack within the error e.  Let p be a place on the surface.  At p + e n each number is at least what it stands for at p, and
 * at p - e n at most that.  So one of these places is outside of the planes' solid, and the other inside of it: a face is
 * between them, within e of p.  In the same way the surface is within e of each face.  A number that has
 * the same sign all along the way need not grow.
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

/* In a box, by ways as long as `error` at most; `pieces` are those of the box that is larger by that on all sides. */
FlatNearness flat_nearness(const FlatPieces *pieces, const Box *box, double error);

/* The axis along which half-spaces change most. */
int flat_widest_axis(const FlatPieces *pieces, const Box *box);

#endif
