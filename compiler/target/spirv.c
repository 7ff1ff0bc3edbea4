/*
 * spirv.c: GLSL to SPIR-V, and every module through the SPIR-V validator.
 */
#include <glslang/build_info.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <spirv-tools/libspirv.h>

#include "compiler/target/glslang_border.h"
#include "compiler/target/spirv.h"

/* glslang belongs to the process.  Who compiles holds the lock to read; it is started and stopped
   by one thread while nobody compiles. */
static struct {
    pthread_rwlock_t lock;
    size_t           users;
    bool             runs;
    atomic_bool      spoiled; /* memory ran out in it: what it knows may be half of it */
} glslang = {.lock = PTHREAD_RWLOCK_INITIALIZER};

/* With the lock held to write. */
static void stop(void)
{
    if (glslang.runs)
        border_stop();
    glslang.runs = false;
    atomic_store(&glslang.spoiled, false);
}

void spirv_start(void)
{
    pthread_rwlock_wrlock(&glslang.lock);
    glslang.users++;
    pthread_rwlock_unlock(&glslang.lock);
}

void spirv_stop(void)
{
    pthread_rwlock_wrlock(&glslang.lock);
    if (--glslang.users == 0)
        stop();
    pthread_rwlock_unlock(&glslang.lock);
}

/* Holds the lock to read when it is BORDER_OK. */
static BorderResult begin_use(void)
{
    BorderResult result = BORDER_OK;
    while (result == BORDER_OK) {
        pthread_rwlock_rdlock(&glslang.lock);
        if (glslang.runs && !atomic_load(&glslang.spoiled))
            return BORDER_OK;
        pthread_rwlock_unlock(&glslang.lock);
        pthread_rwlock_wrlock(&glslang.lock);
        if (atomic_load(&glslang.spoiled))
            stop();
        if (!glslang.runs)
            result = border_start();
        glslang.runs = result == BORDER_OK;
        pthread_rwlock_unlock(&glslang.lock);
    }
    return result;
}

static void end_use(BorderResult result)
{
    if (result == BORDER_NO_MEMORY)
        atomic_store(&glslang.spoiled, true);
    pthread_rwlock_unlock(&glslang.lock);
}

#define WORD(number)  #number
#define WORDS(number) WORD(number)

/* It is linked statically, so its version is known when compiling. */
const char *spirv_glslang_version(void)
{
    return WORDS(GLSLANG_VERSION_MAJOR) "." WORDS(GLSLANG_VERSION_MINOR) "." WORDS(
        GLSLANG_VERSION_PATCH);
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

/* What the border says, in the words of the library; takes over `words_of_tool`. */
static KrsStatus judge(BorderResult result, const char *entry, const char *tool,
                       char *words_of_tool, char **log)
{
    bool refused = result == BORDER_REFUSED && words_of_tool;
    *log         = refused ? name_log(entry, tool, words_of_tool) : NULL;
    if (!refused)
        free(words_of_tool);
    return result == BORDER_OK        ? KRS_OK
           : result == BORDER_REFUSED ? KRS_INTERNAL
                                      : KRS_OUT_OF_MEMORY;
}

KrsStatus spirv_compile(const char *glsl, const char *entry, uint32_t **words, size_t *word_count,
                        char **log)
{
    char        *refusal = NULL;
    BorderResult result  = begin_use();
    *words               = NULL;
    if (result == BORDER_OK) {
        result = border_compile(glsl, words, word_count, &refusal);
        end_use(result);
    }
    KrsStatus status = judge(result, entry, "glslang", refusal, log);
    if (status != KRS_OK)
        return status;
    result = border_validate(*words, *word_count, &refusal);
    status = judge(result, entry, "the SPIR-V validator", refusal, log);
    if (status != KRS_OK) {
        free(*words);
        *words = NULL;
    }
    return status;
}

char *spirv_disassemble(const uint32_t *words, size_t word_count)
{
    return border_disassemble(words, word_count);
}
