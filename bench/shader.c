/*
 * shader.c: from a file with includes to a pipeline, by the device layer of the runtime.
 */
#include "bench/shader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/embedded.h"
#include "compiler/target/spirv.h"

enum { BUFFER_BINDING = 1 };

/* ---- Text ---- */

static const char *find_in(const EmbeddedFile *file, const char *name, size_t length)
{
    for (; file->name; file++)
        if (strlen(file->name) == length && strncmp(file->name, name, length) == 0)
            return file->text;
    return NULL;
}

static const char *runtime_file(const char *name, size_t length)
{
    const char *text = find_in(shader_files, name, length);
    return text ? text : find_in(helper_files, name, length);
}

static const char *included_text(Bench *bench, const char *path, const char *name, size_t length)
{
    const char *text = runtime_file(name, length);
    if (text)
        return text;
    char beside[512];
    int  folder = (int)(strrchr(path, '/') + 1 - path);
    snprintf(beside, sizeof beside, "%.*s%.*s", folder, path, (int)length, name);
    return read_file(bench->arena, beside);
}

static const char *stand_in_text(const StandIn *stand_ins, const char *name, size_t length)
{
    for (; stand_ins->name; stand_ins++)
        if (strlen(stand_ins->name) == length && strncmp(stand_ins->name, name, length) == 0)
            return stand_ins->text;
    return NULL;
}

static void add_lines(Bench *bench, Text *out, const char *path, const char *text,
                      const StandIn *stand_ins)
{
    static const char include[] = "#include \"";
    while (*text) {
        size_t line = strcspn(text, "\n") + (strchr(text, '\n') != NULL);
        if (strncmp(text, include, sizeof include - 1) == 0) {
            const char *name     = text + sizeof include - 1;
            size_t      length   = strcspn(name, "\"");
            const char *stand_in = stand_in_text(stand_ins, name, length);
            if (stand_in)
                text_add(out, stand_in);
            else
                add_lines(bench, out, path, included_text(bench, path, name, length), stand_ins);
        } else {
            text_add_bytes(out, text, line);
        }
        text += line;
    }
}

char *bench_shader_text(Bench *bench, const char *path, const StandIn *stand_ins)
{
    Text text = {.arena = bench->arena};
    add_lines(bench, &text, path, read_file(bench->arena, path), stand_ins);
    return text.bytes;
}

/* ---- Pipeline ---- */

static bool layout_create(Gpu *gpu, BenchShader *shader)
{
    VkDescriptorSetLayoutBinding binding = {
        .binding         = BUFFER_BINDING,
        .descriptorType  = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        .descriptorCount = 1,
        .stageFlags      = VK_SHADER_STAGE_COMPUTE_BIT,
    };
    TRY(gpu, "prepare a shader",
        vkCreateDescriptorSetLayout(
            gpu->driver->device,
            &(VkDescriptorSetLayoutCreateInfo){
                .sType        = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                .bindingCount = 1,
                .pBindings    = &binding,
            },
            NULL, &shader->set_layout));
    TRY(gpu, "prepare a shader",
        vkCreatePipelineLayout(
            gpu->driver->device,
            &(VkPipelineLayoutCreateInfo){
                .sType                  = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                .setLayoutCount         = 1,
                .pSetLayouts            = &shader->set_layout,
                .pushConstantRangeCount = 1,
                .pPushConstantRanges    = &(VkPushConstantRange){VK_SHADER_STAGE_COMPUTE_BIT, 0,
                                                                 sizeof(int32_t)},
            },
            NULL, &shader->layout));
    return true;

failed:
    return false;
}

