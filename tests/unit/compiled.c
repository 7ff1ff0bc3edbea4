/*
 * compiled.c: what is compiled once is not compiled again: shaders come from the cache, also under
 * scarce memory; and glslang may be wanted by several threads at once.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "compiler/base/embedded.h"
#include "compiler/passes/compile.h"
#include "runtime/device/driver.h"
#include "runtime/device/shader.h"
#include "runtime/tracer/handles.h"
#include "tests/support/device.h"
#include "tests/support/folder.h"
#include "tests/support/scarce.h"
#include "tests/unit/compiled_files.h"

/* Makes a scene ready, whose shaders the program cannot carry. */
static KrsStatus prepare_scene(const KrsRendererOptions *options)
{
    static const char text[] = "show sphere(1);\n";
    KrsRenderer      *renderer;
    KrsRendering     *rendering = NULL;
    KrsScene         *scene;
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene), KRS_OK);
    KrsStatus status = krs_renderer_new(options, &renderer);
    if (status == KRS_OK)
        status = krs_rendering_new(renderer, scene, KRS_FOR_PICTURES, &rendering);
    krs_rendering_free(rendering);
    krs_renderer_free(renderer);
    krs_scene_free(scene);
    return status;
}

static void a_shader_is_compiled_once(void **state)
{
    (void)state;
    char               name[NAME_MAX + 1];
    KrsRendererOptions options = {.device = tested_device(), .cache = folder};
    assert_int_equal(prepare_scene(&options), KRS_OK);
    int shaders = count_files_that_end(".spirv", name);
    assert_true(shaders > 0);
    ino_t number = number_of(name);
    assert_int_equal(prepare_scene(&options), KRS_OK);
    assert_int_equal(count_files_that_end(".spirv", name), shaders);
    assert_int_equal(number_of(name), number);

    assert_int_equal(truncate(name, 100), 0);
    assert_int_equal(prepare_scene(&options), KRS_OK);
    assert_int_equal(count_files_that_end(".spirv", name), shaders);
    number = number_of(name);
    struct stat repaired;
    assert_int_equal(stat(name, &repaired), 0);
    assert_true(repaired.st_size > 100);
    assert_int_equal(prepare_scene(&options), KRS_OK);
    assert_int_equal(number_of(name), number);
}

static void nothing_is_written_unasked(void **state)
{
    (void)state;
    char name[NAME_MAX + 1];
    setenv("XDG_CACHE_HOME", folder, 1);
    setenv("HOME", folder, 1);
    assert_int_equal(prepare_scene(&(KrsRendererOptions){.device = tested_device()}), KRS_OK);
    assert_int_equal(count_files_that_end(".spirv", name), 0);
    assert_int_equal(access("krs", F_OK), -1);
}

