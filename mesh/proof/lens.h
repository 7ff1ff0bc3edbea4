/*
 * lens.h: thin parts of space that have the surface in them.
 */
#ifndef KRS_MESH_LENS_H
#define KRS_MESH_LENS_H

#include "compiler/field/gradient.h"
#include "mesh/proof/verifier.h"

/* For what rounding may take from a proof. */
#define ROUNDING (1 + 1e-9)

/* A disc of some radius; within that of its axis, and as far from its plane as the balls reach, all is
   outside above `above` and inside below -`below`. */
typedef struct Lens {
    double center[3], normal[3], radius, above, below;
} Lens;

/* Finds heights by balls above and below a disc; false: they are not below the error. */
bool find_lens_by_balls(const Verifier *verifier, Lens *lens);
/* In a part of space with this centre, where the distance is `distance`: a disc of its radius, and heights, which
   need not be below the error. */
void find_lens_by_slope(const Gradient *gradient, const double center[3], double distance,
                        Lens *lens);
/* Tells whether the mesh goes through the lens: then it is a graph over all of its disc, since it is closed
   and its triangles all face to one side.  So it is as near as it is at any point. */
bool mesh_fills_lens(const Verifier *verifier, const Lens *lens);
/* How far from its centre that asks for triangles. */
double lens_reach(const Verifier *verifier, const Lens *lens);
/* Tells whether all corners are above the lens, or all below. */
bool is_beside_lens(const Lens *lens, const double corners[4][3]);

#endif
