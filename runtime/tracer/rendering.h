/*
 * rendering.h: what a scene on a device needs for a state, and the commands that run its shaders.
 */
#ifndef KRS_RENDERING_H
#define KRS_RENDERING_H

#include "runtime/tracer/handles.h"

/* Begins a call of the caller: clears the last failure, and opens a lost device anew, with all that it had; slices and bands are
   half as large then, and films keep what the host has of them.  False with the failure noted. */
bool rendering_ready(KrsRenderer *renderer);
/* Copies the state's parameters and zones to the device.  Chooses the shaders for these zones, and
   for the scene's own cameras. */
bool rendering_set_parameters(KrsRendering *rendering, const KrsState *state,
                              const double *rebase_origin);
/* Chooses the shaders for rays of another kind; call it after rendering_set_parameters.  Shaders of
   a scene with a panorama or a lens serve all of its cameras. */
bool rendering_set_rays(KrsRendering *rendering, RayKind kind);
/* Makes points relative to this origin, and chooses the shaders for that; call it after
   rendering_set_parameters. */
bool rendering_rebase(KrsRendering *rendering, KrsState *state, const double rebase_origin[3]);
/* Copies the lights of a state to the device, relative to an origin, and makes room for `rays`
   listed rays behind them.  `light` is as in KrsRenderOptions: others are black. */
bool rendering_set_lights(KrsRendering *rendering, const KrsLight *lights, size_t count,
                          uint32_t light, const double rebase_origin[3], size_t rays);
/* Copies balls around what emits light; call it after rendering_set_lights. */
void rendering_set_emissive(KrsRendering *rendering, const EmissiveBlock *balls, size_t count);
/* Returns the listed rays, which lie behind `lights` lights. */
ListedRayBlock *rendering_listed_rays(KrsRendering *rendering, size_t lights);
/* Returns a stride that visits all numbers in [0, count), far apart each time.  Neighbouring
   workgroups cost the same, so a stride spreads the cost over a device that assigns contiguous
   ranges to its cores. */
uint32_t rendering_spread(const KrsRendering *rendering, uint32_t count);
/* Points a binding of set 1 at a buffer. */
void rendering_bind(KrsRendering *rendering, Handle set, uint32_t binding, const Buffer *buffer);
/* Points the bindings of the frame and of the control block at those of the rendering. */
void rendering_bind_frame(KrsRendering *rendering, Handle set);
/* These do what gpu_begin and gpu_finish do, and copy the control block to the shaders, and the
   counters back. */
bool rendering_begin(KrsRendering *rendering);
bool rendering_finish(KrsRendering *rendering, double *ms);
/* Returns the control block that shaders use. */
const Buffer *rendering_control(const KrsRendering *rendering);
/* Records that a shader runs with this block of work on `groups` workgroups. */
void rendering_dispatch(KrsRendering *rendering, const Shader *shader, Handle set, const void *work,
                        uint32_t work_bytes, uint32_t groups);
/* Does the same, on as many workgroups as the control block has in `groups` by then. */
void rendering_dispatch_counted(KrsRendering *rendering, const Shader *shader, Handle set,
                                const void *work, uint32_t work_bytes);
/* The most workgroups of a dispatch on any device. */
enum { MAX_GROUPS = 65535 };

#endif
