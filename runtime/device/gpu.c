/*
 * gpu.c: opening a Vulkan device: instance, validation, choice, queue.
 */
#include "runtime/device/gpu.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>

#include "runtime/device/pipelines.h"
#include "runtime/device/resources.h"

#define VALIDATION_LAYER "VK_LAYER_KHRONOS_validation"
/* Where fewer texels than that can be read, buffers are: the lowest band of the widest picture has
   so many (render.c). */
#define LEAST_TEXELS (1u << 22)
/* What every device must have at least (Vulkan, table 53). */
#define LEAST_TEXEL_LIMIT (1u << 16)
#define LEAST_RANGE_LIMIT (1u << 27)

#define NO_DEVICE \
    "no usable Vulkan device: install a driver, for example Debian's mesa-vulkan-drivers"

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

/* ---- Instance and validation ---- */

static VKAPI_ATTR VkBool32 VKAPI_CALL take_complaint(
    VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT type,
    const VkDebugUtilsMessengerCallbackDataEXT *data, void *user)
{
    (void)severity;
    (void)type;
    Gpu *gpu = user;
    gpu->complaints++;
    if (gpu->complaint)
        gpu->complaint(gpu->user, data->pMessage ? data->pMessage : "");
    return VK_FALSE;
}

/* Devices that do not have all of Vulkan (on macOS none has) are listed to those only who ask for
   them by this; and one that says so of itself wants to hear that it is known. */
#define PORTABILITY_SUBSET "VK_KHR_portability_subset" /* in a header of its own */

/* Whether an extension is among those that are offered: by a device, or without one by Vulkan. */
static bool is_offered(Gpu *gpu, VkPhysicalDevice physical, const char *extension)
{
    uint32_t count  = 0;
    bool     found  = false;
    VkResult result = physical ? vkEnumerateDeviceExtensionProperties(physical, NULL, &count, NULL)
                               : vkEnumerateInstanceExtensionProperties(NULL, &count, NULL);
    VkExtensionProperties *offered = result == VK_SUCCESS
                                         ? gpu_alloc(gpu, count, sizeof *offered, "list extensions")
                                         : NULL;
    if (offered)
        result = physical ? vkEnumerateDeviceExtensionProperties(physical, NULL, &count, offered)
                          : vkEnumerateInstanceExtensionProperties(NULL, &count, offered);
    for (uint32_t i = 0; offered && result == VK_SUCCESS && i < count; i++)
        found = found || strcmp(offered[i].extensionName, extension) == 0;
    gpu_release(gpu, offered);
    return found;
}

