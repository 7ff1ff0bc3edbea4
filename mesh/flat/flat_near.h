/*
 * flat_near.h: proves that planes that approximate what is round are within an error of it.
 */
#ifndef KRS_MESH_FLAT_NEAR_H
#define KRS_MESH_FLAT_NEAR_H

#include "mesh/flat/flat_proof.h"
#include "mesh/proof/mesher.h"

/* Boxes in which planes approximate what is round. */
typedef struct FlatBoxes {
    Box   *items;
    size_t count, capacity;
} FlatBoxes;

typedef enum FlatVerdict {
    FLAT_PROVEN, /* but for the mesher's `unresolved`, where the solid is about as thin as the error */
    FLAT_REFUTED, /* more sides are needed; `rounds` have been blamed */
    FLAT_IN_VAIN, /* more sides would be of no use */
    FLAT_STOPPED  /* it was stopped, or there are too many seams, which have no proofs */
} FlatVerdict;

/* Proves what is in the boxes, and leaves those in which more sides are needed. */
FlatVerdict flat_near(Mesher *m, FlatRounds *rounds, FlatBoxes *boxes, double error);

#endif
