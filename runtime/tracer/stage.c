/*
 * stage.c: layouts, idle sets, and kernels that have run once before they are needed.
 *
 * lavapipe compiles a kernel when it first runs, one after the other, and keeps what it has
 * compiled on disk.  So a rehearsal has it do so while the host is busy with other things; and
 * where several kernels are new, a second device, which exists for no longer, takes some of
 * them: the first then finds those on disk.  Graphics cards compile a kernel when its pipeline is
 * made: only devices of type CPU rehearse.
 */
#include "runtime/tracer/stage.h"

#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

/* ---- Layouts ---- */

/* What a texel is at a binding, by the TexelKinds. */
static const struct {
    VkFormat format;
    uint32_t bytes;
} texel_kinds[TEXEL_KINDS] = {
    [ONE_NUMBER]   = {VK_FORMAT_R32_UINT, 4},
    [TWO_NUMBERS]  = {VK_FORMAT_R32G32_UINT, 8},
    [FOUR_NUMBERS] = {VK_FORMAT_R32G32B32A32_UINT, 16},
};
static const TexelKind texels_of[BINDING_COUNT] = {
    [LIGHTS_BINDING] = FOUR_NUMBERS, [END_TEXELS] = TWO_NUMBERS,     [HIT_TEXELS] = FOUR_NUMBERS,
    [SOLID_TEXELS] = ONE_NUMBER,     [RESULT_TEXELS] = FOUR_NUMBERS,
};

static_assert((int)BUFFER_BINDINGS <= (int)STORAGE_BUFFERS, "devices are asked for so many");

static VkDescriptorType type_of(uint32_t binding)
{
    return binding == FRAME_BINDING ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
           : texels_of[binding]     ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
                                    : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

static bool is_bound(const Gpu *gpu, uint32_t binding)
{
    return gpu->texels || !texels_of[binding];
}

static bool set_layout_create(Gpu *gpu, uint32_t count, VkDescriptorSetLayout *layout)
{
    VkDescriptorSetLayoutBinding bindings[BINDING_COUNT];
    for (uint32_t i = 0; i < count; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding         = i,
            .descriptorType  = type_of(i),
            .descriptorCount = is_bound(gpu, i),
            .stageFlags      = VK_SHADER_STAGE_COMPUTE_BIT,
        };
    VkDescriptorSetLayoutCreateInfo info = {
        .sType        = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = count,
        .pBindings    = bindings,
    };
    TRY(gpu, "prepare the renderer", vkCreateDescriptorSetLayout(gpu->device, &info, NULL, layout));
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
        .sType          = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 2,
        .pSetLayouts    = (VkDescriptorSetLayout[]){renderer->scene_layout, renderer->frame_layout},
        .pushConstantRangeCount = 1,
        .pPushConstantRanges    = &work,
    };
    TRY(gpu, "prepare the renderer",
        vkCreatePipelineLayout(gpu->device, &info, NULL, &renderer->layout));
    return true;

failed:
    return false;
}

/* ---- Idle sets ---- */

bool stage_view(Gpu *gpu, uint32_t binding, Buffer *buffer, const char *name)
{
    TexelKind kind = texels_of[binding];
    if (!is_bound(gpu, binding))
        return true;
    return buffer_view(gpu, buffer, texel_kinds[kind].format, texel_kinds[kind].bytes, name);
}

void stage_bind(Gpu *gpu, VkDescriptorSet set, uint32_t binding, const Buffer *buffer)
{
    if (!is_bound(gpu, binding))
        return;
    vkUpdateDescriptorSets(
        gpu->device, 1,
        &(VkWriteDescriptorSet){
            .sType            = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet           = set,
            .dstBinding       = binding,
            .descriptorCount  = 1,
            .descriptorType   = type_of(binding),
            .pTexelBufferView = &buffer->texels,
            .pBufferInfo      = &(VkDescriptorBufferInfo){buffer->buffer, 0, buffer->size},
        },
        0, NULL);
}

/* Room for any scene's parameters, where the device has no more of it than most have. */
static VkDeviceSize idle_bytes(const Gpu *gpu)
{
    const uint32_t most = 1 << 16, limit = gpu->properties.limits.maxUniformBufferRange;
    return limit < most ? limit : most;
}

/* Sets of buffers that hold zeros: no kernel finds any item in them. */
static bool idle_create(KrsRenderer *renderer)
{
    Gpu            *gpu     = &renderer->gpu;
    const char     *attempt = "prepare the renderer";
    VkDescriptorSet sets[2];
    const char     *name = "rehearsals";
    for (TexelKind kind = NO_TEXELS; kind < TEXEL_KINDS; kind++) {
        Buffer      *idle  = &renderer->idle[kind];
        VkDeviceSize bytes = kind == NO_TEXELS ? idle_bytes(gpu) : buffer_texel_bytes(1);
        if (!buffer_create(gpu, idle, bytes, SHARED, name) ||
            (kind != NO_TEXELS &&
             !buffer_view(gpu, idle, texel_kinds[kind].format, texel_kinds[kind].bytes, name)))
            return false;
        memset(idle->bytes, 0, idle->size);
    }
    TRY(gpu, attempt,
        vkCreateDescriptorPool(
            gpu->device,
            &(VkDescriptorPoolCreateInfo){
                .sType         = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                .maxSets       = 2,
                .poolSizeCount = 3,
                .pPoolSizes =
                    (VkDescriptorPoolSize[]){
                        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2},
                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BUFFER_BINDINGS},
                        {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, TEXEL_BINDINGS},
                    },
            },
            NULL, &renderer->idle_pool));
    TRY(gpu, attempt,
        vkAllocateDescriptorSets(
            gpu->device,
            &(VkDescriptorSetAllocateInfo){
                .sType              = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                .descriptorPool     = renderer->idle_pool,
                .descriptorSetCount = 2,
                .pSetLayouts        = (VkDescriptorSetLayout[]){renderer->scene_layout,
                                                                renderer->frame_layout},
            },
            sets));
    renderer->idle_scene = sets[0];
    renderer->idle_frame = sets[1];
    stage_bind(gpu, renderer->idle_scene, 0, &renderer->idle[0]);
    for (uint32_t binding = 0; binding < BINDING_COUNT; binding++)
        stage_bind(gpu, renderer->idle_frame, binding, &renderer->idle[texels_of[binding]]);
    return true;

