/*
 * driver.c: failures of Vulkan, and what is asked of an opened device.
 */
#include "runtime/device/driver.h"

#include "runtime/device/resources.h"

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
        gpu->lost = true;
        gpu_refuse(gpu, KRS_INTERNAL,
                   "cannot %s: the device was lost (its driver gave up or was reset)", attempt);
        break;
    default:
        gpu_refuse(gpu, KRS_INTERNAL, "cannot %s: the driver answers with Vulkan error %d", attempt,
                   result);
    }
}

void gpu_name(Gpu *gpu, VkObjectType type, Handle handle, const char *name)
{
    const Driver *driver = gpu->driver;
    if (driver->set_name)
        driver->set_name(driver->device,
                         &(VkDebugUtilsObjectNameInfoEXT){
                             .sType        = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                             .objectType   = type,
                             .objectHandle = handle,
                             .pObjectName  = name,
                         });
}

bool gpu_is_open(const Gpu *gpu) { return gpu->driver && gpu->driver->device; }

bool gpu_is_cpu(const Gpu *gpu)
{
    return gpu->driver->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU && !gpu->emulates_card;
}

uint64_t gpu_memory(const Gpu *gpu)
{
    uint64_t most = 0;
    for (uint32_t i = 0; i < gpu->driver->memory.memoryHeapCount; i++) {
        const VkMemoryHeap *heap = &gpu->driver->memory.memoryHeaps[i];
        if ((heap->flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) && heap->size > most)
            most = heap->size;
    }
    return most;
}
