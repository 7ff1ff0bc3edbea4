/*
 * gpu.c: opening and closing a Vulkan device and its queue; memory of the host, and failures.
 */
#include "runtime/device/gpu.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "runtime/device/instance.h"
#include "runtime/device/pipelines.h"
#include "runtime/device/resources.h"

/* Where fewer texels than that can be read, buffers are: the lowest band of the widest picture has
   so many (band.c). */
#define LEAST_TEXELS (1u << 22)
/* What every device must have at least (Vulkan, table 53). */
#define LEAST_TEXEL_LIMIT (1u << 16)
#define LEAST_RANGE_LIMIT (1u << 27)

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

static void read_properties(Gpu *gpu, unsigned pretence)
{
    VkPhysicalDeviceSubgroupProperties subgroups = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES,
    };
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
        .pNext = &subgroups,
    };
    vkGetPhysicalDeviceProperties2(gpu->physical, &properties);
    gpu->properties                = properties.properties;
    VkPhysicalDeviceLimits *limits = &gpu->properties.limits;
    if (pretence & KRS_PRETEND_LEAST_LIMITS) {
        limits->maxTexelBufferElements = LEAST_TEXEL_LIMIT;
        limits->maxStorageBufferRange  = LEAST_RANGE_LIMIT;
    }
    gpu->pretends_card = pretence & KRS_PRETEND_CARD;
    gpu->texels        = limits->maxTexelBufferElements >= LEAST_TEXELS;
    bool shuffles      = subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT &&
                    subgroups.supportedOperations & VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
    const VkSubgroupFeatureFlags sums = VK_SUBGROUP_FEATURE_BASIC_BIT |
                                        VK_SUBGROUP_FEATURE_ARITHMETIC_BIT |
                                        VK_SUBGROUP_FEATURE_BALLOT_BIT;
    gpu->sums_lanes = subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT &&
                      (subgroups.supportedOperations & sums) == sums;
    gpu->refill_lanes = !shuffles || subgroups.subgroupSize < 4 ? 0
                        : subgroups.subgroupSize < 8            ? 4
                                                                : 8;
}

/* What is attempted, in messages. */
#define OPENING "open the device"

/* The device itself, and its queue. */
static bool make_device(Gpu *gpu)
{
    const char *extensions[] = {PORTABILITY_SUBSET};
    /* Nothing outside of a buffer is read or written: the layers are to see it if it is. */
    VkPhysicalDeviceFeatures offered, taken = {0};
    vkGetPhysicalDeviceFeatures(gpu->physical, &offered);
    taken.robustBufferAccess = offered.robustBufferAccess && !gpu->messenger;

    TRY(gpu, OPENING,
        vkCreateDevice(
            gpu->physical,
            &(VkDeviceCreateInfo){
                .sType                = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                .queueCreateInfoCount = 1,
                .pQueueCreateInfos =
                    &(VkDeviceQueueCreateInfo){
                        .sType            = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                        .queueFamilyIndex = gpu->family,
                        .queueCount       = 1,
                        .pQueuePriorities = &(float){1},
                    },
                .enabledExtensionCount   = vulkan_offers(gpu, gpu->physical, PORTABILITY_SUBSET),
                .ppEnabledExtensionNames = extensions,
                .pEnabledFeatures        = &taken,
            },
            NULL, &gpu->device));
    vkGetDeviceQueue(gpu->device, gpu->family, 0, &gpu->queue);
    return true;

failed:
    return false;
}

