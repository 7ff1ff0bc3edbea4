/*
 * layouts.c: layouts of descriptor sets and of the pipeline, and descriptor sets of zeros.
 */
#include "runtime/tracer/layouts.h"

#include <string.h>

/* ---- Layouts ---- */

/* The format of each kind of texel, and the kind at each binding. */
static const struct {
    VkFormat format;
    uint32_t bytes;
} texel_kinds[TEXEL_KINDS] = {
    [ONE_NUMBER]   = {VK_FORMAT_R32_UINT, 4},
    [TWO_NUMBERS]  = {VK_FORMAT_R32G32_UINT, 8},
    [FOUR_NUMBERS] = {VK_FORMAT_R32G32B32A32_UINT, 16},
    [FOUR_FLOATS]  = {VK_FORMAT_R32G32B32A32_SFLOAT, 16},
};
static const TexelKind texels_of_scene[SCENE_BINDINGS] = {
    [ROWS_BINDING]      = FOUR_FLOATS,
    [CELLS_BINDING]     = TWO_NUMBERS,
    [SKY_TABLE_BINDING] = FOUR_FLOATS,
};
static const TexelKind texels_of[FRAME_BINDINGS] = {
    [INPUT_TEXELS_BINDING] = FOUR_NUMBERS,   [END_TEXELS_BINDING] = TWO_NUMBERS,
    [HIT_TEXELS_BINDING] = FOUR_NUMBERS,     [PIXEL_LIST_TEXELS_BINDING] = ONE_NUMBER,
    [RESULT_TEXELS_BINDING] = FOUR_NUMBERS,  [TILE_TEXELS_BINDING] = FOUR_NUMBERS,
    [FRAME_TEXELS_BINDING] = FOUR_NUMBERS,   [CONTROL_TEXELS_BINDING] = FOUR_NUMBERS,
    [SURFACE_TEXELS_BINDING] = FOUR_NUMBERS,
};

static_assert((int)BUFFER_BINDINGS <= (int)STORAGE_BUFFERS, "devices are asked for so many");
static_assert((int)SKY_TABLE_BINDING == (int)SKY_BINDING, "as shaders have it");
static_assert((int)TABLE_BINDINGS <= (int)STORAGE_BUFFERS_FOR_TEXELS, "and for so many more");

static VkDescriptorType type_of(uint32_t binding)
{
    return binding == FRAME_BINDING ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
           : texels_of[binding]     ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
                                    : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

static VkDescriptorType type_of_scene(const Gpu *gpu, uint32_t binding)
{
    return !texels_of_scene[binding] ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
           : gpu->texels             ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
                                     : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

static bool is_bound(const Gpu *gpu, uint32_t binding)
{
    return gpu->texels || !texels_of[binding];
}

static VkDescriptorSetLayoutBinding layout_binding(uint32_t binding, VkDescriptorType type,
                                                   bool bound)
{
    return (VkDescriptorSetLayoutBinding){
        .binding         = binding,
        .descriptorType  = type,
        .descriptorCount = bound,
        .stageFlags      = VK_SHADER_STAGE_COMPUTE_BIT,
    };
}

static bool set_layout_create(Gpu *gpu, const VkDescriptorSetLayoutBinding *bindings,
                              uint32_t count, VkDescriptorSetLayout *layout)
{
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

static bool set_layouts_create(KrsRenderer *renderer)
{
    Gpu                         *gpu = &renderer->gpu;
    VkDescriptorSetLayoutBinding scene[SCENE_BINDINGS], frame[FRAME_BINDINGS];
    for (uint32_t i = 0; i < SCENE_BINDINGS; i++)
        scene[i] = layout_binding(i, type_of_scene(gpu, i), true);
    for (uint32_t i = 0; i < FRAME_BINDINGS; i++)
        frame[i] = layout_binding(i, type_of(i), is_bound(gpu, i));
    return set_layout_create(gpu, scene, SCENE_BINDINGS, &renderer->scene_layout) &&
           set_layout_create(gpu, frame, FRAME_BINDINGS, &renderer->frame_layout);
}

static bool pipeline_layout_create(KrsRenderer *renderer)
{
    Gpu *gpu = &renderer->gpu;
    if (!set_layouts_create(renderer))
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

bool layouts_view_texels(Gpu *gpu, uint32_t binding, Buffer *buffer, const char *name)
{
    TexelKind kind = texels_of[binding];
    if (!is_bound(gpu, binding))
        return true;
    return buffer_view(gpu, buffer, texel_kinds[kind].format, texel_kinds[kind].bytes, name);
}

bool layouts_view_table(Gpu *gpu, uint32_t binding, Buffer *buffer, const char *name)
{
    TexelKind kind = texels_of_scene[binding];
    return !gpu->texels ||
           buffer_view(gpu, buffer, texel_kinds[kind].format, texel_kinds[kind].bytes, name);
}

static void bind(Gpu *gpu, VkDescriptorSet set, uint32_t binding, VkDescriptorType type,
                 const Buffer *buffer)
{
    vkUpdateDescriptorSets(
        gpu->device, 1,
        &(VkWriteDescriptorSet){
            .sType            = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet           = set,
            .dstBinding       = binding,
            .descriptorCount  = 1,
            .descriptorType   = type,
            .pTexelBufferView = &buffer->texels,
            .pBufferInfo      = &(VkDescriptorBufferInfo){buffer->buffer, 0, buffer->size},
        },
        0, NULL);
}

void layouts_bind(Gpu *gpu, VkDescriptorSet set, uint32_t binding, const Buffer *buffer)
{
    if (is_bound(gpu, binding))
        bind(gpu, set, binding, type_of(binding), buffer);
}

void layouts_bind_scene(Gpu *gpu, VkDescriptorSet set, uint32_t binding, const Buffer *buffer)
{
    bind(gpu, set, binding, type_of_scene(gpu, binding), buffer);
}

const Buffer *layouts_idle_table(const KrsRenderer *renderer, uint32_t binding)
{
    return &renderer->idle[texels_of_scene[binding]];
}

/* Returns the size of a buffer of zeros for the parameters of any scene: 64 KB, the limit of most
   devices, or this device's own limit if lower. */
static VkDeviceSize idle_bytes(const Gpu *gpu)
{
    const uint32_t most = 1 << 16, limit = gpu->properties.limits.maxUniformBufferRange;
    return limit < most ? limit : most;
}

/* Makes descriptor sets whose buffers hold zeros, so that no shader finds any item in them. */
static bool idle_create(KrsRenderer *renderer)
{
    Gpu            *gpu     = &renderer->gpu;
    const char     *attempt = "prepare the renderer";
    VkDescriptorSet sets[2];
    const char     *name = "idle frame";
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
                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BUFFER_BINDINGS + TABLE_BINDINGS},
                        {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, TEXEL_BINDINGS + TABLE_BINDINGS},
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
    for (uint32_t binding = 0; binding < SCENE_BINDINGS; binding++)
        layouts_bind_scene(gpu, renderer->idle_scene, binding,
                           &renderer->idle[texels_of_scene[binding]]);
    for (uint32_t binding = 0; binding < FRAME_BINDINGS; binding++)
        layouts_bind(gpu, renderer->idle_frame, binding, &renderer->idle[texels_of[binding]]);
    return true;

failed:
    return false;
}

bool layouts_create(KrsRenderer *renderer)
{
    return pipeline_layout_create(renderer) && idle_create(renderer);
}

void layouts_destroy(KrsRenderer *renderer)
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
