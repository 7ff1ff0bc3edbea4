/*
 * scattered.h: points at which texts of a scene are compared with the evaluator.
 */
#ifndef SUPPORT_SCATTERED_H
#define SUPPORT_SCATTERED_H

#include "krs/krs.h"
#include "tests/support/random.h"

/* Points in the boxes of components, one after the other, and around them; the fourth number is 0. */
void scatter(const KrsScene *scene, Random *random, float (*points)[4], size_t count);
/* Moves the first of them to where a surface is a hundredth away at most, if they can be moved there by their normals. */
void bring_near(KrsState *state, Random *random, float (*points)[4], size_t count);

#endif
