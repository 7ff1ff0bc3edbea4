/*
 * instance.c: starting and ending Vulkan, and listening to its validation layers.
 */
#include "runtime/device/instance.h"

#include <stdio.h>
#include <string.h>

#define VALIDATION_LAYER "VK_LAYER_KHRONOS_validation"

static VKAPI_ATTR VkBool32 VKAPI_CALL take_validation_message(
    VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT type,
    const VkDebugUtilsMessengerCallbackDataEXT *data, void *user)
{
    (void)severity;
    (void)type;
    Gpu        *gpu     = user;
    const char *message = data->pMessage ? data->pMessage : "";
    const char *name    = data->pMessageIdName ? data->pMessageIdName : "";
    char        text[8192];
    gpu->validation_messages++;
    if (!strstr(message, name)) { /* some versions of the layers leave it out */
        snprintf(text, sizeof text, "%s: %s", name, message);
        message = text;
    }
    if (gpu->validation_message)
        gpu->validation_message(gpu->user, message);
    return VK_FALSE;
}

bool vulkan_offers(Gpu *gpu, VkPhysicalDevice physical, const char *extension)
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

/* Tells how the layers are listened to. */
static VkDebugUtilsMessengerCreateInfoEXT listener(Gpu *gpu)
{
    return (VkDebugUtilsMessengerCreateInfoEXT){
        .sType           = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType     = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = take_validation_message,
        .pUserData       = gpu,
    };
}

/* Listens from here on, and finds the function that gives objects names in the messages. */
static bool start_listening(Gpu *gpu, const VkDebugUtilsMessengerCreateInfoEXT *listen)
{
    PFN_vkCreateDebugUtilsMessengerEXT create = (PFN_vkCreateDebugUtilsMessengerEXT)
        vkGetInstanceProcAddr(gpu->driver->instance, "vkCreateDebugUtilsMessengerEXT");
    if (create)
        TRY(gpu, "listen to the validation layers",
            create(gpu->driver->instance, listen, NULL, &gpu->driver->messenger));
    gpu->driver->set_name = (PFN_vkSetDebugUtilsObjectNameEXT)vkGetInstanceProcAddr(
        gpu->driver->instance, "vkSetDebugUtilsObjectNameEXT");
    return true;

failed:
    return false;
}

bool instance_create(Gpu *gpu, bool validation)
{
    gpu->driver = gpu_alloc(gpu, 1, sizeof *gpu->driver, "start Vulkan");
    if (!gpu->driver)
        return false;
    gpu->validates              = validation;
    const char *layers[]        = {VALIDATION_LAYER}, *extensions[3];
    uint32_t    extension_count = 0;
    bool        portability     = vulkan_offers(gpu, VK_NULL_HANDLE,
                                                VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
    if (portability)
        extensions[extension_count++] = VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME;
    if (validation) {
        extensions[extension_count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
        extensions[extension_count++] = VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;
    }
    VkValidationFeatureEnableEXT enables[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkDebugUtilsMessengerCreateInfoEXT listen   = listener(gpu);
    VkValidationFeaturesEXT            features = {
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
            NULL, &gpu->driver->instance));

    return !validation || start_listening(gpu, &listen);

failed:
    return false;
}

void instance_destroy(Gpu *gpu)
{
    if (!gpu->driver)
        return;
    if (gpu->driver->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy = (PFN_vkDestroyDebugUtilsMessengerEXT)
            vkGetInstanceProcAddr(gpu->driver->instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(gpu->driver->instance, gpu->driver->messenger, NULL);
    }
    if (gpu->driver->instance)
        vkDestroyInstance(gpu->driver->instance, NULL);
    gpu_release(gpu, gpu->driver);
    gpu->driver = NULL;
}
