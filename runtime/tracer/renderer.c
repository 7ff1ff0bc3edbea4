/*
 * renderer.c: makes and frees renderers: a device, and what all scenes need on it.
 */
#include "runtime/tracer/renderer.h"

#include <math.h>
#include <pthread.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "compiler/base/allocator.h"
#include "runtime/tracer/prewarm_thread.h"
#include "runtime/tracer/layouts.h"
#include "runtime/tracer/prewarm.h"
#include "runtime/tracer/variants.h"

KrsStatus krs_devices(KrsDevice *devices, size_t capacity, size_t *count)
{
    Gpu gpu = {0};
    return gpu_list(&gpu, devices, capacity, count) ? KRS_OK : gpu.status;
}

/* Defines of shaders without a scene, by how they read. */
#define ALL_READS(own)                          \
    {                                           \
        own NO_TEXELS, own "", own FRAME_TEXELS \
    }
static const char *const ray_defines[RAY_KINDS][SHADER_READS] = {
    [RAYS_OF_CAMERAS] = ALL_READS(),        [RAYS_OF_PANORAMAS] = ALL_READS(PANORAMIC),
    [RAYS_OF_LENSES] = ALL_READS(LENS),     [RAYS_OF_LISTS] = ALL_READS(LISTED_RAYS),
    [RAYS_OF_PATHS] = ALL_READS(PATH_RAYS),
};
/* The same where the sky is a picture. */
static const char *const map_defines[RAYS_OF_PATHS][SHADER_READS] = {
    [RAYS_OF_CAMERAS]   = ALL_READS(SKY_MAP),
    [RAYS_OF_PANORAMAS] = ALL_READS(SKY_MAP PANORAMIC),
    [RAYS_OF_LENSES]    = ALL_READS(SKY_MAP LENS),
    [RAYS_OF_LISTS]     = ALL_READS(SKY_MAP LISTED_RAYS),
};
/* The same for rays of paths as well. */
static const char *const mixed_defines[RAYS_OF_LISTS][SHADER_READS] = {
    [RAYS_OF_CAMERAS]   = ALL_READS(MIXED_RAYS),
    [RAYS_OF_PANORAMAS] = ALL_READS(MIXED_RAYS PANORAMIC),
    [RAYS_OF_LENSES]    = ALL_READS(MIXED_RAYS LENS),
};

/* The same for paths that may meet the plate of another renderer. */
static const char *const plate_defines[SHADER_READS] = ALL_READS(PATH_RAYS CATCHES);

/* Returns a shader without a scene, for rays of a kind. */
static ShaderRequest request_shader(KrsRenderer *renderer, Shader *shader, const char *file,
                                    RayKind kind)
{
    const ShaderReads reads = variants_reads(&renderer->gpu);
    return (ShaderRequest){shader, {.file = file, .defines = ray_defines[kind][reads]}};
}

PixelShader renderer_background(const KrsRendering *rendering)
{
    return rendering->program->sky_map ? PIXELS_BACKGROUND_OF_MAP : PIXELS_BACKGROUND;
}

static const char *const pixel_files[PIXEL_SHADERS] = {
    [PIXELS_BACKGROUND] = "background.comp", [PIXELS_BACKGROUND_OF_MAP] = "background.comp",
    [PIXELS_UNPROVEN] = "unproven.comp",     [PIXELS_PENUMBRAE] = "penumbrae.comp",
    [PIXELS_SHADOW] = "shadow.comp",         [PIXELS_OCCLUSION] = "occlusion.comp",
};

size_t renderer_request_pixels(const KrsRendering *rendering, ShaderRequest *requests)
{
    static const PixelShader backgrounds[] = {
        [false] = PIXELS_BACKGROUND_OF_MAP, [true] = PIXELS_BACKGROUND};
    KrsRenderer      *renderer = rendering->renderer;
    const RayKind     kind     = rendering->rays;
    const PixelShader other    = backgrounds[rendering->program->sky_map];
    size_t            count    = 0;
    for (int i = 0; i < PIXEL_SHADERS; i++) {
        if (renderer->pixels[kind][i].pipeline || i == (int)other)
            continue;
        requests[count] = request_shader(renderer, &renderer->pixels[kind][i], pixel_files[i],
                                         kind);
        if (i == PIXELS_BACKGROUND_OF_MAP)
            requests[count].source.defines = map_defines[kind][variants_reads(&renderer->gpu)];
        count++;
    }
    return count;
}

size_t renderer_request_escapes(KrsRenderer *renderer, RayKind kind, ShaderRequest *requests)
{
    const RayKind kinds[2] = {kind, RAYS_OF_PATHS};
    size_t        count    = 0;
    for (int i = kind == RAYS_OF_PATHS; i < 2; i++)
        if (!renderer->escapes[kinds[i]].pipeline)
            requests[count++] = request_shader(renderer, &renderer->escapes[kinds[i]],
                                               "escape.comp", kinds[i]);
    return count;
}

