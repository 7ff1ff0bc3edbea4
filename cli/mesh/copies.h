/*
 * copies.h: the copies of parts, one behind the other.
 */
#ifndef KRS_MESH_COPIES_H
#define KRS_MESH_COPIES_H

#include "cli/mesh/bridge.h"

/* A part, placed. */
typedef struct MeshCopy {
    const MeshPart *part;
    const double (*matrix)[4]; /* NULL: it is where it is */
    bool mirrored;             /* its triangles face inwards unless their order is reversed */
} MeshCopy;

/* Calls `visit` for each copy of a body until it returns false; then that is returned. */
typedef bool VisitMeshCopy(void *user, const MeshCopy *copy);
bool         mesh_body_visit(const MeshParts *parts, size_t body, VisitMeshCopy *visit, void *user);

/* Computes a vertex of a copy, by its number in the part. */
void mesh_copy_vertex(const MeshParts *parts, const MeshCopy *copy, size_t number, double at[3]);
/* Finds a triangle of a copy, by its number in the part, of vertices that are numbered from `base`;
   it faces outwards. */
void mesh_copy_triangle(const MeshParts *parts, const MeshCopy *copy, size_t number, size_t base,
                        uint32_t triangle[3]);
/* Finds the colors of its corners, in the same order; there are such. */
void mesh_copy_colors(const MeshParts *parts, const MeshCopy *copy, size_t number,
                      unsigned char colors[3][3]);
/* Finds their places in a texture, in the same order; there is one. */
void mesh_copy_places(const MeshParts *parts, const MeshCopy *copy, size_t number,
                      double places[3][2]);
/* Finds their frames, likewise. */
void mesh_copy_frames(const MeshParts *parts, const MeshCopy *copy, size_t number,
                      MeshFrame frames[3]);

#endif
