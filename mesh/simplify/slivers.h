/*
 * slivers.h: triangles without area.
 */
#ifndef KRS_MESH_SLIVERS_H
#define KRS_MESH_SLIVERS_H

#include "mesh/common/crossing.h"

/* Where three corners are in a line, their triangle and the one beyond its longest edge become two others with the
   same corners, so that both have area.  What the triangles cover does not change. */
void flip_slivers(const double (*vertices)[3], uint32_t (*triangles)[3], size_t count,
                  Arena *arena);

#endif