/* As the scene's text (set 0) and frame.glsl (set 1) have them: texels where shaders only read. */
static VkDescriptorType type_of_binding(int set, uint32_t binding)
{
    const bool read[] = {binding >= 1 && binding <= 3,
                         binding == 8 || (binding >= 10 && binding <= 17)};
    if (set == 1 && binding == WORK_BINDING)
        return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC;
    if (binding == 0)
        return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    return read[set] ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

/* Returns a layout that has room for the bindings of any shader. */
static Handle make_layout(Gpu *gpu)
{
    enum { SETS = 2, BINDINGS = FRAME_BINDINGS };
    VkDescriptorSetLayoutBinding bindings[BINDINGS];
    VkDescriptorSetLayout        sets[SETS];
    VkPipelineLayout             layout;
    for (int set = 0; set < SETS; set++) {
        for (uint32_t i = 0; i < BINDINGS; i++)
            bindings[i] = (VkDescriptorSetLayoutBinding){.binding         = i,
                                                         .descriptorCount = 1,
                                                         .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
                                                         .descriptorType = type_of_binding(set, i)};
        assert_int_equal(vkCreateDescriptorSetLayout(
                             gpu->driver->device,
                             &(VkDescriptorSetLayoutCreateInfo){
                                 .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                 .bindingCount = BINDINGS,
                                 .pBindings    = bindings},
                             NULL, &sets[set]),
                         VK_SUCCESS);
    }
    assert_int_equal(
        vkCreatePipelineLayout(gpu->driver->device,
                               &(VkPipelineLayoutCreateInfo){
                                   .sType          = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                   .setLayoutCount = SETS,
                                   .pSetLayouts    = sets,
                               },
                               NULL, &layout),
        VK_SUCCESS);
    for (int i = 0; i < SETS; i++)
        vkDestroyDescriptorSetLayout(gpu->driver->device, sets[i], NULL);
    return TO_HANDLE(layout);
}

/* Returns a shader that needs no scene. */
static const char *find_shader(void)
{
    for (const EmbeddedFile *file = shader_files; file->name; file++)
        if (strstr(file->name, ".comp") && !strstr(file->text, "#include \"scene.glsl\""))
            return file->name;
    fail_msg("every shader includes the scene");
    return NULL;
}

/* A shader without a scene comes with the program: nothing is compiled for it.  A sphere's own are
   those of its rays, normals, secondary rays, albedos of occluders and shading. */
static void some_shaders_come_along(void **state)
{
    (void)state;
    char               name[NAME_MAX + 1];
    KrsRendererOptions options = {.device = tested_device(), .cache = folder};
    assert_int_equal(open_and_close(&options), KRS_OK);
    assert_int_equal(count_files_that_end(".spirv", name), 0);
    assert_int_equal(prepare_scene(&options), KRS_OK);
    assert_int_equal(count_files_that_end(".spirv", name), 5);
}

/* The key of the cache is of what is compiled: comments, blank lines and blanks before a line's end
   are no part of it, and nothing else is lost. */
static void comments_are_not_compiled(void **state)
{
    (void)state;
    static const struct {
        const char *given, *left;
    } texts[] = {
        {"", ""},
        {"// only this", " "},
        {"a;\n// b\nc;\n", "a;\nc;\n"},
        {"a; // b\n\n \t\nc; \r\n", "a;\nc;\n"},
        {"a/* b */c\n", "a c\n"},
        {"a /* b\n// c */ d\n", "a   d\n"},
        {"a // b /* c\nd // */ e\n", "a\nd\n"},
        {"#define A(b) b / 2 // half\nA(c) / d;\n", "#define A(b) b / 2\nA(c) / d;\n"},
        {"a /*/ b */ c\n", "a   c\n"},
        {"a /* never closed\nb", "a  "},
        {"    indented;\n", "    indented;\n"},
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char text[64];
        snprintf(text, sizeof text, "%s", texts[i].given);
        shader_strip(text);
        assert_string_equal(text, texts[i].left);
    }
}

/* Several variants of a shader: all are made, or the reason is told. */
static void shaders_are_compiled_together(void **state)
{
    enum { SHADERS = 4 };
    (void)state;
    Gpu                      gpu;
    const char              *file = find_shader();
    Shader                   shaders[SHADERS];
    ShaderRequest            requests[SHADERS];
    double                   spirv_ms = 0, pipeline_ms = 0;
    char                     name[NAME_MAX + 1];
    static const char *const defines[SHADERS] = {"#define VARIANT 0\n", "#define VARIANT 1\n",
                                                 "#define VARIANT 2\n", "#error refused\n"};
    assert_true(
        gpu_open(&gpu, &(KrsRendererOptions){.device = tested_device(), .cache = folder}, 0));
    Handle layout = make_layout(&gpu);
    for (int i = 0; i < SHADERS; i++)
        requests[i] = (ShaderRequest){&shaders[i], {file, NULL, defines[i]}};

    spirv_start();
    for (int kept = 0; kept < 2; kept++) { /* compiled, then from the cache */
        assert_true(
            shader_create_all(&gpu, requests, SHADERS - 1, layout, &spirv_ms, &pipeline_ms));
        for (int i = 0; i < SHADERS - 1; i++) {
            assert_true(shaders[i].pipeline != 0);
            shader_destroy(&gpu, &shaders[i]);
        }
        assert_int_equal(count_files_that_end(".spirv", name), SHADERS - 1);
    }
    assert_false(shader_create_all(&gpu, requests, SHADERS, layout, &spirv_ms, &pipeline_ms));
    assert_int_equal(gpu.status, KRS_INTERNAL);
    assert_non_null(strstr(gpu.message, file));
    for (int i = 0; i < SHADERS; i++)
        shader_destroy(&gpu, &shaders[i]);
    requests[1].source.file = "missing.comp";
    assert_false(shader_create_all(&gpu, requests, 2, layout, &spirv_ms, &pipeline_ms));
    assert_non_null(strstr(gpu.message, "missing.comp"));
    spirv_stop();
    vkDestroyPipelineLayout(gpu.driver->device, FROM_HANDLE(VkPipelineLayout, layout), NULL);
    gpu_close(&gpu);
}

static KrsStatus prepare_with(Scarce scarce)
{
    KrsRendererOptions options = {
        .device = tested_device(), .cache = folder, .allocator = scarce_allocator(&scarce)};
    KrsStatus status = prepare_scene(&options);
    assert_true(status == KRS_OK || status == KRS_OUT_OF_MEMORY);
    assert_int_equal(scarce.held, 0);
    return status;
}

/* No memory from each allocation on in turn, until there is plenty.  Once it suffices, the cache
   is filled, and what lies there needs memory of its own; where that is missing, it is compiled. */
static void memory_that_runs_out_is_reported(void **state)
{
    enum { PLENTY = 120 };
    (void)state;
    int failures = 0;
    spirv_start(); /* so that glslang starts once */
    for (int left = 0; left < PLENTY; left++)
        failures += prepare_with((Scarce){.failing = left + 1, .lasting = true}) != KRS_OK;
    assert_true(failures > 20 && failures < PLENTY / 2);
    assert_int_equal(prepare_with((Scarce){.failing = PLENTY + 1, .lasting = true}), KRS_OK);
    spirv_stop();
}

/* ---- Rehearsals ---- */

/* Shaders are run before they are needed on devices of type CPU alone; an emulated card has nothing
   to run them with, so that it would crash. */
static void graphics_cards_do_not_rehearse(void **state)
{
    (void)state;
    static const char  text[]  = "show sphere(1);\n";
    KrsRendererOptions options = {.device = tested_device()};
    KrsRenderer       *renderer;
    KrsRendering      *rendering;
    KrsScene          *scene;
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene), KRS_OK);
    assert_int_equal(krs_renderer_new(&options, &renderer), KRS_OK);
    Gpu          *gpu          = &renderer->gpu;
    VkCommandPool prewarm_pool = gpu->driver->prewarm_pool;
    assert_true(gpu_wait(gpu));
    gpu->driver->properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    gpu->driver->prewarm_pool          = VK_NULL_HANDLE;
    assert_int_equal(krs_rendering_new(renderer, scene, KRS_FOR_PICTURES, &rendering), KRS_OK);
    gpu->driver->prewarm_pool = prewarm_pool;
    krs_rendering_free(rendering);
    krs_renderer_free(renderer);
    krs_scene_free(scene);
}

