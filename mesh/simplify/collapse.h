/*
 * collapse.h: fewer triangles of a closed mesh, by leaving out one vertex after the other.
 */
#ifndef KRS_MESH_COLLAPSE_H
#define KRS_MESH_COLLAPSE_H

#include "compiler/base/arena.h"

#include <stdint.h>

/* Whether a new triangle is within the error of the mesh that is simplified, and how far it is from it, at most. */
typedef bool IsGoodTriangle(void *user, const uint32_t triangle[3], double *distance);
/* Told now and then which part of the work is done, as far as one can say; false: stop. */
typedef bool IsWanted(void *user, double part);

typedef struct CollapseRules {
    const bool *kept; /* of triangles: those whose corners stay */
    const uint32_t *
        below; /* of vertices that are no corners: a triangle to which they are near; UINT32_MAX: none is
                              known.  What replaces it must be within the error of them. */
    double          error;
    double          distance; /* between that mesh and the triangles before */
    IsGoodTriangle *is_good;
    IsWanted       *is_wanted;
    void           *user;
} CollapseRules;

/* Moves vertices to one at the other end of an edge, the one that changes least first, where all triangles that
   this makes are good and the mesh stays closed.  Returns how many triangles are left. */
size_t collapse_edges(const double (*vertices)[3], size_t vertex_count, uint32_t (*triangles)[3],
                      size_t count, const CollapseRules *rules, Arena *arena);

#endif
