/*
 * prewarm.h: makes shaders, and runs each once before it is needed.
 */
#ifndef KRS_PREWARM_H
#define KRS_PREWARM_H

#include "runtime/tracer/handles.h"

/* Makes at most SHADERS_AT_ONCE shaders, and has the driver run each once in the background.  The
   scene's set may be 0. */
enum { SHADERS_AT_ONCE = 16 + 2 * KRS_MAX_MARCH_GROUPS };
bool shaders_make(KrsRenderer *renderer, Handle scene_set, const ShaderRequest *asked, size_t count,
                  double *spirv_ms, double *pipeline_ms);

#endif
