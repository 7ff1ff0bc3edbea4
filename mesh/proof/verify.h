/*
 * verify.h: proofs that mesh and surface are near to each other.
 */
#ifndef KRS_MESH_VERIFY_H
#define KRS_MESH_VERIFY_H

#include "mesh/proof/verifier.h"

/* Whether, within a tetrahedron, each point of the surface is within the error of the mesh, and each
   point of its triangles within the error of the surface. */
TetState verify_tet(Verifier *verifier, Tet *tet);
/* Tells whether the distance of a corner proves that there is no surface in it; or that, or the one of its centre. */
bool verify_is_far(const Tets *tets, const Tet *tet);
bool verify_is_empty(const Verifier *verifier, const Tet *tet);

#endif
