/*
 * borders.h: triangles of one material each.
 */
#ifndef KRS_MESH_BORDERS_H
#define KRS_MESH_BORDERS_H

#include "krs/krs.h"

/*
 * Splits the triangles of a mesh, in place, along the borders between materials that change in
 * steps (steps.h).  Then each has the material of its middle everywhere, but for one and a half
 * errors beside its edges; the surface stays the same.  Triangles are sampled at about two errors,
 * or at a 500th of the size of the mesh if that is more.  `copy` is the transform of a copy of the
 * mesh in the scene, or NULL. Of the options it asks for error, memory_limit, progress and user.
 * On failure the mesh is as it was.
 */
KrsStatus mesh_split_at_borders(KrsState *state, const KrsMeshOptions *options,
                                const double (*copy)[4], KrsMesh      *mesh);

#endif
