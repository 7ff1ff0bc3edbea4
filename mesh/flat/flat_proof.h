/*
 * flat_proof.h: whether planes that stand for what is round are within an error of it.
 *
 * In a box the solid is made of half-spaces by intersections and unions.  The number that tells the side of each stands for
 * another one, which is less or more by its slack at most.  Let n be a way, no longer than the error e, along which each number
 * grows by at least its slack.  Let p be a place on the surface.  At p + n each number is at least what it stands for at p, and
 * at p - n at most that.  So one of these places is outside of the planes' solid, and the other inside of it: a face is
 * between them, within e of p.  In the same way the surface is within e of each face.  A number that has
 * the same sign all along the way may grow less.
 *
 * Often there is no such way, as where three solids meet in a short edge.  Then not all numbers need to grow.  The solid's
 * complement is a union of sets: p is in all complements of one set, and a way is enough along which these
 * numbers grow.  Each set has a way of its own, and so have the sets of half-spaces whose union the solid is.  The two places
 * are in the ball around p, so the line between them is, too.  This alone would not tell two edges that cross at a small distance
 * from two that touch.  So what makes a difference in the box, and not only beside it, must have one way all the same.
 */
#ifndef KRS_MESH_FLAT_PROOF_H
#define KRS_MESH_FLAT_PROOF_H

#include "mesh/flat/flat_pieces.h"

typedef enum FlatNearness {
    FLAT_NEAR,     /* faces and surface are within the error of each other */
    FLAT_HARD,     /* they are, by more than one way */
    FLAT_UNPROVEN, /* they may not be: with planes that are nearer to what they stand for they are */
    FLAT_THIN,     /* there is no such way, not even where planes are exact */
    FLAT_SEAM,   /* nor may there be: which of two surfaces there is depends on what is not exact */
    FLAT_UNKNOWN /* there are too many planes */
} FlatNearness;

/* In a box, by ways as long as `error` at most; `pieces` are those of the box that is larger by that on all sides. */
FlatNearness flat_nearness(const FlatPieces *pieces, const Box *box, double error);

/* The axis along which half-spaces change most. */
int flat_widest_axis(const FlatPieces *pieces, const Box *box);

#endif
