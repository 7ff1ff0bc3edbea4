/*
 * collapse.h: simplifies a closed mesh by collapsing one edge after the other.
 */
#ifndef KRS_MESH_COLLAPSE_H
#define KRS_MESH_COLLAPSE_H

#include "compiler/base/arena.h"

#include <stdint.h>

/* Tells whether a new triangle is within the error of the mesh that is simplified; `*distance`
   bounds how far it is. */
typedef bool IsGoodTriangle(void *user, const uint32_t triangle[3], double *distance);
/* Reports about which part of the work is done; returns false to stop. */
typedef bool IsWanted(void *user, double part);

typedef struct CollapseRules {
    const bool *kept; /* of triangles: corners stay */
    /* Of vertices without triangles: a triangle that they are near to, or UINT32_MAX. What replaces
       it must be within the error of them. */
    const uint32_t *below;
    double          error;
    double          distance; /* between that mesh and the triangles at first */
    IsGoodTriangle *is_good;
    IsWanted       *is_wanted;
    void           *user;
} CollapseRules;

/* Collapses edges, those first that change least, where all triangles that this makes are good and
   the mesh stays closed.  Returns how many triangles are left. */
size_t collapse_edges(const double (*vertices)[3], size_t vertex_count, uint32_t (*triangles)[3],
                      size_t count, const CollapseRules *rules, Arena *arena);

#endif
