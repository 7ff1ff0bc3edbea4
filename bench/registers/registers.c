/*
 * registers.c: what a driver's compiler says of shaders: registers, spills, waves.
 *
 * Mesa's driver for AMD compiles for cards that are not there (RADV_FORCE_FAMILY), so no hardware
 * is needed; KRS_DEVICE names another device, by a part of its name.  Each argument is a module as
 * `krs compile` writes them, SCENE.KERNEL.spv.
 */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <vulkan/vulkan.h>

#include "bench/fixture.h"

static const char card[] = "navi21";

enum { MAX_STATISTICS = 64, MAX_BINDINGS = 64, SETS = 2 };

/* What is told, in this order, by the names that Mesa's driver has for it. */
static const struct {
    const char *column, *name;
} columns[] = {
    {"vector registers", "VGPRs"},       {"scalar registers", "SGPRs"},
    {"spilled vector", "Spilled VGPRs"}, {"spilled scalar", "Spilled SGPRs"},
    {"waves", "Subgroups per SIMD"},     {"scratch", "Scratch size"},
    {"instructions", "Instructions"},    {"code bytes", "Code size"},
};
enum { COLUMNS = sizeof columns / sizeof columns[0] };

static void check(VkResult result, const char *what)
{
    char words[32];
    snprintf(words, sizeof words, "Vulkan error %d", result);
    if (result != VK_SUCCESS)
        give_up(what, words);
}

/* ---- The device ---- */

static bool has_statistics(VkPhysicalDevice physical)
{
    uint32_t               count = 0;
    VkExtensionProperties *all   = NULL;
    bool                   found = false;
    check(vkEnumerateDeviceExtensionProperties(physical, NULL, &count, NULL), "extensions");
    all = calloc(count + 1, sizeof *all);
    if (!all)
        give_up("extensions", "no memory");
    check(vkEnumerateDeviceExtensionProperties(physical, NULL, &count, all), "extensions");
    for (uint32_t i = 0; i < count; i++)
        found |= strcmp(all[i].extensionName,
                        VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME) == 0;
    free(all);
    return found;
}

static VkPhysicalDevice find_device(VkInstance instance, char *name)
{
    VkPhysicalDevice devices[16];
    uint32_t         count    = 16;
    const char      *asked    = getenv("KRS_DEVICE");
    bool             is_asked = asked && *asked;
    check(vkEnumeratePhysicalDevices(instance, &count, devices), "list the devices");
    for (uint32_t i = 0; i < count; i++) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        if (strcasestr(properties.deviceName, is_asked ? asked : card)) {
            snprintf(name, VK_MAX_PHYSICAL_DEVICE_NAME_SIZE, "%s", properties.deviceName);
            if (!has_statistics(devices[i]))
                give_up(name, "the driver tells nothing of its pipelines");
            return devices[i];
        }
    }
    give_up(is_asked ? asked : card, "there is no such device (Debian: mesa-vulkan-drivers)");
}

static VkDevice open_device(VkPhysicalDevice physical)
{
    VkDevice                                                device;
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
        .pipelineExecutableInfo = VK_TRUE,
    };
    const char *extension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
    check(vkCreateDevice(physical,
                         &(VkDeviceCreateInfo){
                             .sType                = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                             .pNext                = &statistics,
                             .queueCreateInfoCount = 1,
                             .pQueueCreateInfos =
                                 &(VkDeviceQueueCreateInfo){
                                     .sType            = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                     .queueCount       = 1,
                                     .pQueuePriorities = &(float){1},
                                 },
                             .enabledExtensionCount   = 1,
                             .ppEnabledExtensionNames = &extension,
                         },
                         NULL, &device),
          "open the device");
    return device;
}

/* ---- A module ---- */

typedef struct Module {
    uint32_t *words;
    size_t    count;
} Module;

static Module read_module(const char *path)
{
    FILE  *file   = fopen(path, "rb");
    Module module = {0};
    long   bytes  = 0;
    if (file && fseek(file, 0, SEEK_END) == 0 && (bytes = ftell(file)) > 0) {
        rewind(file);
        module.words = malloc((size_t)bytes);
        module.count = (size_t)bytes / sizeof *module.words;
    }
    if (!module.words ||
        fread(module.words, sizeof *module.words, module.count, file) != module.count)
        give_up(path, "cannot be read");
    fclose(file);
    return module;
}

