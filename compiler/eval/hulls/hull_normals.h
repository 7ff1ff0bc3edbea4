/*
 * hull_normals.h: which ways the faces of a convex hull look.
 */
#ifndef KRS_HULL_NORMALS_H
#define KRS_HULL_NORMALS_H

#include <stddef.h>

#include "compiler/base/arena.h"

typedef struct HullNormals {
    Arena   *arena;
    double **items; /* unit vectors of three numbers */
    size_t   count, capacity;
} HullNormals;

/* Adds those of the hull of points, three numbers each; none where they lie in a plane. */
void hull_normals(const double *points, size_t count, HullNormals *normals);

#endif
