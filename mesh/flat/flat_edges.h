/*
 * flat_edges.h: makes whole faces of the segments of edges in all boxes (flat_faces.h).
 */
#ifndef KRS_MESH_FLAT_EDGES_H
#define KRS_MESH_FLAT_EDGES_H

#include "mesh/flat/flat_faces.h"

/* Joins segments to edges, and fills faces with triangles; returns false if they are no closed
   surface. */
bool flat_faces_finish(FlatFaces *faces, FlatVertices *vertices, Triangles *triangles);

#endif
