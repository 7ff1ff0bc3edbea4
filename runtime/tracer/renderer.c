/*
 * renderer.c: making a device, and a scene on it, ready; and taking them down.
 */
#include "runtime/tracer/renderer.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "runtime/tracer/layouts.h"
#include "runtime/tracer/warmup.h"
#include "runtime/tracer/variants.h"

KrsStatus krs_devices(KrsDevice *devices, size_t capacity, size_t *count)
{
    Gpu gpu = {0};
    return gpu_list(&gpu, devices, capacity, count) ? KRS_OK : gpu.status;
}

/* The radius of a zone in which nothing is. */
#define NO_ZONE (-1e30f)

/* ---- The renderer ---- */

static void request_pixels(KrsRenderer *renderer, bool panoramic, KernelRequest *requests)
{
    static const char *const files[PIXEL_KERNELS] = {
        [PIXELS_BACKGROUND] = "background.comp", [PIXELS_UNPROVEN] = "unproven.comp",
        [PIXELS_PENUMBRAE] = "penumbrae.comp",   [PIXELS_SHADOW] = "shadow.comp",
        [PIXELS_OCCLUSION] = "occlusion.comp",
    };
    static const char *const defines[2][2] = {{NO_TEXELS, NULL}, {PANORAMIC NO_TEXELS, PANORAMIC}};
    for (int i = 0; i < PIXEL_KERNELS; i++)
        requests[i] = (KernelRequest){
            &renderer->pixels[panoramic][i],
            {.file = files[i], .defines = defines[panoramic][renderer->gpu.texels]}};
}

KrsStatus krs_renderer_new(const KrsRendererOptions *options, KrsRenderer **out)
{
    Gpu          allocating = {.allocator = options ? options->allocator : (KrsAllocator){0}};
    KrsRenderer *renderer   = gpu_alloc(&allocating, 1, sizeof *renderer, "make a renderer");
    *out                    = renderer;
    if (!renderer)
        return KRS_OUT_OF_MEMORY;
    if (!gpu_open(&renderer->gpu, options))
        return renderer->gpu.status;
    KrsEarlyOuts early_outs = options ? options->early_outs : KRS_EARLY_OUTS_DEFAULT;
    renderer->early_outs    = early_outs == KRS_EARLY_OUTS_DEFAULT ? !gpu_is_cpu(&renderer->gpu)
                                                                   : early_outs == KRS_EARLY_OUTS_ON;
    spirv_start();
    renderer->compiler_started               = true;
    KernelRequest kernels[PIXEL_KERNELS + 1] = {
        [PIXEL_KERNELS] = {&renderer->plan, {.file = "plan.comp"}}};
    request_pixels(renderer, false, kernels);
    const size_t count = PIXEL_KERNELS + (gpu_is_cpu(&renderer->gpu) ? 0 : 1);
    if (!layouts_create(renderer) || !kernels_make(renderer, VK_NULL_HANDLE, kernels, count,
                                                   &renderer->spirv_ms, &renderer->pipeline_ms))
        return renderer->gpu.status;
    return KRS_OK;
}

