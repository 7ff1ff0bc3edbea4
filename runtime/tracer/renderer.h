/*
 * renderer.h: a device, with the kernels that need no scene.
 */
#ifndef KRS_RENDERER_H
#define KRS_RENDERER_H

#include "runtime/tracer/handles.h"

/* Makes the kernels without a scene for rays of a kind, unless they exist.  Adds the time that this
   takes. */
bool renderer_create_pixels(KrsRenderer *renderer, RayKind kind, double *spirv_ms,
                            double *pipeline_ms);
/* Likewise the kernels of escape.comp for a kind of primary rays, and for paths. */
bool renderer_create_escapes(KrsRenderer *renderer, RayKind kind, double *spirv_ms,
                             double *pipeline_ms);
/* The kernel that ends rays at given depths, for rays of a kind; NULL with the failure noted. */
const Kernel *renderer_limit(KrsRenderer *renderer, RayKind kind, double *spirv_ms,
                             double *pipeline_ms);
/* The kernel that ends samples of pixels whose error is small; NULL with the failure noted. */
const Kernel *renderer_noise(KrsRenderer *renderer, double *spirv_ms, double *pipeline_ms);
/* Clears the status and the message of the last failure. */
void renderer_clear(KrsRenderer *renderer);

#endif
