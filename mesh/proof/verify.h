/*
 * verify.h: proves that mesh and surface are near to each other.
 */
#ifndef KRS_MESH_VERIFY_H
#define KRS_MESH_VERIFY_H

#include "mesh/proof/verifier.h"

/* Finds whether, within a tetrahedron, each point of the surface is within the error of the mesh,
   and each point of its triangles within the error of the surface. */
TetState verify_tet(Verifier *verifier, Tet *tet);
/* Tell whether the distance at a corner proves that a tetrahedron has no surface; or at a corner or
   the centre. */
bool verify_is_far(const Tets *tets, const Tet *tet);
bool verify_is_empty(const Verifier *verifier, const Tet *tet);

#endif
