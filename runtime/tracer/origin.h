/*
 * origin.h: the origin that points on the device are relative to.
 */
#ifndef KRS_ORIGIN_H
#define KRS_ORIGIN_H

#include "runtime/tracer/handles.h"

/* The viewer of a frame: a camera, for which rays of a list may stand (view_of_rays), and the size
   of its picture. */
typedef struct Viewer {
    const KrsCamera *camera;
    const KrsRays   *rays; /* NULL: they are those of the camera */
    uint32_t         width, height;
} Viewer;

/* Sets the origin: a point near the eye, where rounding to single precision would be visible; else 0. */
void origin_choose(const KrsRendering *rendering, KrsState *state, const Viewer *viewer,
                   double origin[3]);

#endif
