/*
 * devices.c: which Vulkan devices there are, and which of them is taken.
 */
#include "runtime/device/devices.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "runtime/device/driver.h"
#include "runtime/device/instance.h"

/* The texels below which buffers are read in their place: the lowest band of the widest picture has
   so many (band.c). */
#define MIN_TEXELS (1u << 22)

bool devices_read_texels(uint32_t texels) { return texels >= MIN_TEXELS; }

static uint32_t needed_buffers(const VkPhysicalDeviceLimits *limits)
{
    return STORAGE_BUFFERS +
           (devices_read_texels(limits->maxTexelBufferElements) ? 0 : STORAGE_BUFFERS_FOR_TEXELS);
}

/* Tells whether the device has what all shaders need. */
static bool is_capable(const VkPhysicalDeviceProperties *properties)
{
    const VkPhysicalDeviceLimits *limits = &properties->limits;
    return properties->apiVersion >= VK_API_VERSION_1_1 &&
           limits->maxPerStageDescriptorStorageBuffers >= needed_buffers(limits);
}

/* Finds the first queue family with compute, and how many bits its clock has; false when there is
   none.  No device has more families than are looked at. */
static bool find_family(VkPhysicalDevice physical, uint32_t *family, uint32_t *clock_bits)
{
    VkQueueFamilyProperties families[32];
    uint32_t                count = 32;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    for (uint32_t i = 0; i < count; i++)
        if (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) {
            *family     = i;
            *clock_bits = families[i].timestampValidBits;
            return true;
        }
    return false;
}

static KrsDevice describe(VkPhysicalDevice physical)
{
    VkPhysicalDeviceProperties properties;
    uint32_t                   family, clock_bits;
    vkGetPhysicalDeviceProperties(physical, &properties);
    KrsDevice device = {
        .api_version = properties.apiVersion,
        .usable      = is_capable(&properties) && find_family(physical, &family, &clock_bits),
    };
    snprintf(device.name, sizeof device.name, "%s", properties.deviceName);
    switch (properties.deviceType) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: device.kind = KRS_DEVICE_DISCRETE; break;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: device.kind = KRS_DEVICE_INTEGRATED; break;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: device.kind = KRS_DEVICE_VIRTUAL; break;
    case VK_PHYSICAL_DEVICE_TYPE_CPU: device.kind = KRS_DEVICE_CPU; break;
    default: device.kind = KRS_DEVICE_OTHER;
    }
    return device;
}

KrsDevice gpu_describe(const Gpu *gpu) { return describe(gpu->driver->physical); }

/* Returns all physical devices, in memory of the host; NULL with the failure noted. */
static VkPhysicalDevice *find_devices(Gpu *gpu, uint32_t *count)
{
    VkPhysicalDevice *devices = NULL;
    VkResult          result;
    do { /* a device may come while we ask */
        gpu_release(gpu, devices);
        devices = NULL;
        TRY(gpu, "list the Vulkan devices",
            vkEnumeratePhysicalDevices(gpu->driver->instance, count, NULL));
        devices = gpu_alloc(gpu, *count, sizeof *devices, "list the Vulkan devices");
        if (!devices)
            return NULL;
        result = vkEnumeratePhysicalDevices(gpu->driver->instance, count, devices);
    } while (result == VK_INCOMPLETE);
    TRY(gpu, "list the Vulkan devices", result);
    if (*count > 0)
        return devices;
    gpu_refuse(gpu, KRS_NO_DEVICE, NO_DEVICE);

failed:
    gpu_release(gpu, devices);
    return NULL;
}

static bool all_digits(const char *text)
{
    while (isdigit((unsigned char)*text))
        text++;
    return *text == '\0';
}

/* Tells whether `device`, of number `index`, is one that the words ask for. */
static bool wanted(const KrsDevice *device, uint32_t index, const char *words)
{
    if (!words || !*words)
        return true;
    if (strcasecmp(words, "cpu") == 0)
        return device->kind == KRS_DEVICE_CPU;
    if (all_digits(words))
        return strtoul(words, NULL, 10) == index;
    return strcasestr(device->name, words) != NULL;
}

/* Returns the usable device that is wanted; of several the first when words name it, else the first
   of the best kind.  `count` when there is none. */
static uint32_t choose(const VkPhysicalDevice *devices, uint32_t count, const char *words)
{
    uint32_t      best      = count;
    KrsDeviceKind best_kind = KRS_DEVICE_OTHER;
    for (uint32_t i = 0; i < count; i++) {
        KrsDevice device = describe(devices[i]);
        if (!device.usable || !wanted(&device, i, words))
            continue;
        if (words && *words)
            return i;
        if (best == count || device.kind > best_kind) { /* the enum rises from worse to better */
            best      = i;
            best_kind = device.kind;
        }
    }
    return best;
}

bool gpu_list(Gpu *gpu, KrsDevice *devices, size_t capacity, size_t *count)
{
    *count = 0;
    if (!instance_create(gpu, false)) {
        instance_destroy(gpu);
        return false;
    }
    uint32_t          found    = 0;
    VkPhysicalDevice *physical = find_devices(gpu, &found);
    if (physical) {
        uint32_t preferred = choose(physical, found, NULL);
        *count             = found;
        for (uint32_t i = 0; i < found && i < capacity; i++) {
            devices[i]           = describe(physical[i]);
            devices[i].preferred = i == preferred;
        }
    }
    gpu_release(gpu, physical);
    instance_destroy(gpu);
    return physical != NULL;
}

/* Says why none of the devices that the words ask for can be used. */
static void refuse_devices(Gpu *gpu, const VkPhysicalDevice *devices, uint32_t count,
                           const char *words)
{
    for (uint32_t i = 0; i < count; i++) {
        VkPhysicalDeviceProperties properties;
        KrsDevice                  device = describe(devices[i]);
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        uint32_t buffers = properties.limits.maxPerStageDescriptorStorageBuffers;
        uint32_t needed  = needed_buffers(&properties.limits);
        if (!wanted(&device, i, words) || buffers >= needed)
            continue;
        gpu_refuse(gpu, KRS_NO_DEVICE,
                   "the device `%s` gives a shader %u storage buffers, and krs needs %u",
                   device.name, buffers, needed);
        return;
    }
    if (words && *words)
        gpu_refuse(gpu, KRS_NO_DEVICE,
                   "no usable Vulkan device is called `%s`: `krs devices` lists them", words);
    else
        gpu_refuse(gpu, KRS_NO_DEVICE, NO_DEVICE);
}

bool choose_device(Gpu *gpu, const char *words)
{
    uint32_t          count   = 0;
    VkPhysicalDevice *devices = find_devices(gpu, &count);
    if (!devices)
        return false;
    uint32_t chosen = choose(devices, count, words);
    uint32_t bits   = 0;
    bool     found  = chosen < count && find_family(devices[chosen], &gpu->driver->family, &bits);
    if (found) {
        gpu->driver->physical  = devices[chosen];
        gpu->driver->time_mask = bits >= 64 ? UINT64_MAX : (UINT64_C(1) << bits) - 1;
    } else {
        refuse_devices(gpu, devices, count, words);
    }
    gpu_release(gpu, devices);
    return found;
}
