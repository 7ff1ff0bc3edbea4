/*
 * renderer.c: making a device, and a scene on it, ready; and taking them down.
 */
#include "runtime/tracer/renderer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bindings of set 1; those in between are the buffers of a band. */
enum { FRAME_BINDING = 0, CONTROL_BINDING = 4, LIGHTS_BINDING = 8, BINDING_COUNT = 10 };

KrsStatus krs_devices(KrsDevice *devices, size_t capacity, size_t *count)
{
    Gpu gpu = {0};
    return gpu_list(&gpu, devices, capacity, count) ? KRS_OK : gpu.status;
}

/* ---- The renderer ---- */

static bool set_layout_create(Gpu *gpu, uint32_t count, VkDescriptorSetLayout *layout)
{
    VkDescriptorSetLayoutBinding bindings[BINDING_COUNT];
    for (uint32_t i = 0; i < count; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = i == FRAME_BINDING ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                                                 : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
        };
    VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = count,
        .pBindings = bindings,
    };
    TRY(gpu, "prepare the renderer",
        vkCreateDescriptorSetLayout(gpu->device, &info, NULL, layout));
    return true;

failed:
    return false;
}

static bool layouts_create(KrsRenderer *renderer)
{
    Gpu *gpu = &renderer->gpu;
    if (!set_layout_create(gpu, 1, &renderer->scene_layout) ||
        !set_layout_create(gpu, BINDING_COUNT, &renderer->frame_layout))
        return false;
    VkPushConstantRange        work = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(WorkBlock)};
    VkPipelineLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 2,
        .pSetLayouts = (VkDescriptorSetLayout[]){renderer->scene_layout, renderer->frame_layout},
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &work,
    };
    TRY(gpu, "prepare the renderer",
        vkCreatePipelineLayout(gpu->device, &info, NULL, &renderer->layout));
    return true;

failed:
    return false;
}

/* ---- Rehearsals ---- */

static void bind(Gpu *gpu, VkDescriptorSet set, uint32_t binding, const Buffer *buffer)
{
    vkUpdateDescriptorSets(gpu->device, 1, &(VkWriteDescriptorSet){
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
        .dstSet = set,
        .dstBinding = binding,
        .descriptorCount = 1,
        .descriptorType = binding == FRAME_BINDING ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                                                   : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        .pBufferInfo = &(VkDescriptorBufferInfo){buffer->buffer, 0, buffer->size},
    }, 0, NULL);
}

/* A set of buffers that hold zeros: no kernel finds any item in them. */
static bool idle_create(KrsRenderer *renderer)
{
    Gpu        *gpu = &renderer->gpu;
    const char *attempt = "prepare the renderer";
    enum { IDLE_BYTES = 4096 };
    if (!buffer_create(gpu, &renderer->idle, IDLE_BYTES, SHARED, "rehearsals"))
        return false;
    memset(renderer->idle.bytes, 0, IDLE_BYTES);
    TRY(gpu, attempt, vkCreateDescriptorPool(gpu->device, &(VkDescriptorPoolCreateInfo){
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = 1,
        .poolSizeCount = 2,
        .pPoolSizes = (VkDescriptorPoolSize[]){
            {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BINDING_COUNT - 1},
        },
    }, NULL, &renderer->idle_pool));
    TRY(gpu, attempt, vkAllocateDescriptorSets(gpu->device, &(VkDescriptorSetAllocateInfo){
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = renderer->idle_pool,
        .descriptorSetCount = 1,
        .pSetLayouts = &renderer->frame_layout,
    }, &renderer->idle_set));
    for (uint32_t binding = 0; binding < BINDING_COUNT; binding++)
        bind(gpu, renderer->idle_set, binding, &renderer->idle);
    return true;

failed:
    return false;
}

/* Makes kernels and sends them through the driver once, in the background. */
static bool make_kernels(KrsRenderer *renderer, VkDescriptorSet scene_set,
                         const KernelRequest *requests, size_t count, double *spirv_ms,
                         double *pipeline_ms)
{
    const VkDescriptorSet sets[2] = {scene_set, renderer->idle_set};
    const WorkBlock       work = {.groups = 1, .stride = 1};
    if (!kernel_create_all(&renderer->gpu, requests, count, renderer->layout, spirv_ms,
                           pipeline_ms))
        return false;
    for (size_t i = 0; i < count; i++)
        if (!gpu_rehearse(&renderer->gpu, requests[i].kernel->pipeline, renderer->layout, sets,
                          &work, sizeof work))
            return false;
    return true;
}

