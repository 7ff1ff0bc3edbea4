/*
 * crossing.h: tells whether triangles are a closed surface that does not cross itself.
 */
#ifndef KRS_MESH_CROSSING_H
#define KRS_MESH_CROSSING_H

#include "compiler/field/bvh.h"

/* A directed edge, from the upper half of `ends` to the lower, and its triangle. */
typedef struct TriangleEdge {
    uint64_t ends;
    uint32_t triangle;
} TriangleEdge;

/* All edges, in order of their ends. */
typedef struct TriangleEdges {
    TriangleEdge *items;
    size_t        count;
    uint32_t     *begins; /* of each vertex, the first edge from it; and one more */
    size_t        vertex_count;
} TriangleEdges;

TriangleEdges sort_edges(const uint32_t (*triangles)[3], size_t count, Arena *arena);
/* Returns an edge of that direction, or NULL. */
const TriangleEdge *find_edge(const TriangleEdges *edges, uint32_t from, uint32_t to);

typedef void ReportTriangle(void *user, uint32_t triangle);

/* Reports triangles with an edge that is not in two triangles with opposite directions. */
void report_open(const TriangleEdges *edges, ReportTriangle *report, void *user);
/* Tells whether the triangles around a vertex are one ring, or there are none. */
bool is_one_ring(const TriangleEdges *edges, const uint32_t (*triangles)[3], uint32_t vertex);
/* Tells whether a triangle may meet another one beyond their common corners and edges.  They may
   overlap by `depth`: above 0 triangles that only touch do not cross. */
bool triangle_crosses(const Bvh *bvh, uint32_t triangle, double depth);

#endif
