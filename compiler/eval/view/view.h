/*
 * view.h: what a scene has beside its shapes, for the files of this folder.
 */
#ifndef KRS_EVAL_VIEW_H
#define KRS_EVAL_VIEW_H

#include "compiler/eval/elaborate.h"

/* ---- camera.c ---- */
/* Adds a camera to the scene. */
void elaborate_camera(Elaboration *e, const Environment *env, const Syntax *syntax);
/* A camera with the properties of a block, the others as camera.def says. */
SceneCamera read_camera(Elaboration *e, const Environment *env, const Syntax *syntax);

/* ---- sky.c ---- */
void elaborate_sky(Elaboration *e, const Environment *env, const Syntax *syntax);
/* Finds the light that is the sun of daylight, once all lights are known. */
void complete_sky(Elaboration *e);

#endif