void krs_renderer_free(KrsRenderer *renderer)
{
    if (!renderer)
        return;
    Gpu *gpu = &renderer->gpu;
    if (gpu->device) {
        gpu_wait(gpu);
        for (int i = 0; i < PIXEL_KERNELS; i++) {
            kernel_destroy(gpu, &renderer->pixels[0][i]);
            kernel_destroy(gpu, &renderer->pixels[1][i]);
        }
        kernel_destroy(gpu, &renderer->plan);
        layouts_destroy(renderer);
    }
    gpu_close(gpu);
    if (renderer->compiler_started)
        spirv_stop();
    Gpu allocating = {.allocator = gpu->allocator};
    gpu_release(&allocating, renderer);
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

KrsDevice krs_renderer_device(const KrsRenderer *renderer)
{
    return gpu_describe(renderer->gpu.physical);
}

uint64_t krs_renderer_complaints(const KrsRenderer *renderer) { return renderer->gpu.complaints; }

/* ---- The rendering ---- */

void rendering_bind(KrsRendering *rendering, VkDescriptorSet set, uint32_t binding,
                    const Buffer *buffer)
{
    layouts_bind(&rendering->renderer->gpu, set, binding, buffer);
}

static bool sets_create(KrsRendering *rendering)
{
    Gpu        *gpu     = &rendering->renderer->gpu;
    const char *attempt = "prepare the scene";
    TRY(gpu, attempt,
        vkCreateDescriptorPool(
            gpu->device,
            &(VkDescriptorPoolCreateInfo){
                .sType         = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                .maxSets       = 3,
                .poolSizeCount = 3,
                .pPoolSizes =
                    (VkDescriptorPoolSize[]){
                        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 3},
                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2 * BUFFER_BINDINGS},
                        {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 2 * TEXEL_BINDINGS},
                    },
            },
            NULL, &rendering->pool));
    VkDescriptorSet sets[3];
    TRY(gpu, attempt,
        vkAllocateDescriptorSets(
            gpu->device,
            &(VkDescriptorSetAllocateInfo){
                .sType              = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                .descriptorPool     = rendering->pool,
                .descriptorSetCount = 3,
                .pSetLayouts        = (VkDescriptorSetLayout[]){rendering->renderer->scene_layout,
                                                                rendering->renderer->frame_layout,
                                                                rendering->renderer->frame_layout},
            },
            sets));
    rendering->scene_set  = sets[0];
    rendering->band_set   = sets[1];
    rendering->points_set = sets[2];
    return true;

failed:
    return false;
}

/* Of the parameter block, aside from values of the frame that kernels may find by themselves. */
static uint32_t slots_without_values(const KrsProgram *program)
{
    return program->parameter_slots + KRS_MOST_ZONES + program->camera_relative_slots + 1;
}

static uint32_t most_slots(const KrsRendering *rendering)
{
    return rendering->renderer->gpu.properties.limits.maxUniformBufferRange / (4 * sizeof(float));
}

uint32_t rendering_value_slots(const KrsRendering *rendering)
{
    const KrsProgram *program = rendering->program;
    uint32_t          slots   = slots_without_values(program) + program->value_slots;
    return program->camera_relative || slots <= most_slots(rendering) ? program->value_slots : 0;
}

static bool buffers_create(KrsRendering *rendering)
{
    Gpu     *gpu   = &rendering->renderer->gpu;
    uint32_t slots = slots_without_values(rendering->program) + rendering_value_slots(rendering);
    if (slots > most_slots(rendering)) {
        gpu_refuse(gpu, KRS_NO_DEVICE, "the device has no room for the scene's %u parameters",
                   rendering->program->parameter_slots);
        return false;
    }
    if (!buffer_create(gpu, &rendering->parameters, (VkDeviceSize)slots * 4 * sizeof(float),
                       UPLOADED, "scene's parameters") ||
        !buffer_create(gpu, &rendering->frame, sizeof(FrameBlock), UPLOADED, "camera") ||
        !buffer_create(gpu, &rendering->control, sizeof(ControlBlock), SHARED, "control block") ||
        (!gpu_is_cpu(gpu) && !buffer_create(gpu, &rendering->device_control, sizeof(ControlBlock),
                                            ON_DEVICE, "control block")))
        return false;
    rendering_bind(rendering, rendering->scene_set, 0, &rendering->parameters);
    rendering_bind(rendering, rendering->band_set, FRAME_BINDING, &rendering->frame);
    rendering_bind(rendering, rendering->band_set, CONTROL_BINDING, rendering_control(rendering));
    return true;
}

/* Where a distance costs less than this, refilling lanes costs more than it gains. */
#define FLOPS_WORTH_REFILL 150
/* For a march group it is more: few of the rays of its tiles meet it. */
#define FLOPS_WORTH_REFILL_OF_GROUP 350

