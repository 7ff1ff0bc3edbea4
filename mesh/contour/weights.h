/*
 * weights.h: points of triangles and tetrahedra as means of the corners.
 */
#ifndef KRS_MESH_WEIGHTS_H
#define KRS_MESH_WEIGHTS_H

#include <stdbool.h>

/* Moves a point of a convex body towards `center`, which is inside of it, until none of its `weights` of the corners is less
   than a small part.  `inner` are those of `center`. */
void keep_inside(const double *weights, const double *inner, int count, double point[3],
                 const double center[3]);

/* Areas of the parts of a triangle around a point of its plane, over all of it. */
void face_weights(const double corners[3][3], const double normal[3], const double point[3],
                  double weights[3]);
void tet_weights(const double corners[4][3], const double point[3], double weights[4]);

/* Solves for the point with these products with three vectors; false: they are in a plane. */
bool solve3(const double rows[3][3], const double right[3], double point[3]);

#endif
