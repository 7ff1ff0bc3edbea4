/*
 * transform.h: affine maps of imported files, as methods of the language.
 */
#ifndef KRS_IMPORT_TRANSFORM_H
#define KRS_IMPORT_TRANSFORM_H

#include "import/common/text.h"

/* The point q goes to rows q + shift. */
typedef struct Transform {
    double rows[3][3];
    double shift[3];
} Transform;

Transform transform_identity(void);
Transform transform_move(const double by[3]);
Transform transform_scale(const double by[3]);
/* Rotates about x (0), y (1) or z (2), by radians, from each axis to the next one. */
Transform transform_rotate(int axis, double angle);
/* Returns a transform that is first `first`, then `then`. */
Transform transform_chain(const Transform *first, const Transform *then);
/* Returns the same map seen in a mirror that changes the sign of z. */
Transform transform_mirrored(const Transform *transform);
/* Inverts a transform; false: it flattens space. */
bool transform_invert(Transform *transform);
void transform_apply(const Transform *transform, const double q[3], double to[3]);
/* Returns the factor by which all lengths grow; 0 where it differs by direction. */
double transform_factor(const Transform *transform);
/* Tells whether figures in x and y stay there; makes it the plain map of space that
 * does the same. */
bool transform_flatten(Transform *transform);

/* Adds `.scale(...).rotate(...).move(...)`, as much of it as is needed; false
   when the transform flattens space to a plane, or is larger or smaller than
   numbers allow. */
bool transform_write(Text *text, const Transform *transform);

#endif
