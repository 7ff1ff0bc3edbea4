/*
 * limits.c: properties, limits and features of a device that the runtime depends on.
 */
#include "bench/device/device.h"
#include "runtime/device/driver.h"

#include <stdio.h>

static void print_driver(const Gpu *gpu)
{
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceFloatControlsProperties floats = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES, .pNext = &driver};
    VkPhysicalDeviceSubgroupProperties subgroups = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES, .pNext = &floats};
    VkPhysicalDeviceProperties2 all = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                       .pNext = &subgroups};
    vkGetPhysicalDeviceProperties2(gpu->driver->physical, &all);
    const VkPhysicalDeviceProperties *device = &all.properties;
    printf("| driver | %s %s, %#x |\n", driver.driverName, driver.driverInfo,
           device->driverVersion);
    printf("| Vulkan | %u.%u.%u |\n", VK_API_VERSION_MAJOR(device->apiVersion),
           VK_API_VERSION_MINOR(device->apiVersion), VK_API_VERSION_PATCH(device->apiVersion));
    printf("| vendor, device | %#x, %#x |\n", device->vendorID, device->deviceID);
    printf("| subgroupSize | %u |\n", subgroups.subgroupSize);
    printf("| subgroup operations | %#x%s%s |\n", subgroups.supportedOperations,
           subgroups.supportedOperations & VK_SUBGROUP_FEATURE_SHUFFLE_BIT ? ", shuffle" : "",
           subgroups.supportedOperations & VK_SUBGROUP_FEATURE_ARITHMETIC_BIT ? ", arithmetic"
                                                                              : "");
    printf("| float32: keeps NaN and infinity, denormals, rounds to even | %s, %s, %s |\n",
           floats.shaderSignedZeroInfNanPreserveFloat32 ? "yes" : "no",
           floats.shaderDenormPreserveFloat32 ? "yes" : "no",
           floats.shaderRoundingModeRTEFloat32 ? "yes" : "no");
}

static void print_numbers(const VkPhysicalDeviceLimits *l)
{
    const struct {
        const char *name;
        uint64_t    value;
    } rows[] = {
        {"maxTexelBufferElements", l->maxTexelBufferElements},
        {"maxStorageBufferRange", l->maxStorageBufferRange},
        {"maxUniformBufferRange", l->maxUniformBufferRange},
        {"maxPushConstantsSize", l->maxPushConstantsSize},
        {"maxPerStageDescriptorStorageBuffers", l->maxPerStageDescriptorStorageBuffers},
        {"maxPerStageDescriptorSampledImages", l->maxPerStageDescriptorSampledImages},
        {"maxPerStageResources", l->maxPerStageResources},
        {"maxComputeWorkGroupInvocations", l->maxComputeWorkGroupInvocations},
        {"maxComputeWorkGroupCount[0]", l->maxComputeWorkGroupCount[0]},
        {"maxComputeSharedMemorySize", l->maxComputeSharedMemorySize},
        {"maxMemoryAllocationCount", l->maxMemoryAllocationCount},
        {"minStorageBufferOffsetAlignment", l->minStorageBufferOffsetAlignment},
        {"timestampComputeAndGraphics", l->timestampComputeAndGraphics},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        printf("| %s | %llu |\n", rows[i].name, (unsigned long long)rows[i].value);
    printf("| timestampPeriod, ns | %g |\n", (double)l->timestampPeriod);
}

static void print_memory(const VkPhysicalDeviceMemoryProperties *memory)
{
    for (uint32_t i = 0; i < memory->memoryHeapCount; i++)
        printf("| heap %u, MiB | %llu%s |\n", i,
               (unsigned long long)(memory->memoryHeaps[i].size >> 20),
               memory->memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT ? ", device" : "");
    for (uint32_t i = 0; i < memory->memoryTypeCount; i++) {
        VkMemoryPropertyFlags flags = memory->memoryTypes[i].propertyFlags;
        printf("| memory type %u | heap %u%s%s%s%s |\n", i, memory->memoryTypes[i].heapIndex,
               flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT ? ", device local" : "",
               flags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT ? ", host visible" : "",
               flags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT ? ", coherent" : "",
               flags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT ? ", cached" : "");
    }
}

static void print_queues(VkPhysicalDevice physical)
{
    VkQueueFamilyProperties families[16];
    uint32_t                count = 16;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    for (uint32_t i = 0; i < count; i++)
        printf("| queue family %u | %u queues, flags %#x, clock of %u bits |\n", i,
               families[i].queueCount, families[i].queueFlags, families[i].timestampValidBits);
}

static void print_features(VkPhysicalDevice physical)
{
    VkPhysicalDeviceFeatures features;
    vkGetPhysicalDeviceFeatures(physical, &features);
    printf("| robustBufferAccess | %s |\n| shaderInt64 | %s |\n| shaderFloat64 | %s |\n",
           features.robustBufferAccess ? "yes" : "no", features.shaderInt64 ? "yes" : "no",
           features.shaderFloat64 ? "yes" : "no");
}

void print_device_limits(KrsRenderer *renderer)
{
    const Gpu *gpu = &renderer->gpu;
    puts("| | |\n| --- | --- |");
    print_driver(gpu);
    print_numbers(&gpu->driver->properties.limits);
    print_features(gpu->driver->physical);
    print_memory(&gpu->driver->memory);
    print_queues(gpu->driver->physical);
    printf("| krs: early outs | %s |\n| krs: lanes that refill | %u |\n",
           renderer->early_outs ? "on" : "off", gpu->refill_lanes);
    printf("| krs: reads texels | %s |\n", gpu->texels ? "yes" : "no");
}