/* ---- glslang ---- */

static void *compile_a_few_times(void *user)
{
    bool *done = user;
    *done      = true;
    for (int i = 0; i < 3; i++) {
        uint32_t *words = NULL;
        size_t    count;
        char     *log = NULL;
        spirv_start();
        *done = *done && spirv_compile(small_text, "test", &words, &count, &log) == KRS_OK &&
                count > 5 && words[0] == 0x07230203;
        free(words);
        free(log);
        spirv_stop();
    }
    return NULL;
}

static void threads_may_compile_at_once(void **state)
{
    enum { THREADS = 4 };
    pthread_t threads[THREADS];
    bool      done[THREADS];
    (void)state;
    for (int i = 0; i < THREADS; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, compile_a_few_times, &done[i]), 0);
    for (int i = 0; i < THREADS; i++) {
        pthread_join(threads[i], NULL);
        assert_true(done[i]);
    }
}

#define in_folder(test) cmocka_unit_test_setup_teardown(test, enter_folder, leave_folder)
int main(void)
{
    const struct CMUnitTest tests[] = {
        in_folder(a_shader_is_compiled_once),
        in_folder(nothing_is_written_unasked),
        in_folder(some_shaders_come_along),
        in_folder(shaders_are_compiled_together),
        in_folder(memory_that_runs_out_is_reported),
        cmocka_unit_test(graphics_cards_do_not_rehearse),
        cmocka_unit_test(comments_are_not_compiled),
        cmocka_unit_test(threads_may_compile_at_once),
    };
    return cmocka_run_group_tests_name("compiled", tests, NULL, NULL);
}
