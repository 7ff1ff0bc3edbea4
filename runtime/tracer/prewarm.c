/*
 * prewarm.c: runs each shader once before it is needed.
 *
 * lavapipe compiles a shader when it first runs, one shader at a time, and keeps the code on disk.
 * So each shader runs once without any items, while the host does other work.  Where several
 * shaders are new, a second device takes some of them, and is closed when they are done.  The first
 * device then finds those on disk.  Graphics cards compile a shader when its pipeline is made, so
 * only devices of type CPU are prewarmed.
 */
#include "runtime/tracer/prewarm.h"

#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

#include "runtime/tracer/prewarm_thread.h"
#include "runtime/tracer/layouts.h"

/* Shaders that two devices prewarm.  Each takes the next one that the other has not taken. */
typedef struct PrewarmQueue {
    const Gpu           *gpu; /* the first */
    const ShaderRequest *requests;
    const ShaderCode    *codes;
    size_t               count;
    atomic_size_t        next;
    double               second_ms[SHADERS_AT_ONCE]; /* that the second device's driver took */
    pthread_t            thread;                     /* of the second device, */
    bool                 helped;                     /* which runs */
} PrewarmQueue;

/* Tells whether a second device is worth its cost.  There must be a core for it, and more than one shader
   that the driver probably does not have yet.  The callback of the validation layers works for one
   thread only. */
static bool worth_second_device(const PrewarmQueue *queue)
{
    const Gpu *gpu      = queue->gpu;
    size_t     compiled = 0;
    for (size_t i = 0; i < queue->count; i++)
        compiled += queue->codes[i].compiled;
    return compiled > 1 && gpu_is_cpu(gpu) && !gpu->validates && sysconf(_SC_NPROCESSORS_ONLN) > 1;
}

/* Takes shaders from the queue, and prewarms them on a device of its own, in a thread.  If anything fails, or nothing is
   kept on disk, the first device compiles what this one should have. */
static void *prewarm_on_second_device(void *user)
{
    PrewarmQueue *queue  = user;
    KrsRenderer   second = {0};
    bool          ready  = gpu_open_beside(&second.gpu, queue->gpu) && layouts_create(&second);
    for (size_t i; ready && (i = atomic_fetch_add(&queue->next, 1)) < queue->count;) {
        Shader shader;
        double ms = 0;
        if (queue->codes[i].shared)
            continue;
        ready = shader_load(&second.gpu, &shader, &queue->codes[i], second.layout, &ms) &&
                shader_prewarm(&second, second.idle_scene, &shader) && gpu_wait(&second.gpu);
        queue->second_ms[i] = shader_driver_ms(&second.gpu, &shader);
        shader_destroy(&second.gpu, &shader);
    }
    layouts_destroy(&second);
    gpu_close(&second.gpu);
    return NULL;
}

static size_t taken_so_far(PrewarmQueue *queue)
{
    const size_t next = atomic_load(&queue->next);
    return next < queue->count ? next : queue->count;
}

static bool tell_prewarmed(KrsRenderer *renderer, size_t prewarmed, size_t count)
{
    const double part = count > 0 ? (double)prewarmed / (double)count : 1;
    return gpu_tell_compiled(&renderer->gpu, COMPILED_PART + (1 - COMPILED_PART) * part);
}

static void start_second_device(PrewarmQueue *queue)
{
    queue->helped = worth_second_device(queue) &&
                    pthread_create(&queue->thread, NULL, prewarm_on_second_device, queue) == 0;
}

static void end_second_device(PrewarmQueue *queue)
{
    if (queue->helped)
        pthread_join(queue->thread, NULL);
}

/* Prewarms the shaders that the second device does not take, and then, from the disk, those that it
   took. */
