/*
 * glslang_bridge.cpp: calls the C interface of glslang and SPIRV-Tools, and catches their
 * exceptions.  It is the only file in C++.
 */
#include "compiler/target/glslang_bridge.h"
#include "compiler/target/flatten.h"

#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>
#include <spirv-tools/libspirv.h>
#include <spirv-tools/optimizer.hpp>

/* glslang leaves its own lock locked when an exception ends its start.  Versions before 14 have a function
   that releases it, and does nothing in threads that do not hold it.  In later ones the lock is lost. */
namespace glslang
{
__attribute__((weak)) void ReleaseGlobalLock();
}

/* Tells whether the lock is lost: whoever calls glslang would wait for ever.  The caller of
   bridge_start has a lock of its own. */
static bool lock_is_lost;

static void release_lock()
{
    if (glslang::ReleaseGlobalLock)
        glslang::ReleaseGlobalLock();
}

static BridgeResult refuse(const char *text, char **log)
{
    *log = strdup(text && *text ? text : "no reason given");
    return *log ? BRIDGE_REFUSED : BRIDGE_NO_MEMORY;
}

/* Frees the shader and the program, also when an exception is thrown. */
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

/* Lets all functions return at their ends alone, where some do not. */
static bool merge_returns(std::vector<uint32_t> &words)
{
    spvtools::Optimizer        merging(SPV_ENV_VULKAN_1_1);
    spvtools::OptimizerOptions options;
    options.set_run_validator(false); /* spirv.c validates the result */
    merging.RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateMergeReturnPass());
    return merging.Run(words.data(), words.size(), &words, options);
}

static BridgeResult copy(const std::vector<uint32_t> &words, uint32_t **made, size_t *count)
{
    *made = static_cast<uint32_t *>(malloc(words.size() * sizeof **made));
    if (!*made)
        return BRIDGE_NO_MEMORY;
    memcpy(*made, words.data(), words.size() * sizeof **made);
    *count = words.size();
    return BRIDGE_OK;
}

/* Makes one function of a module, or leaves it as it is.  Otherwise drivers do so at every start.
   They copy a body once for each call above it, and compare each access to a global with all before
   it.  Results are the same but for the last digit, which a driver may round differently. */
static BridgeResult flatten(std::vector<uint32_t> &words, uint32_t **made, size_t *count)
{
    Flattening result = flatten_module(words.data(), words.size(), made, count);
    if (result == FLATTEN_REFUSED && merge_returns(words))
        result = flatten_module(words.data(), words.size(), made, count);
    if (result != FLATTEN_REFUSED)
        return result == FLATTEN_OK ? BRIDGE_OK : BRIDGE_NO_MEMORY;
    return copy(words, made, count);
}

static BridgeResult compile(const char *glsl, bool flat, uint32_t **words, size_t *word_count,
                            char **log)
{
    glslang_input_t input         = {};
    input.language                = GLSLANG_SOURCE_GLSL;
    input.stage                   = GLSLANG_STAGE_COMPUTE;
    input.client                  = GLSLANG_CLIENT_VULKAN;
    input.client_version          = GLSLANG_TARGET_VULKAN_1_1;
    input.target_language         = GLSLANG_TARGET_SPV;
    input.target_language_version = GLSLANG_TARGET_SPV_1_3;
    input.code                    = glsl;
    input.default_version         = 450;
    input.default_profile         = GLSLANG_NO_PROFILE;
    input.messages                = GLSLANG_MSG_DEFAULT_BIT;
    input.resource                = glslang_default_resource();

    Work work;
    work.shader = glslang_shader_create(&input);
    if (!work.shader)
        return BRIDGE_NO_MEMORY;
    if (!glslang_shader_preprocess(work.shader, &input) ||
        !glslang_shader_parse(work.shader, &input))
        return refuse(glslang_shader_get_info_log(work.shader), log);
    work.program = glslang_program_create();
    if (!work.program)
        return BRIDGE_NO_MEMORY;
    glslang_program_add_shader(work.program, work.shader);
    if (!glslang_program_link(work.program,
                              GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT))
        return refuse(glslang_program_get_info_log(work.program), log);
    glslang_spv_options_t options = {}; /* no validation: spirv.c does that */
    options.disable_optimizer     = true;
    glslang_program_SPIRV_generate_with_options(work.program, GLSLANG_STAGE_COMPUTE, &options);

    std::vector<uint32_t> made(glslang_program_SPIRV_get_size(work.program));
    glslang_program_SPIRV_get(work.program, made.data());
    return flat ? flatten(made, words, word_count) : copy(made, words, word_count);
}

/* Calls `work` and returns its result; an exception becomes BRIDGE_NO_MEMORY or BRIDGE_REFUSED. */
template <typename Work> static BridgeResult guarded(Work work, char **log)
{
    *log = nullptr;
    try {
        return work();
    } catch (const std::bad_alloc &) {
        return BRIDGE_NO_MEMORY;
    } catch (...) {
        return refuse("an exception", log);
    }
}

