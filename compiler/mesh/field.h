/*
 * field.h: what the mesher knows of a scene: a number at a point.
 *
 * Its sign says what is solid (negative inside), and its size is never above the distance to the
 * nearest surface.  Nothing else here asks the scene, so a faster evaluator has its place in field.c.
 */
#ifndef KRS_MESH_FIELD_H
#define KRS_MESH_FIELD_H

#include "compiler/krs.h"

typedef struct MeshField {
    KrsFrame *frame;
    size_t    component; /* from 1; 0: all */
    bool      cut;       /* nothing is solid outside of the box */
    double    low[3], high[3];
} MeshField;

double field_distance(const MeshField *field, const double point[3]);
/* The unit gradient, by differences over `step`; false and 0 where there is none. */
bool field_normal(const MeshField *field, const double point[3], double step, double normal[3]);

#endif