static bool set_create(Gpu *gpu, BenchShader *shader, const Buffer *buffer)
{
    TRY(gpu, "prepare a shader",
        vkCreateDescriptorPool(
            gpu->driver->device,
            &(VkDescriptorPoolCreateInfo){
                .sType         = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                .maxSets       = 1,
                .poolSizeCount = 1,
                .pPoolSizes    = &(VkDescriptorPoolSize){VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
            },
            NULL, &shader->pool));
    TRY(gpu, "prepare a shader",
        vkAllocateDescriptorSets(gpu->driver->device,
                                 &(VkDescriptorSetAllocateInfo){
                                     .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                     .descriptorPool     = shader->pool,
                                     .descriptorSetCount = 1,
                                     .pSetLayouts        = &shader->set_layout,
                                 },
                                 &shader->set));
    vkUpdateDescriptorSets(
        gpu->driver->device, 1,
        &(VkWriteDescriptorSet){
            .sType           = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet          = shader->set,
            .dstBinding      = BUFFER_BINDING,
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

static bool pipeline_create(Gpu *gpu, BenchShader *shader, const uint32_t *words, size_t count)
{
    bool           ready  = false;
    VkShaderModule module = VK_NULL_HANDLE;
    TRY(gpu, "load a shader",
        vkCreateShaderModule(gpu->driver->device,
                             &(VkShaderModuleCreateInfo){
                                 .sType    = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                 .codeSize = count * sizeof *words,
                                 .pCode    = words,
                             },
                             NULL, &module));
    TRY(gpu, "prepare a shader",
        vkCreateComputePipelines(
            gpu->driver->device, VK_NULL_HANDLE, 1,
            &(VkComputePipelineCreateInfo){
                .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                .stage =
                    {
                        .sType  = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                        .stage  = VK_SHADER_STAGE_COMPUTE_BIT,
                        .module = module,
                        .pName  = "main",
                    },
                .layout = shader->layout,
            },
            NULL, &shader->pipeline));
    ready = true;

failed:
    vkDestroyShaderModule(gpu->driver->device, module, NULL);
    return ready;
}

void bench_shader_create(Bench *bench, BenchShader *shader, const char *text, const char *name,
                         const Buffer *buffer)
{
    Gpu      *gpu   = &bench->gpu;
    uint32_t *words = NULL;
    size_t    count = 0;
    char     *log   = NULL;
    *shader         = (BenchShader){0};

    double start = clock_ms();
    if (spirv_compile(text, name, &words, &count, &log) != KRS_OK)
        fail("%s does not compile: %s", name, log ? log : "out of memory");
    double compiled = clock_ms();
    if (!layout_create(gpu, shader) || !set_create(gpu, shader, buffer) ||
        !pipeline_create(gpu, shader, words, count))
        fail("%s: %s", name, gpu->message);
    free(words);
    free(log);
    bench_shader_run(bench, shader, 1);
    shader->spirv_ms    = compiled - start;
    shader->pipeline_ms = clock_ms() - compiled;
}

void bench_shader_destroy(Bench *bench, BenchShader *shader)
{
    VkDevice device = bench->gpu.driver->device;
    vkDestroyPipeline(device, shader->pipeline, NULL);
    vkDestroyDescriptorPool(device, shader->pool, NULL);
    vkDestroyPipelineLayout(device, shader->layout, NULL);
    vkDestroyDescriptorSetLayout(device, shader->set_layout, NULL);
    *shader = (BenchShader){0};
}

double bench_shader_run(Bench *bench, const BenchShader *shader, uint32_t groups)
{
    Gpu          *gpu  = &bench->gpu;
    const int32_t zero = 0;
    double        ms   = 0;
    if (!gpu_begin(gpu))
        fail("%s", gpu->message);
    vkCmdBindPipeline(gpu->driver->commands, VK_PIPELINE_BIND_POINT_COMPUTE, shader->pipeline);
    vkCmdBindDescriptorSets(gpu->driver->commands, VK_PIPELINE_BIND_POINT_COMPUTE, shader->layout,
                            0, 1, &shader->set, 0, NULL);
    vkCmdPushConstants(gpu->driver->commands, shader->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                       sizeof zero, &zero);
    vkCmdDispatch(gpu->driver->commands, groups, 1, 1);
    if (!gpu_finish(gpu, &ms))
        fail("%s", gpu->message);
    return ms;
}
