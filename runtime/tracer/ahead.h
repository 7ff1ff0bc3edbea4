/*
 * ahead.h: kernels that run once before they are needed, and those that all pictures need, which
 * are made while the host still does other work.
 */
#ifndef KRS_AHEAD_H
#define KRS_AHEAD_H

#include "runtime/tracer/handles.h"

/* Has the driver run a kernel that exists once, in the background. */
bool kernel_warm_up(KrsRenderer *renderer, VkDescriptorSet scene_set, Kernel *kernel);

/* Makes at most MOST_AHEAD kernels without a scene, one after the other by a thread of its own.  It
   does nothing where that would not help: on graphics cards, and on one core. */
enum { MOST_AHEAD = PIXEL_KERNELS };
void ahead_start(KrsRenderer *renderer, const KernelRequest *requests, size_t count);
/* No further kernel is begun. */
void ahead_stop(KrsRenderer *renderer);
/* After ahead_stop, and before ahead_end: whether a kernel is made, or at hand. */
bool ahead_begun(const KrsRenderer *renderer, const Kernel *kernel);
/* Waits for the kernel at hand, and takes over what was made so far.  What was not, or failed, is
   made when it is needed, as if nothing had been begun.  Until then no other thread may use the
   renderer's queue. */
void ahead_end(KrsRenderer *renderer);

#endif
