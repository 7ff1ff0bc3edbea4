/*
 * spirv.c: compiles GLSL to SPIR-V and validates every module.
 */
#include <glslang/build_info.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/target/glslang_bridge.h"
#include "compiler/target/spirv.h"

/* The process has one glslang.  A thread that compiles holds the read lock.  A thread that starts
   or stops glslang holds the write lock, so that none compiles meanwhile. */
static struct {
    pthread_rwlock_t lock;
    size_t           users; /* calls of spirv_start without spirv_stop */
    bool             runs;
    atomic_bool      spoiled; /* memory ran out in glslang: its tables may be incomplete */
} glslang = {.lock = PTHREAD_RWLOCK_INITIALIZER};

/* The caller holds the write lock. */
static void stop(void)
{
    if (glslang.runs)
        bridge_stop();
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

/* Locks for reading, with glslang started; the lock is held only if the result is BRIDGE_OK. */
static BridgeResult begin_use(void)
{
    BridgeResult result = BRIDGE_OK;
    while (result == BRIDGE_OK) {
        pthread_rwlock_rdlock(&glslang.lock);
        if (glslang.runs && !atomic_load(&glslang.spoiled))
            return BRIDGE_OK;
        pthread_rwlock_unlock(&glslang.lock);
        pthread_rwlock_wrlock(&glslang.lock);
        if (atomic_load(&glslang.spoiled))
            stop();
        if (!glslang.runs)
            result = bridge_start();
        glslang.runs = result == BRIDGE_OK;
        pthread_rwlock_unlock(&glslang.lock);
    }
    return result;
}

static void end_use(BridgeResult result)
{
    if (result == BRIDGE_NO_MEMORY)
        atomic_store(&glslang.spoiled, true);
    pthread_rwlock_unlock(&glslang.lock);
}

void spirv_prepare(void)
{
    if (begin_use() == BRIDGE_OK)
        end_use(BRIDGE_OK);
}

#define WORD(number)  #number
#define WORDS(number) WORD(number)

/* Returns the version of glslang, which is linked statically, so it is known when krs is compiled. */
const char *spirv_glslang_version(void)
{
    return WORDS(GLSLANG_VERSION_MAJOR) "." WORDS(GLSLANG_VERSION_MINOR) "." WORDS(
        GLSLANG_VERSION_PATCH);
}

const char *spirv_tools_version(void) { return bridge_tools_version(); }

/* Returns a log of the names of the shader and of the tool, and the tool's message, which is
   freed. */
static char *name_log(const char *entry, const char *tool, char *message)
{
    size_t length = strlen(entry) + strlen(tool) + strlen(message) + 32;
    char  *log    = malloc(length);
    if (log)
        snprintf(log, length, "%s: refused by %s: %s", entry, tool, message);
    free(message);
    return log;
}

/* Converts a BridgeResult to a status.  `message` is freed or becomes part of the log. */
static KrsStatus status_of(BridgeResult result, const char *entry, const char *tool, char *message,
                           char **log)
{
    bool refused = result == BRIDGE_REFUSED && message;
    *log         = refused ? name_log(entry, tool, message) : NULL;
    if (!refused)
        free(message);
    return result == BRIDGE_OK        ? KRS_OK
           : result == BRIDGE_REFUSED ? KRS_INTERNAL
                                      : KRS_OUT_OF_MEMORY;
}

static KrsStatus compile(const char *glsl, bool flat, const char *entry, uint32_t **words,
                         size_t *word_count, char **log)
{
    char        *refusal = NULL;
    BridgeResult result  = begin_use();
    *words               = NULL;
    if (result == BRIDGE_OK) {
        result = bridge_compile(glsl, flat, words, word_count, &refusal);
        end_use(result);
    }
    KrsStatus status = status_of(result, entry, "glslang", refusal, log);
    if (status != KRS_OK)
        return status;
    result = bridge_validate(*words, *word_count, &refusal);
    status = status_of(result, entry, "the SPIR-V validator", refusal, log);
    if (status != KRS_OK) {
        free(*words);
        *words = NULL;
    }
    return status;
}

KrsStatus spirv_compile(const char *glsl, const char *entry, uint32_t **words, size_t *word_count,
                        char **log)
{
    return compile(glsl, true, entry, words, word_count, log);
}

KrsStatus spirv_compile_functions(const char *glsl, const char *entry, uint32_t **words,
                                  size_t *word_count, char **log)
{
    return compile(glsl, false, entry, words, word_count, log);
}

char *spirv_disassemble(const uint32_t *words, size_t word_count)
{
    return bridge_disassemble(words, word_count);
}
