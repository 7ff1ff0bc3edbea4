/*
 * Flattened modules: a device gets the same numbers from them as from what glslang makes.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>

#include "compiler/target/flatten.h"
#include "compiler/target/spirv.h"
#include "runtime/device/buffer.h"
#include "runtime/device/driver.h"
#include "runtime/device/gpu.h"
#include "runtime/device/shader.h"
#include "tests/support/device.h"

/* ---- modules ---- */

enum { LANES = 64, NUMBERS = 1 + 4 * LANES }; /* a counter, and four of each lane */

#define AROUND(functions, statements)                                                      \
    "#version 440\n"                                                                       \
    "layout(local_size_x = 64) in;\n"                                                      \
    "layout(std430, binding = 0) buffer Data { uint counter; float data[]; };\n" functions \
    "void main() {"                                                                        \
    "    uint i = gl_GlobalInvocationID.x;\n"                                              \
    "    float a = data[4u * i], b = data[4u * i + 1u];\n" statements "}\n"

static const struct {
    const char *name, *text;
} shaders[] = {
    {"a value of a loop is that of its round",
     AROUND("float once(float x, int k) { float y = x + float(k); return y * y; }\n",
            "float sum = 0.0, before;\n"
            "for (int k = 0; k < 5; k++) {\n"
            "    if (k > 0) sum += before;\n" /* stored once, below, and loaded above */
            "    before = once(a, k);\n"
            "}\n"
            "data[4u * i + 3u] = sum + before;\n")},
    {"a variable that is stored in one branch",
     AROUND("float last;\n", "last = 1.0;\n"
                             "if (a > b) { float inner = a * 3.0; last = inner; }\n"
                             "data[4u * i + 3u] = last;\n")},
    {"variables of functions begin anew",
     AROUND("float count(float x) { float c = 2.0; while (c < x) c = c * 1.5 + 0.25; return c; }\n"
            "float twice(float x) { return count(x) - count(x * 0.5); }\n",
            "data[4u * i + 3u] = twice(abs(a)) + twice(abs(b));\n")},
    {"members of members, and members that are computed",
     AROUND("struct Inner { vec3 p; float w; };\n"
            "struct Outer { Inner one, two; float list[4]; };\n"
            "Outer make(float x, float y) {\n"
            "    Outer o;\n"
            "    o.one = Inner(vec3(x, y, x - y), 2.0);\n"
            "    o.two = Inner(vec3(y), x);\n"
            "    o.list = float[4](x, y, x * y, 7.0);\n"
            "    return o;\n"
            "}\n",
            "Outer o = make(a, b), other = o;\n"
            "other.one.p.y = 3.0;\n"
            "data[4u * i + 3u] = o.one.p.y + o.two.w + o.list[i & 3u];\n"
            "data[4u * i + 1u] = other.one.p.y + other.two.p.z + o.list[2];\n")},
    {"arguments that are written, and globals",
     AROUND("float total;\n"
            "void add(inout float x, in float y, out float z) { x += y; z = x * y; total += z; }\n",
            "total = 0.5;\n"
            "float z, w;\n"
            "add(a, b, z);\n"
            "add(b, a, w);\n"
            "add(a, z, z);\n"
            "data[4u * i + 3u] = a + z; data[4u * i + 1u] = b - w; data[4u * i + 2u] = total;\n")},
    {"choices within calls within choices",
     AROUND("float pick(float x) { return x > 0.0 && x < 0.7 ? x * 2.0 : x - 1.0; }\n",
            "float c = pick(a) > 0.3 || pick(b) > pick(a * b) ? pick(pick(a)) : pick(-b);\n"
            "data[4u * i + 3u] = c > 0.1 && pick(c) < 0.4 ? c : pick(c + 0.5);\n")},
    {"functions that return early",
     AROUND("float early(float x) {\n"
            "    if (x < 0.0) return -1.0;\n"
            "    for (int k = 0; k < 6; k++) { x *= 1.3; if (x > 1.5) return x + float(k); }\n"
            "    return x;\n"
            "}\n",
            "float sum = early(a) + early(early(b));\n"
            "for (int k = 0; k < 3; k++) sum += early(a + 0.6 * float(k));\n"
            "data[4u * i + 3u] = sum;\n")},
    {"loops whose steps call",
     AROUND("int next(int k) { int m = k; if (k > 3) m += 2; return m + 1; }\n"
            "bool goes(int k, float x) { return k < 12 && x < 50.0; }\n",
            "float x = a;\n"
            "for (int k = 0; goes(k, x); k = next(k)) x = x * 1.5 + b;\n"
            "data[4u * i + 3u] = x;\n")},
    {"sums that may not be changed",
     AROUND("float exact(float x, float y) { precise float s = x + y; precise float r = s - x; "
            "return r; }\n",
            "data[4u * i + 3u] = exact(a, 1e7 * b); data[4u * i + 1u] = exact(b, 1e7 * a);\n")},
    {"a store that nobody needs, and atomics",
     AROUND("float waste(float x) { float unused[3]; unused[1] = sin(x); return x; }\n",
            "if (waste(a) > 0.2) atomicAdd(counter, 1u);\n"
            "data[4u * i + 2u] = waste(b);\n")},
};

