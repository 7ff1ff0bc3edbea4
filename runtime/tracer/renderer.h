/*
 * renderer.h: a device, with the shaders that need no scene.
 */
#ifndef KRS_RENDERER_H
#define KRS_RENDERER_H

#include "runtime/tracer/handles.h"

/* Makes a renderer as krs_renderer_new does, with bits of emulation (gpu.h). */
KrsStatus renderer_new_emulating(const KrsRendererOptions *options, unsigned emulation,
                                 KrsRenderer **out);

/* Visits all shaders without a scene, whether they have been made or not. */
void renderer_visit(KrsRenderer *renderer, void (*visit)(void *user, Shader *shader), void *user);

/* Lists the shaders of previews without a scene for a rendering, PIXEL_SHADERS at most, that do not
   exist.  Returns how many. */
size_t renderer_request_pixels(const KrsRendering *rendering, ShaderRequest *requests);
/* Lists likewise the shaders of escape.comp for a kind of primary rays, and for paths; 2 at
   most. */
size_t renderer_request_escapes(KrsRenderer *renderer, RayKind kind, ShaderRequest *requests);
/* Makes these shaders of previews.  Adds the time that this takes to that of the rendering. */
bool renderer_create_pixels(KrsRendering *rendering);
/* Makes those of escape.comp likewise. */
bool renderer_create_escapes(KrsRenderer *renderer, RayKind kind, double *spirv_ms,
                             double *pipeline_ms);
/* Returns the shader of escape.comp for rays of paths, which renderer_create_escapes has made;
   where paths may meet a plate it is made here.  NULL with the failure noted. */
const Shader *renderer_escape_of_paths(KrsRendering *rendering);
/* Returns the shader for pixels without a hit. */
PixelShader renderer_background(const KrsRendering *rendering);
/* Lists likewise the shaders before and behind rays of hits that lanes of the host march; 2 at most. */
size_t renderer_request_lane_rays(KrsRendering *rendering, ShaderRequest *requests);
/* These return the shaders before and behind rays of hits that lanes of the host march. */
const Shader *renderer_aim(KrsRendering *rendering);
const Shader *renderer_arrive(KrsRendering *rendering);
/* Returns the shader that ends rays at given depths, for rays of a kind; NULL with the failure
   noted. */
const Shader *renderer_limit(KrsRenderer *renderer, RayKind kind, double *spirv_ms,
                             double *pipeline_ms);
/* Returns the shader of normals of a plate; NULL with the failure noted. */
const Shader *renderer_plate(KrsRenderer *renderer, double *spirv_ms, double *pipeline_ms);
/* Returns the shader that ends samples of pixels whose error is small; NULL with the failure
   noted. */
const Shader *renderer_noise(KrsRenderer *renderer, double *spirv_ms, double *pipeline_ms);
/* Clears the status and the message of the last failure. */
void renderer_clear(KrsRenderer *renderer);
/* Makes what all scenes need; false with the failure noted. */
bool renderer_prepare(KrsRenderer *renderer);
/* Destroys that; nothing of it runs any more. */
void renderer_release(KrsRenderer *renderer);
/* A device that is lost so often, while nothing is gained, is given up. */
enum { MAX_LOSSES = 3 };
/* Returns the halvings of slices after losses; there is an end to them. */
uint32_t renderer_halvings(const KrsRenderer *renderer);

#endif
