/*
 * kernel.c: a kernel's text, with the scene's put in, becomes SPIR-V and then a pipeline.
 */
#include "runtime/device/kernel.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/embedded.h"
#include "compiler/compile.h"

static const char *find_file(const char *name, size_t length)
{
    for (const EmbeddedFile *file = shader_files; file->name; file++)
        if (strlen(file->name) == length && strncmp(file->name, name, length) == 0)
            return file->text;
    return NULL;
}

/* Copies `text` to `out` (NULL: only counts) with its includes in place, which include nothing
   themselves.  Returns the length, or 0 when a file is missing. */
static size_t expand(const char *text, const char *scene, char *out)
{
    static const char include[] = "#include \"";
    size_t length = 0;
    while (*text) {
        size_t      line = strcspn(text, "\n") + (strchr(text, '\n') != NULL);
        const char *from = text;
        size_t      bytes = line;
        if (strncmp(text, include, sizeof include - 1) == 0) {
            const char *name = text + sizeof include - 1;
            size_t      name_length = strcspn(name, "\"");
            bool        is_scene = strncmp(name, "scene.glsl", name_length) == 0;
            from = is_scene ? scene : find_file(name, name_length);
            if (!from)
                return 0;
            bytes = strlen(from);
        }
        if (out)
            memcpy(out + length, from, bytes);
        length += bytes;
        text += line;
    }
    if (out)
        out[length] = '\0';
    return length;
}

char *kernel_text(Gpu *gpu, const char *file, const char *scene)
{
    const char *text = find_file(file, strlen(file));
    size_t      length = text ? expand(text, scene, NULL) : 0;
    if (length == 0) {
        gpu_refuse(gpu, KRS_INTERNAL, "the kernel `%s`, or a file that it includes, is missing",
                   file);
        return NULL;
    }
    char *whole = gpu_alloc(gpu, length + 1, 1, "put a kernel together");
    if (whole)
        expand(text, scene, whole);
    return whole;
}

static bool compile(Gpu *gpu, const char *file, const char *scene, uint32_t **words, size_t *count)
{
    char *text = kernel_text(gpu, file, scene);
    if (!text)
        return false;
    char     *log = NULL;
    KrsStatus status = spirv_compile(text, file, words, count, &log);
    if (status == KRS_OUT_OF_MEMORY)
        gpu_refuse(gpu, status, "cannot compile the kernel `%s`: out of memory", file);
    else if (status != KRS_OK)
        gpu_refuse(gpu, KRS_INTERNAL, "the kernel `%s` does not compile: %.*s", file,
                   log ? (int)strcspn(log, "\n") : 0, log ? log : "");
    free(log);
    gpu_release(gpu, text);
    return status == KRS_OK;
}

bool kernel_create(Gpu *gpu, Kernel *kernel, const char *file, const char *scene,
                   VkPipelineLayout layout, double *spirv_ms, double *pipeline_ms)
{
    *kernel = (Kernel){0};
    uint32_t      *words = NULL;
    size_t         count = 0;
    VkShaderModule module = VK_NULL_HANDLE;
    bool           ready = false;

    double start = clock_ms();
    if (!compile(gpu, file, scene, &words, &count))
        return false;
    double compiled = clock_ms();
    *spirv_ms += compiled - start;

    TRY(gpu, "load a kernel", vkCreateShaderModule(gpu->device, &(VkShaderModuleCreateInfo){
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = count * sizeof *words,
        .pCode = words,
    }, NULL, &module));
    TRY(gpu, "prepare a kernel", vkCreateComputePipelines(gpu->device, VK_NULL_HANDLE, 1,
        &(VkComputePipelineCreateInfo){
            .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
            .stage = {
                .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                .module = module,
                .pName = "main",
            },
            .layout = layout,
        }, NULL, &kernel->pipeline));
    gpu_name(gpu, VK_OBJECT_TYPE_PIPELINE, (uint64_t)(uintptr_t)kernel->pipeline, file);
    *pipeline_ms += clock_ms() - compiled;
    ready = true;

failed:
    vkDestroyShaderModule(gpu->device, module, NULL);
    free(words);
    return ready;
}

void kernel_destroy(Gpu *gpu, Kernel *kernel)
{
    if (gpu->device)
        vkDestroyPipeline(gpu->device, kernel->pipeline, NULL);
    *kernel = (Kernel){0};
}