void rendering_choose(const KrsRendering *rendering, KrsTrace *trace, KrsSchedule *schedule)
{
    const Gpu *gpu      = &rendering->renderer->gpu;
    bool       software = gpu_is_cpu(gpu);
    bool       heavy    = rendering->program->flops >= FLOPS_WORTH_REFILL && gpu->refill_lanes > 0;
    if (*trace == KRS_TRACE_DEFAULT)
        *trace = rendering->program->along ? KRS_TRACE_EXACT : KRS_TRACE_AUTO;
    /* What has no thickness is met by roots alone. */
    if (rendering->program->sheets && (*trace < KRS_TRACE_EXACT || *trace >= KRS_TRACE_DIRECTIONAL))
        *trace = KRS_TRACE_EXACT;
    if (*schedule == KRS_SCHEDULE_DEFAULT)
        *schedule = !software ? KRS_SCHEDULE_QUEUE
                    : heavy   ? KRS_SCHEDULE_REFILL
                              : KRS_SCHEDULE_PIXEL;
}

/* Of all loops of an invocation together: some devices end them silently after 65,535 iterations,
   and an item that is begun may be finished. */
#define MOST_ITERATIONS 24576

uint32_t rendering_steps_within(const KrsRendering *rendering, uint32_t wanted)
{
    uint32_t most = MOST_ITERATIONS / (1 + rendering->program->loops);
    return wanted < most ? wanted : most > 0 ? most : 1;
}

KrsSchedule rendering_schedule_of_march_group(const KrsRendering *rendering, KrsSchedule asked,
                                              uint32_t march_group)
{
    KrsTrace trace = KRS_TRACE_DEFAULT;
    bool     cheap = rendering->program->march_groups[march_group - 1].flops <
                 FLOPS_WORTH_REFILL_OF_GROUP;
    if (asked == KRS_SCHEDULE_DEFAULT && cheap && gpu_is_cpu(&rendering->renderer->gpu))
        return KRS_SCHEDULE_PIXEL;
    rendering_choose(rendering, &trace, &asked);
    return asked;
}

/* A queue is the kernel of pixels with fewer steps. */
static KrsSchedule schedule_of_kernel(KrsSchedule schedule)
{
    return schedule == KRS_SCHEDULE_QUEUE ? KRS_SCHEDULE_PIXEL : schedule;
}

/* Zones cut holes into planes. */
bool rendering_knows_planes(const KrsRendering *rendering)
{
    return rendering->program->planes && rendering->current_kernels->zones == 0;
}

/* On devices of type CPU alone: others leave far components out by branches. */
bool rendering_marches_per_component(const KrsRendering *rendering, KrsComponents components)
{
    bool by_default = rendering->program->per_component && gpu_is_cpu(&rendering->renderer->gpu) &&
                      !rendering->renderer->early_outs;
    bool holes = rendering->program->planes && !rendering_knows_planes(rendering);
    return rendering->program->march_group_count > 0 && !rendering->program->along && !holes &&
           !rendering->current_kernels->camera_relative &&
           (components == KRS_COMPONENTS_DEFAULT ? by_default : components == KRS_COMPONENTS_APART);
}

bool rendering_goes_along(const KrsRendering *rendering, KrsTrace trace)
{
    bool known = trace >= KRS_TRACE_DIRECTIONAL ? rendering->program->inverts
                                                : rendering->program->along;
    return trace >= KRS_TRACE_EXACT && known && !rendering->current_kernels->camera_relative;
}

bool rendering_marches_packed(const KrsRendering *rendering, KrsComponents components,
                              KrsTrace trace)
{
    bool by_default = rendering->program->expensive >= 2 && !gpu_is_cpu(&rendering->renderer->gpu);
    return rendering->program->scene_parts >= 2 && !rendering_goes_along(rendering, trace) &&
           (components == KRS_COMPONENTS_DEFAULT ? by_default
                                                 : components == KRS_COMPONENTS_PACKED);
}

static Kernel *find_kernel(KrsRendering *rendering, Kernel *kernel, const char *file,
                           KernelVariant variant)
{
    KernelRequest request = {kernel, variant_source(file, &variant)};
    if (!kernel->pipeline && !kernels_make(rendering->renderer, rendering->scene_set, &request, 1,
                                           &rendering->spirv_ms, &rendering->pipeline_ms))
        return NULL;
    return kernel;
}

