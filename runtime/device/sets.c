/*
 * sets.c: descriptor sets and their layouts.
 */
#include "runtime/device/sets.h"

#include <assert.h>

#include "runtime/device/driver.h"

enum { MAX_BINDINGS = 32, MAX_SETS = 4 };

static const VkDescriptorType types[BINDING_KINDS] = {
    [BINDS_NOTHING] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, /* of which there are none */
    [BINDS_UNIFORM] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
    [BINDS_WORK]    = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC,
    [BINDS_STORAGE] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
    [BINDS_TEXELS]  = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
};

bool set_layout_create(Gpu *gpu, SetLayout *layout, const BindingKind *kinds, uint32_t count)
{
    VkDescriptorSetLayoutBinding bindings[MAX_BINDINGS];
    VkDescriptorSetLayout        made;
    assert(count <= MAX_BINDINGS);
    *layout = (SetLayout){0};
    for (uint32_t i = 0; i < count; i++) {
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding         = i,
            .descriptorType  = types[kinds[i]],
            .descriptorCount = kinds[i] != BINDS_NOTHING,
            .stageFlags      = VK_SHADER_STAGE_COMPUTE_BIT,
        };
        layout->of_kind[kinds[i]]++;
    }
    TRY(gpu, "prepare the renderer",
        vkCreateDescriptorSetLayout(
            gpu->driver->device,
            &(VkDescriptorSetLayoutCreateInfo){
                .sType        = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                .bindingCount = count,
                .pBindings    = bindings,
            },
            NULL, &made));
    layout->layout = TO_HANDLE(made);
    return true;

failed:
    return false;
}

void set_layout_destroy(Gpu *gpu, SetLayout *layout)
{
    vkDestroyDescriptorSetLayout(gpu->driver->device,
                                 FROM_HANDLE(VkDescriptorSetLayout, layout->layout), NULL);
    *layout = (SetLayout){0};
}

bool run_layout_create(Gpu *gpu, const SetLayout *const sets[2], Handle *layout)
{
    const VkDescriptorSetLayout layouts[2] = {FROM_HANDLE(VkDescriptorSetLayout, sets[0]->layout),
                                              FROM_HANDLE(VkDescriptorSetLayout, sets[1]->layout)};
    VkPipelineLayout            made;
    TRY(gpu, "prepare the renderer",
        vkCreatePipelineLayout(gpu->driver->device,
                               &(VkPipelineLayoutCreateInfo){
                                   .sType          = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                   .setLayoutCount = 2,
                                   .pSetLayouts    = layouts,
                               },
                               NULL, &made));
    *layout = TO_HANDLE(made);
    return true;

failed:
    return false;
}

void run_layout_destroy(Gpu *gpu, Handle layout)
{
    vkDestroyPipelineLayout(gpu->driver->device, FROM_HANDLE(VkPipelineLayout, layout), NULL);
}

/* Makes a pool with room for sets of these layouts. */
static bool pool_create(Gpu *gpu, const SetLayout *const *layouts, uint32_t count,
                        VkDescriptorPool *pool)
{
    VkDescriptorPoolSize sizes[BINDING_KINDS];
    uint32_t             size_count = 0;
    for (int kind = BINDS_NOTHING + 1; kind < BINDING_KINDS; kind++) {
        uint32_t bindings = 0;
        for (uint32_t i = 0; i < count; i++)
            bindings += layouts[i]->of_kind[kind];
        if (bindings > 0)
            sizes[size_count++] = (VkDescriptorPoolSize){types[kind], bindings};
    }
    TRY(gpu, "prepare the scene",
        vkCreateDescriptorPool(gpu->driver->device,
                               &(VkDescriptorPoolCreateInfo){
                                   .sType         = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                   .maxSets       = count,
                                   .poolSizeCount = size_count,
                                   .pPoolSizes    = sizes,
                               },
                               NULL, pool));
    return true;

failed:
    return false;
}

bool sets_create(Gpu *gpu, const SetLayout *const *layouts, uint32_t count, Handle *sets,
                 Handle *pool)
{
    VkDescriptorSetLayout wanted[MAX_SETS];
    VkDescriptorSet       made[MAX_SETS];
    VkDescriptorPool      room;
    assert(count <= MAX_SETS);
    for (uint32_t i = 0; i < count; i++)
        wanted[i] = FROM_HANDLE(VkDescriptorSetLayout, layouts[i]->layout);
    if (!pool_create(gpu, layouts, count, &room))
        return false;
    *pool = TO_HANDLE(room);
    TRY(gpu, "prepare the scene",
        vkAllocateDescriptorSets(gpu->driver->device,
                                 &(VkDescriptorSetAllocateInfo){
                                     .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                     .descriptorPool     = room,
                                     .descriptorSetCount = count,
                                     .pSetLayouts        = wanted,
                                 },
                                 made));
    for (uint32_t i = 0; i < count; i++)
        sets[i] = TO_HANDLE(made[i]);
    return true;

failed:
    return false;
}

void sets_destroy(Gpu *gpu, Handle pool)
{
    vkDestroyDescriptorPool(gpu->driver->device, FROM_HANDLE(VkDescriptorPool, pool), NULL);
}

void set_bind(Gpu *gpu, Handle set, uint32_t binding, BindingKind kind, const Buffer *buffer)
{
    const VkBufferView view = FROM_HANDLE(VkBufferView, buffer->texels);
    if (kind == BINDS_NOTHING)
        return;
    vkUpdateDescriptorSets(
        gpu->driver->device, 1,
        &(VkWriteDescriptorSet){
            .sType            = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet           = FROM_HANDLE(VkDescriptorSet, set),
            .dstBinding       = binding,
            .descriptorCount  = 1,
            .descriptorType   = types[kind],
            .pTexelBufferView = &view,
            .pBufferInfo      = &(VkDescriptorBufferInfo){FROM_HANDLE(VkBuffer, buffer->buffer), 0,
                                                     kind == BINDS_WORK ? WORK_BYTES
                                                                             : buffer->size},
        },
        0, NULL);
}
