/*
 * pipelines.c: pipelines of a driver are kept, and those of another device are not taken for them.
 *
 * lavapipe keeps no pipelines of its own.  Mesa's driver for AMD's cards can pretend to have one,
 * which compiles, and keeps what it compiled, but has no queue to run it on.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "compiler/passes/compile.h"
#include "runtime/device/pipelines.h"
#include "tests/support/folder.h"
#include "tests/unit/compiled_files.h"

/* The card that is not there: no queue can be had, so gpu_open would not take it.  False when
   Mesa lacks the driver. */
static bool pretend_to_open(Gpu *gpu)
{
    uint32_t         count = 8;
    VkPhysicalDevice devices[8];
    setenv("RADV_FORCE_FAMILY", "navi21", 1);
    assert_int_equal(vkCreateInstance(
                         &(VkInstanceCreateInfo){
                             .sType            = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                             .pApplicationInfo = &(
                                 VkApplicationInfo){.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                                    .apiVersion = VK_API_VERSION_1_1},
                         },
                         NULL, &gpu->driver->instance),
                     VK_SUCCESS);
    assert_true(vkEnumeratePhysicalDevices(gpu->driver->instance, &count, devices) >= VK_SUCCESS);
    unsetenv("RADV_FORCE_FAMILY");
    for (uint32_t i = 0; i < count && !gpu->driver->physical; i++) {
        vkGetPhysicalDeviceProperties(devices[i], &gpu->driver->properties);
        if (strstr(gpu->driver->properties.deviceName, "NAVI21"))
            gpu->driver->physical = devices[i];
    }
    if (!gpu->driver->physical) {
        vkDestroyInstance(gpu->driver->instance, NULL);
        return false;
    }
    assert_int_equal(vkCreateDevice(gpu->driver->physical,
                                    &(VkDeviceCreateInfo){
                                        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                        .queueCreateInfoCount = 1,
                                        .pQueueCreateInfos =
                                            &(VkDeviceQueueCreateInfo){
                                                .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                                .queueCount       = 1,
                                                .pQueuePriorities = &(float){1},
                                            },
                                    },
                                    NULL, &gpu->driver->device),
                     VK_SUCCESS);
    return true;
}

static void make_pipeline(const Gpu *gpu, const uint32_t *words, size_t bytes)
{
    VkShaderModule   module;
    VkPipelineLayout layout;
    VkPipeline       pipeline;
    assert_int_equal(vkCreateShaderModule(gpu->driver->device,
                                          &(VkShaderModuleCreateInfo){
                                              .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                              .codeSize = bytes,
                                              .pCode    = words},
                                          NULL, &module),
                     VK_SUCCESS);
    assert_int_equal(
        vkCreatePipelineLayout(
            gpu->driver->device,
            &(VkPipelineLayoutCreateInfo){.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO},
            NULL, &layout),
        VK_SUCCESS);
    assert_int_equal(vkCreateComputePipelines(
                         gpu->driver->device, gpu->driver->pipelines, 1,
                         &(VkComputePipelineCreateInfo){
                             .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                             .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                       .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                       .module = module,
                                       .pName  = "main"},
                             .layout = layout},
                         NULL, &pipeline),
                     VK_SUCCESS);
    vkDestroyPipeline(gpu->driver->device, pipeline, NULL);
    vkDestroyPipelineLayout(gpu->driver->device, layout, NULL);
    vkDestroyShaderModule(gpu->driver->device, module, NULL);
}

/* Bytes that drivers keep at most of no pipeline: a header, and some numbers. */
enum { NOTHING = sizeof(VkPipelineCacheHeaderVersionOne) + 32 };

/* A run that makes one pipeline, or none; returns how much of the driver's data it began with. */
static size_t run_on(Gpu *gpu, const uint32_t *words, size_t bytes)
{
    cache_open(&gpu->cache, folder, (KrsAllocator){0});
    gpu->pipelines_loaded = 0;
    pipelines_open(gpu);
    assert_true(gpu->driver->pipelines != VK_NULL_HANDLE);
    if (words)
        make_pipeline(gpu, words, bytes);
    pipelines_close(gpu);
    cache_close(&gpu->cache);
    return gpu->pipelines_loaded;
}

static void pipelines_are_kept(void **state)
{
    (void)state;
    Driver    driver = {0};
    Gpu       gpu    = {.driver = &driver};
    uint32_t *words;
    size_t    count;
    char      name[NAME_MAX + 1], *log;
    if (!pretend_to_open(&gpu))
        skip();
    spirv_start();
    assert_int_equal(spirv_compile(small_text, "test", &words, &count, &log), KRS_OK);
    spirv_stop();

    assert_int_equal(run_on(&gpu, NULL, 0), 0);
    assert_true(run_on(&gpu, words, 4 * count) <= NOTHING);
    assert_int_equal(count_files_that_end(".pipelines", name), 1);
    assert_true(run_on(&gpu, words, 4 * count) > NOTHING); /* some drivers fill up what they load */
    size_t loaded = run_on(&gpu, words, 4 * count);
    ino_t  number = number_of(name);
    assert_int_equal(run_on(&gpu, words, 4 * count), loaded);
    assert_int_equal(number_of(name), number); /* it was known, so nothing has grown */

    assert_int_equal(truncate(name, 100), 0);
    assert_int_equal(run_on(&gpu, words, 4 * count), 0);
    assert_true(run_on(&gpu, words, 4 * count) > NOTHING);

    /* Another device finds nothing, and what its driver would not have made is not kept. */
    gpu.driver->properties.vendorID ^= 1;
    assert_int_equal(run_on(&gpu, words, 4 * count), 0);
    assert_int_equal(count_files_that_end(".pipelines", name), 1);
    gpu.driver->properties.vendorID ^= 1;
    free(words);
    vkDestroyDevice(gpu.driver->device, NULL);
    vkDestroyInstance(gpu.driver->instance, NULL);
}

static void lavapipe_keeps_none(void **state)
{
    (void)state;
    char               name[NAME_MAX + 1];
    KrsRendererOptions options = {.device = "llvmpipe", .cache = folder};
    KrsStatus          status  = open_and_close(&options);
    if (status == KRS_NO_DEVICE)
        skip(); /* another driver for the processor */
    assert_int_equal(status, KRS_OK);
    assert_int_equal(count_files_that_end(".pipelines", name), 0);
}

#define in_folder(test) cmocka_unit_test_setup_teardown(test, enter_folder, leave_folder)
int main(void)
{
    const struct CMUnitTest tests[] = {
        in_folder(lavapipe_keeps_none),
        in_folder(pipelines_are_kept),
    };
    return cmocka_run_group_tests_name("pipelines", tests, NULL, NULL);
}