Kernel *rendering_trace(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                        uint32_t march_group)
{
    schedule = schedule_of_kernel(schedule);
    return find_kernel(rendering, &rendering->current_kernels->trace[trace][schedule][march_group],
                       "trace.comp", variant_of_trace(rendering, trace, schedule, march_group));
}

Kernel *rendering_beams(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                        uint32_t march_group)
{
    return rendering_trace(rendering, trace >= KRS_TRACE_EXACT ? KRS_TRACE_PLAIN : trace, schedule,
                           march_group);
}

KrsNormals rendering_normals(const KrsRendering *rendering, KrsNormals normals)
{
    if (rendering->program->sheets)
        return KRS_NORMALS_ANALYTIC; /* differences see both sides of a sheet */
    if (normals != KRS_NORMALS_DEFAULT)
        return normals;
    return rendering->program->algebraic ? KRS_NORMALS_ANALYTIC : KRS_NORMALS_OCTAHEDRON;
}

bool rendering_has_roots(const KrsRendering *rendering, KrsTrace trace)
{
    return (trace == KRS_TRACE_EXACT || rendering->program->sheets) && rendering->program->along &&
           !rendering->current_kernels->camera_relative;
}

Kernel *rendering_secondary(KrsRendering *rendering, KrsSchedule schedule, bool by_roots)
{
    schedule       = schedule_of_kernel(schedule);
    KrsTrace trace = by_roots ? KRS_TRACE_EXACT : KRS_TRACE_PLAIN;
    return find_kernel(rendering, &rendering->current_kernels->secondary[schedule][by_roots],
                       "secondary.comp", variant_of_secondary(rendering, trace, schedule));
}

Kernel *rendering_normals_kernel(KrsRendering *rendering, KrsNormals normals, uint32_t march_group)
{
    normals = rendering_normals(rendering, normals);
    return find_kernel(rendering, &rendering->current_kernels->normals[normals][march_group],
                       "normals.comp", variant_of_normals(rendering, normals, march_group));
}

static KrsTrace trace_of_questions(const KrsRendering *rendering)
{
    return rendering->program->sheets ? KRS_TRACE_EXACT : KRS_TRACE_AUTO;
}

Kernel *rendering_query(KrsRendering *rendering, KrsSchedule schedule)
{
    schedule = schedule_of_kernel(schedule);
    return find_kernel(rendering, &rendering->current_kernels->query[schedule], "query.comp",
                       variant_of_query(rendering, trace_of_questions(rendering), schedule));
}

Kernel *rendering_shade(KrsRendering *rendering)
{
    return find_kernel(rendering, &rendering->current_kernels->shade, "shade.comp",
                       variant_of_shade(rendering));
}

Kernel *rendering_point_query(KrsRendering *rendering)
{
    return find_kernel(rendering, &rendering->current_kernels->point_query, "point_query.comp",
                       variant_of_point_query(rendering));
}

/* The renderer's kernels for panoramas. */
static bool panoramic_create(KrsRendering *rendering)
{
    KrsRenderer  *renderer = rendering->renderer;
    KernelRequest kernels[PIXEL_KERNELS];
    request_pixels(renderer, true, kernels);
    return !rendering->panoramic || renderer->pixels[1][0].pipeline ||
           kernels_make(renderer, VK_NULL_HANDLE, kernels, PIXEL_KERNELS, &rendering->spirv_ms,
                        &rendering->pipeline_ms);
}

/* Kernels of the scene that are made at the same time. */
typedef struct Requests {
    KernelRequest items[5 + 2 * KRS_MOST_MARCH_GROUPS];
    KernelVariant variants[5 + 2 * KRS_MOST_MARCH_GROUPS];
    size_t        count;
} Requests;

static void request(Requests *requests, Kernel *kernel, const char *file, KernelVariant variant)
{
    KernelVariant *kept                = &requests->variants[requests->count];
    *kept                              = variant;
    requests->items[requests->count++] = (KernelRequest){kernel, variant_source(file, kept)};
}