failed:
    return false;
}

bool stage_create(KrsRenderer *renderer)
{
    return layouts_create(renderer) && idle_create(renderer);
}

void stage_destroy(KrsRenderer *renderer)
{
    Gpu *gpu = &renderer->gpu;
    if (!gpu->device || gpu->stuck)
        return;
    vkDestroyDescriptorPool(gpu->device, renderer->idle_pool, NULL);
    for (TexelKind kind = NO_TEXELS; kind < TEXEL_KINDS; kind++)
        buffer_destroy(gpu, &renderer->idle[kind]);
    vkDestroyPipelineLayout(gpu->device, renderer->layout, NULL);
    vkDestroyDescriptorSetLayout(gpu->device, renderer->frame_layout, NULL);
    vkDestroyDescriptorSetLayout(gpu->device, renderer->scene_layout, NULL);
}

/* ---- Rehearsals ---- */

static bool rehearse(KrsRenderer *renderer, VkDescriptorSet scene_set, const Kernel *kernel)
{
    const VkDescriptorSet sets[2] = {scene_set, renderer->idle_frame};
    const WorkBlock       work    = {.groups = 1, .stride = 1};
    return gpu_rehearse(&renderer->gpu, kernel->pipeline, renderer->layout, sets, &work,
                        sizeof work);
}

/* Kernels that two devices rehearse: each takes the next that nobody has. */
typedef struct Sharing {
    const Gpu        *gpu; /* the first */
    const KernelCode *codes;
    size_t            count;
    atomic_size_t     next;
} Sharing;

/* Whether a second device is worth its making: its host has a core for it, and there is more than
   one kernel that the driver is not likely to have.  The validation layers' callback is for one
   thread. */
static bool worth_sharing(const Gpu *gpu, const KernelCode *codes, size_t count)
{
    size_t compiled = 0;
    for (size_t i = 0; i < count; i++)
        compiled += codes[i].compiled;
    return compiled > 1 && gpu_is_cpu(gpu) && !gpu->messenger && sysconf(_SC_NPROCESSORS_ONLN) > 1;
}

/* The second device's thread.  If anything fails, or nothing is kept on disk, the first device
   compiles what this one should have. */
static void *assist(void *user)
{
    Sharing    *sharing = user;
    KrsRenderer second  = {0};
    bool        ready   = gpu_open_beside(&second.gpu, sharing->gpu) && stage_create(&second);
    for (size_t i; ready && (i = atomic_fetch_add(&sharing->next, 1)) < sharing->count;) {
        Kernel kernel;
        double ms = 0;
        ready     = kernel_load(&second.gpu, &kernel, &sharing->codes[i], second.layout, &ms) &&
                rehearse(&second, second.idle_scene, &kernel) && gpu_wait(&second.gpu);
        kernel_destroy(&second.gpu, &kernel);
    }
    stage_destroy(&second);
    gpu_close(&second.gpu);
    return NULL;
}

/* Those that the second device does not take, and then, off the disk, those that it did. */
static bool rehearse_all(KrsRenderer *renderer, VkDescriptorSet scene_set,
                         const KernelRequest *requests, const KernelCode *codes, size_t count)
{
    Sharing   sharing = {.gpu = &renderer->gpu, .codes = codes, .count = count};
    pthread_t thread;
    bool      ready = true, taken[KERNELS_AT_ONCE] = {false};
    bool      shared = worth_sharing(&renderer->gpu, codes, count) &&
                  pthread_create(&thread, NULL, assist, &sharing) == 0;
    while (shared && ready) {
        ready    = gpu_wait(&renderer->gpu); /* takes no more than it can work on */
        size_t i = atomic_fetch_add(&sharing.next, 1);
        if (i >= count)
            break;
        taken[i] = ready = ready && rehearse(renderer, scene_set, requests[i].kernel);
    }
    if (shared)
        pthread_join(thread, NULL);
    for (size_t i = 0; i < count && ready; i++)
        ready = taken[i] || rehearse(renderer, scene_set, requests[i].kernel);
    return ready;
}

bool stage_make_kernels(KrsRenderer *renderer, VkDescriptorSet scene_set,
                        const KernelRequest *requests, size_t count, double *spirv_ms,
                        double *pipeline_ms)
{
    Gpu       *gpu = &renderer->gpu;
    KernelCode codes[KERNELS_AT_ONCE];
    bool       ready = kernel_compile_all(gpu, requests, count, codes, spirv_ms);
    double     start = clock_ms();
    for (size_t i = 0; i < count; i++)
        *requests[i].kernel = (Kernel){0};
    ready = ready && kernel_load_all(gpu, requests, codes, count, renderer->layout);
    if (gpu_is_cpu(gpu))
        ready = ready && rehearse_all(renderer, scene_set, requests, codes, count);
    for (size_t i = 0; i < count; i++)
        kernel_code_release(gpu, &codes[i]);
    *pipeline_ms += clock_ms() - start;
    return ready;
}
