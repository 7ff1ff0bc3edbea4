/*
 * rendering.h: what a scene on a device is given for a frame, and what is sent to the device.
 */
#ifndef KRS_RENDERING_H
#define KRS_RENDERING_H

#include "runtime/tracer/handles.h"

/* Copies the frame's parameters and zones to the device, and chooses the kernels for them, and for
   the scene's own cameras. */
bool rendering_set_parameters(KrsRendering *rendering, const KrsFrame *frame);
/* After it: chooses the kernels for rays of another kind.  Those of a scene with a panorama do for
   all of its cameras. */
bool rendering_set_rays(KrsRendering *rendering, RayKind kind);
/* Likewise: points are relative to this origin from now on; chooses the kernels for that. */
bool rendering_rebase(KrsRendering *rendering, KrsFrame *frame, const double rebase_origin[3]);
/* Copies the lights of a frame to the device, relative to an origin, and makes room for `rays`
   behind them. */
bool rendering_set_lights(KrsRendering *rendering, const KrsLight *lights, size_t count,
                          const double rebase_origin[3], size_t rays);
/* Where the rays behind so many lights are. */
ListedRayBlock *rendering_listed_rays(KrsRendering *rendering, size_t lights);
/* A step through [0, count) that visits all and goes far each time, so that neighbours, which cost
   alike, are spread over a device that assigns contiguous ranges. */
uint32_t rendering_spread(const KrsRendering *rendering, uint32_t count);
/* Points a binding of set 1 at a buffer. */
void rendering_bind(KrsRendering *rendering, VkDescriptorSet set, uint32_t binding,
                    const Buffer *buffer);
/* As gpu_begin and gpu_finish: with what the control block says, and then counts. */
bool rendering_begin(KrsRendering *rendering);
bool rendering_finish(KrsRendering *rendering, double *ms);
/* The control block that kernels use. */
const Buffer *rendering_control(const KrsRendering *rendering);
/* Records that a kernel runs with these push constants on `groups` workgroups. */
void rendering_dispatch(KrsRendering *rendering, const Kernel *kernel, VkDescriptorSet set,
                        const void *work, uint32_t work_bytes, uint32_t groups);
/* The same on as many as the control block says (`groups`). */
void rendering_dispatch_counted(KrsRendering *rendering, const Kernel *kernel, VkDescriptorSet set,
                                const void *work, uint32_t work_bytes);
/* The most workgroups of a dispatch on any device. */
enum { MOST_GROUPS = 65535 };

#endif