/* Where march groups follow one another each of them has its own kernel of rays and of normals. */
static void request_marches(Requests *requests, KrsRendering *rendering, KrsTrace trace,
                            KrsSchedule schedule)
{
    SceneKernels *to       = rendering->current_kernels;
    KrsNormals    usual    = rendering_normals(rendering, KRS_NORMALS_DEFAULT);
    bool     per_component = rendering_marches_per_component(rendering, KRS_COMPONENTS_DEFAULT);
    bool     packed        = rendering_marches_packed(rendering, KRS_COMPONENTS_DEFAULT, trace);
    uint32_t whole         = packed                              ? MARCH_PACKED
                             : rendering_knows_planes(rendering) ? MARCH_WITHOUT_PLANES
                                                                 : 0;
    if (trace == KRS_TRACE_EXACT)
        request(requests, &to->trace[KRS_TRACE_PLAIN][schedule][whole], "trace.comp",
                variant_of_trace(rendering, KRS_TRACE_PLAIN, schedule, whole));
    if (!per_component)
        request(requests, &to->trace[trace][schedule][whole], "trace.comp",
                variant_of_trace(rendering, trace, schedule, whole));
    for (uint32_t march_group = 1;
         per_component && march_group <= rendering->program->march_group_count; march_group++) {
        KrsSchedule own = schedule_of_kernel(
            rendering_schedule_of_march_group(rendering, KRS_SCHEDULE_DEFAULT, march_group));
        request(requests, &to->trace[trace][own][march_group], "trace.comp",
                variant_of_trace(rendering, trace, own, march_group));
        request(requests, &to->normals[usual][march_group], "normals.comp",
                variant_of_normals(rendering, usual, march_group));
    }
}

static void request_pictures(Requests *requests, KrsRendering *rendering, KrsTrace trace,
                             KrsSchedule schedule)
{
    SceneKernels *to    = rendering->current_kernels;
    KrsNormals    usual = rendering_normals(rendering, KRS_NORMALS_DEFAULT);
    request(requests, &to->normals[usual][0], "normals.comp",
            variant_of_normals(rendering, usual, 0));
    request(requests, &to->shade, "shade.comp", variant_of_shade(rendering));
    bool     by_roots = rendering_has_roots(rendering, trace);
    KrsTrace along    = by_roots ? KRS_TRACE_EXACT : KRS_TRACE_PLAIN;
    request(requests, &to->secondary[schedule][by_roots], "secondary.comp",
            variant_of_secondary(rendering, along, schedule));
    request_marches(requests, rendering, trace, schedule);
}

/* Those that a picture by default, or questions, need. */
static bool kernels_create(KrsRendering *rendering, KrsPurpose purpose)
{
    SceneKernels *to       = rendering->current_kernels;
    KrsTrace      trace    = KRS_TRACE_DEFAULT;
    KrsSchedule   schedule = KRS_SCHEDULE_DEFAULT;
    Requests      requests = {.count = 0};
    rendering_choose(rendering, &trace, &schedule);
    schedule = schedule_of_kernel(schedule);
    if (purpose == KRS_FOR_PICTURES) {
        request_pictures(&requests, rendering, trace, schedule);
    } else {
        request(&requests, &to->query[schedule], "query.comp",
                variant_of_query(rendering, trace_of_questions(rendering), schedule));
        request(&requests, &to->point_query, "point_query.comp", variant_of_point_query(rendering));
    }
    return kernels_make(rendering->renderer, rendering->scene_set, requests.items, requests.count,
                        &rendering->spirv_ms, &rendering->pipeline_ms);
}

