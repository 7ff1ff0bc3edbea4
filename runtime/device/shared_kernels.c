/*
 * shared_kernels.c: a list of kernels, the one that was found or left last at the front.
 */
#include "runtime/device/shared_kernels.h"

#include <string.h>

static void destroy(Gpu *gpu, SharedKernel *shared)
{
    if (gpu->device && !gpu->stuck)
        vkDestroyPipeline(gpu->device, shared->pipeline, NULL);
    gpu_release(gpu, shared);
}

static void move_to_front(Gpu *gpu, SharedKernel *shared)
{
    SharedKernel **link = &gpu->shared_kernels;
    while (*link != shared)
        link = &(*link)->next;
    *link               = shared->next;
    shared->next        = gpu->shared_kernels;
    gpu->shared_kernels = shared;
}

SharedKernel *shared_kernel_find(Gpu *gpu, CacheKey key)
{
    SharedKernel *shared = gpu->shared_kernels;
    while (shared && memcmp(&shared->key, &key, sizeof key) != 0)
        shared = shared->next;
    if (!shared)
        return NULL;
    shared->users++;
    move_to_front(gpu, shared);
    return shared;
}

SharedKernel *shared_kernel_add(Gpu *gpu, CacheKey key, VkPipeline pipeline)
{
    SharedKernel *shared = gpu_alloc(gpu, 1, sizeof *shared, "prepare the kernels");
    if (!shared)
        return NULL;
    *shared             = (SharedKernel){key, pipeline, 1, gpu->shared_kernels};
    gpu->shared_kernels = shared;
    return shared;
}

/* Destroys those without users that were left longest ago, if there are too many. */
static void limit_unused(Gpu *gpu)
{
    size_t unused = 0;
    for (SharedKernel **link = &gpu->shared_kernels; *link;) {
        SharedKernel *shared = *link;
        unused += shared->users == 0;
        if (shared->users > 0 || unused <= MOST_UNUSED_KERNELS) {
            link = &shared->next;
            continue;
        }
        *link = shared->next;
        destroy(gpu, shared);
    }
}

void shared_kernel_leave(Gpu *gpu, SharedKernel *shared)
{
    move_to_front(gpu, shared);
    if (--shared->users == 0)
        limit_unused(gpu);
}

void shared_kernels_destroy(Gpu *gpu)
{
    for (SharedKernel *shared = gpu->shared_kernels, *next; shared; shared = next) {
        next = shared->next;
        destroy(gpu, shared);
    }
    gpu->shared_kernels = NULL;
}
