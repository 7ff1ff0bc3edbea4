/*
 * lens.h: finds thin parts of space that have the surface in them.
 */
#ifndef KRS_MESH_LENS_H
#define KRS_MESH_LENS_H

#include "compiler/field/gradient.h"
#include "mesh/proof/verifier.h"

/* The margin that proofs leave for rounding. */
#define ROUNDING (1 + 1e-9)

/* A disc.  Within its radius of the axis, and as far from its plane as the balls reach, all above
   `above` is outside, and all below -`below` inside. */
typedef struct Lens {
    double center[3], normal[3], radius, above, below;
} Lens;

/* Finds heights by balls above and below a disc; returns whether they are below the error. */
bool find_lens_by_balls(const Verifier *verifier, Lens *lens);
/* Finds a disc of the lens's radius around a centre, where the distance is `distance`, and its
   heights, which need not be below the error. */
void find_lens_by_slope(const Gradient *gradient, const double center[3], double distance,
                        Lens *lens);
/* Tells whether the mesh within the error of the lens covers all of its disc: the mesh is closed,
   its triangles there face to one side, and one meets the axis. */
bool mesh_fills_lens(const Verifier *verifier, const Lens *lens);
/* Returns how far from the centre of the lens that needs triangles. */
double lens_reach(const Verifier *verifier, const Lens *lens);
/* Tells whether all corners are above the lens, or all below. */
bool is_beside_lens(const Lens *lens, const double corners[4][3]);

#endif
