/*
 * spirv.c: GLSL to SPIR-V, and every module through the SPIR-V validator.
 */
#include <glslang/build_info.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <spirv-tools/libspirv.h>

#include "compiler/shader/glslang_border.h"
#include "compiler/shader/spirv.h"

/* glslang belongs to the process, and cannot be started by one thread while another uses it. */
static struct {
    pthread_mutex_t lock;
    size_t          users;
    bool            runs;
} glslang = {.lock = PTHREAD_MUTEX_INITIALIZER};

void spirv_start(void)
{
    pthread_mutex_lock(&glslang.lock);
    glslang.users++;
    pthread_mutex_unlock(&glslang.lock);
}

void spirv_stop(void)
{
    pthread_mutex_lock(&glslang.lock);
    if (--glslang.users == 0 && glslang.runs) {
        border_stop();
        glslang.runs = false;
    }
    pthread_mutex_unlock(&glslang.lock);
}

static void start_when_needed(void)
{
    pthread_mutex_lock(&glslang.lock);
    if (!glslang.runs)
        border_start();
    glslang.runs = true;
    pthread_mutex_unlock(&glslang.lock);
}

#define WORD(number)  #number
#define WORDS(number) WORD(number)

/* It is linked statically, so its version is known when compiling. */
const char *spirv_glslang_version(void)
{
    return WORDS(GLSLANG_VERSION_MAJOR) "." WORDS(GLSLANG_VERSION_MINOR) "."
           WORDS(GLSLANG_VERSION_PATCH);
}

const char *spirv_tools_version(void) { return spvSoftwareVersionString(); }

/* The log, headed by the shader's name; takes over `words_of_tool`. */
static char *name_log(const char *entry, const char *tool, char *words_of_tool)
{
    size_t length = strlen(entry) + strlen(tool) + strlen(words_of_tool) + 32;
    char  *log    = malloc(length);
    if (log)
        snprintf(log, length, "%s: refused by %s: %s", entry, tool, words_of_tool);
    free(words_of_tool);
    return log;
}

/* Names for people are made for messages only: of a thousand values that glslang names alike, each
   is tried against all before it. */
static spv_result_t run_validator(const uint32_t *words, size_t word_count, bool names,
                                  spv_context context, spv_diagnostic *diagnostic)
{
    spv_validator_options options = spvValidatorOptionsCreate();
    spv_const_binary_t    binary  = {words, word_count};
    if (!options)
        return SPV_ERROR_OUT_OF_MEMORY;
    spvValidatorOptionsSetFriendlyNames(options, names);
    spv_result_t result = spvValidateWithOptions(context, options, &binary, diagnostic);
    spvValidatorOptionsDestroy(options);
    return result;
}

static KrsStatus validate(const char *entry, const uint32_t *words, size_t word_count, char **log)
{
    spv_context    context    = spvContextCreate(SPV_ENV_VULKAN_1_1);
    spv_diagnostic diagnostic = NULL;
    if (!context)
        return KRS_OUT_OF_MEMORY;
    spv_result_t result = run_validator(words, word_count, false, context, NULL);
    KrsStatus    status = KRS_OK;
    if (result != SPV_SUCCESS) {
        result = run_validator(words, word_count, true, context, &diagnostic);
        const char *reason =
            diagnostic && diagnostic->error ? diagnostic->error : "no reason given";
        char       *copy   = strdup(reason);
        status = result == SPV_ERROR_OUT_OF_MEMORY ? KRS_OUT_OF_MEMORY : KRS_INTERNAL;
        if (copy)
            *log = name_log(entry, "the SPIR-V validator", copy);
    }
    spvDiagnosticDestroy(diagnostic);
    spvContextDestroy(context);
    return status;
}

KrsStatus spirv_compile(const char *glsl, const char *entry, uint32_t **words, size_t *word_count,
                        char **log)
{
    start_when_needed();
    char        *refusal = NULL;
    BorderResult result  = border_compile(glsl, words, word_count, &refusal);
    *log                 = NULL;
    if (result == BORDER_REFUSED) {
        *log = name_log(entry, "glslang", refusal);
        return KRS_INTERNAL;
    }
    if (result == BORDER_NO_MEMORY) {
        free(refusal);
        return KRS_OUT_OF_MEMORY;
    }
    KrsStatus status = validate(entry, *words, *word_count, log);
    if (status != KRS_OK) {
        free(*words);
        *words = NULL;
    }
    return status;
}

char *spirv_disassemble(const uint32_t *words, size_t word_count)
{
    spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_1);
    spv_text    text    = NULL;
    char       *copy    = NULL;
    uint32_t style = SPV_BINARY_TO_TEXT_OPTION_FRIENDLY_NAMES | SPV_BINARY_TO_TEXT_OPTION_INDENT;
    if (context && spvBinaryToText(context, words, word_count, style, &text, NULL) == SPV_SUCCESS)
        copy = strdup(text->str);
    spvTextDestroy(text);
    spvContextDestroy(context);
    return copy;
}
