/*
 * steps.h: materials that change in steps only.
 */
#ifndef KRS_FIELD_STEPS_H
#define KRS_FIELD_STEPS_H

#include "compiler/scene/program.h"

/* Tells whether around almost every point all properties of the materials stay the same: those of parts in one
   paint each, and patterns of such.  `wanted`: components by their index among the lowered, or NULL for all. */
bool materials_step(const KrsScene *scene, const bool *wanted);

/* Tells whether some material may depend on the normal of the surface. */
bool materials_have_normals(const KrsScene *scene);

#endif
