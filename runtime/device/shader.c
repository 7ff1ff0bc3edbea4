/*
 * shader.c: a shader's text becomes SPIR-V and then a pipeline; both are kept in the cache, the
 * pipeline by the driver's own.
 */
#include "runtime/device/shader.h"

#include <errno.h>
#include <inttypes.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "compiler/base/clock.h"
#include "compiler/base/embedded.h"
#include "runtime/device/driver.h"
#include "runtime/device/shared_shaders.h"
#include "compiler/passes/compile.h"

/* A shader on its way to SPIR-V, in a thread of its own when it must be compiled. */
typedef struct ShaderBuild {
    const char   *file;
    char         *text;
    CacheKey      key;
    uint32_t     *found, *made; /* in the cache, or by the compiler; one of them, when done */
    size_t        bytes;
    size_t        glsl_bytes;
    uint32_t      march_group;
    double        ms;     /* that SPIR-V took, of one processor */
    KrsStatus     status; /* of the compiler */
    char         *log;
    pthread_t     thread;
    bool          started; /* the thread */
    bool          to_share;
    SharedShader *shared; /* the device has it already: nothing is found or made */
} ShaderBuild;

static double ms_of(clockid_t clock) { return 1e3 * clock_seconds(clock); }

static void *compile(void *user)
{
    ShaderBuild *build = user;
    size_t       count = 0;
    const double start = ms_of(CLOCK_THREAD_CPUTIME_ID);
    build->status      = spirv_compile(build->text, build->file, &build->made, &count, &build->log);
    build->bytes       = count * sizeof *build->made;
    build->ms += ms_of(CLOCK_THREAD_CPUTIME_ID) - start;
    return NULL;
}

/* Returns the SPIR-V that the program carries of a shader without a scene: FILE.spv, or
   FILE-NAME-NAME.spv of a shader for which these names are defined, and nothing else is. */
static const EmbeddedFile *find_module(const ShaderSource *source)
{
    char        wanted[128], defined[32];
    const char *defines = source->defines ? source->defines : "";
    size_t      length  = (size_t)snprintf(wanted, sizeof wanted, "%s", source->file);
    if (source->scene)
        return NULL;
    for (int end = 0;
         length < sizeof wanted && sscanf(defines, " #define %31s%n", defined, &end) == 1;
         defines += end)
        length += (size_t)snprintf(wanted + length, sizeof wanted - length, "-%s", defined);
    if (length >= sizeof wanted || strspn(defines, " \n") != strlen(defines))
        return NULL;
    snprintf(wanted + length, sizeof wanted - length, ".spv");
    return embedded_find(module_files, wanted);
}

/* Makes the cache's key: all that the text depends on but cannot show, and the text. */
static CacheKey make_key(const ShaderSource *source, const char *text)
{
    const ShaderScene *s       = source->scene;
    uint64_t           variant = s ? krs_variant_hash(&s->variant, s->wanted, s->wanted_count) : 0;
    char               maker[192];
    snprintf(maker, sizeof maker, "%s: glslang %s, SPIRV-Tools %s, flat, variant %016" PRIx64,
             source->file, spirv_glslang_version(), spirv_tools_version(), variant);
    return cache_key(maker, text, strlen(text));
}

/* Takes the shader from the program itself, or puts its text together and looks into the cache. */
static bool begin(Gpu *gpu, ShaderBuild *build, const ShaderSource *source)
{
    const EmbeddedFile *module = find_module(source);
    const double        start  = ms_of(CLOCK_THREAD_CPUTIME_ID);
    *build                     = (ShaderBuild){.file = source->file};
    if (module) {
        build->bytes = module->length;
        build->found = gpu_alloc(gpu, module->length, 1, "load a shader");
        if (build->found)
            memcpy(build->found, module->text, module->length);
        return build->found != NULL;
    }
    build->text = shader_text(gpu, source);
    if (!build->text)
        return false;
    build->glsl_bytes  = strlen(build->text);
    build->march_group = source->scene ? source->scene->variant.march_group : 0;
    build->key         = make_key(source, build->text);
    build->to_share    = source->scene != NULL;
    build->shared      = build->to_share ? shared_shader_find(gpu, build->key) : NULL;
    if (!build->shared)
        build->found = cache_load(&gpu->cache, CACHE_SPIRV, build->key, &build->bytes);
    build->ms = ms_of(CLOCK_THREAD_CPUTIME_ID) - start;
    return true;
}

