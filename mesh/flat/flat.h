/*
 * flat.h: meshes of solids between planes: their faces, as few triangles as they have.
 */
#ifndef KRS_MESH_FLAT_H
#define KRS_MESH_FLAT_H

#include "mesh/flat/flat_edges.h"
#include "mesh/proof/mesher.h"

/* False: something in it is not flat, or is too fine; nothing is known. */
bool find_flat_mesh(Mesher *m, FlatVertices *vertices, Triangles *triangles);

#endif
