/*
 * rounds.h: refines a coarse mesh where it is refuted, until it is proven.
 */
#ifndef KRS_MESH_ROUNDS_H
#define KRS_MESH_ROUNDS_H

#include "mesh/proof/mesher.h"

/* Finds the mesh within the box of the mesher, whose fields are open; returns false if stopped. */
bool find_proven_mesh(Mesher *m);

#endif
