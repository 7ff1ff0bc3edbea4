/*
 * vulkan_faults.c: a Vulkan layer that counts the calls which can fail, and lets one fail.
 *
 * KRS_VULKAN_FAULT=CALL:N:RESULT[:TIMES[:EVERY]] names a call ("any": all of them are counted together), its number from 1 on
 * in a process, what it returns (a number of VkResult), how many from there on fail (1), and every how many-th of them (1).
 * A call that fails is not passed on.  After VK_ERROR_DEVICE_LOST a device fails all that could tell, as real ones do, until
 * it is destroyed.
 * KRS_VULKAN_FAULT_LOG is a file: each process that ends writes there how many calls it made, and how many failed.
 */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

/* Calls of an instance or a physical device, and of a device or what belongs to it, that have a result: name,
   parameters, arguments; for the latter whether a lost device fails them. */
#define INSTANCE_CALLS(X) \
    X(EnumeratePhysicalDevices, (VkInstance a, uint32_t * b, VkPhysicalDevice * c), (a, b, c))

#define DEVICE_CALLS(X)                                                                            \
    X(CreateCommandPool,                                                                           \
      (VkDevice a, const VkCommandPoolCreateInfo *b, const VkAllocationCallbacks *c,               \
       VkCommandPool *d),                                                                          \
      (a, b, c, d), 0)                                                                             \
    X(AllocateCommandBuffers,                                                                      \
      (VkDevice a, const VkCommandBufferAllocateInfo *b, VkCommandBuffer *c), (a, b, c), 0)        \
    X(CreateFence,                                                                                 \
      (VkDevice a, const VkFenceCreateInfo *b, const VkAllocationCallbacks *c, VkFence *d),        \
      (a, b, c, d), 0)                                                                             \
    X(CreateQueryPool,                                                                             \
      (VkDevice a, const VkQueryPoolCreateInfo *b, const VkAllocationCallbacks *c,                 \
       VkQueryPool *d),                                                                            \
      (a, b, c, d), 0)                                                                             \
    X(CreateBuffer,                                                                                \
      (VkDevice a, const VkBufferCreateInfo *b, const VkAllocationCallbacks *c, VkBuffer *d),      \
      (a, b, c, d), 0)                                                                             \
    X(AllocateMemory,                                                                              \
      (VkDevice a, const VkMemoryAllocateInfo *b, const VkAllocationCallbacks *c,                  \
       VkDeviceMemory *d),                                                                         \
      (a, b, c, d), 0)                                                                             \
    X(BindBufferMemory, (VkDevice a, VkBuffer b, VkDeviceMemory c, VkDeviceSize d), (a, b, c, d),  \
      0)                                                                                           \
    X(MapMemory,                                                                                   \
      (VkDevice a, VkDeviceMemory b, VkDeviceSize c, VkDeviceSize d, VkMemoryMapFlags e,           \
       void **f),                                                                                  \
      (a, b, c, d, e, f), 0)                                                                       \
    X(CreateBufferView,                                                                            \
      (VkDevice a, const VkBufferViewCreateInfo *b, const VkAllocationCallbacks *c,                \
       VkBufferView *d),                                                                           \
      (a, b, c, d), 0)                                                                             \
    X(CreateDescriptorSetLayout,                                                                   \
      (VkDevice a, const VkDescriptorSetLayoutCreateInfo *b, const VkAllocationCallbacks *c,       \
       VkDescriptorSetLayout *d),                                                                  \
      (a, b, c, d), 0)                                                                             \
    X(CreatePipelineLayout,                                                                        \
      (VkDevice a, const VkPipelineLayoutCreateInfo *b, const VkAllocationCallbacks *c,            \
       VkPipelineLayout *d),                                                                       \
      (a, b, c, d), 0)                                                                             \
    X(CreateDescriptorPool,                                                                        \
      (VkDevice a, const VkDescriptorPoolCreateInfo *b, const VkAllocationCallbacks *c,            \
       VkDescriptorPool *d),                                                                       \
      (a, b, c, d), 0)                                                                             \
    X(AllocateDescriptorSets,                                                                      \
      (VkDevice a, const VkDescriptorSetAllocateInfo *b, VkDescriptorSet *c), (a, b, c), 0)        \
    X(CreateShaderModule,                                                                          \
      (VkDevice a, const VkShaderModuleCreateInfo *b, const VkAllocationCallbacks *c,              \
       VkShaderModule *d),                                                                         \
      (a, b, c, d), 0)                                                                             \
    X(CreateComputePipelines,                                                                      \
      (VkDevice a, VkPipelineCache b, uint32_t c, const VkComputePipelineCreateInfo *d,            \
       const VkAllocationCallbacks *e, VkPipeline *f),                                             \
      (a, b, c, d, e, f), 0)                                                                       \
    X(CreatePipelineCache,                                                                         \
      (VkDevice a, const VkPipelineCacheCreateInfo *b, const VkAllocationCallbacks *c,             \
       VkPipelineCache *d),                                                                        \
      (a, b, c, d), 0)                                                                             \
    X(GetPipelineCacheData, (VkDevice a, VkPipelineCache b, size_t * c, void *d), (a, b, c, d), 0) \
    X(ResetCommandPool, (VkDevice a, VkCommandPool b, VkCommandPoolResetFlags c), (a, b, c), 0)    \
    X(BeginCommandBuffer, (VkCommandBuffer a, const VkCommandBufferBeginInfo *b), (a, b), 0)       \
    X(EndCommandBuffer, (VkCommandBuffer a), (a), 0)                                               \
    X(QueueSubmit, (VkQueue a, uint32_t b, const VkSubmitInfo *c, VkFence d), (a, b, c, d), 1)     \
    X(WaitForFences, (VkDevice a, uint32_t b, const VkFence *c, VkBool32 d, uint64_t e),           \
      (a, b, c, d, e), 1)                                                                          \
    X(ResetFences, (VkDevice a, uint32_t b, const VkFence *c), (a, b, c), 0)                       \
    X(GetQueryPoolResults,                                                                         \
      (VkDevice a, VkQueryPool b, uint32_t c, uint32_t d, size_t e, void *f, VkDeviceSize g,       \
       VkQueryResultFlags h),                                                                      \
      (a, b, c, d, e, f, g, h), 1)

