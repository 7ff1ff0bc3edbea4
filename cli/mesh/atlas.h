/*
 * atlas.h: a square picture in which each triangle has a place of its own.
 */
#ifndef KRS_MESH_ATLAS_H
#define KRS_MESH_ATLAS_H

#include "cli/mesh/bridge.h"
#include "compiler/base/arena.h"

/* Places count in pixels from the left upper corner, to the right and down; pixel 0 is from 0 to 1. */
typedef struct Atlas {
    uint32_t side;
    double   pixel;          /* how long one is in the scene, where the fineness is 1 */
    double (*corners)[3][2]; /* of the triangles that are in it */
    uint32_t *owner; /* of pixels, row by row: the nearest triangle; ATLAS_NONE: none is near */
    size_t    charts;
} Atlas;

#define ATLAS_NONE UINT32_MAX

/* A triangle has `fineness` times as many pixels along a length; none if that is 0.  False: there are too many triangles
   that do not lie beside others. */
bool atlas_make(Arena *arena, const MeshParts *parts, const float *fineness, uint32_t side,
                Atlas *atlas);

/* Returns the distance of a point from a triangle, and weights of its corners in the nearest point
   of it. */
double atlas_nearest(const double corners[3][2], const double point[2], double weights[3]);

#endif