/* Begins to compile what was not found.  Meanwhile the texts of other shaders are printed. */
static void start_build(ShaderBuild *build)
{
    build->started = !build->found && !build->shared &&
                     pthread_create(&build->thread, NULL, compile, build) == 0;
}

/* Waits for what was started, and compiles what found no thread. */
static void end_build(ShaderBuild *build)
{
    if (build->started)
        pthread_join(build->thread, NULL);
    else if (build->text && !build->found && !build->shared)
        compile(build);
}

/* Keeps what was compiled, or says why it was not. */
static bool finish(Gpu *gpu, const ShaderBuild *build)
{
    const char *log = build->log ? build->log : "";
    if (build->found || build->shared)
        return true;
    if (build->status == KRS_OK)
        cache_store(&gpu->cache, CACHE_SPIRV, build->key, build->made, build->bytes);
    else if (build->status == KRS_OUT_OF_MEMORY)
        gpu_refuse(gpu, build->status, "cannot compile the shader `%s`: out of memory",
                   build->file);
    else
        gpu_refuse(gpu, KRS_INTERNAL, "the shader `%s` does not compile: %.*s", build->file,
                   (int)strcspn(log, "\n"), log);
    return build->status == KRS_OK;
}

static void release(Gpu *gpu, ShaderBuild *build)
{
    gpu_release(gpu, build->text);
    gpu_release(gpu, build->found);
    if (build->shared)
        shared_shader_leave(gpu, build->shared);
    free(build->made);
    free(build->log);
}

/* Takes the words over, for good or bad. */
static ShaderCode take_code(ShaderBuild *build)
{
    ShaderCode code = {.file        = build->file,
                       .words       = build->found ? build->found : build->made,
                       .bytes       = build->bytes,
                       .compiled    = build->made != NULL,
                       .march_group = build->march_group,
                       .glsl_bytes  = build->glsl_bytes,
                       .ms          = build->ms,
                       .shared      = build->shared,
                       .to_share    = build->to_share,
                       .key         = build->key};
    build->found = build->made = NULL;
    build->shared              = NULL;
    return code;
}

bool shader_is_known(Gpu *gpu, const ShaderSource *source, CacheKey *key)
{
    ShaderBuild build;
    const bool  known = begin(gpu, &build, source) && (build.found || build.shared);
    *key              = build.key;
    release(gpu, &build);
    return known;
}

bool shader_compile_all(Gpu *gpu, const ShaderRequest *requests, size_t count, ShaderCode *codes,
                        double *spirv_ms)
{
    double       start  = clock_ms();
    ShaderBuild *builds = gpu_alloc(gpu, count, sizeof *builds, "compile the shaders");
    bool         ready  = builds != NULL;
    for (size_t i = 0; i < count && ready; i++) {
        ready = begin(gpu, &builds[i], &requests[i].source);
        if (ready)
            start_build(&builds[i]);
    }
    for (size_t i = 0; i < count && builds; i++) {
        end_build(&builds[i]);
        ready = ready && gpu_tell_compiled(gpu, COMPILED_PART * (double)(i + 1) / (double)count);
    }
    for (size_t i = 0; i < count && ready; i++)
        ready = finish(gpu, &builds[i]);
    for (size_t i = 0; i < count; i++)
        codes[i] = ready ? take_code(&builds[i]) : (ShaderCode){0};
    for (size_t i = 0; i < count && builds; i++)
        release(gpu, &builds[i]);
    gpu_release(gpu, builds);
    *spirv_ms += clock_ms() - start;
    return ready;
}

