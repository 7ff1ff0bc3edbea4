/*
 * accuracy.c: how far results of the device are from those in double precision of the same floats.
 *
 * Vulkan lets divisions be off by 2.5 units in the last place, square roots by as much as an
 * inverse root and a product, and sines by 2^-11 of 1; what shaders call is told beside what is
 * built in.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/device/device.h"
#include "compiler/print/printer.h"
#include "compiler/target/spirv.h"
#include "runtime/device/driver.h"

enum { LANES = 64, GROUPS = 1024, COUNT = LANES * GROUPS };

static double by_division(double a, double b) { return a / b; }
static double by_sum(double a, double b) { return a + b; }
static double by_product(double a, double b) { return a * b; }
static double by_sin(double a, double b)
{
    (void)b;
    return sin(a);
}
static double by_cos(double a, double b)
{
    (void)b;
    return cos(a);
}
static double by_tan(double a, double b)
{
    (void)b;
    return tan(a);
}
static double by_asin(double a, double b)
{
    (void)b;
    return asin(a);
}
static double by_acos(double a, double b)
{
    (void)b;
    return acos(a);
}
static double by_atan(double a, double b)
{
    (void)b;
    return atan(a);
}
static double by_sqrt(double a, double b)
{
    (void)b;
    return sqrt(a);
}
static double by_inverse(double a, double b)
{
    (void)b;
    return 1 / sqrt(a);
}
static double by_exp(double a, double b)
{
    (void)b;
    return exp(a);
}
static double by_exp2(double a, double b)
{
    (void)b;
    return exp2(a);
}
static double by_log(double a, double b)
{
    (void)b;
    return log(a);
}
static double by_log2(double a, double b)
{
    (void)b;
    return log2(a);
}
static double by_floor(double a, double b)
{
    (void)b;
    return floor(a);
}
static double by_fma(double a, double b) { return a * b - 1; }

/* An operation on a and b, each of a range; a range from above 0 is gone through by its logarithm.
   `op`: whose helpers are needed. */
typedef struct Operation {
    const char *glsl;
    double (*exact)(double, double);
    double low[2], high[2];
    Op     op;
} Operation;

#define PI 3.14159265358979
#define ONE_ARGUMENT(low, high) \
    {low, 0}, { high, 0 }

static const Operation operations[] = {
    {"a + b", by_sum, {-100, -100}, {100, 100}, OP_add},
    {"a * b", by_product, {-100, -100}, {100, 100}, OP_mul},
    {"a * b - 1.0", by_fma, {0.5, 0.5}, {2, 2}, OP_mul},
    {"a / b", by_division, {-100, 1e-4}, {100, 1e4}, OP_div},
    {"sqrt(a)", by_sqrt, ONE_ARGUMENT(1e-12, 1e12), OP_sqrt},
    {"inversesqrt(a)", by_inverse, ONE_ARGUMENT(1e-12, 1e12), OP_inversesqrt},
    {"length(vec2(a, b))", hypot, {-100, -100}, {100, 100}, OP_length},
    {"floor(a)", by_floor, ONE_ARGUMENT(-1000, 1000), OP_floor},
    {"exp(a)", by_exp, ONE_ARGUMENT(-20, 20), OP_exp},
    {"exp2(a)", by_exp2, ONE_ARGUMENT(-30, 30), OP_exp2},
    {"log(a)", by_log, ONE_ARGUMENT(1e-6, 1e6), OP_log},
    {"log2(a)", by_log2, ONE_ARGUMENT(1e-6, 1e6), OP_log2},
    {"pow(a, b)", pow, {1e-2, -4}, {1e2, 4}, OP_mul},
    {"krs_pow(a, b)", pow, {1e-2, -4}, {1e2, 4}, OP_pow},
    {"sin(a)", by_sin, ONE_ARGUMENT(-PI, PI), OP_mul},
    {"krs_sin(a)", by_sin, ONE_ARGUMENT(-PI, PI), OP_sin},
    {"krs_sin(a), far", by_sin, ONE_ARGUMENT(-1000, 1000), OP_sin},
    {"cos(a)", by_cos, ONE_ARGUMENT(-PI, PI), OP_mul},
    {"krs_cos(a)", by_cos, ONE_ARGUMENT(-PI, PI), OP_cos},
    {"tan(a)", by_tan, ONE_ARGUMENT(-1.5, 1.5), OP_mul},
    {"krs_tan(a)", by_tan, ONE_ARGUMENT(-1.5, 1.5), OP_tan},
    {"asin(a)", by_asin, ONE_ARGUMENT(-1, 1), OP_mul},
    {"krs_asin(a)", by_asin, ONE_ARGUMENT(-1, 1), OP_asin},
    {"acos(a)", by_acos, ONE_ARGUMENT(-1, 1), OP_mul},
    {"krs_acos(a)", by_acos, ONE_ARGUMENT(-1, 1), OP_acos},
    {"atan(a)", by_atan, ONE_ARGUMENT(-100, 100), OP_mul},
    {"krs_atan(a)", by_atan, ONE_ARGUMENT(-100, 100), OP_atan},
    {"krs_atan2(a, b)", atan2, {-100, -100}, {100, 100}, OP_atan2},
};

