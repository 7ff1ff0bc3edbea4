/*
 * buffer.c: each buffer has memory of its own; a rendering needs fewer than ten.
 */
#include "runtime/device/buffer.h"

#include <stdio.h>

/* Finds a permitted memory type with all `needed` properties, if possible one with `liked` ones
   too. */
static bool find_type(const Gpu *gpu, uint32_t permitted, VkMemoryPropertyFlags needed,
                      VkMemoryPropertyFlags liked, uint32_t *type)
{
    const VkMemoryPropertyFlags tries[] = {needed | liked, needed};
    for (int i = 0; i < 2; i++)
        for (uint32_t t = 0; t < gpu->memory.memoryTypeCount; t++) {
            VkMemoryPropertyFlags has = gpu->memory.memoryTypes[t].propertyFlags;
            if ((permitted >> t & 1) && (has & tries[i]) == tries[i]) {
                *type = t;
                return true;
            }
        }
    return false;
}

static bool find_type_for(const Gpu *gpu, uint32_t permitted, Where where, uint32_t *type)
{
    const VkMemoryPropertyFlags mapped = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                         VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    if (where == ON_DEVICE)
        return find_type(gpu, permitted, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, type);
    return find_type(gpu, permitted, mapped,
                     where == SHARED ? VK_MEMORY_PROPERTY_HOST_CACHED_BIT
                                     : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                     type);
}

bool buffer_create(Gpu *gpu, Buffer *buffer, VkDeviceSize size, Where where, const char *name)
{
    char attempt[128];
    snprintf(attempt, sizeof attempt, "make room for the %s", name);
    *buffer = (Buffer){.size = size};

    TRY(gpu, attempt,
        vkCreateBuffer(
            gpu->device,
            &(VkBufferCreateInfo){
                .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                .size  = size,
                .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                         VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                         VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                         VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
            },
            NULL, &buffer->buffer));
    gpu_name(gpu, VK_OBJECT_TYPE_BUFFER, (uint64_t)(uintptr_t)buffer->buffer, name);

    VkMemoryRequirements needs;
    uint32_t             type;
    vkGetBufferMemoryRequirements(gpu->device, buffer->buffer, &needs);
    if (!find_type_for(gpu, needs.memoryTypeBits, where, &type)) {
        gpu_fail(gpu, VK_ERROR_OUT_OF_DEVICE_MEMORY, attempt);
        goto failed;
    }
    TRY(gpu, attempt,
        vkAllocateMemory(gpu->device,
                         &(VkMemoryAllocateInfo){
                             .sType           = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                             .allocationSize  = needs.size,
                             .memoryTypeIndex = type,
                         },
                         NULL, &buffer->memory));
    buffer->held = needs.size;
    gpu->memory_used += buffer->held;
    if (gpu->memory_used > gpu->memory_peak)
        gpu->memory_peak = gpu->memory_used;
    TRY(gpu, attempt, vkBindBufferMemory(gpu->device, buffer->buffer, buffer->memory, 0));
    if (where != ON_DEVICE)
        TRY(gpu, attempt,
            vkMapMemory(gpu->device, buffer->memory, 0, VK_WHOLE_SIZE, 0, &buffer->bytes));
    return true;

failed:
    buffer_destroy(gpu, buffer);
    return false;
}

VkDeviceSize buffer_texel_bytes(VkDeviceSize bytes)
{
    const VkDeviceSize page  = 4096;
    VkDeviceSize       pages = (bytes + page - 1) / page;
    return (pages < 3 ? 3 : pages | 1) * page;
}

bool buffer_view(Gpu *gpu, Buffer *buffer, VkFormat format, uint32_t texel_bytes, const char *name)
{
    char attempt[128];
    snprintf(attempt, sizeof attempt, "make room for the %s", name);
    if (buffer->texels)
        return true;
    if (buffer->size / texel_bytes > gpu->properties.limits.maxTexelBufferElements) {
        gpu_fail(gpu, VK_ERROR_OUT_OF_DEVICE_MEMORY, attempt);
        return false;
    }
    TRY(gpu, attempt,
        vkCreateBufferView(gpu->device,
                           &(VkBufferViewCreateInfo){
                               .sType  = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                               .buffer = buffer->buffer,
                               .format = format,
                               .range  = VK_WHOLE_SIZE,
                           },
                           NULL, &buffer->texels));
    return true;

failed:
    return false;
}

void buffer_destroy(Gpu *gpu, Buffer *buffer)
{
    if (gpu->device && !gpu->stuck) {
        vkDestroyBufferView(gpu->device, buffer->texels, NULL);
        vkDestroyBuffer(gpu->device, buffer->buffer, NULL);
        vkFreeMemory(gpu->device, buffer->memory, NULL); /* unmaps it, too */
    }
    gpu->memory_used -= buffer->held;
    *buffer = (Buffer){0};
}
