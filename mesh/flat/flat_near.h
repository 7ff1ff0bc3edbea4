/*
 * flat_near.h: proves that planes that stand for what is round are within an error of it.
 */
#ifndef KRS_MESH_FLAT_NEAR_H
#define KRS_MESH_FLAT_NEAR_H

#include "mesh/flat/flat_proof.h"
#include "mesh/proof/mesher.h"

/* In an array: boxes in which planes stand for what is round. */
typedef struct FlatBoxes {
    Box   *items;
    size_t count, capacity;
} FlatBoxes;

typedef enum FlatVerdict {
    FLAT_PROVEN, /* but for where the solid is about as thin as the error: the mesher's `unresolved` */
    FLAT_REFUTED, /* more sides are needed; `rounds` have been blamed */
    FLAT_IN_VAIN, /* more sides would be of no use */
    FLAT_STOPPED  /* it was not wanted any more, or there are seams that have no proofs */
} FlatVerdict;

/* Leaves those boxes in which more sides are needed. */
FlatVerdict flat_near(Mesher *m, FlatRounds *rounds, FlatBoxes *boxes, double error);

#endif