static void kernels_destroy(Gpu *gpu, SceneKernels *kernels)
{
    kernel_destroy(gpu, &kernels->shade);
    kernel_destroy(gpu, &kernels->point_query);
    for (int normals = 0; normals < KRS_NORMALS_COUNT; normals++)
        for (uint32_t march_group = 0; march_group <= KRS_MOST_MARCH_GROUPS; march_group++)
            kernel_destroy(gpu, &kernels->normals[normals][march_group]);
    for (int schedule = 0; schedule < KRS_SCHEDULE_COUNT; schedule++) {
        kernel_destroy(gpu, &kernels->query[schedule]);
        for (int by_roots = 0; by_roots < 2; by_roots++)
            kernel_destroy(gpu, &kernels->secondary[schedule][by_roots]);
        for (int trace = 0; trace < KRS_TRACE_COUNT; trace++)
            for (uint32_t march_group = 0; march_group < MARCH_KINDS; march_group++)
                kernel_destroy(gpu, &kernels->trace[trace][schedule][march_group]);
    }
    *kernels = (SceneKernels){0};
}

/* What a kernel with the scene does for an item before it may be interrupted, in distances, about;
   without the scene it does as much as some operations. */
static const double distances_of_item[KRS_PHASE_COUNT] = {
    [KRS_PHASE_BEAMS] = 64,   [KRS_PHASE_PRIMARY] = 16,  [KRS_PHASE_NORMALS] = 7,
    [KRS_PHASE_SHADOWS] = 64, [KRS_PHASE_OCCLUSION] = 5, [KRS_PHASE_SHADING] = 4,
    [KRS_PHASE_RESOLVE] = 1,
};
#define FLOPS_WITHOUT_SCENE 1000

/* The first slice, in groups: 50 ms on a slow device of its kind, until more is known.  A processor
   is interrupted at every look of its driver, so there it may be short. */
static uint32_t guess_slice(const KrsRendering *rendering, int phase, bool has_scene)
{
    static const double slow[] = {
        /* flops of 50 ms, where a tenth of what is promised is reached */
        [KRS_DEVICE_OTHER] = 5e8,      [KRS_DEVICE_CPU] = 5e8,       [KRS_DEVICE_VIRTUAL] = 5e8,
        [KRS_DEVICE_INTEGRATED] = 1e9, [KRS_DEVICE_DISCRETE] = 1e10,
    };
    const Gpu *gpu    = &rendering->renderer->gpu;
    double     flops  = has_scene ? rendering->program->flops * distances_of_item[phase]
                                  : FLOPS_WITHOUT_SCENE;
    double     groups = slow[gpu_describe(gpu->physical).kind] / (64 * fmax(flops, 1));
    return gpu_is_cpu(gpu) ? 8 : (uint32_t)fmin(fmax(groups, 1), MOST_GROUPS);
}

KrsStatus krs_rendering_new(KrsRenderer *renderer, const KrsScene *scene, KrsRendering **out)
{
    return krs_rendering_new_for(renderer, scene, KRS_FOR_PICTURES, out);
}

KrsStatus krs_rendering_new_for(KrsRenderer *renderer, const KrsScene *scene, KrsPurpose purpose,
                                KrsRendering **out)
{
    *out = NULL;
    renderer_clear(renderer);
    KrsRendering *rendering = gpu_alloc(&renderer->gpu, 1, sizeof *rendering, "prepare the scene");
    if (!rendering)
        return renderer->gpu.status;
    rendering->renderer        = renderer;
    rendering->scene           = scene;
    rendering->program         = krs_scene_program(scene);
    rendering->current_kernels = &rendering->kernels;
    rendering->purpose         = purpose;
    rendering->panoramic       = krs_scene_is_panoramic(scene);
    rendering->spirv_ms        = renderer->spirv_ms;
    rendering->pipeline_ms     = renderer->pipeline_ms;
    for (int phase = 0; phase < KRS_PHASE_COUNT; phase++)
        for (int has_scene = 0; has_scene < 2; has_scene++)
            rendering->groups_at_once[phase][has_scene] = guess_slice(rendering, phase, has_scene);
    if (!sets_create(rendering) || !buffers_create(rendering) || !panoramic_create(rendering) ||
        !kernels_create(rendering, purpose)) {
        KrsStatus status = renderer->gpu.status;
        krs_rendering_free(rendering);
        return status;
    }
    *out = rendering;
    return KRS_OK;
}

