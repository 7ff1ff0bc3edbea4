/*
 * gpu.c: opening and closing a Vulkan device and its queue.
 */
#include "runtime/device/gpu.h"

#include "runtime/device/devices.h"
#include "runtime/device/driver.h"
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
    vkGetPhysicalDeviceProperties2(gpu->driver->physical, &properties);
    gpu->driver->properties              = properties.properties;
    const VkPhysicalDeviceLimits *limits = &gpu->driver->properties.limits;
    const bool                    least  = emulation & EMULATE_MIN_LIMITS;
    gpu->limits                          = (GpuLimits){
                                 .texels        = least ? MIN_TEXEL_LIMIT : limits->maxTexelBufferElements,
                                 .storage_bytes = least ? MIN_RANGE_LIMIT : limits->maxStorageBufferRange,
                                 .uniform_bytes = limits->maxUniformBufferRange,
                                 .uniform_step  = (uint32_t)limits->minUniformBufferOffsetAlignment,
    };
    gpu->emulates_card = emulation & EMULATE_CARD;
    gpu->texels        = devices_read_texels(gpu->limits.texels);
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
    vkGetPhysicalDeviceFeatures(gpu->driver->physical, &offered);
    taken.robustBufferAccess = offered.robustBufferAccess && !gpu->validates;

    TRY(gpu, OPENING,
        vkCreateDevice(gpu->driver->physical,
                       &(VkDeviceCreateInfo){
                           .sType                = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                           .queueCreateInfoCount = 1,
                           .pQueueCreateInfos =
                               &(VkDeviceQueueCreateInfo){
                                   .sType            = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                   .queueFamilyIndex = gpu->driver->family,
                                   .queueCount       = 1,
                                   .pQueuePriorities = &(float){1},
                               },
                           .enabledExtensionCount   = vulkan_offers(gpu, gpu->driver->physical,
                                                                    PORTABILITY_SUBSET),
                           .ppEnabledExtensionNames = extensions,
                           .pEnabledFeatures        = &taken,
                       },
                       NULL, &gpu->driver->device));
    vkGetDeviceQueue(gpu->driver->device, gpu->driver->family, 0, &gpu->driver->queue);
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
        .queueFamilyIndex = gpu->driver->family,
    };
    TRY(gpu, OPENING, vkCreateCommandPool(gpu->driver->device, &pool, NULL, &gpu->driver->pool));
    TRY(gpu, OPENING,
        vkCreateCommandPool(gpu->driver->device, &pool, NULL, &gpu->driver->prewarm_pool));
    TRY(gpu, OPENING,
        vkAllocateCommandBuffers(gpu->driver->device,
                                 &(VkCommandBufferAllocateInfo){
                                     .sType       = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                     .commandPool = gpu->driver->pool,
                                     .level       = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                     .commandBufferCount = 1,
                                 },
                                 &gpu->driver->commands));
    TRY(gpu, OPENING,
        vkCreateFence(gpu->driver->device,
                      &(VkFenceCreateInfo){
                          .sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                      },
                      NULL, &gpu->driver->fence));
    if (gpu->has_clock)
        TRY(gpu, OPENING,
            vkCreateQueryPool(gpu->driver->device,
                              &(VkQueryPoolCreateInfo){
                                  .sType      = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                  .queryType  = VK_QUERY_TYPE_TIMESTAMP,
                                  .queryCount = 2 + MAX_MARKS,
                              },
                              NULL, &gpu->driver->times));
    if (gpu->has_clock)
        TRY(gpu, OPENING,
            vkCreateQueryPool(gpu->driver->device,
                              &(VkQueryPoolCreateInfo){
                                  .sType      = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                  .queryType  = VK_QUERY_TYPE_TIMESTAMP,
                                  .queryCount = 2 * MAX_TIMED_PREWARMS,
                              },
                              NULL, &gpu->driver->prewarm_times));
    gpu_name(gpu, VK_OBJECT_TYPE_COMMAND_BUFFER, TO_HANDLE(gpu->driver->commands), "slice");
    return true;

failed:
    return false;
}

static bool device_create(Gpu *gpu, unsigned emulation)
{
    gpu->has_clock = gpu->driver->time_mask != 0;
    read_properties(gpu, emulation);
    vkGetPhysicalDeviceMemoryProperties(gpu->driver->physical, &gpu->driver->memory);
    return make_device(gpu) && make_commands(gpu);
}

static const double DEFAULT_TIMEOUT = 300; /* seconds; a first submission also compiles */

static bool check_threads(Gpu *gpu)
{
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(gpu->driver->physical, &properties);
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
    *gpu        = (Gpu){.timeout = other->timeout};
    gpu->driver = gpu_alloc(gpu, 1, sizeof *gpu->driver, OPENING);
    if (!gpu->driver)
        return false;
    gpu->driver->physical  = other->driver->physical;
    gpu->driver->family    = other->driver->family;
    gpu->driver->time_mask = other->driver->time_mask;
    if (device_create(gpu, other->texels ? 0 : EMULATE_MIN_LIMITS))
        return true;
    gpu_close(gpu);
    return false;
}

/* Destroys the device with what gpu_open and gpu_reopen made on it. */
static void device_destroy(Gpu *gpu)
{
    Driver        *driver = gpu->driver;
    const VkDevice device = driver->device;
    pipelines_close(gpu);
    vkDestroyQueryPool(device, driver->prewarm_times, NULL);
    vkDestroyQueryPool(device, driver->times, NULL);
    vkDestroyFence(device, driver->fence, NULL);
    vkDestroyCommandPool(device, driver->prewarm_pool, NULL);
    vkDestroyCommandPool(device, driver->pool, NULL);
    vkDestroyDevice(device, NULL);
    driver->prewarm_times = driver->times = VK_NULL_HANDLE;
    driver->prewarm_pool = driver->pool = VK_NULL_HANDLE;
    driver->fence                       = VK_NULL_HANDLE;
    driver->device                      = VK_NULL_HANDLE;
}

bool gpu_reopen(Gpu *gpu)
{
    shared_shaders_destroy(gpu);
    if (gpu_is_open(gpu))
        device_destroy(gpu);
    gpu->prewarms = 0;
    gpu->lost     = false;
    gpu->lost     = !make_device(gpu) || !make_commands(gpu);
    if (!gpu->lost)
        pipelines_open(gpu);
    return !gpu->lost;
}

void gpu_close(Gpu *gpu)
{
    if (gpu->stuck) { /* its driver would wait for it, too: all of it stays until the process ends */
        cache_close(&gpu->cache);
        gpu_release(gpu, gpu->driver);
        gpu->driver = NULL;
        return;
    }
    shared_shaders_destroy(gpu);
    if (gpu_is_open(gpu))
        device_destroy(gpu);
    instance_destroy(gpu);
    cache_close(&gpu->cache);
}
