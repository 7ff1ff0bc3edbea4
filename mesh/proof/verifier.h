/*
 * verifier.h: what a proof needs.
 */
#ifndef KRS_MESH_VERIFIER_H
#define KRS_MESH_VERIFIER_H

#include "compiler/field/bvh.h"
#include "mesh/contour/contour.h"
#include "mesh/proof/around.h"

/* For one thread. */
typedef struct Verifier {
    MeshField  *field;
    const Tets *tets;
    const Bvh  *mesh;
    double      error;
    double
        sharp; /* edges, in errors, of the smallest that are bisected where it is not decided; 0: none is */
    Tet     *tet;
    Sure     sure; /* where in it the surface is near without cells */
    double   center[3];
    double   budget;        /* cells that the proof may still look at */
    uint32_t last;          /* the triangle that was found to be near to a place */
    uint32_t unresolved;    /* places of the tetrahedron where it has not been decided, */
    double   place[3];      /* and one of them; else its centre */
    uint32_t asked_in_vain; /* cells of it whose pieces did not tell on which side they are */
} Verifier;

#endif