void krs_rendering_free(KrsRendering *rendering)
{
    if (!rendering)
        return;
    Gpu    *gpu       = &rendering->renderer->gpu;
    Band   *band      = &rendering->band;
    Buffer *buffers[] = {&rendering->parameters,
                         &rendering->frame,
                         &rendering->control,
                         &rendering->device_control,
                         &rendering->lights,
                         &rendering->points,
                         &rendering->answers,
                         &rendering->query_rays,
                         &rendering->ray_hits,
                         &rendering->taken,
                         &band->ends,
                         &band->hits,
                         &band->results,
                         &band->fetched,
                         &band->queue,
                         &band->taken,
                         &band->tiles};
    gpu_wait(gpu); /* kernels may still be warmed up; a device that is lost has none */
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        buffer_destroy(gpu, buffers[i]);
    kernels_destroy(gpu, &rendering->kernels);
    kernels_destroy(gpu, &rendering->zoned);
    kernels_destroy(gpu, &rendering->camera_relative);
    if (!gpu->stuck)
        vkDestroyDescriptorPool(gpu->device, rendering->pool, NULL);
    gpu_release(gpu, rendering);
}

bool rendering_set_lights(KrsRendering *rendering, const KrsLight *lights, size_t count,
                          const double rebase_origin[3])
{
    Gpu    *gpu    = &rendering->renderer->gpu;
    Buffer *buffer = &rendering->lights;
    /* Kernels load as many at once, and those beyond the last as well. */
    VkDeviceSize bytes = buffer_texel_bytes((count + LIGHTS_AT_ONCE) * sizeof(LightBlock));
    if (buffer->size < bytes) {
        buffer_destroy(gpu, buffer);
        if (!buffer_create(gpu, buffer, bytes, UPLOADED, "lights") ||
            !layouts_view_texels(gpu, LIGHTS_BINDING, buffer, "lights"))
            return false;
        rendering_bind(rendering, rendering->band_set,
                       gpu->texels ? LIGHTS_BINDING : LIGHT_ROWS_BINDING, buffer);
    }
    LightBlock *blocks = buffer->bytes;
    for (size_t i = 0; i < count; i++) {
        const KrsLight *light = &lights[i];
        blocks[i].kind        = (light->positional ? LIGHT_POSITIONAL : 0) |
                         (light->shadow ? LIGHT_CASTS_SHADOWS : 0);
        blocks[i].softness = (float)light->softness;
        for (int k = 0; k < 3; k++) {
            blocks[i].vector[k] = (float)(light->vector[k] -
                                          (light->positional ? rebase_origin[k] : 0));
            blocks[i].color[k]  = (float)light->color[k];
        }
    }
    return true;
}

/* Kernels with room for so many zones: 1, 2, 4, 8 or 16; those that have more room stay. */
static bool choose_zones(KrsRendering *rendering, size_t count)
{
    Gpu          *gpu          = &rendering->renderer->gpu;
    SceneKernels *zoned        = &rendering->zoned;
    rendering->current_kernels = count > 0 ? zoned : &rendering->kernels;
    if (count <= zoned->zones)
        return true;
    if (!gpu_wait(gpu)) /* the old ones may still be warmed up */
        return false;
    kernels_destroy(gpu, zoned);
    for (zoned->zones = 1; zoned->zones < count;)
        zoned->zones *= 2;
    return kernels_create(rendering, rendering->purpose);
}

bool rendering_set_parameters(KrsRendering *rendering, const KrsFrame *frame)
{
    /* Into memory of the host first: the compiler may read back what it writes. */
    Gpu   *gpu         = &rendering->renderer->gpu;
    size_t first_value = rendering->program->parameter_slots;
    size_t values = rendering_value_slots(rendering), slots = first_value + values;
    float(*block)[4] = gpu_alloc(gpu, slots + KRS_MOST_ZONES, sizeof *block,
                                 "set the scene's parameters");
    if (!block)
        return false;
    krs_frame_parameters(frame, block);
    if (values > 0)
        krs_frame_values(frame, block + first_value);
    size_t zones = krs_frame_zones(frame, block + slots);
    for (size_t i = zones; i < KRS_MOST_ZONES; i++)
        block[slots + i][3] = NO_ZONE;
    memcpy(rendering->parameters.bytes, block, (slots + KRS_MOST_ZONES) * sizeof *block);
    gpu_release(gpu, block);
    return choose_zones(rendering, zones);
}

