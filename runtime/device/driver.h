/*
 * driver.h: what the driver has of a device: handles of Vulkan.  This folder alone includes it.
 */
#ifndef KRS_DRIVER_H
#define KRS_DRIVER_H

#include <vulkan/vulkan.h>

#include "runtime/device/gpu_state.h"

struct Driver {
    VkInstance       instance;
    VkPhysicalDevice physical;
    VkDevice         device;
    VkQueue          queue;
    uint32_t         family;
    VkCommandPool    pool, prewarm_pool;
    VkCommandBuffer  commands; /* the one that is recorded, run and waited for */
    VkFence          fence;
    VkQueryPool      times; /* timestamps; none when the queue has no clock */
    uint64_t         time_mask;
    VkQueryPool      prewarm_times; /* timestamps before and after each; none likewise */
    VkPipelineCache  pipelines;     /* the driver's, or none */

    VkPhysicalDeviceProperties       properties;
    VkPhysicalDeviceMemoryProperties memory;

    VkDebugUtilsMessengerEXT         messenger;
    PFN_vkSetDebugUtilsObjectNameEXT set_name; /* NULL without validation */
};

/* These turn an object of Vulkan into the number by which others know it, and back. */
#define TO_HANDLE(object)         ((Handle)(uintptr_t)(object))
#define FROM_HANDLE(type, handle) ((type)(uintptr_t)(handle))

/* Notes a failure in Vulkan's words: "cannot <attempt>: <reason>". */
void gpu_fail(Gpu *gpu, VkResult result, const char *attempt);

/* Gives an object a name in the messages of the validation layers. */
void gpu_name(Gpu *gpu, VkObjectType type, Handle handle, const char *name);

/* Run a Vulkan call, or note why not and go to `failed`. */
#define TRY(gpu, attempt, call)                \
    do {                                       \
        VkResult result_ = (call);             \
        if (result_ != VK_SUCCESS) {           \
            gpu_fail((gpu), result_, attempt); \
            goto failed;                       \
        }                                      \
    } while (0)

#endif