/* What commands need that are recorded, submitted, waited for and timed. */
static bool make_commands(Gpu *gpu)
{
    const VkCommandPoolCreateInfo pool = {
        .sType            = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags            = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
        .queueFamilyIndex = gpu->family,
    };
    TRY(gpu, OPENING, vkCreateCommandPool(gpu->device, &pool, NULL, &gpu->pool));
    TRY(gpu, OPENING, vkCreateCommandPool(gpu->device, &pool, NULL, &gpu->warm_up_pool));
    TRY(gpu, OPENING,
        vkAllocateCommandBuffers(gpu->device,
                                 &(VkCommandBufferAllocateInfo){
                                     .sType       = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                     .commandPool = gpu->pool,
                                     .level       = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                     .commandBufferCount = 1,
                                 },
                                 &gpu->commands));
    TRY(gpu, OPENING,
        vkCreateFence(gpu->device,
                      &(VkFenceCreateInfo){
                          .sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                      },
                      NULL, &gpu->fence));
    if (gpu->time_mask != 0)
        TRY(gpu, OPENING,
            vkCreateQueryPool(gpu->device,
                              &(VkQueryPoolCreateInfo){
                                  .sType      = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                  .queryType  = VK_QUERY_TYPE_TIMESTAMP,
                                  .queryCount = 2 + MOST_MARKS,
                              },
                              NULL, &gpu->times));
    gpu_name(gpu, VK_OBJECT_TYPE_COMMAND_BUFFER, (uint64_t)(uintptr_t)gpu->commands, "slice");
    return true;

failed:
    return false;
}

static bool device_create(Gpu *gpu, unsigned pretence)
{
    read_properties(gpu, pretence);
    vkGetPhysicalDeviceMemoryProperties(gpu->physical, &gpu->memory);
    return make_device(gpu) && make_commands(gpu);
}

static const double DEFAULT_PATIENCE = 300; /* seconds; a first submission also compiles */

static bool check_threads(Gpu *gpu)
{
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(gpu->physical, &properties);
    bool     software = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    unsigned wanted   = software ? threads_of_software_device() : 1,
             count    = threads_available(wanted);
    if (count == wanted)
        return true;
    gpu_refuse(gpu, KRS_OUT_OF_MEMORY,
               "cannot open the device: its driver makes %u threads, of "
               "which the system allows %u (`ulimit -u`, or the limits of a container)",
               wanted, count);
    return false;
}

bool gpu_open(Gpu *gpu, const KrsRendererOptions *options)
{
    static const KrsRendererOptions defaults;
    if (!options)
        options = &defaults;
    *gpu = (Gpu){
        .allocator = options->allocator,
        .complaint = options->complaint,
        .working   = options->working,
        .user      = options->user,
        .patience  = options->patience > 0 ? options->patience : DEFAULT_PATIENCE,
    };
    cache_open(&gpu->cache, options->cache, options->allocator);
    if (instance_create(gpu, options->validation) && choose_device(gpu, options->device) &&
        check_threads(gpu) && device_create(gpu, options->pretence)) {
        pipelines_open(gpu);
        return true;
    }
    gpu_close(gpu);
    return false;
}

bool gpu_open_beside(Gpu *gpu, const Gpu *other)
{
    *gpu = (Gpu){.physical = other->physical, .family = other->family, .patience = other->patience};
    if (device_create(gpu, other->texels ? 0 : KRS_PRETEND_LEAST_LIMITS))
        return true;
    gpu_close(gpu);
    return false;
}

void gpu_close(Gpu *gpu)
{
    if (gpu->stuck) { /* its driver would wait for it, too: all of it stays until the process ends */
        cache_close(&gpu->cache);
        return;
    }
    if (gpu->device) {
        pipelines_close(gpu);
        vkDestroyQueryPool(gpu->device, gpu->times, NULL);
        vkDestroyFence(gpu->device, gpu->fence, NULL);
        vkDestroyCommandPool(gpu->device, gpu->warm_up_pool, NULL);
        vkDestroyCommandPool(gpu->device, gpu->pool, NULL);
        vkDestroyDevice(gpu->device, NULL);
    }
    if (gpu->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy = (PFN_vkDestroyDebugUtilsMessengerEXT)
            vkGetInstanceProcAddr(gpu->instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(gpu->instance, gpu->messenger, NULL);
    }
    if (gpu->instance)
        vkDestroyInstance(gpu->instance, NULL);
    cache_close(&gpu->cache);
    gpu->device    = VK_NULL_HANDLE;
    gpu->messenger = VK_NULL_HANDLE;
    gpu->instance  = VK_NULL_HANDLE;
}

bool gpu_is_cpu(const Gpu *gpu)
{
    return gpu->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU && !gpu->pretends_card;
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