static bool prewarm_all(KrsRenderer *renderer, Handle scene_set, PrewarmQueue *queue)
{
    const ShaderRequest *requests = queue->requests;
    const ShaderCode    *codes    = queue->codes;
    const size_t         count    = queue->count;
    bool                 ready = true, taken[SHADERS_AT_ONCE] = {false};
    while (queue->helped && ready) {
        /* This device takes a shader only when it can run it. */
        ready    = gpu_wait(&renderer->gpu) && tell_prewarmed(renderer, taken_so_far(queue), count);
        size_t i = atomic_fetch_add(&queue->next, 1);
        if (i >= count)
            break;
        taken[i] = ready = ready && (codes[i].shared ||
                                     shader_prewarm(renderer, scene_set, requests[i].shader));
    }
    if (!ready)
        atomic_store(&queue->next, count);
    end_second_device(queue);
    for (size_t i = 0; i < count && ready; i++) {
        requests[i].shader->pipeline_ms += queue->second_ms[i];
        ready = taken[i] || codes[i].shared ||
                shader_prewarm(renderer, scene_set, requests[i].shader);
    }
    return ready;
}

/* Puts the largest shaders first.  They take longest, and no thread should begin one when all others
   are done. */
static void sort_by_size(ShaderRequest *requests, ShaderCode *codes, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        const ShaderRequest request = requests[i];
        const ShaderCode    code    = codes[i];
        size_t              to      = i;
        for (; to > 0 && codes[to - 1].bytes < code.bytes; to--) {
            requests[to] = requests[to - 1];
            codes[to]    = codes[to - 1];
        }
        requests[to] = request;
        codes[to]    = code;
    }
}

/* Leaves out the shaders that are made, or begun ahead.  Returns how many are left. */
static size_t drop_made(KrsRenderer *renderer, ShaderRequest *requests, ShaderCode *codes,
                        size_t count)
{
    size_t left = 0;
    for (size_t i = 0; i < count; i++) {
        if (requests[i].shader->pipeline || prewarm_begun(renderer, requests[i].shader)) {
            shader_code_release(&renderer->gpu, &codes[i]);
            continue;
        }
        requests[left] = requests[i];
        codes[left++]  = codes[i];
    }
    return left;
}

/* Loads shaders and prewarms them.  The second device begins at once, while the first still has a
   shader at hand that was begun ahead. */
static bool load_and_prewarm(KrsRenderer *renderer, Handle scene_set, const ShaderRequest *requests,
                             const ShaderCode *codes, size_t count)
{
    Gpu         *gpu   = &renderer->gpu;
    PrewarmQueue queue = {.gpu = gpu, .requests = requests, .codes = codes, .count = count};
    start_second_device(&queue);
    bool ready = shader_load_all(gpu, requests, codes, count, renderer->layout);
    prewarm_end(renderer);
    if (!ready)
        atomic_store(&queue.next, count);
    if (ready && gpu_is_cpu(gpu))
        return prewarm_all(renderer, scene_set, &queue);
    end_second_device(&queue);
    return ready;
}

/* Compiles shaders, loads them and prewarms them, and waits for those that were begun ahead. */
static bool make(KrsRenderer *renderer, Handle scene_set, const ShaderRequest *asked, size_t count,
                 double *spirv_ms, double *pipeline_ms)
{
    Gpu          *gpu = &renderer->gpu;
    ShaderRequest requests[SHADERS_AT_ONCE];
    ShaderCode    codes[SHADERS_AT_ONCE];
    memcpy(requests, asked, count * sizeof *requests);
    bool ready = shader_compile_all(gpu, requests, count, codes, spirv_ms);
    prewarm_stop(renderer);
    count = drop_made(renderer, requests, codes, count);
    sort_by_size(requests, codes, count);
    double start = clock_ms();
    for (size_t i = 0; i < count; i++)
        *requests[i].shader = (Shader){0};
    ready = ready && load_and_prewarm(renderer, scene_set, requests, codes, count);
    prewarm_end(renderer);
    ready = ready && tell_prewarmed(renderer, count, count);
    for (size_t i = 0; i < count; i++)
        shader_code_release(gpu, &codes[i]);
    *pipeline_ms += clock_ms() - start;
    return ready;
}

bool shaders_make(KrsRenderer *renderer, Handle scene_set, const ShaderRequest *asked, size_t count,
                  double *spirv_ms, double *pipeline_ms)
{
    bool ready = count == 0 || make(renderer, scene_set, asked, count, spirv_ms, pipeline_ms);
    /* Shaders that were begun ahead, and failed, are made now: nothing is made ahead any more. */
    for (size_t i = 0; i < count && ready; i++)
        ready = asked[i].shader->pipeline ||
                make(renderer, scene_set, &asked[i], 1, spirv_ms, pipeline_ms);
    return ready;
}