/* What glslang makes, as it is. */
static uint32_t *compile_by_glslang(const char *text, size_t *count)
{
    const glslang_input_t input = {
        .language                = GLSLANG_SOURCE_GLSL,
        .stage                   = GLSLANG_STAGE_COMPUTE,
        .client                  = GLSLANG_CLIENT_VULKAN,
        .client_version          = GLSLANG_TARGET_VULKAN_1_1,
        .target_language         = GLSLANG_TARGET_SPV,
        .target_language_version = GLSLANG_TARGET_SPV_1_3,
        .code                    = text,
        .default_version         = 450,
        .default_profile         = GLSLANG_NO_PROFILE,
        .messages                = GLSLANG_MSG_DEFAULT_BIT,
        .resource                = glslang_default_resource(),
    };
    glslang_shader_t  *shader  = glslang_shader_create(&input);
    glslang_program_t *program = glslang_program_create();
    if (!glslang_shader_preprocess(shader, &input) || !glslang_shader_parse(shader, &input))
        fail_msg("%s", glslang_shader_get_info_log(shader));
    glslang_program_add_shader(program, shader);
    assert_true(
        glslang_program_link(program, GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT));
    glslang_program_SPIRV_generate(program, GLSLANG_STAGE_COMPUTE);
    *count          = glslang_program_SPIRV_get_size(program);
    uint32_t *words = malloc(*count * sizeof *words);
    assert_non_null(words);
    glslang_program_SPIRV_get(program, words);
    glslang_program_delete(program);
    glslang_shader_delete(shader);
    return words;
}

static size_t count_instructions(const uint32_t *words, size_t count, uint32_t opcode)
{
    size_t found = 0;
    for (size_t at = 5; at < count; at += words[at] >> 16)
        found += (words[at] & 0xffff) == opcode;
    return found;
}

/* ---- a device ---- */

typedef struct Fixture {
    Gpu                   gpu;
    Buffer                buffer;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout      layout;
    VkDescriptorPool      pool;
    VkDescriptorSet       set;
} Fixture;

static void create_layout(Fixture *fixture)
{
    const VkDescriptorSetLayoutBinding binding = {
        .descriptorType  = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        .descriptorCount = 1,
        .stageFlags      = VK_SHADER_STAGE_COMPUTE_BIT};
    const VkDescriptorSetLayoutCreateInfo set = {
        .sType        = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 1,
        .pBindings    = &binding};
    VkDevice device = fixture->gpu.driver->device;
    assert_int_equal(vkCreateDescriptorSetLayout(device, &set, NULL, &fixture->set_layout),
                     VK_SUCCESS);
    const VkPipelineLayoutCreateInfo layout = {
        .sType          = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts    = &fixture->set_layout};
    assert_int_equal(vkCreatePipelineLayout(device, &layout, NULL, &fixture->layout), VK_SUCCESS);
}

static void create_set(Fixture *fixture)
{
    VkDevice                         device = fixture->gpu.driver->device;
    const VkDescriptorPoolSize       size   = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets       = 1,
                                             .poolSizeCount = 1,
                                             .pPoolSizes    = &size};
    assert_int_equal(vkCreateDescriptorPool(device, &pool, NULL, &fixture->pool), VK_SUCCESS);
    const VkDescriptorSetAllocateInfo set = {
        .sType              = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool     = fixture->pool,
        .descriptorSetCount = 1,
        .pSetLayouts        = &fixture->set_layout};
    assert_int_equal(vkAllocateDescriptorSets(device, &set, &fixture->set), VK_SUCCESS);
    const VkDescriptorBufferInfo buffer = {FROM_HANDLE(VkBuffer, fixture->buffer.buffer), 0,
                                           fixture->buffer.size};
    vkUpdateDescriptorSets(device, 1,
                           &(VkWriteDescriptorSet){
                               .sType           = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                               .dstSet          = fixture->set,
                               .descriptorCount = 1,
                               .descriptorType  = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                               .pBufferInfo     = &buffer,
                           },
                           0, NULL);
}

