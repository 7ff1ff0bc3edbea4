/*
 * slivers.h: removes triangles without area.
 */
#ifndef KRS_MESH_SLIVERS_H
#define KRS_MESH_SLIVERS_H

#include "mesh/common/crossing.h"

/* Flips the longest edges of triangles with collinear corners, so that both triangles at the edge
   have area; what they cover does not change. */
void flip_slivers(const double (*vertices)[3], uint32_t (*triangles)[3], size_t count,
                  Arena *arena);

#endif