BridgeResult bridge_compile(const char *glsl, int flat, uint32_t **words, size_t *word_count,
                            char **log)
{
    *words              = nullptr;
    BridgeResult result = guarded([=] { return compile(glsl, flat != 0, words, word_count, log); },
                                  log);
    if (result != BRIDGE_OK)
        release_lock();
    return result;
}

/* Starts glslang, which makes its tables of built-in names, under its lock, when it compiles the
   first shader of a version of GLSL.  An exception then leaves them incomplete.  So an empty shader
   of the shaders' version is compiled first. */
static BridgeResult start(bool *started, char **log)
{
    static const char first[] = "#version 440\nlayout(local_size_x = 1) in;\nvoid main() {}\n";
    uint32_t         *words   = nullptr;
    size_t            count;
    *started            = true; /* in case of an exception: then glslang has to be stopped */
    *started            = glslang_initialize_process() != 0;
    BridgeResult result = *started ? compile(first, true, &words, &count, log) : BRIDGE_NO_MEMORY;
    free(words);
    return result;
}

BridgeResult bridge_start(void)
{
    char *log;
    bool  started = false;
    if (lock_is_lost)
        return BRIDGE_NO_MEMORY;
    BridgeResult result = guarded([&] { return start(&started, &log); }, &log);
    free(log);
    if (result == BRIDGE_OK || !started)
        return result;
    release_lock();
    lock_is_lost = !glslang::ReleaseGlobalLock;
    if (!lock_is_lost)
        bridge_stop();
    return result;
}

void bridge_stop(void)
{
    char *log;
    guarded(
        [] {
            glslang_finalize_process();
            return BRIDGE_OK;
        },
        &log);
    free(log);
}

/* ---- SPIRV-Tools ---- */

struct SpirvFree {
    void operator()(spv_context_t *context) const { spvContextDestroy(context); }
    void operator()(spv_diagnostic_t *diagnostic) const { spvDiagnosticDestroy(diagnostic); }
    void operator()(spv_validator_options_t *options) const { spvValidatorOptionsDestroy(options); }
    void operator()(spv_text_t *text) const { spvTextDestroy(text); }
};
template <typename Thing> using Owned = std::unique_ptr<Thing, SpirvFree>;

/* Runs the validator; `names`: whether messages have readable names.  These are slow to make: if
   glslang gave a thousand values one name, each new name is compared with all before it. */
static spv_result_t run_validator(const uint32_t *words, size_t word_count, bool names,
                                  spv_context context, spv_diagnostic *diagnostic)
{
    Owned<spv_validator_options_t> options(spvValidatorOptionsCreate());
    spv_const_binary_t             binary = {words, word_count};
    if (!options)
        return SPV_ERROR_OUT_OF_MEMORY;
    spvValidatorOptionsSetFriendlyNames(options.get(), names);
    return spvValidateWithOptions(context, options.get(), &binary, diagnostic);
}

static BridgeResult validate(const uint32_t *words, size_t word_count, char **log)
{
    Owned<spv_context_t> context(spvContextCreate(SPV_ENV_VULKAN_1_1));
    spv_diagnostic       diagnostic = nullptr;
    if (!context)
        return BRIDGE_NO_MEMORY;
    if (run_validator(words, word_count, false, context.get(), nullptr) == SPV_SUCCESS)
        return BRIDGE_OK;
    spv_result_t result = run_validator(words, word_count, true, context.get(), &diagnostic);
    Owned<spv_diagnostic_t> owned(diagnostic);
    if (result == SPV_ERROR_OUT_OF_MEMORY)
        return BRIDGE_NO_MEMORY;
    return refuse(diagnostic ? diagnostic->error : nullptr, log);
}

BridgeResult bridge_validate(const uint32_t *words, size_t word_count, char **log)
{
    return guarded([=] { return validate(words, word_count, log); }, log);
}

const char *bridge_tools_version(void) { return spvSoftwareVersionString(); }

static BridgeResult disassemble(const uint32_t *words, size_t word_count, char **assembly)
{
    Owned<spv_context_t> context(spvContextCreate(SPV_ENV_VULKAN_1_1));
    spv_text             text = nullptr;
    uint32_t style = SPV_BINARY_TO_TEXT_OPTION_FRIENDLY_NAMES | SPV_BINARY_TO_TEXT_OPTION_INDENT;
    if (!context)
        return BRIDGE_NO_MEMORY;
    spv_result_t result = spvBinaryToText(context.get(), words, word_count, style, &text, nullptr);
    Owned<spv_text_t> owned(text);
    if (result == SPV_SUCCESS)
        *assembly = strdup(text->str);
    return *assembly ? BRIDGE_OK : BRIDGE_REFUSED;
}

char *bridge_disassemble(const uint32_t *words, size_t word_count)
{
    char *log, *assembly = nullptr;
    guarded([&] { return disassemble(words, word_count, &assembly); }, &log);
    free(log);
    return assembly;
}
