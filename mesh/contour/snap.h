/*
 * snap.h: moves a vertex of a face or a tetrahedron to the surface.
 */
#ifndef KRS_MESH_SNAP_H
#define KRS_MESH_SNAP_H

#include "compiler/field/field.h"

/* A vertex of a face or a tetrahedron, within which it may go to the surface. */
typedef struct Snapping {
    const double (*corners)[3];
    int           count;  /* of the corners */
    const double *across; /* unit normal of the face, or NULL */
    const double *middle; /* of the crossings, */
    double        missed; /* and the value there */
    double        error;  /* of the mesh */
} Snapping;

/* Searches from a guess, if there is one, and then from the middle; returns false if the value is
   nowhere much less. */
bool snap_nearby(const MeshField *field, const Snapping *snapping, bool guess, double at[3],
                 double *value);

/* Returns the largest absolute value in the middles between a vertex and others. */
double max_off(const MeshField *field, const double at[3], const double *const *others,
               size_t count);

#endif
