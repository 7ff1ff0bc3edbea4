/*
 * near.h: proves that triangles are within an error of a mesh.
 */
#ifndef KRS_MESH_NEAR_H
#define KRS_MESH_NEAR_H

#include "mesh/common/crossing.h"

#define NO_TRIANGLE UINT32_MAX

/* A mesh, prepared for questions of what is near to it. */
typedef struct NearMesh {
    Bvh           bvh;
    TriangleEdges edges;
    /* The other triangle at each edge of a triangle; NO_TRIANGLE: none, or several. */
    uint32_t (*beyond)[3];
    double size; /* the largest coordinate */
} NearMesh;

void near_mesh_new(NearMesh *mesh, const double (*vertices)[3], const uint32_t (*triangles)[3],
                   size_t count, Arena *arena);

enum { MAX_FACED = 4096, FACED_SLOTS = 2 * MAX_FACED };

/* The working memory of one thread. */
typedef struct NearQuery {
    uint32_t last;     /* a triangle that may be near */
    double   distance; /* bound of how far the last triangle that was near is from the mesh */
    uint32_t faced[MAX_FACED];
    size_t   faced_count;
    uint32_t slots[FACED_SLOTS]; /* `faced` by hash: number + 1 */
} NearQuery;

/* Tells whether a triangle is within the error of one of a mesh. */
bool is_near_triangle(const NearMesh *mesh, uint32_t triangle, const double corners[3][3],
                      double error);
/* Tells whether all points of a triangle are proven to be within the error of a mesh.  `starts` are
   triangles of the mesh that it may face; the query then has those that it faces. */
bool is_near_mesh(const NearMesh *mesh, const double corners[3][3], double error,
                  const uint32_t *starts, size_t start_count, NearQuery *query);

#endif