bool rendering_rebase(KrsRendering *rendering, KrsFrame *frame, const double rebase_origin[3])
{
    Gpu   *gpu   = &rendering->renderer->gpu;
    size_t first = rendering->program->parameter_slots + rendering->program->value_slots +
                   KRS_MOST_ZONES;
    size_t slots     = rendering->program->camera_relative_slots;
    float(*block)[4] = gpu_alloc(gpu, slots + 1, sizeof *block,
                                 "move the scene's origin to the camera");
    if (!block)
        return false;
    krs_frame_rebase(frame, rebase_origin, block);
    memcpy((char *)rendering->parameters.bytes + first * sizeof *block, block,
           slots * sizeof *block);
    gpu_release(gpu, block);
    rendering->current_kernels                  = &rendering->camera_relative;
    rendering->current_kernels->camera_relative = true;
    return true;
}

uint32_t rendering_spread(const KrsRendering *rendering, uint32_t count)
{
    if (!gpu_is_cpu(&rendering->renderer->gpu) || count < 3)
        return 1;
    for (uint32_t step = (uint32_t)(0.618 * count);; step++) {
        uint32_t a = count, b = step;
        while (b != 0) {
            uint32_t rest = a % b;
            a             = b;
            b             = rest;
        }
        if (a == 1)
            return step;
    }
}

const Buffer *rendering_control(const KrsRendering *rendering)
{
    return rendering->device_control.buffer ? &rendering->device_control : &rendering->control;
}

bool rendering_begin(KrsRendering *rendering)
{
    Gpu *gpu = &rendering->renderer->gpu;
    if (!gpu_begin(gpu))
        return false;
    if (rendering->device_control.buffer) {
        vkCmdCopyBuffer(gpu->commands, rendering->control.buffer, rendering->device_control.buffer,
                        1, &(VkBufferCopy){0, 0, sizeof(ControlBlock)});
        gpu_barrier(gpu);
    }
    return true;
}

bool rendering_finish(KrsRendering *rendering, double *ms)
{
    Gpu               *gpu      = &rendering->renderer->gpu;
    const VkDeviceSize counters = offsetof(ControlBlock, queued);
    if (rendering->device_control.buffer) {
        gpu_barrier(gpu);
        vkCmdCopyBuffer(gpu->commands, rendering->device_control.buffer, rendering->control.buffer,
                        1, &(VkBufferCopy){counters, counters, sizeof(ControlBlock) - counters});
    }
    return gpu_finish(gpu, ms);
}

static void bind_kernel(KrsRendering *rendering, const Kernel *kernel, VkDescriptorSet set,
                        const void *work, uint32_t work_bytes)
{
    VkCommandBuffer  commands = rendering->renderer->gpu.commands;
    VkPipelineLayout layout   = rendering->renderer->layout;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 2,
                            (VkDescriptorSet[]){rendering->scene_set, set}, 0, NULL);
    vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, work_bytes, work);
}

void rendering_dispatch(KrsRendering *rendering, const Kernel *kernel, VkDescriptorSet set,
                        const void *work, uint32_t work_bytes, uint32_t groups)
{
    bind_kernel(rendering, kernel, set, work, work_bytes);
    vkCmdDispatch(rendering->renderer->gpu.commands, groups, 1, 1);
}

void rendering_dispatch_counted(KrsRendering *rendering, const Kernel *kernel, VkDescriptorSet set,
                                const void *work, uint32_t work_bytes)
{
    bind_kernel(rendering, kernel, set, work, work_bytes);
    vkCmdDispatchIndirect(rendering->renderer->gpu.commands, rendering_control(rendering)->buffer,
                          offsetof(ControlBlock, groups));
}