typedef enum Call {
    CALL_CreateInstance,
    CALL_CreateDevice,
#define INSTANCE_ID(name, parameters, arguments)     CALL_##name,
#define DEVICE_ID(name, parameters, arguments, lost) CALL_##name,
    INSTANCE_CALLS(INSTANCE_ID) DEVICE_CALLS(DEVICE_ID) CALL_COUNT
} Call;

static const char *const names[CALL_COUNT] = {"vkCreateInstance", "vkCreateDevice",
#define INSTANCE_NAME(name, parameters, arguments)     "vk" #name,
#define DEVICE_NAME(name, parameters, arguments, lost) "vk" #name,
                                              INSTANCE_CALLS(INSTANCE_NAME)
                                                  DEVICE_CALLS(DEVICE_NAME)};

/* ---- Which call fails ---- */

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static unsigned long   made[CALL_COUNT], made_of_any, failed, at, times = 1, every = 1;
static int             wanted; /* a Call, or CALL_COUNT: any */
static VkResult        result;

__attribute__((constructor)) static void begin(void)
{
    const char *fault = getenv("KRS_VULKAN_FAULT");
    char        name[64];
    int         number;
    if (!fault || sscanf(fault, "%63[^:]:%lu:%d:%lu:%lu", name, &at, &number, &times, &every) < 3)
        return;
    result = (VkResult)number;
    for (wanted = 0; wanted < CALL_COUNT && strcmp(names[wanted], name) != 0;)
        wanted++;
    if (wanted == CALL_COUNT && strcmp(name, "any") != 0) {
        fprintf(stderr, "vulkan_faults: there is no call %s\n", name);
        abort();
    }
}

__attribute__((destructor)) static void tell(void)
{
    const char *log  = getenv("KRS_VULKAN_FAULT_LOG");
    FILE       *file = log && made_of_any > 0 ? fopen(log, "a") : NULL;
    if (!file)
        return;
    fprintf(file, "any %lu failed %lu\n", made_of_any, failed);
    for (int call = 0; call < CALL_COUNT; call++)
        if (made[call] > 0)
            fprintf(file, "%s %lu\n", names[call], made[call]);
    fclose(file);
}

/* The loader's table of what it dispatches on is the first word of an object: devices, their queues and command buffers
   share it. */
#define TABLE_OF(object) (*(void **)(object))

