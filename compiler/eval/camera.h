/*
 * camera.h: cameras of a scene.
 */
#ifndef KRS_EVAL_CAMERA_H
#define KRS_EVAL_CAMERA_H

#include "compiler/eval/elaborate.h"

/* Adds a camera to the scene. */
void elaborate_camera(Elaboration *e, const Environment *env, const Syntax *syntax);
/* Sets what is about lens and shutter: neither is there. */
void camera_without_lens(Elaboration *e, SceneCamera *camera);

#endif
