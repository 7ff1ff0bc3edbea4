/*
 * flat_touches.h: finds vertices that coincide, and vertices on the inside of edges.
 *
 * Where four planes meet in a point, edges may touch there that have no end in common: the ridges
 * of two roofs of one height that cross, or two bodies that touch.
 */
#ifndef KRS_MESH_FLAT_TOUCHES_H
#define KRS_MESH_FLAT_TOUCHES_H

#include "mesh/flat/polygons.h"

/* A vertex on an edge. */
typedef struct FlatTouch {
    uint32_t edge, vertex;
} FlatTouch;

typedef struct FlatTouches {
    FlatTouch *items;
    size_t     count, capacity;
} FlatTouches;

/* Finds for each vertex one that is no farther than `near` and comes before it, or itself. */
void flat_join_vertices(const FlatVertices *vertices, double near, uint32_t *first, Arena *arena);

/* Appends the vertices that are no farther than `near` from an edge and farther from both its ends.
   Of vertices that coincide the first counts. */
void flat_find_touches(const FlatVertices *vertices, const uint32_t (*ends)[2], size_t count,
                       const uint32_t *first, double near, FlatTouches *touches, Arena *arena);

#endif
