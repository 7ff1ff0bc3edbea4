/*
 * plane.h: evaluates the distance in a plane.
 */
#ifndef KRS_SLICE_PLANE_H
#define KRS_SLICE_PLANE_H

#include "compiler/field/field.h"

/* A plane; its points are origin + x right + y up. */
typedef struct SlicePlane {
    double origin[3], right[3], up[3];
} SlicePlane;

SlicePlane slice_plane(const KrsSectionPlane *plane);

static inline void slice_point(const SlicePlane *plane, const double at[2], double point[3])
{
    for (int k = 0; k < 3; k++)
        point[k] = plane->origin[k] + at[0] * plane->right[k] + at[1] * plane->up[k];
}

/* Returns the box around a square in a plane, wider by a margin. */
Box slice_box(const SlicePlane *plane, const double low[2], const double high[2], double margin);

/* Evaluates up to MAX_FIELD_POINTS points. */
void slice_distances(const MeshField *field, const SlicePlane *plane, const double (*points)[2],
                     size_t count, double *distances);

/* A search for where the sign changes between a point inside and one outside. */
typedef struct PlaneRoot {
    double inside[2], outside[2], at_inside, at_outside;
    double at[2]; /* what is found */
} PlaneRoot;

/* Makes up to MAX_FIELD_POINTS searches, to an accuracy of `enough`. */
void slice_roots(const MeshField *field, const SlicePlane *plane, PlaneRoot *roots, size_t count,
                 double enough);

/* Finds the gradients in the plane at two points, by differences over `step`. */
void slice_gradients(const MeshField *field, const SlicePlane *plane, const double (*points)[2],
                     double step, double (*gradients)[2]);

#endif
