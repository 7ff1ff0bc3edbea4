/*
 * verifier.h: what one thread needs for proofs.
 */
#ifndef KRS_MESH_VERIFIER_H
#define KRS_MESH_VERIFIER_H

#include "compiler/field/bvh.h"
#include "mesh/contour/contour.h"
#include "mesh/proof/around.h"

typedef struct Verifier {
    MeshField  *field;
    const Tets *tets;
    const Bvh  *mesh;
    double      error;
    /* Edges, in errors, of the smallest tetrahedra that are bisected rather than unresolved; 0:
       none is. */
    double   sharp;
    Tet     *tet;
    Sure     sure; /* where in it bounds prove that the surface is near */
    double   center[3];
    double   budget;        /* cells that the proof may still try */
    uint32_t last;          /* the triangle that was last found to be near */
    uint32_t unresolved;    /* points of the tetrahedron where nothing is decided, */
    double   location[3];   /* and one of them; else its centre */
    uint32_t asked_in_vain; /* cells whose pieces did not tell on which side they are */
} Verifier;

#endif
