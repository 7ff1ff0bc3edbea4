/*
 * draft.h: which tetrahedra fit, as far as some points tell.
 */
#ifndef KRS_MESH_DRAFT_H
#define KRS_MESH_DRAFT_H

#include "compiler/mesh/mesher.h"

/* TET_EMPTY, TET_FITS, or TET_REFUTED where the surface is farther than `off` from its triangles, or in it and there are none. */
TetState draft_state(const Mesher *m, const MeshField *field, const Tet *tet, double off);
/* Finds the states of a group that is new, by points alone: they are right where features are larger than some errors, and
   nothing proves it. */
void draft_group(Mesher *m, Verifier *verifier, const Group *group);

#endif