/* What a module says of an id, by the numbers of the SPIR-V specification. */
typedef struct IdInfo {
    uint32_t set, binding, storage, type; /* of a variable its pointer, of that what it points to */
    bool     bound, is_texels, is_old_buffer;
} IdInfo;

static void read_instruction(const uint32_t *word, IdInfo *ids)
{
    enum {
        TYPE_IMAGE         = 25,
        TYPE_SAMPLED_IMAGE = 27,
        TYPE_POINTER       = 32,
        VARIABLE           = 59,
        DECORATE           = 71,
        BUFFER_BLOCK       = 3,
        BINDING            = 33,
        DESCRIPTOR_SET     = 34
    };
    switch (*word & 0xffff) {
    case TYPE_IMAGE:
    case TYPE_SAMPLED_IMAGE: ids[word[1]].is_texels = true; break;
    case TYPE_POINTER:
        ids[word[1]].storage = word[2];
        ids[word[1]].type    = word[3];
        break;
    case VARIABLE: ids[word[2]].type = word[1]; break;
    case DECORATE:
        if (word[2] == BUFFER_BLOCK)
            ids[word[1]].is_old_buffer = true;
        if (word[2] == DESCRIPTOR_SET)
            ids[word[1]].set = word[3];
        if (word[2] == BINDING) {
            ids[word[1]].binding = word[3];
            ids[word[1]].bound   = true;
        }
        break;
    }
}

