/*
 * verify.h: proofs that mesh and surface are near to each other.
 */
#ifndef KRS_MESH_VERIFY_H
#define KRS_MESH_VERIFY_H

#include "compiler/mesh/bvh.h"
#include "compiler/mesh/contour.h"

/* What a proof needs; for one thread. */
typedef struct Verifier {
    const MeshField *field;
    const Tets      *tets;
    const Bvh       *mesh;
    double           error;
    double           budget;     /* cells that the proof may still look at */
    uint32_t         unresolved; /* places of the tetrahedron where it has not been decided */
} Verifier;

/* Whether, within a tetrahedron, each point of the surface is within the error of the mesh, and each
   point of its triangles within the error of the surface. */
TetState verify_tet(Verifier *verifier, const Tet *tet);
/* Whether a distance proves that there is no surface in it. */
bool verify_is_empty(const Verifier *verifier, const Tet *tet);

#endif