void shader_code_release(Gpu *gpu, ShaderCode *code)
{
    if (code->compiled)
        free(code->words);
    else
        gpu_release(gpu, code->words);
    if (code->shared)
        shared_shader_leave(gpu, code->shared);
    *code = (ShaderCode){0};
}

/* Describes a shader before the device has it. */
static Shader describe(const ShaderCode *code)
{
    return (Shader){.file        = code->file,
                    .march_group = code->march_group,
                    .glsl_bytes  = code->glsl_bytes,
                    .cached      = !code->compiled,
                    .spirv_ms    = code->ms};
}

bool shader_load(Gpu *gpu, Shader *shader, const ShaderCode *code, Handle layout,
                 double *pipeline_ms)
{
    double         start  = clock_ms();
    VkShaderModule module = VK_NULL_HANDLE;
    VkPipeline     made   = VK_NULL_HANDLE;
    bool           ready  = false;
    *shader               = describe(code);
    TRY(gpu, "load a shader",
        vkCreateShaderModule(gpu->driver->device,
                             &(VkShaderModuleCreateInfo){
                                 .sType    = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                 .codeSize = code->bytes,
                                 .pCode    = code->words,
                             },
                             NULL, &module));
    TRY(gpu, "prepare a shader",
        vkCreateComputePipelines(
            gpu->driver->device, gpu->driver->pipelines, 1,
            &(VkComputePipelineCreateInfo){
                .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                .stage =
                    {
                        .sType  = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                        .stage  = VK_SHADER_STAGE_COMPUTE_BIT,
                        .module = module,
                        .pName  = "main",
                    },
                .layout = FROM_HANDLE(VkPipelineLayout, layout),
            },
            NULL, &made));
    shader->pipeline = TO_HANDLE(made);
    gpu_name(gpu, VK_OBJECT_TYPE_PIPELINE, shader->pipeline, code->file);
    ready = true;

failed:
    vkDestroyShaderModule(gpu->driver->device, module, NULL);
    shader->pipeline_ms = clock_ms() - start;
    *pipeline_ms += shader->pipeline_ms;
    return ready;
}

double shader_driver_ms(const Gpu *gpu, const Shader *shader)
{
    return shader->pipeline_ms + (shader->prewarmed ? gpu_prewarm_ms(gpu, shader->prewarm) : 0);
}

/* ---- Side by side ---- */

/* Shaders that several threads make: each takes the next that nobody has. */
typedef struct Loading {
    const ShaderRequest *requests;
    const ShaderCode    *codes;
    size_t               count;
    Handle               layout;
    atomic_size_t        next;
} Loading;

enum { MAX_LOADERS = 16 };
typedef struct PipelineLoader {
    Loading  *loading;
    Gpu       gpu; /* a copy, which takes the note when something fails */
    pthread_t thread;
    bool      started, ready;
} PipelineLoader;

static void *load_some(void *user)
{
    PipelineLoader *loader  = user;
    Loading        *loading = loader->loading;
    double          ms      = 0;
    for (size_t i; loader->ready && (i = atomic_fetch_add(&loading->next, 1)) < loading->count;)
        loader->ready = loading->codes[i].shared ||
                        shader_load(&loader->gpu, loading->requests[i].shader, &loading->codes[i],
                                    loading->layout, &ms);
    return NULL;
}

/* Tells once a second whether the process has worked for a part of it. */
static void await(const Gpu *gpu, pthread_t thread)
{
    struct timespec until;
    double          worked = ms_of(CLOCK_PROCESS_CPUTIME_ID);
    clock_gettime(CLOCK_REALTIME, &until);
    for (until.tv_sec++; pthread_timedjoin_np(thread, NULL, &until) == ETIMEDOUT; until.tv_sec++) {
        double now = ms_of(CLOCK_PROCESS_CPUTIME_ID);
        if (gpu->working && now > worked + 50)
            gpu->working(gpu->user);
        worked = now;
    }
}

