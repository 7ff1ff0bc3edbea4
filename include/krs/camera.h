/*
 * camera.h: moves a camera as a mouse and keys do.
 *
 * Directions are those of the picture.  Lengths are in parts of the picture's height, at the distance
 * of the target, so that what is under the mouse stays under it.
 */
#ifndef KRS_CAMERA_H
#define KRS_CAMERA_H

#include "krs/krs.h"

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

/* Orbits the target: to the right and upwards, in radians.  The picture stays upright; it does
   not turn over the poles. */
void krs_camera_orbit(KrsCamera *camera, double right, double up);
/* Turns around the eye, to look elsewhere. */
void krs_camera_look(KrsCamera *camera, double right, double up);
/* Moves eye and target, so that the picture moves to the right and upwards. */
void krs_camera_pan(KrsCamera *camera, double right, double up);
/* Goes to or away from a point, which stays where it is in the picture; the distance from it is
   multiplied by `factor`.  NULL: the target. */
void krs_camera_dolly(KrsCamera *camera, const double *point, double factor);
/* Flies, in parts of the distance to the target. */
void krs_camera_fly(KrsCamera *camera, double forward, double right, double up);
/* Turns around the line of sight. */
void krs_camera_roll(KrsCamera *camera, double angle);
/* Shows a box whole, from where it is seen; `aspect` is the picture's width / height. */
void krs_camera_fit(KrsCamera *camera, const double low[3], const double high[3], double aspect);
/* Looks along an axis without perspective: `from` is where the eye is, such as [0, 0, 1]. */
void krs_camera_axis(KrsCamera *camera, const double from[3]);
/* Changes between perspective and an orthographic view that shows the target as large. */
void krs_camera_toggle_perspective(KrsCamera *camera);
/* Looks at a point from where the eye is, with the point as the new center of orbits. */
void krs_camera_aim(KrsCamera *camera, const double point[3]);

/* Finds the unit direction of sight, and those of the picture's right and top. */
void krs_camera_axes(const KrsCamera *camera, double forward[3], double right[3], double up[3]);
/* Finds the box around a component at the values of a state; false: it has no end, or is empty. */
bool krs_state_component_box(KrsState *state, size_t component, double low[3], double high[3]);
/* Finds the box around all components that have an end; false: there is none. */
bool krs_state_box(KrsState *state, double low[3], double high[3]);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
