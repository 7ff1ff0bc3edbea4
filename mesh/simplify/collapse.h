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
    /* The triangles near to vertices without one, or UINT32_MAX.  What replaces it must be within
       the error of them, and takes its place here. */
    uint32_t *below;
    double    error;
    /* Bounds of how far triangles are from that mesh, and of how far what they replace is from
       them; afterwards of those that are left. */
    double         *off, *missed;
    IsGoodTriangle *is_good; /* NULL: only what these bounds prove is good */
    IsWanted       *is_wanted;
    void           *user;
    size_t          enough; /* it ends when no more triangles are left */
    const bool     *border; /* of vertices: they have further triangles, and stay; NULL: none has */
} CollapseRules;

/* Collapses edges, those first that change least, where all triangles that this makes are good and
   the mesh stays closed.  Returns how many triangles are left. */
size_t collapse_edges(const double (*vertices)[3], size_t vertex_count, uint32_t (*triangles)[3],
                      size_t count, const CollapseRules *rules, Arena *arena);

#endif
