/*
 * prewarm_thread.h: shaders that run once before they are needed, and those that all pictures need, which
 * are made while the host still does other work.
 */
#ifndef KRS_PREWARM_THREAD_H
#define KRS_PREWARM_THREAD_H

#include "runtime/tracer/handles.h"

/* Has the driver run a shader that exists once, in the background. */
bool shader_prewarm(KrsRenderer *renderer, Handle scene_set, Shader *shader);

/* Makes at most MAX_PREWARMED shaders without a scene, one after the other by a thread of its own.  It
   does nothing where that would not help: on graphics cards, and on one core. */
enum { MAX_PREWARMED = PIXEL_SHADERS };
void prewarm_start(KrsRenderer *renderer, const ShaderRequest *requests, size_t count);
/* Begins no further shader. */
void prewarm_stop(KrsRenderer *renderer);
/* Tells, after prewarm_stop and before prewarm_end, whether a shader is made, or at hand. */
bool prewarm_begun(const KrsRenderer *renderer, const Shader *shader);
/* Waits for the shader at hand, and takes over what was made so far.  What was not, or failed, is
   made when it is needed, as if nothing had been begun.  Until then no other thread may use the
   renderer's queue. */
void prewarm_end(KrsRenderer *renderer);

#endif
