/*
 * weights.h: barycentric coordinates in triangles and tetrahedra.
 */
#ifndef KRS_MESH_WEIGHTS_H
#define KRS_MESH_WEIGHTS_H

#include <stdbool.h>

/* Moves a point towards `center` until none of its barycentric coordinates, `weights`, is less than
   a small part; `inner` are those of `center`, which is inside. */
void keep_inside(const double *weights, const double *inner, int count, double point[3],
                 const double center[3]);

/* Finds barycentric coordinates; the point is in the plane of the face with this normal. */
void face_weights(const double corners[3][3], const double normal[3], const double point[3],
                  double weights[3]);
void tet_weights(const double corners[4][3], const double point[3], double weights[4]);

/* Solves for the point whose dot products with three rows are given; returns false if the rows are
   in a plane. */
bool solve3(const double rows[3][3], const double right[3], double point[3]);

#endif
