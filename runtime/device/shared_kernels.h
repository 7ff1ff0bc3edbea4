/*
 * shared_kernels.h: the kernels of a device that contain functions of scenes, by their text.
 *
 * Renderings whose kernels have the same text share them.  Some stay although no rendering uses them
 * any more, for scenes that are edited back and forth.
 */
#ifndef KRS_SHARED_KERNELS_H
#define KRS_SHARED_KERNELS_H

#include "runtime/device/gpu_state.h"

struct SharedKernel {
    CacheKey      key;
    VkPipeline    pipeline;
    uint32_t      users;
    SharedKernel *next;
};

/* How many kernels stay that nobody uses. */
enum { MOST_UNUSED_KERNELS = 64 };

/* The kernel with this key, for one more user; NULL: there is none. */
SharedKernel *shared_kernel_find(Gpu *gpu, CacheKey key);
/* Takes over a pipeline, which has one user then; NULL with the failure noted. */
SharedKernel *shared_kernel_add(Gpu *gpu, CacheKey key, VkPipeline pipeline);
/* A user ends.  The device must have run all that uses the kernel. */
void shared_kernel_leave(Gpu *gpu, SharedKernel *shared);
/* Destroys all; none may have a user. */
void shared_kernels_destroy(Gpu *gpu);

#endif
