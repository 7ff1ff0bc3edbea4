/*
 * mesh.h: meshes of solids.
 */
#ifndef KRS_MESH_MESH_H
#define KRS_MESH_MESH_H

#include "compiler/field/solid.h"

/* As krs_mesh, which it is behind; the component of the options does not count. */
KrsStatus mesh_solid(KrsState *state, const KrsMeshOptions *options, const MeshSolid *solid,
                     KrsMesh **mesh);

#endif
