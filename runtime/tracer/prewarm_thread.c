/*
 * prewarm_thread.c: shaders that all pictures need, made while the host still does other work.
 *
 * A scene is compiled by one thread, for a second if it is large, and lavapipe takes a quarter of a
 * second for the shaders without a scene.  So they are made meanwhile.  The thread has copies of the
 * renderer and of the shaders, which prewarm_end takes over.
 */
#include "runtime/tracer/prewarm_thread.h"

#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

#include "compiler/passes/compile.h"

struct PrewarmThread {
    KrsRenderer   renderer; /* a copy: its device counts, and takes the note when something fails */
    ShaderRequest requests[MAX_PREWARMED];
    ShaderCode    codes[MAX_PREWARMED];
    Shader        shaders[MAX_PREWARMED];
    size_t        count, made;
    size_t        begun; /* after prewarm_stop; all, before */
    atomic_size_t next;  /* that is begun, unless there are no more */
    pthread_t     thread;
};

bool shader_prewarm(KrsRenderer *renderer, Handle scene_set, Shader *shader)
{
    const Run run            = {.pipeline = shader->pipeline,
                                .layout   = renderer->layout,
                                .sets = {scene_set ? scene_set : renderer->idle_scene, renderer->idle_frame}};
    return shader->prewarmed = gpu_prewarm(&renderer->gpu, &run, &shader->prewarm);
}

/* Tells whether the driver had to compile the first shader, which its cache gives in a few milliseconds.  Where
   that is empty, ours is as well. */
static bool finds_no_cache(const PrewarmThread *prewarm)
{
    const double compiled_ms = 20;
    return gpu_prewarm_ms(&prewarm->renderer.gpu, prewarm->shaders[0].prewarm) > compiled_ms;
}

/* Makes a shader, and waits until the driver has compiled it.  To start glslang takes a quarter of the
   time of a small scene's first picture with full caches, which needs none. */
static bool make(PrewarmThread *prewarm, size_t i)
{
    Gpu   *gpu    = &prewarm->renderer.gpu;
    double unused = 0;
    bool   ready  = shader_load(gpu, &prewarm->shaders[i], &prewarm->codes[i],
                                prewarm->renderer.layout, &unused) &&
                 shader_prewarm(&prewarm->renderer, 0, &prewarm->shaders[i]);
    if (i == 1 && finds_no_cache(prewarm))
        spirv_prepare(); /* while the driver's own thread works */
    ready = ready && gpu_wait(gpu);
    if (!ready)
        shader_destroy(gpu, &prewarm->shaders[i]);
    return ready;
}

static void *make_all(void *user)
{
    PrewarmThread *prewarm = user;
    for (size_t i; (i = atomic_fetch_add(&prewarm->next, 1)) < prewarm->count && make(prewarm, i);)
        prewarm->made++;
    return NULL;
}

/* Frees it; its thread has ended.  Memory is had and freed by the caller's thread alone. */
static void prewarm_free(KrsRenderer *renderer, PrewarmThread *prewarm)
{
    for (size_t i = 0; i < prewarm->count; i++)
        shader_code_release(&renderer->gpu, &prewarm->codes[i]);
    gpu_release(&renderer->gpu, prewarm);
}

/* The program carries these shaders where texels are read, and has to compile them elsewhere.  The
   callback of the validation layers works for one thread only. */
void prewarm_start(KrsRenderer *renderer, const ShaderRequest *requests, size_t count)
{
    Gpu *gpu = &renderer->gpu;
    if (!gpu_is_cpu(gpu) || !gpu->texels || gpu->validates || sysconf(_SC_NPROCESSORS_ONLN) < 2)
        return;
    PrewarmThread *prewarm = gpu_alloc(gpu, 1, sizeof *prewarm, "make shaders ahead");
    double         unused  = 0;
    if (!prewarm)
        return;
    prewarm->renderer               = *renderer;
    prewarm->renderer.gpu.compiling = NULL; /* the caller's thread tells how far it is */
    prewarm->count = prewarm->begun = count;
    memcpy(prewarm->requests, requests, count * sizeof *requests);
    if (shader_compile_all(&prewarm->renderer.gpu, prewarm->requests, prewarm->count,
                           prewarm->codes, &unused) &&
        pthread_create(&prewarm->thread, NULL, make_all, prewarm) == 0)
        renderer->prewarm = prewarm;
    else
        prewarm_free(renderer, prewarm);
}

void prewarm_stop(KrsRenderer *renderer)
{
    PrewarmThread *prewarm = renderer->prewarm;
    if (!prewarm)
        return;
    const size_t begun = atomic_exchange(&prewarm->next, MAX_PREWARMED);
    prewarm->begun     = begun < prewarm->begun ? begun : prewarm->begun;
}

bool prewarm_begun(const KrsRenderer *renderer, const Shader *shader)
{
    const PrewarmThread *prewarm = renderer->prewarm;
    bool                 found   = false;
    for (size_t i = 0; prewarm && i < prewarm->begun; i++)
        found = found || prewarm->requests[i].shader == shader;
    return found;
}

void prewarm_end(KrsRenderer *renderer)
{
    PrewarmThread *prewarm = renderer->prewarm;
    if (!prewarm)
        return;
    prewarm_stop(renderer);
    pthread_join(prewarm->thread, NULL);
    for (size_t i = 0; i < prewarm->made; i++)
        *prewarm->requests[i].shader = prewarm->shaders[i];
    renderer->gpu.prewarms = prewarm->renderer.gpu.prewarms;
    renderer->gpu.stuck    = prewarm->renderer.gpu.stuck;
    renderer->gpu.lost     = renderer->gpu.lost || prewarm->renderer.gpu.lost;
    renderer->gpu.shaders_made += prewarm->made;
    renderer->prewarm = NULL;
    prewarm_free(renderer, prewarm);
}
