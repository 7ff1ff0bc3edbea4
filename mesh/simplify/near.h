/*
 * near.h: whether triangles are within an error of a mesh.
 */
#ifndef KRS_MESH_NEAR_H
#define KRS_MESH_NEAR_H

#include "mesh/common/crossing.h"

#define NO_TRIANGLE UINT32_MAX

/* A mesh that triangles may be near to. */
typedef struct NearMesh {
    Bvh           bvh;
    TriangleEdges edges;
    uint32_t (*beyond)
        [3]; /* of each edge of a triangle, the other with that edge; NO_TRIANGLE: none, or several */
    double size; /* the largest coordinate */
} NearMesh;

void near_mesh_new(NearMesh *mesh, const double (*vertices)[3], const uint32_t (*triangles)[3],
                   size_t count, Arena *arena);

enum { MAX_FACED = 4096, FACED_SLOTS = 2 * MAX_FACED };

/* What one thread looks with. */
typedef struct NearLook {
    uint32_t last;     /* a triangle that may be near */
    double   distance; /* how far the last triangle that was near is from the mesh, at most */
    uint32_t faced[MAX_FACED];
    size_t   faced_count;
    uint32_t slots[FACED_SLOTS]; /* `faced` by hash: number + 1 */
} NearLook;

/* Tells whether a triangle is within the error of one of a mesh. */
bool is_near_triangle(const NearMesh *mesh, uint32_t triangle, const double corners[3][3],
                      double error);
/* Tells whether all points of a triangle are within the error of a mesh.  `starts`: triangles of the mesh that it
   may face.  Says also which those are that it was found to face. */
bool is_near_mesh(const NearMesh *mesh, const double corners[3][3], double error,
                  const uint32_t *starts, size_t start_count, NearLook *look);

#endif
