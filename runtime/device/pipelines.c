/*
 * pipelines.c: loads a driver's pipeline cache, and saves it when it has grown.
 */
#include "runtime/device/pipelines.h"

#include <stdio.h>
#include <string.h>

#include "compiler/base/allocator.h"

/* The size at which data that grow with every scene start anew. */
static const size_t LARGE = CACHE_ENTRY_BYTES / 2;

bool pipelines_fit(const VkPhysicalDeviceProperties *device, const void *bytes, size_t length)
{
    VkPipelineCacheHeaderVersionOne header;
    if (length <= sizeof header)
        return false;
    memcpy(&header, bytes, sizeof header);
    return header.headerSize == sizeof header &&
           header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
           header.vendorID == device->vendorID && header.deviceID == device->deviceID &&
           memcmp(header.pipelineCacheUUID, device->pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

static CacheKey device_key(const VkPhysicalDeviceProperties *device)
{
    char maker[96];
    snprintf(maker, sizeof maker, "pipelines: vendor %x, device %x, driver %x", device->vendorID,
             device->deviceID, device->driverVersion);
    return cache_key(maker, device->pipelineCacheUUID, VK_UUID_SIZE);
}

static VkResult create(Gpu *gpu, const void *bytes, size_t length)
{
    return vkCreatePipelineCache(gpu->driver->device,
                                 &(VkPipelineCacheCreateInfo){
                                     .sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                     .initialDataSize = length,
                                     .pInitialData    = bytes,
                                 },
                                 NULL, &gpu->driver->pipelines);
}

void pipelines_open(Gpu *gpu)
{
    if (!gpu->cache.folder)
        return;
    size_t length = 0;
    void  *bytes  = cache_load(&gpu->cache, CACHE_PIPELINES, device_key(&gpu->driver->properties),
                               &length);
    if (bytes && length < LARGE && pipelines_fit(&gpu->driver->properties, bytes, length) &&
        create(gpu, bytes, length) == VK_SUCCESS)
        gpu->pipelines_loaded = length;
    else if (create(gpu, NULL, 0) != VK_SUCCESS)
        gpu->driver->pipelines = VK_NULL_HANDLE;
    gpu_release(gpu, bytes);
}

/* Saves the pipelines.  lavapipe's data is a header and nothing else, which does not fit, so
   nothing is written: Mesa keeps its pipelines by itself. */
static void save(Gpu *gpu)
{
    size_t length = 0;
    if (vkGetPipelineCacheData(gpu->driver->device, gpu->driver->pipelines, &length, NULL) !=
            VK_SUCCESS ||
        length <= gpu->pipelines_loaded)
        return;
    void *bytes = allocator_new(&gpu->allocator, length, 1); /* without it nothing is saved */
    if (bytes &&
        vkGetPipelineCacheData(gpu->driver->device, gpu->driver->pipelines, &length, bytes) ==
            VK_SUCCESS &&
        pipelines_fit(&gpu->driver->properties, bytes, length))
        cache_store(&gpu->cache, CACHE_PIPELINES, device_key(&gpu->driver->properties), bytes,
                    length);
    allocator_release(&gpu->allocator, bytes);
}

void pipelines_close(Gpu *gpu)
{
    if (gpu->driver->pipelines) {
        save(gpu);
        vkDestroyPipelineCache(gpu->driver->device, gpu->driver->pipelines, NULL);
    }
    gpu->driver->pipelines = VK_NULL_HANDLE;
}
