/*
 * gpu.c: opening and closing a Vulkan device and its queue.
 */
#include "runtime/device/gpu.h"

#include "runtime/device/devices.h"
#include "runtime/device/instance.h"
#include "runtime/device/pipelines.h"
#include "runtime/device/resources.h"
#include "runtime/device/shared_shaders.h"

/* The limit that every device must have at least (Vulkan, table 53). */
#define MIN_TEXEL_LIMIT (1u << 16)
#define MIN_RANGE_LIMIT (1u << 27)

static void read_properties(Gpu *gpu, unsigned emulation)
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
    if (emulation & EMULATE_MIN_LIMITS) {
        limits->maxTexelBufferElements = MIN_TEXEL_LIMIT;
        limits->maxStorageBufferRange  = MIN_RANGE_LIMIT;
    }
    gpu->emulates_card = emulation & EMULATE_CARD;
    gpu->texels        = devices_read_texels(limits);
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

/* The attempt that messages name. */
#define OPENING "open the device"

/* Makes the device and its queue. */
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

/* Makes what commands need that are recorded, submitted, waited for and timed. */
static bool make_commands(Gpu *gpu)
{
    const VkCommandPoolCreateInfo pool = {
        .sType            = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags            = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
        .queueFamilyIndex = gpu->family,
    };
    TRY(gpu, OPENING, vkCreateCommandPool(gpu->device, &pool, NULL, &gpu->pool));
    TRY(gpu, OPENING, vkCreateCommandPool(gpu->device, &pool, NULL, &gpu->prewarm_pool));
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
                                  .queryCount = 2 + MAX_MARKS,
                              },
                              NULL, &gpu->times));
    if (gpu->time_mask != 0)
        TRY(gpu, OPENING,
            vkCreateQueryPool(gpu->device,
                              &(VkQueryPoolCreateInfo){
                                  .sType      = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                  .queryType  = VK_QUERY_TYPE_TIMESTAMP,
                                  .queryCount = 2 * MAX_TIMED_PREWARMS,
                              },
                              NULL, &gpu->prewarm_times));
    gpu_name(gpu, VK_OBJECT_TYPE_COMMAND_BUFFER, (uint64_t)(uintptr_t)gpu->commands, "slice");
    return true;

failed:
    return false;
}

static bool device_create(Gpu *gpu, unsigned emulation)
{
    read_properties(gpu, emulation);
    vkGetPhysicalDeviceMemoryProperties(gpu->physical, &gpu->memory);
    return make_device(gpu) && make_commands(gpu);
}

static const double DEFAULT_TIMEOUT = 300; /* seconds; a first submission also compiles */

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

bool gpu_open(Gpu *gpu, const KrsRendererOptions *options, unsigned emulation)
{
    static const KrsRendererOptions defaults;
    if (!options)
        options = &defaults;
    *gpu = (Gpu){
        .allocator          = options->allocator,
        .validation_message = options->validation_message,
        .working            = options->working,
        .user               = options->user,
        .compiling          = options->progress,
        .compiling_user     = options->progress_user,
        .timeout            = options->timeout > 0 ? options->timeout : DEFAULT_TIMEOUT,
    };
    cache_open(&gpu->cache, options->cache, options->allocator);
    if (instance_create(gpu, options->validation) && choose_device(gpu, options->device) &&
        check_threads(gpu) && device_create(gpu, emulation)) {
        pipelines_open(gpu);
        return true;
    }
    gpu_close(gpu);
    return false;
}

bool gpu_open_beside(Gpu *gpu, const Gpu *other)
{
    *gpu = (Gpu){.physical  = other->physical,
                 .family    = other->family,
                 .time_mask = other->time_mask,
                 .timeout   = other->timeout};
    if (device_create(gpu, other->texels ? 0 : EMULATE_MIN_LIMITS))
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
    shared_shaders_destroy(gpu);
    if (gpu->device) {
        pipelines_close(gpu);
        vkDestroyQueryPool(gpu->device, gpu->prewarm_times, NULL);
        vkDestroyQueryPool(gpu->device, gpu->times, NULL);
        vkDestroyFence(gpu->device, gpu->fence, NULL);
        vkDestroyCommandPool(gpu->device, gpu->prewarm_pool, NULL);
        vkDestroyCommandPool(gpu->device, gpu->pool, NULL);
        vkDestroyDevice(gpu->device, NULL);
    }
    gpu->device = VK_NULL_HANDLE;
    instance_destroy(gpu);
    cache_close(&gpu->cache);
}
