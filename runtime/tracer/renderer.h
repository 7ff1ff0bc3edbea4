/*
 * renderer.h: a device, with the kernels that need no scene.
 */
#ifndef KRS_RENDERER_H
#define KRS_RENDERER_H

#include "runtime/tracer/handles.h"

/* Makes the kernels without a scene for rays of a kind, unless they are there; adds the time that
   it took. */
bool renderer_create_pixels(KrsRenderer *renderer, RayKind kind, double *spirv_ms,
                            double *pipeline_ms);
/* Forgets the message of the call before. */
void renderer_clear(KrsRenderer *renderer);

#endif