static VkDescriptorType kind_of(const IdInfo *ids, const IdInfo *variable)
{
    enum { UNIFORM = 2 };
    const IdInfo *pointer = &ids[variable->type], *type = &ids[pointer->type];
    return type->is_texels ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
           : pointer->storage == UNIFORM && !type->is_old_buffer
               ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
               : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

/* Returns the layout that the module's own bindings ask for. */
static VkPipelineLayout make_layout(VkDevice device, const Module *module,
                                    VkDescriptorSetLayout sets[SETS])
{
    VkDescriptorSetLayoutBinding bindings[SETS][MAX_BINDINGS];
    uint32_t                     counts[SETS] = {0}, bound = module->words[3];
    IdInfo                      *ids = calloc(bound, sizeof *ids);
    VkPipelineLayout             layout;
    if (!ids)
        give_up("bindings", "no memory");
    for (size_t at = 5; at < module->count; at += module->words[at] >> 16)
        read_instruction(&module->words[at], ids);
    for (uint32_t id = 0; id < bound; id++)
        if (ids[id].bound && ids[id].set < SETS && counts[ids[id].set] < MAX_BINDINGS)
            bindings[ids[id].set][counts[ids[id].set]++] = (VkDescriptorSetLayoutBinding){
                .binding         = ids[id].binding,
                .descriptorType  = kind_of(ids, &ids[id]),
                .descriptorCount = 1,
                .stageFlags      = VK_SHADER_STAGE_COMPUTE_BIT,
            };
    free(ids);
    for (int i = 0; i < SETS; i++)
        check(vkCreateDescriptorSetLayout(
                  device,
                  &(VkDescriptorSetLayoutCreateInfo){
                      .sType        = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                      .bindingCount = counts[i],
                      .pBindings    = bindings[i],
                  },
                  NULL, &sets[i]),
              "a layout");
    check(vkCreatePipelineLayout(device,
                                 &(VkPipelineLayoutCreateInfo){
                                     .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                     .setLayoutCount         = SETS,
                                     .pSetLayouts            = sets,
                                     .pushConstantRangeCount = 1,
                                     .pPushConstantRanges    = &(
                                         VkPushConstantRange){VK_SHADER_STAGE_COMPUTE_BIT, 0, 128},
                                 },
                                 NULL, &layout),
          "a layout");
    return layout;
}

/* ---- What is told of it ---- */

static unsigned long long value_of(const VkPipelineExecutableStatisticKHR *statistic)
{
    switch (statistic->format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR: return statistic->value.u64;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
        return (unsigned long long)statistic->value.i64;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR: return statistic->value.b32;
    default: return (unsigned long long)statistic->value.f64;
    }
}

static void print_statistics(VkDevice device, VkPipeline pipeline)
{
    static VkPipelineExecutableStatisticKHR  statistics[MAX_STATISTICS];
    uint32_t                                 count = MAX_STATISTICS;
    PFN_vkGetPipelineExecutableStatisticsKHR get   = (PFN_vkGetPipelineExecutableStatisticsKHR)
        vkGetDeviceProcAddr(device, "vkGetPipelineExecutableStatisticsKHR");
    for (uint32_t i = 0; i < MAX_STATISTICS; i++)
        statistics[i].sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
    check(get(device,
              &(VkPipelineExecutableInfoKHR){
                  .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, .pipeline = pipeline},
              &count, statistics),
          "statistics");
    for (int column = 0; column < COLUMNS; column++) {
        bool found = false;
        for (uint32_t i = 0; i < count && !found; i++) {
            found = strcmp(statistics[i].name, columns[column].name) == 0;
            if (found)
                printf(" %llu |", value_of(&statistics[i]));
        }
        if (!found)
            printf(" |");
    }
    if (getenv("ALL_STATISTICS"))
        for (uint32_t i = 0; i < count; i++)
            fprintf(stderr, "%s: %llu\n", statistics[i].name, value_of(&statistics[i]));
}

/* "out/04-school.trace.spv" is shader trace of scene 04-school. */
static void print_names(const char *path)
{
    const char *scene  = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    int         length = (int)strcspn(scene, ".");
    const char *shader = scene + length + (scene[length] == '.');
    printf("| %.*s | %.*s |", length, scene, (int)strcspn(shader, "."), shader);
}

static void print_row(VkDevice device, const char *path)
{
    Module                module = read_module(path);
    VkDescriptorSetLayout sets[SETS];
    VkPipelineLayout      layout = make_layout(device, &module, sets);
    VkShaderModule        shader;
    VkPipeline            pipeline;
    check(vkCreateShaderModule(device,
                               &(VkShaderModuleCreateInfo){
                                   .sType    = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                   .codeSize = module.count * sizeof *module.words,
                                   .pCode    = module.words,
                               },
                               NULL, &shader),
          path);
    check(vkCreateComputePipelines(
              device, VK_NULL_HANDLE, 1,
              &(VkComputePipelineCreateInfo){
                  .sType  = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                  .flags  = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR,
                  .stage  = {.sType  = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                             .stage  = VK_SHADER_STAGE_COMPUTE_BIT,
                             .module = shader,
                             .pName  = "main"},
                  .layout = layout,
              },
              NULL, &pipeline),
          path);
    print_names(path);
    print_statistics(device, pipeline);
    putchar('\n');
    fflush(stdout);
    vkDestroyPipeline(device, pipeline, NULL);
    vkDestroyShaderModule(device, shader, NULL);
    vkDestroyPipelineLayout(device, layout, NULL);
    for (int i = 0; i < SETS; i++)
        vkDestroyDescriptorSetLayout(device, sets[i], NULL);
    free(module.words);
}

int main(int argc, char **argv)
{
    VkInstance instance;
    char       name[VK_MAX_PHYSICAL_DEVICE_NAME_SIZE];
    setenv("RADV_FORCE_FAMILY", card, 0);
    check(vkCreateInstance(
              &(VkInstanceCreateInfo){
                  .sType            = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                  .pApplicationInfo = &(
                      VkApplicationInfo){.sType      = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                         .apiVersion = VK_API_VERSION_1_1},
              },
              NULL, &instance),
          "start Vulkan");
    VkPhysicalDevice physical = find_device(instance, name);
    VkDevice         device   = open_device(physical);
    printf("%s\n\n| scene | shader |", name);
    for (int i = 0; i < COLUMNS; i++)
        printf(" %s |", columns[i].column);
    puts("");
    for (int i = 0; i < COLUMNS + 2; i++)
        printf("| --- ");
    puts("|");
    for (int i = 1; i < argc; i++)
        print_row(device, argv[i]);
    vkDestroyDevice(device, NULL);
    vkDestroyInstance(instance, NULL);
    return 0;
}