/* The validation layers' callback is for one thread. */
static size_t count_loaders(const Gpu *gpu, size_t shaders)
{
    long   cores = sysconf(_SC_NPROCESSORS_ONLN);
    size_t most  = cores < 1 ? 1 : cores < MAX_LOADERS ? (size_t)cores : MAX_LOADERS;
    return gpu->validates ? 0 : shaders < most ? shaders : most;
}

/* Takes what the device has already, and shares what is new. */
static bool share(Gpu *gpu, Shader *shader, const ShaderCode *code)
{
    if (code->shared) {
        *shader          = describe(code);
        shader->shared   = shared_shader_find(gpu, code->key);
        shader->pipeline = shader->shared->pipeline;
        return true;
    }
    gpu->shaders_made++;
    if (code->to_share)
        shader->shared = shared_shader_add(gpu, code->key, shader->pipeline);
    return shader->shared || !code->to_share;
}

bool shader_load_all(Gpu *gpu, const ShaderRequest *requests, const ShaderCode *codes, size_t count,
                     Handle layout)
{
    Loading         loading = {requests, codes, count, layout, 0};
    size_t          loaders = count_loaders(gpu, count);
    PipelineLoader *all     = gpu_alloc(gpu, 1 + loaders, sizeof *all, "prepare the shaders");
    bool            ready   = all != NULL;
    for (size_t i = 0; i < count; i++)
        *requests[i].shader = (Shader){0};
    for (size_t i = 0; ready && i < loaders; i++) {
        all[i]         = (PipelineLoader){.loading = &loading, .gpu = *gpu, .ready = true};
        all[i].started = pthread_create(&all[i].thread, NULL, load_some, &all[i]) == 0;
    }
    for (size_t i = 0; all && i < loaders; i++)
        if (all[i].started)
            await(gpu, all[i].thread);
    if (ready) { /* what is left where no thread could be had */
        all[loaders] = (PipelineLoader){.loading = &loading, .gpu = *gpu, .ready = true};
        load_some(&all[loaders]);
    }
    for (size_t i = 0; all && i <= loaders; i++)
        if (!all[i].ready) {
            gpu_refuse(gpu, all[i].gpu.status, "%s", all[i].gpu.message);
            ready = false;
        }
    gpu_release(gpu, all);
    for (size_t i = 0; i < count && ready; i++)
        ready = share(gpu, requests[i].shader, &codes[i]);
    return ready;
}

bool shader_create_all(Gpu *gpu, const ShaderRequest *requests, size_t count, Handle layout,
                       double *spirv_ms, double *pipeline_ms)
{
    ShaderCode *codes = gpu_alloc(gpu, count, sizeof *codes, "compile the shaders");
    bool        ready = codes && shader_compile_all(gpu, requests, count, codes, spirv_ms);
    double      start = clock_ms();
    for (size_t i = 0; i < count; i++)
        *requests[i].shader = (Shader){0};
    ready = ready && shader_load_all(gpu, requests, codes, count, layout);
    *pipeline_ms += clock_ms() - start;
    for (size_t i = 0; i < count && codes; i++)
        shader_code_release(gpu, &codes[i]);
    gpu_release(gpu, codes);
    return ready;
}

bool shader_create(Gpu *gpu, Shader *shader, const ShaderSource *source, Handle layout,
                   double *spirv_ms, double *pipeline_ms)
{
    return shader_create_all(gpu, &(ShaderRequest){shader, *source}, 1, layout, spirv_ms,
                             pipeline_ms);
}

void shader_destroy(Gpu *gpu, Shader *shader)
{
    if (shader->shared)
        shared_shader_leave(gpu, shader->shared);
    else if (gpu_is_open(gpu) && !gpu->stuck)
        vkDestroyPipeline(gpu->driver->device, FROM_HANDLE(VkPipeline, shader->pipeline), NULL);
    *shader = (Shader){0};
}