static bool instance_create(Gpu *gpu, bool validation)
{
    const char *layers[]        = {VALIDATION_LAYER}, *extensions[3];
    uint32_t    extension_count = 0;
    bool        portability     = is_offered(gpu, VK_NULL_HANDLE,
                                             VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
    if (portability)
        extensions[extension_count++] = VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME;
    if (validation) {
        extensions[extension_count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
        extensions[extension_count++] = VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;
    }
    VkValidationFeatureEnableEXT enables[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkDebugUtilsMessengerCreateInfoEXT listen = {
        .sType           = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType     = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = take_complaint,
        .pUserData       = gpu,
    };
    VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &listen, /* also while the instance itself is made and unmade */
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures    = enables,
    };
    TRY(gpu, "start Vulkan",
        vkCreateInstance(
            &(VkInstanceCreateInfo){
                .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                .pNext = validation ? &features : NULL,
                .flags = portability ? VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR : 0,
                .pApplicationInfo =
                    &(VkApplicationInfo){
                        .sType            = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                        .pApplicationName = "krs",
                        .pEngineName      = "krs",
                        .apiVersion       = VK_API_VERSION_1_1,
                    },
                .enabledLayerCount       = validation,
                .ppEnabledLayerNames     = layers,
                .enabledExtensionCount   = extension_count,
                .ppEnabledExtensionNames = extensions,
            },
            NULL, &gpu->instance));

    if (validation) {
        PFN_vkCreateDebugUtilsMessengerEXT create = (PFN_vkCreateDebugUtilsMessengerEXT)
            vkGetInstanceProcAddr(gpu->instance, "vkCreateDebugUtilsMessengerEXT");
        if (create)
            TRY(gpu, "listen to the validation layers",
                create(gpu->instance, &listen, NULL, &gpu->messenger));
        gpu->set_name = (PFN_vkSetDebugUtilsObjectNameEXT)vkGetInstanceProcAddr(
            gpu->instance, "vkSetDebugUtilsObjectNameEXT");
    }
    return true;

failed:
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

/* ---- Choice ---- */

/* Whether the device has what all kernels need. */
static bool is_capable(const VkPhysicalDeviceProperties *properties)
{
    return properties->apiVersion >= VK_API_VERSION_1_1 &&
           properties->limits.maxPerStageDescriptorStorageBuffers >= STORAGE_BUFFERS;
}

/* The first queue family with compute, and how many bits its clock has; false when there is
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

KrsDevice gpu_describe(VkPhysicalDevice physical)
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

/* All physical devices, in memory of the host; NULL with the failure noted. */
static VkPhysicalDevice *find_devices(Gpu *gpu, uint32_t *count)
{
    VkPhysicalDevice *devices = NULL;
    VkResult          result;
    do { /* a device may come while we ask */
        gpu_release(gpu, devices);
        devices = NULL;
        TRY(gpu, "list the Vulkan devices", vkEnumeratePhysicalDevices(gpu->instance, count, NULL));
        devices = gpu_alloc(gpu, *count, sizeof *devices, "list the Vulkan devices");
        if (!devices)
            return NULL;
        result = vkEnumeratePhysicalDevices(gpu->instance, count, devices);
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

/* Whether `device`, of number `index`, is one that the words ask for. */
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

/* The usable device that is wanted; of several the first when words name it, else the first of
   the best kind.  `count` when there is none. */
static uint32_t choose(const VkPhysicalDevice *devices, uint32_t count, const char *words)
{
    uint32_t      best      = count;
    KrsDeviceKind best_kind = KRS_DEVICE_OTHER;
    for (uint32_t i = 0; i < count; i++) {
        KrsDevice device = gpu_describe(devices[i]);
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
    if (!instance_create(gpu, false))
        return false;
    uint32_t          found    = 0;
    VkPhysicalDevice *physical = find_devices(gpu, &found);
    if (physical) {
        uint32_t preferred = choose(physical, found, NULL);
        *count             = found;
        for (uint32_t i = 0; i < found && i < capacity; i++) {
            devices[i]           = gpu_describe(physical[i]);
            devices[i].preferred = i == preferred;
        }
    }
    gpu_release(gpu, physical);
    gpu_close(gpu);
    return physical != NULL;
}

/* Says why none of the devices that the words ask for can be used. */
static void refuse_devices(Gpu *gpu, const VkPhysicalDevice *devices, uint32_t count,
                           const char *words)
{
    for (uint32_t i = 0; i < count; i++) {
        VkPhysicalDeviceProperties properties;
        KrsDevice                  device = gpu_describe(devices[i]);
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        uint32_t buffers = properties.limits.maxPerStageDescriptorStorageBuffers;
        if (!wanted(&device, i, words) || buffers >= STORAGE_BUFFERS)
            continue;
        gpu_refuse(gpu, KRS_NO_DEVICE,
                   "the device `%s` gives a kernel %u storage buffers, and krs needs %d",
                   device.name, buffers, STORAGE_BUFFERS);
        return;
    }
    if (words && *words)
        gpu_refuse(gpu, KRS_NO_DEVICE,
                   "no usable Vulkan device is called `%s`: `krs devices` lists them", words);
    else
        gpu_refuse(gpu, KRS_NO_DEVICE, NO_DEVICE);
}

static bool choose_device(Gpu *gpu, const char *words)
{
    uint32_t          count   = 0;
    VkPhysicalDevice *devices = find_devices(gpu, &count);
    if (!devices)
        return false;
    uint32_t chosen = choose(devices, count, words);
    uint32_t bits   = 0;
    bool     found  = chosen < count && find_family(devices[chosen], &gpu->family, &bits);
    if (found) {
        gpu->physical  = devices[chosen];
        gpu->time_mask = bits >= 64 ? UINT64_MAX : (UINT64_C(1) << bits) - 1;
    } else {
        refuse_devices(gpu, devices, count, words);
    }
    gpu_release(gpu, devices);
    return found;
}

/* ---- Device ---- */

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

static bool device_create(Gpu *gpu, unsigned pretence)
{
    read_properties(gpu, pretence);
    vkGetPhysicalDeviceMemoryProperties(gpu->physical, &gpu->memory);
    const char *extensions[] = {PORTABILITY_SUBSET};
    /* Nothing outside of a buffer is read or written: the layers are to see it if it is. */
    VkPhysicalDeviceFeatures offered, taken = {0};
    vkGetPhysicalDeviceFeatures(gpu->physical, &offered);
    taken.robustBufferAccess = offered.robustBufferAccess && !gpu->messenger;

    const char *attempt = "open the device";
    TRY(gpu, attempt,
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
                .enabledExtensionCount   = is_offered(gpu, gpu->physical, PORTABILITY_SUBSET),
                .ppEnabledExtensionNames = extensions,
                .pEnabledFeatures        = &taken,
            },
            NULL, &gpu->device));
    vkGetDeviceQueue(gpu->device, gpu->family, 0, &gpu->queue);

    const VkCommandPoolCreateInfo pool = {
        .sType            = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags            = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
        .queueFamilyIndex = gpu->family,
    };
    TRY(gpu, attempt, vkCreateCommandPool(gpu->device, &pool, NULL, &gpu->pool));
    TRY(gpu, attempt, vkCreateCommandPool(gpu->device, &pool, NULL, &gpu->warm_up_pool));
    TRY(gpu, attempt,
        vkAllocateCommandBuffers(gpu->device,
                                 &(VkCommandBufferAllocateInfo){
                                     .sType       = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                     .commandPool = gpu->pool,
                                     .level       = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                     .commandBufferCount = 1,
                                 },
                                 &gpu->commands));
    TRY(gpu, attempt,
        vkCreateFence(gpu->device,
                      &(VkFenceCreateInfo){
                          .sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                      },
                      NULL, &gpu->fence));
    if (gpu->time_mask != 0)
        TRY(gpu, attempt,
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
