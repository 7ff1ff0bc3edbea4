/*
 * glslang_border.cpp: the one C++ file: calls glslang's C interface and the SPIR-V optimizer, and
 * catches what they throw.
 */
#include "compiler/shader/glslang_border.h"

#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>
#include <spirv-tools/optimizer.hpp>

static BorderResult refuse(const char *text, char **log)
{
    *log = strdup(text && *text ? text : "no reason given");
    return *log ? BORDER_REFUSED : BORDER_NO_MEMORY;
}

/* Owns what glslang made, whatever happens. */
struct Work {
    glslang_shader_t  *shader  = nullptr;
    glslang_program_t *program = nullptr;
    ~Work()
    {
        if (program)
            glslang_program_delete(program);
        if (shader)
            glslang_shader_delete(shader);
    }
};

/* What is larger would take longer here than it saves. */
static const size_t MOST_WORDS = 1 << 17;

/* Puts functions where they are called, and leaves out the variables that only pass values on.
   Drivers do both at every start, the former by copying a body once for each call above it: for a
   twentieth more time at the first, a program starts in a fifth less from then on.  What is
   computed stays the same; a driver may round a last digit otherwise. */
static bool inline_calls(std::vector<uint32_t> &words)
{
    spvtools::Optimizer        optimizer(SPV_ENV_VULKAN_1_1);
    spvtools::OptimizerOptions options;
    options.set_run_validator(false); /* spirv.c does that, afterwards */
    optimizer.RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateMergeReturnPass())
        .RegisterPass(spvtools::CreateInlineExhaustivePass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass());
    return optimizer.Run(words.data(), words.size(), &words, options);
}

static BorderResult compile(const char *glsl, uint32_t **words, size_t *word_count, char **log)
{
    glslang_input_t input                   = {};
    input.language                          = GLSLANG_SOURCE_GLSL;
    input.stage                             = GLSLANG_STAGE_COMPUTE;
    input.client                            = GLSLANG_CLIENT_VULKAN;
    input.client_version                    = GLSLANG_TARGET_VULKAN_1_1;
    input.target_language                   = GLSLANG_TARGET_SPV;
    input.target_language_version           = GLSLANG_TARGET_SPV_1_3;
    input.code                              = glsl;
    input.default_version                   = 450;
    input.default_profile                   = GLSLANG_NO_PROFILE;
    input.messages                          = GLSLANG_MSG_DEFAULT_BIT;
    input.resource                          = glslang_default_resource();

    Work work;
    work.shader = glslang_shader_create(&input);
    if (!work.shader)
        return BORDER_NO_MEMORY;
    if (!glslang_shader_preprocess(work.shader, &input) ||
        !glslang_shader_parse(work.shader, &input))
        return refuse(glslang_shader_get_info_log(work.shader), log);
    work.program = glslang_program_create();
    if (!work.program)
        return BORDER_NO_MEMORY;
    glslang_program_add_shader(work.program, work.shader);
    if (!glslang_program_link(work.program,
                              GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT))
        return refuse(glslang_program_get_info_log(work.program), log);
    glslang_spv_options_t options = {}; /* by default it would validate, which spirv.c does */
    options.disable_optimizer     = true;
    glslang_program_SPIRV_generate_with_options(work.program, GLSLANG_STAGE_COMPUTE, &options);

    std::vector<uint32_t> made(glslang_program_SPIRV_get_size(work.program));
    glslang_program_SPIRV_get(work.program, made.data());
    if (made.size() <= MOST_WORDS && !inline_calls(made))
        return refuse("its functions cannot be inlined", log);
    *words = static_cast<uint32_t *>(malloc(made.size() * sizeof **words));
    if (!*words)
        return BORDER_NO_MEMORY;
    memcpy(*words, made.data(), made.size() * sizeof **words);
    *word_count = made.size();
    return BORDER_OK;
}

BorderResult border_compile(const char *glsl, uint32_t **words, size_t *word_count, char **log)
{
    *words = nullptr;
    *log   = nullptr;
    try {
        return compile(glsl, words, word_count, log);
    } catch (const std::bad_alloc &) {
        return BORDER_NO_MEMORY;
    } catch (...) {
        return refuse("glslang failed with an exception", log);
    }
}

void border_start(void) { glslang_initialize_process(); }
void border_stop(void) { glslang_finalize_process(); }