/* ---- Running a text ---- */

static VkDescriptorSetLayout set_layout;
static VkPipelineLayout      layout;
static VkDescriptorPool      pool;
static VkDescriptorSet       set;

static bool prepare(Gpu *gpu, const Buffer *buffer)
{
    const char *attempt = "prepare the operations";
    TRY(gpu, attempt,
        vkCreateDescriptorSetLayout(
            gpu->driver->device,
            &(VkDescriptorSetLayoutCreateInfo){
                .sType        = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                .bindingCount = 1,
                .pBindings =
                    &(VkDescriptorSetLayoutBinding){
                        .descriptorType  = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                        .descriptorCount = 1,
                        .stageFlags      = VK_SHADER_STAGE_COMPUTE_BIT,
                    },
            },
            NULL, &set_layout));
    TRY(gpu, attempt,
        vkCreatePipelineLayout(gpu->driver->device,
                               &(VkPipelineLayoutCreateInfo){
                                   .sType          = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                   .setLayoutCount = 1,
                                   .pSetLayouts    = &set_layout,
                               },
                               NULL, &layout));
    TRY(gpu, attempt,
        vkCreateDescriptorPool(
            gpu->driver->device,
            &(VkDescriptorPoolCreateInfo){
                .sType         = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                .maxSets       = 1,
                .poolSizeCount = 1,
                .pPoolSizes    = &(VkDescriptorPoolSize){VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
            },
            NULL, &pool));
    TRY(gpu, attempt,
        vkAllocateDescriptorSets(gpu->driver->device,
                                 &(VkDescriptorSetAllocateInfo){
                                     .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                     .descriptorPool     = pool,
                                     .descriptorSetCount = 1,
                                     .pSetLayouts        = &set_layout,
                                 },
                                 &set));
    vkUpdateDescriptorSets(
        gpu->driver->device, 1,
        &(VkWriteDescriptorSet){
            .sType           = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet          = set,
            .descriptorCount = 1,
            .descriptorType  = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
            .pBufferInfo     = &(VkDescriptorBufferInfo){FROM_HANDLE(VkBuffer, buffer->buffer), 0,
                                                         buffer->size},
        },
        0, NULL);
    return true;

failed:
    return false;
}

static void finish(Gpu *gpu)
{
    vkDestroyDescriptorPool(gpu->driver->device, pool, NULL);
    vkDestroyPipelineLayout(gpu->driver->device, layout, NULL);
    vkDestroyDescriptorSetLayout(gpu->driver->device, set_layout, NULL);
}

/* Counts the GLSL of a row's text: it ends before a comma and a space that are outside of parentheses. */
static int glsl_length(const char *text)
{
    int depth = 0, length = 0;
    for (; text[length] && !(text[length] == ',' && depth == 0); length++)
        depth += (text[length] == '(') - (text[length] == ')');
    return length;
}

/* Writes the functions that the operation calls. */
static void write_helpers(const Operation *operation, FILE *out)
{
    jmp_buf exhausted;
    Memory  memory  = {.exhausted = &exhausted};
    Arena   arena   = {.memory = &memory};
    Text    helpers = {.arena = &arena};
    if (setjmp(exhausted) != 0)
        give_up(operation->glsl, "no memory");
    module_print_helpers(&glsl_printer, operation->op, TYPE_FLOAT, 2, &helpers);
    if (helpers.length > 0)
        fwrite(helpers.bytes, 1, helpers.length, out);
    arena_free(&arena);
}

static void write_shader(const Operation *operation, FILE *out)
{
    fprintf(out,
            "#version 440\nlayout(local_size_x = %d) in;\n"
            "layout(std430, set = 0, binding = 0) buffer Numbers { vec4 numbers[]; };\n",
            LANES);
    write_helpers(operation, out);
    fprintf(out,
            "void main()\n{\n    uint i = gl_GlobalInvocationID.x;\n"
            "    float a = numbers[i].x, b = numbers[i].y;\n    numbers[i].z = %.*s;\n}\n",
            glsl_length(operation->glsl), operation->glsl);
}

static void run(Gpu *gpu, const Operation *operation)
{
    char      *text = NULL, *log = NULL;
    size_t     length = 0, words = 0;
    FILE      *out  = open_memstream(&text, &length);
    ShaderCode code = {.file = operation->glsl};
    Shader     shader;
    double     ms = 0;
    if (!out)
        give_up(operation->glsl, "no memory");
    write_shader(operation, out);
    fclose(out);
    if (spirv_compile(text, operation->glsl, &code.words, &words, &log) != KRS_OK)
        give_up(operation->glsl, log ? log : "no memory");
    code.bytes = 4 * words;
    if (!shader_load(gpu, &shader, &code, TO_HANDLE(layout), &ms) || !gpu_begin(gpu))
        give_up(operation->glsl, gpu->message);
    vkCmdBindPipeline(gpu->driver->commands, VK_PIPELINE_BIND_POINT_COMPUTE,
                      FROM_HANDLE(VkPipeline, shader.pipeline));
    vkCmdBindDescriptorSets(gpu->driver->commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1,
                            &set, 0, NULL);
    vkCmdDispatch(gpu->driver->commands, GROUPS, 1, 1);
    if (!gpu_finish(gpu, &ms))
        give_up(operation->glsl, gpu->message);
    shader_destroy(gpu, &shader);
    free(code.words);
    free(text);
}

/* ---- Numbers ---- */

/* Number `share`, from 0 to 1, of the range. */
static float place_in(double low, double high, double share)
{
    return (float)(low > 0 ? low * pow(high / low, share) : low + (high - low) * share);
}

/* Evenly over the first range, and over the second by multiples of the golden ratio. */
static void fill(const Operation *operation, float (*numbers)[4])
{
    for (int i = 0; i < COUNT; i++) {
        double second = i * 0.61803398874989485;
        numbers[i][0] = place_in(operation->low[0], operation->high[0], (i + 0.5) / COUNT);
        numbers[i][1] = place_in(operation->low[1], operation->high[1], second - floor(second));
    }
}

/* Returns a unit in the last place of a float of this size. */
static double unit_of(double value)
{
    int exponent;
    frexp(value, &exponent);
    return ldexp(1, (exponent < -125 ? -125 : exponent) - 24);
}

static void judge(const Operation *operation, float (*numbers)[4])
{
    double absolute = 0, units = 0, worst[2] = {0};
    int    broken = 0;
    for (int i = 0; i < COUNT; i++) {
        double a = numbers[i][0], b = numbers[i][1], exact = operation->exact(a, b);
        double error = fabs(numbers[i][2] - exact);
        broken += !isfinite(numbers[i][2]);
        absolute = fmax(absolute, error);
        if (error > units * unit_of(exact)) {
            units = error / unit_of(exact);
            memcpy(worst, (double[]){a, b}, sizeof worst);
        }
    }
    printf("| `%s` | %g to %g | %.3g | %.3g | %.9g, %.9g | %d |\n", operation->glsl,
           operation->low[0], operation->high[0], absolute, units, worst[0], worst[1], broken);
    fflush(stdout);
}

void print_accuracy(KrsRenderer *renderer)
{
    Gpu   *gpu = &renderer->gpu;
    Buffer buffer;
    if (!buffer_create(gpu, &buffer, COUNT * sizeof(float[4]), SHARED, "numbers") ||
        !prepare(gpu, &buffer))
        give_up("accuracy", gpu->message);
    puts("| operation | a | largest error | in units of the last place | there | not finite |\n"
         "| --- | --- | --- | --- | --- | --- |");
    for (size_t i = 0; i < sizeof operations / sizeof operations[0]; i++) {
        fill(&operations[i], buffer.bytes);
        run(gpu, &operations[i]);
        judge(&operations[i], buffer.bytes);
    }
    finish(gpu);
    buffer_destroy(gpu, &buffer);
}
