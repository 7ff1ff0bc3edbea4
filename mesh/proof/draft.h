/*
 * draft.h: finds which tetrahedra fit, as far as some points tell.
 */
#ifndef KRS_MESH_DRAFT_H
#define KRS_MESH_DRAFT_H

#include "mesh/proof/mesher.h"

/* Finds the states of a group by points alone: they are right where features are larger than some
   errors, but not proven. */
void draft_group(Mesher *m, Verifier *verifier, const Group *group);

#endif
