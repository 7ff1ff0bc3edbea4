/*
 * renderer.h: a device, with the kernels that need no scene.
 */
#ifndef KRS_RENDERER_H
#define KRS_RENDERER_H

#include "runtime/tracer/handles.h"

/* Lists the kernels of previews without a scene for a rendering, PIXEL_KERNELS at most, that do not
   exist.  Returns how many. */
size_t renderer_request_pixels(const KrsRendering *rendering, KernelRequest *requests);
/* Likewise the kernels of escape.comp for a kind of primary rays, and for paths; 2 at most. */
size_t renderer_request_escapes(KrsRenderer *renderer, RayKind kind, KernelRequest *requests);
/* Makes these kernels of previews.  Adds the time that this takes to that of the rendering. */
bool renderer_create_pixels(KrsRendering *rendering);
/* Likewise those of escape.comp. */
bool renderer_create_escapes(KrsRenderer *renderer, RayKind kind, double *spirv_ms,
                             double *pipeline_ms);
/* The kernel of escape.comp for rays of paths, which renderer_create_escapes has made; where paths may
   meet a plate it is made here.  NULL with the failure noted. */
const Kernel *renderer_escape_of_paths(KrsRendering *rendering);
/* The kernel for pixels without a hit. */
PixelKernel renderer_background(const KrsRendering *rendering);
/* The kernel that ends rays at given depths, for rays of a kind; NULL with the failure noted. */
const Kernel *renderer_limit(KrsRenderer *renderer, RayKind kind, double *spirv_ms,
                             double *pipeline_ms);
/* The kernel of normals of a plate; NULL with the failure noted. */
const Kernel *renderer_plate(KrsRenderer *renderer, double *spirv_ms, double *pipeline_ms);
/* The kernel that ends samples of pixels whose error is small; NULL with the failure noted. */
const Kernel *renderer_noise(KrsRenderer *renderer, double *spirv_ms, double *pipeline_ms);
/* Clears the status and the message of the last failure. */
void renderer_clear(KrsRenderer *renderer);

#endif
