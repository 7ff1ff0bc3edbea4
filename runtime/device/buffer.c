/*
 * buffer.c: each buffer has memory of its own; a rendering needs fewer than ten.
 */
#include "runtime/device/buffer.h"

#include <stdio.h>

#include "runtime/device/driver.h"

/* Finds a permitted memory type with all `needed` properties, if possible one with `liked` ones
   too. */
static bool find_type(const Gpu *gpu, uint32_t permitted, VkMemoryPropertyFlags needed,
                      VkMemoryPropertyFlags liked, uint32_t *type)
{
    const VkMemoryPropertyFlags tries[] = {needed | liked, needed};
    for (int i = 0; i < 2; i++)
        for (uint32_t t = 0; t < gpu->driver->memory.memoryTypeCount; t++) {
            VkMemoryPropertyFlags has = gpu->driver->memory.memoryTypes[t].propertyFlags;
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

bool buffer_create(Gpu *gpu, Buffer *buffer, uint64_t size, Where where, const char *name)
{
    const VkDevice device = gpu->driver->device;
    VkBuffer       made;
    VkDeviceMemory memory;
    char           attempt[128];
    snprintf(attempt, sizeof attempt, "make room for the %s", name);
    *buffer = (Buffer){.size = size};

    TRY(gpu, attempt,
        vkCreateBuffer(
            device,
            &(VkBufferCreateInfo){
                .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                .size  = size,
                .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                         VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                         VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                         VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
            },
            NULL, &made));
    buffer->buffer = TO_HANDLE(made);
    gpu_name(gpu, VK_OBJECT_TYPE_BUFFER, buffer->buffer, name);

    VkMemoryRequirements needs;
    uint32_t             type;
    vkGetBufferMemoryRequirements(device, made, &needs);
    if (!find_type_for(gpu, needs.memoryTypeBits, where, &type)) {
        gpu_fail(gpu, VK_ERROR_OUT_OF_DEVICE_MEMORY, attempt);
        goto failed;
    }
    TRY(gpu, attempt,
        vkAllocateMemory(device,
                         &(VkMemoryAllocateInfo){
                             .sType           = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                             .allocationSize  = needs.size,
                             .memoryTypeIndex = type,
                         },
                         NULL, &memory));
    buffer->memory = TO_HANDLE(memory);
    buffer->held   = needs.size;
    gpu->memory_used += buffer->held;
    if (gpu->memory_used > gpu->memory_peak)
        gpu->memory_peak = gpu->memory_used;
    TRY(gpu, attempt, vkBindBufferMemory(device, made, memory, 0));
    if (where != ON_DEVICE)
        TRY(gpu, attempt, vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &buffer->bytes));
    return true;

failed:
    buffer_destroy(gpu, buffer);
    return false;
}

uint64_t buffer_texel_bytes(uint64_t bytes)
{
    const uint64_t page  = 4096;
    uint64_t       pages = (bytes + page - 1) / page;
    return (pages < 3 ? 3 : pages | 1) * page;
}

bool buffer_view(Gpu *gpu, Buffer *buffer, TexelKind kind, const char *name)
{
    static const struct {
        VkFormat format;
        uint32_t bytes;
    } kinds[TEXEL_KINDS] = {
        [ONE_NUMBER]   = {VK_FORMAT_R32_UINT, 4},
        [TWO_NUMBERS]  = {VK_FORMAT_R32G32_UINT, 8},
        [FOUR_NUMBERS] = {VK_FORMAT_R32G32B32A32_UINT, 16},
        [FOUR_FLOATS]  = {VK_FORMAT_R32G32B32A32_SFLOAT, 16},
    };
    VkBufferView view;
    char         attempt[128];
    snprintf(attempt, sizeof attempt, "make room for the %s", name);
    if (buffer->texels)
        return true;
    if (buffer->size / kinds[kind].bytes > gpu->limits.texels) {
        gpu_fail(gpu, VK_ERROR_OUT_OF_DEVICE_MEMORY, attempt);
        return false;
    }
    TRY(gpu, attempt,
        vkCreateBufferView(gpu->driver->device,
                           &(VkBufferViewCreateInfo){
                               .sType  = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                               .buffer = FROM_HANDLE(VkBuffer, buffer->buffer),
                               .format = kinds[kind].format,
                               .range  = VK_WHOLE_SIZE,
                           },
                           NULL, &view));
    buffer->texels = TO_HANDLE(view);
    return true;

failed:
    return false;
}

void buffer_destroy(Gpu *gpu, Buffer *buffer)
{
    if (gpu_is_open(gpu) && !gpu->stuck) {
        const VkDevice device = gpu->driver->device;
        vkDestroyBufferView(device, FROM_HANDLE(VkBufferView, buffer->texels), NULL);
        vkDestroyBuffer(device, FROM_HANDLE(VkBuffer, buffer->buffer), NULL);
        vkFreeMemory(device, FROM_HANDLE(VkDeviceMemory, buffer->memory),
                     NULL); /* unmaps it, too */
    }
    gpu->memory_used -= buffer->held;
    *buffer = (Buffer){0};
}
