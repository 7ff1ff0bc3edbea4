/*
 * view.h: what a scene has beside its shapes, for the files of this folder.
 */
#ifndef KRS_EVAL_VIEW_H
#define KRS_EVAL_VIEW_H

#include "compiler/eval/elaborate.h"

/* ---- rows.c: the kinds that rows of camera.def and lights.def share ---- */
/* A block whose properties are read.  `otherwise` is the value of one that is not given, or of another
   type, which is reported. */
typedef struct Asked {
    Elaboration       *e;
    const Environment *env;
    const Syntax      *block;
    const CameraNodes *camera; /* the rows of a camera that have been read; or NULL */
} Asked;
Node ask_number(const Asked *a, const char *name, const double otherwise[4]);
Node ask_place(const Asked *a, const char *name, const double otherwise[4]);
Node ask_axis(const Asked *a, const char *name, const double otherwise[4]);
Node ask_pair(const Asked *a, const char *name, const double otherwise[4]);

/* ---- light.c ---- */
/* Adds a light to the scene. */
void elaborate_light(Elaboration *e, const Environment *env, const Syntax *syntax);
/* Reads a light with the properties of a block, the others as lights.def says. */
SceneLight read_light(Elaboration *e, const Environment *env, const Syntax *syntax);

/* ---- camera.c ---- */
/* Adds a camera to the scene. */
void elaborate_camera(Elaboration *e, const Environment *env, const Syntax *syntax);
/* Reads a camera with the properties of a block, the others as camera.def says. */
SceneCamera read_camera(Elaboration *e, const Environment *env, const Syntax *syntax);

/* ---- medium.c ---- */
/* Adds a medium to the scene. */
void elaborate_medium(Elaboration *e, const Environment *env, const Syntax *syntax);

/* ---- sky.c ---- */
void elaborate_sky(Elaboration *e, const Environment *env, const Syntax *syntax);
/* Finds the light that is the sun of daylight, once all lights are known. */
void complete_sky(Elaboration *e);

#endif