KrsStatus krs_renderer_new(const KrsRendererOptions *options, KrsRenderer **out)
{
    Gpu allocating = {.allocator = options ? options->allocator : (KrsAllocator){0}};
    KrsRenderer *renderer = gpu_alloc(&allocating, 1, sizeof *renderer, "make a renderer");
    *out = renderer;
    if (!renderer)
        return KRS_OUT_OF_MEMORY;
    if (!gpu_open(&renderer->gpu, options))
        return renderer->gpu.status;
    spirv_start();
    renderer->compiler_started = true;
    const KernelRequest kernels[] = {
        {&renderer->background, {.file = "background.comp"}},
        {&renderer->fill, {.file = "fill.comp"}},
        {&renderer->shade, {.file = "shade.comp"}},
    };
    if (!layouts_create(renderer) || !idle_create(renderer) ||
        !make_kernels(renderer, VK_NULL_HANDLE, kernels, sizeof kernels / sizeof kernels[0],
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
        kernel_destroy(gpu, &renderer->background);
        kernel_destroy(gpu, &renderer->fill);
        kernel_destroy(gpu, &renderer->shade);
        vkDestroyDescriptorPool(gpu->device, renderer->idle_pool, NULL);
        buffer_destroy(gpu, &renderer->idle);
        vkDestroyPipelineLayout(gpu->device, renderer->layout, NULL);
        vkDestroyDescriptorSetLayout(gpu->device, renderer->frame_layout, NULL);
        vkDestroyDescriptorSetLayout(gpu->device, renderer->scene_layout, NULL);
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
    renderer->gpu.status = KRS_OK;
}

KrsDevice krs_renderer_device(const KrsRenderer *renderer)
{
    return gpu_describe(renderer->gpu.physical);
}

uint64_t krs_renderer_complaints(const KrsRenderer *renderer)
{
    return renderer->gpu.complaints;
}

/* ---- The rendering ---- */

void rendering_bind(KrsRendering *rendering, VkDescriptorSet set, uint32_t binding,
                    const Buffer *buffer)
{
    bind(&rendering->renderer->gpu, set, binding, buffer);
}

static bool sets_create(KrsRendering *rendering)
{
    Gpu        *gpu = &rendering->renderer->gpu;
    const char *attempt = "prepare the scene";
    TRY(gpu, attempt, vkCreateDescriptorPool(gpu->device, &(VkDescriptorPoolCreateInfo){
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = 3,
        .poolSizeCount = 2,
        .pPoolSizes = (VkDescriptorPoolSize[]){
            {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 3},
            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2 * (BINDING_COUNT - 1)},
        },
    }, NULL, &rendering->pool));
    VkDescriptorSet sets[3];
    TRY(gpu, attempt, vkAllocateDescriptorSets(gpu->device, &(VkDescriptorSetAllocateInfo){
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = rendering->pool,
        .descriptorSetCount = 3,
        .pSetLayouts = (VkDescriptorSetLayout[]){rendering->renderer->scene_layout,
                                                 rendering->renderer->frame_layout,
                                                 rendering->renderer->frame_layout},
    }, sets));
    rendering->scene_set = sets[0];
    rendering->band_set = sets[1];
    rendering->points_set = sets[2];
    return true;

failed:
    return false;
}

static bool buffers_create(KrsRendering *rendering)
{
    Gpu     *gpu = &rendering->renderer->gpu;
    uint32_t slots = rendering->program->parameter_slots;
    if (slots > gpu->properties.limits.maxUniformBufferRange / (4 * sizeof(float))) {
        gpu_refuse(gpu, KRS_NO_DEVICE, "the device has no room for the scene's %u parameters",
                   slots);
        return false;
    }
    if (!buffer_create(gpu, &rendering->parameters, (VkDeviceSize)slots * 4 * sizeof(float), SHARED,
                       "scene's parameters") ||
        !buffer_create(gpu, &rendering->frame, sizeof(FrameBlock), SHARED, "camera") ||
        !buffer_create(gpu, &rendering->control, sizeof(ControlBlock), SHARED, "control block"))
        return false;
    rendering_bind(rendering, rendering->scene_set, 0, &rendering->parameters);
    rendering_bind(rendering, rendering->band_set, FRAME_BINDING, &rendering->frame);
    rendering_bind(rendering, rendering->band_set, CONTROL_BINDING, &rendering->control);
    return true;
}

/* Where a distance costs less than this, dealing items out to lanes costs more than it gains. */
#define FLOPS_WORTH_REFILL 150

void rendering_choose(const KrsRendering *rendering, KrsTrace *trace, KrsSchedule *schedule)
{
    const Gpu *gpu = &rendering->renderer->gpu;
    bool       software = gpu_is_cpu(gpu);
    bool       heavy = rendering->program->flops >= FLOPS_WORTH_REFILL && gpu->votes;
    if (*trace == KRS_TRACE_DEFAULT)
        *trace = KRS_TRACE_AUTO;
    if (*schedule == KRS_SCHEDULE_DEFAULT)
        *schedule = !software ? KRS_SCHEDULE_QUEUE
                  : heavy     ? KRS_SCHEDULE_REFILL
                              : KRS_SCHEDULE_PIXEL;
}

/* A queue is the kernel of pixels with fewer steps. */
static KrsSchedule schedule_of_kernel(KrsSchedule schedule)
{
    return schedule == KRS_SCHEDULE_QUEUE ? KRS_SCHEDULE_PIXEL : schedule;
}

typedef struct Variant {
    char defines[64];
} Variant;

static Variant name_variant(KrsTrace trace, KrsSchedule schedule)
{
    Variant variant;
    snprintf(variant.defines, sizeof variant.defines, "#define TRACE %du\n#define REFILL %d\n",
             (int)trace, schedule == KRS_SCHEDULE_REFILL);
    return variant;
}

static Kernel *find_variant(KrsRendering *rendering, Kernel *kernel, const char *file,
                            KrsTrace trace, KrsSchedule schedule)
{
    Variant       variant = name_variant(trace, schedule);
    KernelRequest request = {kernel, {file, rendering->program->glsl, variant.defines}};
    if (!kernel->pipeline &&
        !make_kernels(rendering->renderer, rendering->scene_set, &request, 1,
                      &rendering->spirv_ms, &rendering->pipeline_ms))
        return NULL;
    return kernel;
}

Kernel *rendering_trace(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule)
{
    schedule = schedule_of_kernel(schedule);
    return find_variant(rendering, &rendering->trace[trace][schedule], "trace.comp", trace,
                        schedule);
}

Kernel *rendering_secondary(KrsRendering *rendering, KrsSchedule schedule)
{
    schedule = schedule_of_kernel(schedule);
    return find_variant(rendering, &rendering->secondary[schedule], "secondary.comp",
                        KRS_TRACE_PLAIN, schedule);
}

/* Those that a picture by default needs. */
static bool kernels_create(KrsRendering *rendering)
{
    const char *scene = rendering->program->glsl;
    KrsTrace    trace = KRS_TRACE_DEFAULT;
    KrsSchedule schedule = KRS_SCHEDULE_DEFAULT;
    rendering_choose(rendering, &trace, &schedule);
    schedule = schedule_of_kernel(schedule);
    Variant       primary = name_variant(trace, schedule);
    Variant       plain = name_variant(KRS_TRACE_PLAIN, schedule);
    KernelRequest kernels[] = {
        {&rendering->trace[trace][schedule], {"trace.comp", scene, primary.defines}},
        {&rendering->secondary[schedule], {"secondary.comp", scene, plain.defines}},
        {&rendering->material, {"material.comp", scene, NULL}},
    };
    return make_kernels(rendering->renderer, rendering->scene_set, kernels,
                        sizeof kernels / sizeof kernels[0], &rendering->spirv_ms,
                        &rendering->pipeline_ms);
}

KrsStatus krs_rendering_new(KrsRenderer *renderer, const KrsScene *scene, KrsRendering **out)
{
    *out = NULL;
    renderer_clear(renderer);
    KrsRendering *rendering = gpu_alloc(&renderer->gpu, 1, sizeof *rendering, "prepare the scene");
    if (!rendering)
        return renderer->gpu.status;
    rendering->renderer = renderer;
    rendering->scene = scene;
    rendering->program = krs_scene_program(scene);
    rendering->spirv_ms = renderer->spirv_ms;
    rendering->pipeline_ms = renderer->pipeline_ms;
    for (int i = 0; i < 2 * KRS_PHASE_COUNT; i++)
        rendering->groups_at_once[i / 2][i % 2] = gpu_is_cpu(&renderer->gpu) ? 8 : 1024;
    if (!sets_create(rendering) || !buffers_create(rendering) || !kernels_create(rendering)) {
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
    Gpu    *gpu = &rendering->renderer->gpu;
    Band   *band = &rendering->band;
    Buffer *buffers[] = {&rendering->parameters, &rendering->frame, &rendering->control,
                         &rendering->lights, &rendering->points, &rendering->answers,
                         &band->ends, &band->fates, &band->hits, &band->results, &band->fetched,
                         &band->queue, &band->taken, &band->tiles};
    gpu_wait(gpu); /* rehearsals may still run; a device that is lost has none */
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        buffer_destroy(gpu, buffers[i]);
    kernel_destroy(gpu, &rendering->material);
    kernel_destroy(gpu, &rendering->sample);
    for (int schedule = 0; schedule < KRS_SCHEDULE_COUNT; schedule++) {
        kernel_destroy(gpu, &rendering->secondary[schedule]);
        for (int trace = 0; trace < KRS_TRACE_COUNT; trace++)
            kernel_destroy(gpu, &rendering->trace[trace][schedule]);
    }
    vkDestroyDescriptorPool(gpu->device, rendering->pool, NULL);
    gpu_release(gpu, rendering);
}

bool rendering_set_lights(KrsRendering *rendering, const KrsLight *lights, size_t count)
{
    Gpu         *gpu = &rendering->renderer->gpu;
    Buffer      *buffer = &rendering->lights;
    VkDeviceSize bytes = (count > 0 ? count : 1) * sizeof(LightBlock);
    if (buffer->size < bytes) {
        buffer_destroy(gpu, buffer);
        if (!buffer_create(gpu, buffer, bytes, SHARED, "lights"))
            return false;
        rendering_bind(rendering, rendering->band_set, LIGHTS_BINDING, buffer);
    }
    LightBlock *blocks = buffer->bytes;
    for (size_t i = 0; i < count; i++) {
        const KrsLight *light = &lights[i];
        blocks[i].kind = (light->positional ? LIGHT_POSITIONAL : 0) |
                         (light->shadow ? LIGHT_CASTS_SHADOWS : 0);
        blocks[i].softness = (float)light->softness;
        for (int k = 0; k < 3; k++) {
            blocks[i].vector[k] = (float)light->vector[k];
            blocks[i].color[k] = (float)light->color[k];
        }
    }
    return true;
}

bool rendering_set_parameters(KrsRendering *rendering, const KrsFrame *frame)
{
    /* Into memory of the host first: the compiler may read back what it writes. */
    Gpu   *gpu = &rendering->renderer->gpu;
    size_t slots = rendering->program->parameter_slots;
    float (*block)[4] = gpu_alloc(gpu, slots, sizeof *block, "set the scene's parameters");
    if (!block)
        return false;
    krs_frame_parameters(frame, block);
    memcpy(rendering->parameters.bytes, block, slots * sizeof *block);
    gpu_release(gpu, block);
    return true;
}

void rendering_dispatch(KrsRendering *rendering, const Kernel *kernel, VkDescriptorSet set,
                        const void *work, uint32_t work_bytes, uint32_t groups)
{
    VkCommandBuffer  commands = rendering->renderer->gpu.commands;
    VkPipelineLayout layout = rendering->renderer->layout;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 2,
                            (VkDescriptorSet[]){rendering->scene_set, set}, 0, NULL);
    vkCmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, work_bytes, work);
    vkCmdDispatch(commands, groups, 1, 1);
}