static int open_fixture(void **state)
{
    static Fixture           fixture;
    const KrsRendererOptions options = {.device = tested_device()};
    spirv_start();
    if (!gpu_open(&fixture.gpu, &options, 0) ||
        !buffer_create(&fixture.gpu, &fixture.buffer, NUMBERS * sizeof(float), SHARED, "numbers"))
        return -1;
    create_layout(&fixture);
    create_set(&fixture);
    *state = &fixture;
    return 0;
}

static int close_fixture(void **state)
{
    Fixture *fixture = *state;
    vkDestroyDescriptorPool(fixture->gpu.driver->device, fixture->pool, NULL);
    vkDestroyPipelineLayout(fixture->gpu.driver->device, fixture->layout, NULL);
    vkDestroyDescriptorSetLayout(fixture->gpu.driver->device, fixture->set_layout, NULL);
    buffer_destroy(&fixture->gpu, &fixture->buffer);
    gpu_close(&fixture->gpu);
    spirv_stop();
    return 0;
}

/* Numbers from -1 to 1. */
static void fill(float *numbers)
{
    for (uint32_t i = 0; i < NUMBERS; i++)
        numbers[i] = (float)(i * 2654435761u >> 8) / 8388608.0f - 1;
}

static void run(Fixture *fixture, uint32_t *words, size_t count, float results[NUMBERS])
{
    const ShaderCode code = {.file = "a module", .words = words, .bytes = count * sizeof *words};
    Gpu             *gpu  = &fixture->gpu;
    Shader           shader;
    double           ms = 0;
    fill(fixture->buffer.bytes);
    if (!shader_load(gpu, &shader, &code, TO_HANDLE(fixture->layout), &ms) || !gpu_begin(gpu))
        fail_msg("%s", gpu->message);
    vkCmdBindPipeline(gpu->driver->commands, VK_PIPELINE_BIND_POINT_COMPUTE,
                      FROM_HANDLE(VkPipeline, shader.pipeline));
    vkCmdBindDescriptorSets(gpu->driver->commands, VK_PIPELINE_BIND_POINT_COMPUTE, fixture->layout,
                            0, 1, &fixture->set, 0, NULL);
    vkCmdDispatch(gpu->driver->commands, 1, 1, 1);
    if (!gpu_finish(gpu, &ms))
        fail_msg("%s", gpu->message);
    shader_destroy(gpu, &shader);
    memcpy(results, fixture->buffer.bytes, NUMBERS * sizeof *results);
}

/* ---- tests ---- */

static void check(Fixture *fixture, size_t shader)
{
    enum { OP_FUNCTION = 54, OP_CALL = 57 };
    const char *name  = shaders[shader].name;
    char       *log   = NULL;
    size_t      count = 0, flat_count = 0;
    uint32_t   *words, *flat          = NULL;
    float       before[NUMBERS], expected[NUMBERS], found[NUMBERS];
    if (spirv_compile(shaders[shader].text, name, &flat, &flat_count, &log) != KRS_OK)
        fail_msg("%s", log ? log : "out of memory");
    words = compile_by_glslang(shaders[shader].text, &count); /* which runs by now */
    assert_int_equal(count_instructions(flat, flat_count, OP_CALL), 0);
    assert_int_equal(count_instructions(flat, flat_count, OP_FUNCTION), 1);
    run(fixture, words, count, expected);
    run(fixture, flat, flat_count, found);
    fill(before);
    if (memcmp(expected, before, sizeof before) == 0)
        fail_msg("%s: changes nothing", name);
    for (size_t i = 0; i < NUMBERS; i++)
        if (memcmp(&expected[i], &found[i], sizeof *found) != 0)
            fail_msg("%s: number %zu is %.9g, not %.9g", name, i, (double)found[i],
                     (double)expected[i]);
    free(words);
    free(flat);
}

static void results_are_the_same(void **state)
{
    for (size_t i = 0; i < sizeof shaders / sizeof *shaders; i++)
        check(*state, i);
}

/* What is no module of glslang's is left alone. */
static void others_are_refused(void **state)
{
    uint32_t words[] = {0x07230203, 0x10300, 0, 1, 0}, *made;
    uint32_t text[]  = {1, 2, 3, 4, 5, 6};
    size_t   count;
    (void)state;
    assert_int_equal(flatten_module(words, 5, &made, &count), FLATTEN_REFUSED);
    assert_int_equal(flatten_module(words, 3, &made, &count), FLATTEN_REFUSED);
    assert_int_equal(flatten_module(text, 6, &made, &count), FLATTEN_REFUSED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_are_the_same),
        cmocka_unit_test(others_are_refused),
    };
    return cmocka_run_group_tests_name("flatten", tests, open_fixture, close_fixture);
}