/* Begins to make the shaders of previews without a scene, for cameras of any scene. */
static void start_prewarming(KrsRenderer *renderer)
{
    ShaderRequest requests[PIXEL_SHADERS];
    size_t        count = 0;
    for (int i = 0; i < PIXEL_SHADERS; i++)
        if (i != PIXELS_BACKGROUND_OF_MAP)
            requests[count++] = request_shader(renderer, &renderer->pixels[RAYS_OF_CAMERAS][i],
                                               pixel_files[i], RAYS_OF_CAMERAS);
    prewarm_start(renderer, requests, count);
}

static void *start_glslang(void *unused)
{
    spirv_prepare();
    return unused;
}

/* Opens the device.  Where pictures come next and no shader is kept, glslang starts meanwhile: both take
   as long, and use one processor each. */
static bool open_device(KrsRenderer *renderer, const KrsRendererOptions *options,
                        unsigned emulation)
{
    pthread_t  thread;
    const bool helped = options && options->prewarm && cache_is_empty(options->cache) &&
                        sysconf(_SC_NPROCESSORS_ONLN) > 1 &&
                        pthread_create(&thread, NULL, start_glslang, NULL) == 0;
    const bool opened = gpu_open(&renderer->gpu, options, emulation);
    if (helped)
        pthread_join(thread, NULL);
    return opened;
}

bool renderer_prepare(KrsRenderer *renderer)
{
    const ShaderRequest shaders[] = {
        {&renderer->next_dispatch, {.file = "next_dispatch.comp"}},
        request_shader(renderer, &renderer->clear_shared, "clear_shared.comp", RAYS_OF_CAMERAS)};
    const size_t count = gpu_is_cpu(&renderer->gpu) ? 0 : sizeof shaders / sizeof *shaders;
    return layouts_create(renderer) &&
           shaders_make(renderer, 0, shaders, count, &renderer->spirv_ms, &renderer->pipeline_ms);
}

KrsStatus renderer_new_emulating(const KrsRendererOptions *options, unsigned emulation,
                                 KrsRenderer **out)
{
    const KrsAllocator allocator = options ? options->allocator : (KrsAllocator){0};
    KrsRenderer       *renderer  = allocator_new(&allocator, 1, sizeof *renderer);
    *out                         = renderer;
    if (!renderer)
        return KRS_OUT_OF_MEMORY;
    spirv_start();
    const bool opened          = open_device(renderer, options, emulation);
    renderer->compiler_started = true;
    if (!opened)
        return renderer->gpu.status;
    KrsEarlyOuts early_outs = options ? options->early_outs : KRS_EARLY_OUTS_DEFAULT;
    renderer->early_outs    = early_outs == KRS_EARLY_OUTS_DEFAULT ? !gpu_is_cpu(&renderer->gpu)
                                                                   : early_outs == KRS_EARLY_OUTS_ON;
    if (!renderer_prepare(renderer))
        return renderer->gpu.status;
    if (options && options->prewarm)
        start_prewarming(renderer);
    return KRS_OK;
}

KrsStatus krs_renderer_new(const KrsRendererOptions *options, KrsRenderer **renderer)
{
    return renderer_new_emulating(options, 0, renderer);
}

void renderer_visit(KrsRenderer *renderer, void (*visit)(void *user, Shader *shader), void *user)
{
    for (int kind = 0; kind < RAY_KINDS; kind++) {
        for (int i = 0; i < PIXEL_SHADERS; i++)
            visit(user, &renderer->pixels[kind][i]);
        visit(user, &renderer->limits[kind]);
        visit(user, &renderer->escapes[kind]);
    }
    for (int i = 0; i < 2 * RAYS_OF_LISTS; i++)
        visit(user, &renderer->aims[i / 2][i % 2]);
    for (int i = 0; i < 2; i++)
        visit(user, &renderer->arrivals[i]);
    visit(user, &renderer->escapes_to_plate);
    visit(user, &renderer->noise);
    visit(user, &renderer->plate);
    visit(user, &renderer->next_dispatch);
    visit(user, &renderer->clear_shared);
}

static void destroy_shader(void *gpu, Shader *shader) { shader_destroy(gpu, shader); }

void renderer_release(KrsRenderer *renderer)
{
    renderer_visit(renderer, destroy_shader, &renderer->gpu);
    layouts_destroy(renderer);
}

uint32_t renderer_halvings(const KrsRenderer *renderer)
{
    const uint32_t most = 6;
    return renderer->losses < most ? renderer->losses : most;
}

void krs_renderer_free(KrsRenderer *renderer)
{
    if (!renderer)
        return;
    Gpu *gpu = &renderer->gpu;
    prewarm_end(renderer);
    if (gpu_is_open(gpu)) {
        gpu_wait(gpu);
        renderer_release(renderer);
    }
    const KrsAllocator allocator = gpu->allocator;
    gpu_close(gpu);
    if (renderer->compiler_started)
        spirv_stop();
    allocator_release(&allocator, renderer);
}

const char *krs_renderer_message(const KrsRenderer *renderer)
{
    return renderer ? renderer->gpu.message : "cannot make a renderer: out of memory";
}

