/*
 * shared_shaders.c: a list of shaders, the one that was found or left last at the front.
 */
#include "runtime/device/shared_shaders.h"

#include <string.h>

#include "runtime/device/driver.h"

static void destroy(Gpu *gpu, SharedShader *shared)
{
    if (gpu_is_open(gpu) && !gpu->stuck)
        vkDestroyPipeline(gpu->driver->device, FROM_HANDLE(VkPipeline, shared->pipeline), NULL);
    gpu_release(gpu, shared);
}

static void move_to_front(Gpu *gpu, SharedShader *shared)
{
    SharedShader **link = &gpu->shared_shaders;
    while (*link != shared)
        link = &(*link)->next;
    *link               = shared->next;
    shared->next        = gpu->shared_shaders;
    gpu->shared_shaders = shared;
}

SharedShader *shared_shader_find(Gpu *gpu, CacheKey key)
{
    SharedShader *shared = gpu->shared_shaders;
    while (shared && memcmp(&shared->key, &key, sizeof key) != 0)
        shared = shared->next;
    if (!shared)
        return NULL;
    shared->users++;
    move_to_front(gpu, shared);
    return shared;
}

SharedShader *shared_shader_add(Gpu *gpu, CacheKey key, Handle pipeline)
{
    SharedShader *shared = gpu_alloc(gpu, 1, sizeof *shared, "prepare the shaders");
    if (!shared)
        return NULL;
    *shared             = (SharedShader){key, pipeline, 1, gpu->shared_shaders};
    gpu->shared_shaders = shared;
    return shared;
}

/* Destroys those without users that were left longest ago, if there are too many. */
static void limit_unused(Gpu *gpu)
{
    size_t unused = 0;
    for (SharedShader **link = &gpu->shared_shaders; *link;) {
        SharedShader *shared = *link;
        unused += shared->users == 0;
        if (shared->users > 0 || unused <= MAX_UNUSED_SHADERS) {
            link = &shared->next;
            continue;
        }
        *link = shared->next;
        destroy(gpu, shared);
    }
}

void shared_shader_leave(Gpu *gpu, SharedShader *shared)
{
    move_to_front(gpu, shared);
    if (--shared->users == 0)
        limit_unused(gpu);
}

void shared_shaders_destroy(Gpu *gpu)
{
    for (SharedShader *shared = gpu->shared_shaders, *next; shared; shared = next) {
        next = shared->next;
        destroy(gpu, shared);
    }
    gpu->shared_shaders = NULL;
}
