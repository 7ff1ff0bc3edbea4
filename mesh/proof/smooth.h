/*
 * smooth.h: proves tetrahedra where derivatives do not jump, by bounds of second derivatives.
 *
 * Between points with known values a function is as far from linear as its second derivatives
 * permit.  So in a tetrahedron no point that the mesh has inside is farther outside than
 * `deviation` (the value there is not above it), and none that it has outside farther inside.  Let
 * the value grow by at least `slope` along some direction n. From a point of the surface both ways
 * along n, by s = deviation / slope, there are points that are outside and inside of the mesh: so
 * it is crossed within s. From a point of the mesh likewise one meets the surface.  Nothing is
 * sampled, and no triangles or cells are searched.
 */
#ifndef KRS_MESH_SMOOTH_H
#define KRS_MESH_SMOOTH_H

#include "compiler/field/gradient.h"
#include "mesh/proof/verifier.h"

/* The bounds in a box: d^T (second derivatives) d is at most d^T above d, and at least -d^T below
   d, for all d; and along some direction the value grows by `slope` at least.  After smooth_narrow
   forms are those of the box without its margin, and the slope is that of paths no longer than the
   error, from points there whose value is no larger. */
typedef struct SmoothCell {
    Box      box;
    bool     known, empty;
    double   above[6], below[6], slope;
    uint32_t origin; /* of the value: field.h */
    Growth   growth;
} SmoothCell;

/* Finds the forms of second derivatives. */
void smooth_forms(const LaneHessian *hessian, double above[6], double below[6]);
/* Returns the form between two points, which may be below 0. */
double smooth_form(const double form[6], const double a[3], const double b[3]);
/* Returns what a form permits between two points, not below 0. */
double smooth_bend(const double form[6], const double a[3], const double b[3]);
/* Returns the largest w0 w1 a + w1 w2 b + w2 w0 c for weights w >= 0 whose sum is 1. */
double smooth_max_of_three(double a, double b, double c);
/* Bounds the value of what the mesh in a tetrahedron has inside (or, times -1, outside), where the
   mesh has values of no more than `most` (no less than -most): what is beyond sees a corner of the
   other side along a path on which no mesh can be.  Returns INFINITY where no corner is so deep. */
double smooth_level(const SmoothCell *cell, const double (*corners)[3], const double values[4],
                    bool inside, double most);

/* Bounds derivatives in a box; differences are over small parts of `error`. */
void smooth_bound(const MeshField *field, Box box, double error, SmoothCell *cell);

enum { SMOOTH_HALVINGS = 3 };
/* Narrows the bounds of a known cell, which is wider than what is measured by the error, by those
   of its parts. */
void smooth_narrow(const MeshField *field, double error, SmoothCell *cell);
/* Returns how much the gradient may change in the box. */
double smooth_gradient_change(const SmoothCell *cell);
/* Finds what holds in the middle: no bounds, but the best that bounds may become. */
bool smooth_bound_at_middle(const MeshField *field, const SmoothCell *cell, SmoothCell *middle);

/* Finds `deviation` and `slope` of a tetrahedron within the cell; returns whether it has no
   surface. */
bool smooth_measure(const Contour *contour, const SmoothCell *cell, Tet *tet);

#endif