void renderer_clear(KrsRenderer *renderer)
{
    renderer->gpu.message[0] = '\0';
    renderer->gpu.status     = KRS_OK;
}

KrsDevice krs_renderer_device(const KrsRenderer *renderer) { return gpu_describe(&renderer->gpu); }

uint64_t krs_renderer_validation_messages(const KrsRenderer *renderer)
{
    return renderer->gpu.validation_messages;
}

bool renderer_create_pixels(KrsRendering *rendering)
{
    ShaderRequest requests[PIXEL_SHADERS];
    const size_t  count = renderer_request_pixels(rendering, requests);
    return shaders_make(rendering->renderer, 0, requests, count, &rendering->spirv_ms,
                        &rendering->pipeline_ms);
}

bool renderer_create_escapes(KrsRenderer *renderer, RayKind kind, double *spirv_ms,
                             double *pipeline_ms)
{
    ShaderRequest requests[2];
    const size_t  count = renderer_request_escapes(renderer, kind, requests);
    return shaders_make(renderer, 0, requests, count, spirv_ms, pipeline_ms);
}

/* Makes a requested shader, unless it exists; NULL with the failure noted. */
static const Shader *make_request(KrsRenderer *renderer, ShaderRequest *request, double *spirv_ms,
                                  double *pipeline_ms)
{
    const bool made = request->shader->pipeline ||
                      shaders_make(renderer, 0, request, 1, spirv_ms, pipeline_ms);
    return made ? request->shader : NULL;
}

/* Returns the same for a shader without a scene. */
static const Shader *make_ready(KrsRenderer *renderer, Shader *shader, const char *file,
                                RayKind kind, double *spirv_ms, double *pipeline_ms)
{
    ShaderRequest request = request_shader(renderer, shader, file, kind);
    return make_request(renderer, &request, spirv_ms, pipeline_ms);
}

const Shader *renderer_limit(KrsRenderer *renderer, RayKind kind, double *spirv_ms,
                             double *pipeline_ms)
{
    return make_ready(renderer, &renderer->limits[kind], "limit.comp", kind, spirv_ms, pipeline_ms);
}

/* Return what begins, or ends, rays of hits: of a camera's rays, or of those of paths as well. */
static ShaderRequest request_aim(KrsRendering *rendering)
{
    const bool    paths   = rendering->program->mirrors;
    KrsRenderer  *r       = rendering->renderer;
    ShaderRequest request = request_shader(r, &r->aims[rendering->rays][paths], "aim.comp",
                                           rendering->rays);
    if (paths)
        request.source.defines = mixed_defines[rendering->rays][variants_reads(&r->gpu)];
    return request;
}

static ShaderRequest request_arrive(KrsRendering *rendering)
{
    const bool    paths   = rendering->program->mirrors;
    KrsRenderer  *r       = rendering->renderer;
    ShaderRequest request = request_shader(r, &r->arrivals[paths], "arrive.comp", RAYS_OF_CAMERAS);
    if (paths)
        request.source.defines = mixed_defines[RAYS_OF_CAMERAS][variants_reads(&r->gpu)];
    return request;
}

size_t renderer_request_lane_rays(KrsRendering *rendering, ShaderRequest *requests)
{
    const ShaderRequest all[2] = {request_aim(rendering), request_arrive(rendering)};
    size_t              count  = 0;
    for (int i = 0; i < 2; i++)
        if (!all[i].shader->pipeline)
            requests[count++] = all[i];
    return count;
}

const Shader *renderer_aim(KrsRendering *rendering)
{
    ShaderRequest request = request_aim(rendering);
    return make_request(rendering->renderer, &request, &rendering->spirv_ms,
                        &rendering->pipeline_ms);
}

const Shader *renderer_arrive(KrsRendering *rendering)
{
    ShaderRequest request = request_arrive(rendering);
    return make_request(rendering->renderer, &request, &rendering->spirv_ms,
                        &rendering->pipeline_ms);
}

const Shader *renderer_noise(KrsRenderer *renderer, double *spirv_ms, double *pipeline_ms)
{
    return make_ready(renderer, &renderer->noise, "noise.comp", RAYS_OF_CAMERAS, spirv_ms,
                      pipeline_ms);
}

const Shader *renderer_plate(KrsRenderer *renderer, double *spirv_ms, double *pipeline_ms)
{
    return make_ready(renderer, &renderer->plate, "plate.comp", RAYS_OF_CAMERAS, spirv_ms,
                      pipeline_ms);
}

const Shader *renderer_escape_of_paths(KrsRendering *rendering)
{
    KrsRenderer  *renderer = rendering->renderer;
    Shader       *shader   = &renderer->escapes_to_plate;
    ShaderRequest request  = {
         shader, {.file = "escape.comp", .defines = plate_defines[variants_reads(&renderer->gpu)]}};
    if (!rendering->catches)
        return &renderer->escapes[RAYS_OF_PATHS];
    return make_request(renderer, &request, &rendering->spirv_ms, &rendering->pipeline_ms);
}
