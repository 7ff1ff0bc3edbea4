/*
 * sphere_fold.h: mirrors that are spheres: points, distances and normals through them.
 */
#ifndef KRS_SPHERE_FOLD_H
#define KRS_SPHERE_FOLD_H

#include "compiler/lower/normal.h"

/* A mirror that is a sphere, as a point meets it. */
typedef struct SphereFold {
    Node point;   /* the image of the point where it is inside, else the point */
    Node inverse; /* 1 / distance of the point from the centre */
    Node least;   /* distance of `point` from the centre, where it was inside; else the radius */
    Node sigma;   /* the factor by which lengths grow at the point */
    Node core;    /* distance to the image of a ball around all that is mirrored; NODE_NONE: that
                     is endless */
} SphereFold;

/* Makes the fold; `ball` contains what is mirrored. */
SphereFold sphere_fold_at(Graph *g, const SequenceStage *stage, Node point, Ball ball);
/* Converts a distance at `point` into one outside of the mirror. */
Lowered sphere_fold_out(Lowering *l, const SphereFold *fold, Lowered result);
/* Tells whether a point is inside of the sphere. */
Node sphere_front(Graph *g, const SequenceStage *stage, Node point);
/* Adds the mirror to the path of the normal. */
void normal_sphere(Lowering *l, NormalPath *path, const SequenceStage *stage, Node point,
                   const SphereFold *fold);

#endif
