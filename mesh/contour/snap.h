/*
 * snap.h: where a vertex of a face or a tetrahedron is on the surface.
 */
#ifndef KRS_MESH_SNAP_H
#define KRS_MESH_SNAP_H

#include "compiler/field/field.h"

/* A vertex of a face or a tetrahedron, which may go to the surface within it. */
typedef struct Snapping {
    const double (*corners)[3];
    int           count;  /* of the corners */
    const double *across; /* unit normal of the face, or NULL */
    const double *middle; /* of the crossings, */
    double        missed; /* and the value there */
    double        error;  /* of the mesh */
} Snapping;

/* From a guess, if there is one, else or if that leads nowhere from the middle.  False: no place was found where the
   value is much less. */
bool snap_nearby(const MeshField *field, const Snapping *snapping, bool guess, double at[3],
                 double *value);

/* The largest value, without its sign, in the middles between a vertex and others. */
double max_off(const MeshField *field, const double at[3], const double *const *others,
               size_t count);

#endif
