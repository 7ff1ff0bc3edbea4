/*
 * flat.h: meshes solids between planes, with as few triangles as their faces need.
 */
#ifndef KRS_MESH_FLAT_H
#define KRS_MESH_FLAT_H

#include "mesh/flat/flat_edges.h"
#include "mesh/proof/mesher.h"

/* Meshes the solid; returns false if something in it is not flat, or too fine. */
bool find_flat_mesh(Mesher *m, FlatVertices *vertices, Triangles *triangles);

#endif