enum { MAX_DEVICES = 64 };
typedef struct Device {
    void                   *table;
    VkDevice                device;
    int                     lost;
    PFN_vkGetDeviceProcAddr next;
    PFN_vkVoidFunction      calls[CALL_COUNT];
} Device;
static Device devices[MAX_DEVICES];

static PFN_vkGetInstanceProcAddr next_of_instance;
static VkInstance                the_instance;
static PFN_vkVoidFunction
    instance_calls[CALL_COUNT]; /* later the loader would begin at the first layer again */

static Device *find(void *table)
{
    for (int i = 0; i < MAX_DEVICES; i++)
        if (devices[i].table == table)
            return &devices[i];
    abort();
}

/* Counts a call; VK_SUCCESS: it is passed on. */
static VkResult count(Call call, Device *device, int fails_if_lost)
{
    VkResult answer = VK_SUCCESS;
    pthread_mutex_lock(&lock);
    made[call]++;
    made_of_any++;
    const unsigned long number = wanted == CALL_COUNT ? made_of_any : made[call];
    if (at > 0 && (wanted == CALL_COUNT || wanted == (int)call) && number >= at &&
        (number - at) % every == 0 && (number - at) / every < times) {
        answer = result;
        failed++;
        if (device && answer == VK_ERROR_DEVICE_LOST)
            device->lost = 1;
    }
    if (answer == VK_SUCCESS && device && device->lost && fails_if_lost)
        answer = VK_ERROR_DEVICE_LOST;
    pthread_mutex_unlock(&lock);
    return answer;
}

/* ---- Calls ---- */

