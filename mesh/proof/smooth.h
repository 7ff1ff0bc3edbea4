/*
 * smooth.h: proofs where derivatives do not jump, by bounds of second derivatives.
 *
 * Between points with known values a function is as far from linear as its second derivatives permit.  So in a
 * tetrahedron no point that the mesh has inside is farther outside than `deviation` (the value there is not above
 * it), and none that it has outside farther inside.  Let the value grow by at least `slope` along some direction n.
 * From a point of the surface both ways along n, by s = deviation / slope, there are points that are outside
 * and inside of the mesh: so it is crossed within s.  From a point of the mesh likewise one meets the
 * surface.  Nothing is sampled, and neither triangles nor cells are searched.
 */
#ifndef KRS_MESH_SMOOTH_H
#define KRS_MESH_SMOOTH_H

#include "compiler/field/gradient.h"
#include "mesh/proof/verifier.h"

/* What is known of a box: d^T (second derivatives) d is at most d^T above d, and at least -d^T below d, for all d; and along
   some direction the value grows by `slope` at least.  After a closer look forms are those of the box without its margin, and
   the slope is that of ways no longer than the error, from points there whose value is no larger. */
typedef struct SmoothCell {
    Box      box;
    bool     known, empty;
    double   above[6], below[6], slope;
    uint32_t origin; /* of the value: field.h */
} SmoothCell;

/* The forms of second derivatives. */
void smooth_forms(const LaneHessian *hessian, double above[6], double below[6]);
/* How much a form permits between two points, not below 0. */
double smooth_bend(const double form[6], const double a[3], const double b[3]);
/* The most that w0 w1 a + w1 w2 b + w2 w0 c is, for weights w >= 0 whose sum is 1. */
double smooth_most_of_three(double a, double b, double c);
/* Where the mesh in a tetrahedron has values of no more than `most` (or no less than -most): the largest value of what it has
   inside (or the least of what it has outside, times -1), for what is beyond that sees a corner of the other side along a way
   on which no mesh can be.  INFINITY: no corner is so deep. */
double smooth_level(const SmoothCell *cell, const double (*corners)[3], const double values[4],
                    bool inside, double most);

/* `error`: differences are over small parts of it. */
void smooth_look(const MeshField *field, Box box, double error, SmoothCell *cell);

enum { SMOOTH_HALVINGS = 3 };
/* Narrower bounds of one that is known, which has the error around what is measured, from parts of it. */
void smooth_look_closer(const MeshField *field, double error, SmoothCell *cell);
/* How much the gradient may turn in the box, for all that is known. */
double smooth_turn(const SmoothCell *cell);
/* What is true in the middle: no bound, but what bounds may become at best. */
bool smooth_look_at_middle(const MeshField *field, const SmoothCell *cell, SmoothCell *middle);

/* Finds `deviation` and `slope` of a tetrahedron within the cell; true: it has no surface. */
bool smooth_measure(const Contour *contour, const SmoothCell *cell, Tet *tet);

#endif
