/*
 * prewarm.h: makes kernels, and runs each once before it is needed.
 */
#ifndef KRS_PREWARM_H
#define KRS_PREWARM_H

#include "runtime/tracer/handles.h"

/* Makes at most KERNELS_AT_ONCE kernels, and has the driver run each once in the background.  The
   scene's set may be VK_NULL_HANDLE. */
enum { KERNELS_AT_ONCE = 16 + 2 * KRS_MOST_MARCH_GROUPS };
bool kernels_make(KrsRenderer *renderer, VkDescriptorSet scene_set, const KernelRequest *asked,
                  size_t count, double *spirv_ms, double *pipeline_ms);

#endif
