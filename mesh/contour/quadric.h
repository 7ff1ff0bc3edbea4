/*
 * quadric.h: finds the point that planes have in common.
 */
#ifndef KRS_MESH_QUADRIC_H
#define KRS_MESH_QUADRIC_H

#include <stddef.h>

/* Finds the point with the least sum of squared distances to planes through `points`; where planes
   leave it free, the one next to the middle of the points (Garland and Heckbert's quadrics, solved
   as in "Dual contouring of Hermite data", Ju et al. 2002). */
void quadric_point(const double (*points)[3], const double (*normals)[3], size_t count,
                   double point[3]);

#endif
