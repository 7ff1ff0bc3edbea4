/*
 * ahead.c: kernels that all pictures need, made while the host still does other work.
 *
 * A scene is compiled by one thread, for a second if it is large, and lavapipe takes a quarter of a
 * second for the kernels without a scene.  So they are made meanwhile.  The thread has copies of the
 * renderer and of the kernels, which ahead_end takes over.
 */
#include "runtime/tracer/ahead.h"

#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

#include "compiler/passes/compile.h"

struct KernelsAhead {
    KrsRenderer   renderer; /* a copy: its device counts, and takes the note when something fails */
    KernelRequest requests[MOST_AHEAD];
    KernelCode    codes[MOST_AHEAD];
    Kernel        kernels[MOST_AHEAD];
    size_t        count, made;
    size_t        begun; /* after ahead_stop; all, before */
    atomic_size_t next;  /* that is begun, unless there are no more */
    pthread_t     thread;
};

bool kernel_warm_up(KrsRenderer *renderer, VkDescriptorSet scene_set, Kernel *kernel)
{
    const VkDescriptorSet sets[2] = {scene_set ? scene_set : renderer->idle_scene,
                                     renderer->idle_frame};
    const WorkBlock work     = {.groups = 1, .stride = 1};
    return kernel->warmed_up = gpu_warm_up(&renderer->gpu, kernel->pipeline, renderer->layout, sets,
                                           &work, sizeof work, &kernel->warm_up);
}

/* Whether the driver had to compile the first kernel, which its cache gives in a few milliseconds.  Where
   that is empty, ours is as well. */
static bool finds_no_cache(const KernelsAhead *ahead)
{
    const double compiled_ms = 20;
    return gpu_warm_up_ms(&ahead->renderer.gpu, ahead->kernels[0].warm_up) > compiled_ms;
}

/* Makes a kernel, and waits until the driver has compiled it.  To start glslang takes a quarter of the
   time of a small scene's first picture with full caches, which needs none. */
static bool make(KernelsAhead *ahead, size_t i)
{
    Gpu   *gpu    = &ahead->renderer.gpu;
    double unused = 0;
    bool   ready  = kernel_load(gpu, &ahead->kernels[i], &ahead->codes[i], ahead->renderer.layout,
                                &unused) &&
                 kernel_warm_up(&ahead->renderer, VK_NULL_HANDLE, &ahead->kernels[i]);
    if (i == 1 && finds_no_cache(ahead))
        spirv_prepare(); /* while the driver's own thread works */
    ready = ready && gpu_wait(gpu);
    if (!ready)
        kernel_destroy(gpu, &ahead->kernels[i]);
    return ready;
}

static void *make_all(void *user)
{
    KernelsAhead *ahead = user;
    for (size_t i; (i = atomic_fetch_add(&ahead->next, 1)) < ahead->count && make(ahead, i);)
        ahead->made++;
    return NULL;
}

/* Frees it; its thread has ended.  Memory is had and freed by the caller's thread alone. */
static void free_ahead(KrsRenderer *renderer, KernelsAhead *ahead)
{
    for (size_t i = 0; i < ahead->count; i++)
        kernel_code_release(&renderer->gpu, &ahead->codes[i]);
    gpu_release(&renderer->gpu, ahead);
}

/* The program carries these kernels where texels are read, and has to compile them elsewhere.  The
   callback of the validation layers works for one thread only. */
void ahead_start(KrsRenderer *renderer, const KernelRequest *requests, size_t count)
{
    Gpu *gpu = &renderer->gpu;
    if (!gpu_is_cpu(gpu) || !gpu->texels || gpu->messenger || sysconf(_SC_NPROCESSORS_ONLN) < 2)
        return;
    KernelsAhead *ahead  = gpu_alloc(gpu, 1, sizeof *ahead, "make kernels ahead");
    double        unused = 0;
    if (!ahead)
        return;
    ahead->renderer               = *renderer;
    ahead->renderer.gpu.compiling = NULL; /* the caller's thread tells how far it is */
    ahead->count = ahead->begun = count;
    memcpy(ahead->requests, requests, count * sizeof *requests);
    if (kernel_compile_all(&ahead->renderer.gpu, ahead->requests, ahead->count, ahead->codes,
                           &unused) &&
        pthread_create(&ahead->thread, NULL, make_all, ahead) == 0)
        renderer->ahead = ahead;
    else
        free_ahead(renderer, ahead);
}

void ahead_stop(KrsRenderer *renderer)
{
    KernelsAhead *ahead = renderer->ahead;
    if (!ahead)
        return;
    const size_t begun = atomic_exchange(&ahead->next, MOST_AHEAD);
    ahead->begun       = begun < ahead->begun ? begun : ahead->begun;
}

bool ahead_begun(const KrsRenderer *renderer, const Kernel *kernel)
{
    const KernelsAhead *ahead = renderer->ahead;
    bool                found = false;
    for (size_t i = 0; ahead && i < ahead->begun; i++)
        found = found || ahead->requests[i].kernel == kernel;
    return found;
}

void ahead_end(KrsRenderer *renderer)
{
    KernelsAhead *ahead = renderer->ahead;
    if (!ahead)
        return;
    ahead_stop(renderer);
    pthread_join(ahead->thread, NULL);
    for (size_t i = 0; i < ahead->made; i++)
        *ahead->requests[i].kernel = ahead->kernels[i];
    renderer->gpu.warm_ups = ahead->renderer.gpu.warm_ups;
    renderer->gpu.stuck    = ahead->renderer.gpu.stuck;
    renderer->gpu.kernels_made += ahead->made;
    renderer->ahead = NULL;
    free_ahead(renderer, ahead);
}