#define INSTANCE_CALL(name, parameters, arguments)                                          \
    static VKAPI_ATTR VkResult VKAPI_CALL layer_##name parameters                           \
    {                                                                                       \
        const VkResult answer = count(CALL_##name, NULL, 0);                                \
        return answer != VK_SUCCESS ? answer                                                \
                                    : ((PFN_vk##name)instance_calls[CALL_##name])arguments; \
    }
INSTANCE_CALLS(INSTANCE_CALL)

#define DEVICE_CALL(name, parameters, arguments, lost)                                     \
    static VKAPI_ATTR VkResult VKAPI_CALL layer_##name parameters                          \
    {                                                                                      \
        Device        *device = find(TABLE_OF(a));                                         \
        const VkResult answer = count(CALL_##name, device, lost);                          \
        return answer != VK_SUCCESS ? answer                                               \
                                    : ((PFN_vk##name)device->calls[CALL_##name])arguments; \
    }
DEVICE_CALLS(DEVICE_CALL)

/* Nothing of a lost device runs any more. */
static VKAPI_ATTR VkResult VKAPI_CALL layer_DeviceWaitIdle(VkDevice of)
{
    Device  *device = find(TABLE_OF(of));
    VkResult answer = ((PFN_vkDeviceWaitIdle)device->next(of, "vkDeviceWaitIdle"))(of);
    return device->lost ? VK_ERROR_DEVICE_LOST : answer;
}

static VKAPI_ATTR void VKAPI_CALL layer_DestroyDevice(VkDevice                     of,
                                                      const VkAllocationCallbacks *callbacks)
{
    if (!of)
        return;
    Device *device = find(TABLE_OF(of));
    ((PFN_vkDestroyDevice)device->next(of, "vkDestroyDevice"))(of, callbacks);
    pthread_mutex_lock(&lock);
    *device = (Device){0};
    pthread_mutex_unlock(&lock);
}

static VKAPI_ATTR VkResult VKAPI_CALL layer_CreateInstance(const VkInstanceCreateInfo  *info,
                                                           const VkAllocationCallbacks *callbacks,
                                                           VkInstance                  *instance)
{
    VkLayerInstanceCreateInfo *link   = (VkLayerInstanceCreateInfo *)(uintptr_t)info->pNext;
    const VkResult             answer = count(CALL_CreateInstance, NULL, 0);
    while (link && !(link->sType == VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO &&
                     link->function == VK_LAYER_LINK_INFO))
        link = (VkLayerInstanceCreateInfo *)(uintptr_t)link->pNext;
    if (!link)
        return VK_ERROR_INITIALIZATION_FAILED;
    if (answer != VK_SUCCESS)
        return answer;
    next_of_instance       = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo     = link->u.pLayerInfo->pNext;
    const VkResult created = ((PFN_vkCreateInstance)next_of_instance(NULL, "vkCreateInstance"))(
        info, callbacks, instance);
    if (created != VK_SUCCESS)
        return created;
    the_instance = *instance;
    for (int call = 0; call < CALL_COUNT; call++)
        instance_calls[call] = next_of_instance(*instance, names[call]);
    return VK_SUCCESS;
}

static VKAPI_ATTR VkResult VKAPI_CALL layer_CreateDevice(VkPhysicalDevice             physical,
                                                         const VkDeviceCreateInfo    *info,
                                                         const VkAllocationCallbacks *callbacks,
                                                         VkDevice                    *device)
{
    VkLayerDeviceCreateInfo *link   = (VkLayerDeviceCreateInfo *)(uintptr_t)info->pNext;
    const VkResult           answer = count(CALL_CreateDevice, NULL, 0);
    while (link && !(link->sType == VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO &&
                     link->function == VK_LAYER_LINK_INFO))
        link = (VkLayerDeviceCreateInfo *)(uintptr_t)link->pNext;
    if (!link)
        return VK_ERROR_INITIALIZATION_FAILED;
    if (answer != VK_SUCCESS)
        return answer;
    const PFN_vkGetInstanceProcAddr of_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    const PFN_vkGetDeviceProcAddr   of_device   = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo                          = link->u.pLayerInfo->pNext;
    const VkResult created = ((PFN_vkCreateDevice)of_instance(the_instance, "vkCreateDevice"))(
        physical, info, callbacks, device);
    if (created != VK_SUCCESS)
        return created;
    pthread_mutex_lock(&lock);
    Device *entry = find(NULL);
    *entry        = (Device){.table = TABLE_OF(*device), .device = *device, .next = of_device};
    for (int call = 0; call < CALL_COUNT; call++)
        entry->calls[call] = of_device(*device, names[call]);
    pthread_mutex_unlock(&lock);
    return VK_SUCCESS;
}

/* ---- What the loader asks ---- */

static PFN_vkVoidFunction own(const char *name)
{
    static const struct {
        const char        *name;
        PFN_vkVoidFunction function;
    } functions[] = {{"vkCreateInstance", (PFN_vkVoidFunction)layer_CreateInstance},
                     {"vkCreateDevice", (PFN_vkVoidFunction)layer_CreateDevice},
                     {"vkDestroyDevice", (PFN_vkVoidFunction)layer_DestroyDevice},
                     {"vkDeviceWaitIdle", (PFN_vkVoidFunction)layer_DeviceWaitIdle},
#define INSTANCE_ENTRY(name, parameters, arguments) {"vk" #name, (PFN_vkVoidFunction)layer_##name},
#define DEVICE_ENTRY(name, parameters, arguments, lost) \
    {"vk" #name, (PFN_vkVoidFunction)layer_##name},
                     INSTANCE_CALLS(INSTANCE_ENTRY) DEVICE_CALLS(DEVICE_ENTRY)};
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
        if (strcmp(functions[i].name, name) == 0)
            return functions[i].function;
    return NULL;
}

VK_LAYER_EXPORT PFN_vkVoidFunction VKAPI_CALL faults_GetDeviceProcAddr(VkDevice    device,
                                                                       const char *name)
{
    const PFN_vkVoidFunction function = own(name);
    return function ? function : find(TABLE_OF(device))->next(device, name);
}

VK_LAYER_EXPORT PFN_vkVoidFunction VKAPI_CALL faults_GetInstanceProcAddr(VkInstance  instance,
                                                                         const char *name)
{
    if (strcmp(name, "vkGetDeviceProcAddr") == 0)
        return (PFN_vkVoidFunction)faults_GetDeviceProcAddr;
    if (strcmp(name, "vkGetInstanceProcAddr") == 0)
        return (PFN_vkVoidFunction)faults_GetInstanceProcAddr;
    const PFN_vkVoidFunction function = own(name);
    return function ? function : next_of_instance ? next_of_instance(instance, name) : NULL;
}

VK_LAYER_EXPORT VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *interface)
{
    interface->loaderLayerInterfaceVersion  = CURRENT_LOADER_LAYER_INTERFACE_VERSION;
    interface->pfnGetInstanceProcAddr       = faults_GetInstanceProcAddr;
    interface->pfnGetDeviceProcAddr         = faults_GetDeviceProcAddr;
    interface->pfnGetPhysicalDeviceProcAddr = NULL;
    return VK_SUCCESS;
}
