/*
 * gpu_state.c: memory of the host, failures, and what is asked of an opened device.
 */
#include "runtime/device/gpu_state.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "runtime/device/resources.h"

double clock_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec / 1e6;
}

void *gpu_alloc(Gpu *gpu, size_t count, size_t size, const char *attempt)
{
    const KrsAllocator *allocator = &gpu->allocator;
    void               *block     = NULL;
    if (size == 0 || count <= SIZE_MAX / size) {
        size_t bytes = count * size > 0 ? count * size : 1;
        if (!allocator->allocate)
            block = calloc(1, bytes); /* knows what is zero already: pages fresh from the system */
        else if ((block = allocator->allocate(allocator->user, bytes)))
            memset(block, 0, bytes);
    }
    if (!block)
        gpu_refuse(gpu, KRS_OUT_OF_MEMORY, "cannot %s: out of memory", attempt);
    return block;
}

void gpu_release(Gpu *gpu, void *block)
{
    if (block && gpu->allocator.release)
        gpu->allocator.release(gpu->allocator.user, block);
    else if (!gpu->allocator.allocate)
        free(block);
}

void gpu_refuse(Gpu *gpu, KrsStatus status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(gpu->message, sizeof gpu->message, format, arguments);
    va_end(arguments);
    gpu->status = status;
}

void gpu_fail(Gpu *gpu, VkResult result, const char *attempt)
{
    bool starts = result != VK_ERROR_INCOMPATIBLE_DRIVER &&
                  result !=
                      VK_ERROR_INITIALIZATION_FAILED; /* what a loader says in want of memory */
    if (!starts && !memory_suffices_to_start())
        result = VK_ERROR_OUT_OF_HOST_MEMORY;
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        gpu_refuse(gpu, KRS_OUT_OF_MEMORY, "cannot %s: out of memory", attempt);
        break;
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    case VK_ERROR_OUT_OF_POOL_MEMORY:
    case VK_ERROR_FRAGMENTED_POOL:
    case VK_ERROR_FRAGMENTATION:
    case VK_ERROR_TOO_MANY_OBJECTS:
        gpu_refuse(gpu, KRS_OUT_OF_MEMORY, "cannot %s: out of memory on the device", attempt);
        break;
    case VK_ERROR_INCOMPATIBLE_DRIVER: gpu_refuse(gpu, KRS_NO_DEVICE, NO_DEVICE); break;
    case VK_ERROR_LAYER_NOT_PRESENT:
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        gpu_refuse(gpu, KRS_NO_DEVICE,
                   "cannot %s: the validation layers are not installed (Debian:"
                   " vulkan-validationlayers)",
                   attempt);
        break;
    case VK_ERROR_INITIALIZATION_FAILED:
        gpu_refuse(gpu, KRS_NO_DEVICE, "cannot %s: the Vulkan driver does not start", attempt);
        break;
    case VK_ERROR_DEVICE_LOST:
        gpu_refuse(gpu, KRS_INTERNAL,
                   "cannot %s: the device was lost (its driver gave up or was reset)", attempt);
        break;
    default:
        gpu_refuse(gpu, KRS_INTERNAL, "cannot %s: the driver answers with Vulkan error %d", attempt,
                   result);
    }
}

bool gpu_tell_compiled(Gpu *gpu, double done)
{
    if (!gpu->compiling || gpu->compiling(gpu->compiling_user, done))
        return true;
    gpu_refuse(gpu, KRS_INTERRUPTED, "interrupted");
    return false;
}

void gpu_name(Gpu *gpu, VkObjectType type, uint64_t handle, const char *name)
{
    if (gpu->set_name)
        gpu->set_name(gpu->device, &(VkDebugUtilsObjectNameInfoEXT){
                                       .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                       .objectType   = type,
                                       .objectHandle = handle,
                                       .pObjectName  = name,
                                   });
}

bool gpu_is_cpu(const Gpu *gpu)
{
    return gpu->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU && !gpu->emulates_card;
}

uint64_t gpu_memory(const Gpu *gpu)
{
    uint64_t most = 0;
    for (uint32_t i = 0; i < gpu->memory.memoryHeapCount; i++) {
        const VkMemoryHeap *heap = &gpu->memory.memoryHeaps[i];
        if ((heap->flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) && heap->size > most)
            most = heap->size;
    }
    return most;
}
