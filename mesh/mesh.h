/*
 * mesh.h: meshes of solids.
 */
#ifndef KRS_MESH_MESH_H
#define KRS_MESH_MESH_H

#include "compiler/field/solid.h"

/* Makes a mesh as krs_mesh does, of any solid; ignores the component of the options. */
KrsStatus mesh_solid(KrsState *state, const KrsMeshOptions *options, const MeshSolid *solid,
                     KrsMesh **mesh);

#endif
