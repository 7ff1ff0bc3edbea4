/*
 * cross.c: GLSL in languages that the compiler does not print, by spirv-cross of Khronos.
 *
 * It is a program and no library here: nobody who does without it needs it, neither to build krs nor to run it.
 */
#include <errno.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "compiler/target/spirv.h"
#include "export/parts.h"

enum { MAX_WORDS = 16 };

static bool write_all(int file, const void *bytes, size_t length)
{
    const char *from = bytes;
    while (length > 0) {
        const ssize_t put = write(file, from, length);
        if (put < 0 && errno != EINTR)
            return false;
        from += put > 0 ? put : 0;
        length -= put > 0 ? (size_t)put : 0;
    }
    return lseek(file, 0, SEEK_SET) == 0;
}

static void read_all(int file, Text *to)
{
    char    bytes[1 << 14];
    ssize_t got;
    text_add(to, "");
    if (lseek(file, 0, SEEK_SET) == 0)
        while ((got = read(file, bytes, sizeof bytes)) > 0)
            text_add_bytes(to, bytes, (size_t)got);
}

/* Files without names, for what goes in, what comes out, and messages. */
typedef struct Ends {
    int in, out, messages;
} Ends;

static bool open_ends(Ends *ends)
{
    *ends = (Ends){memfd_create("in", MFD_CLOEXEC), memfd_create("out", MFD_CLOEXEC),
                   memfd_create("messages", MFD_CLOEXEC)};
    return ends->in >= 0 && ends->out >= 0 && ends->messages >= 0;
}

static void close_ends(const Ends *ends)
{
    const int files[] = {ends->in, ends->out, ends->messages};
    for (int i = 0; i < 3; i++)
        if (files[i] >= 0)
            close(files[i]);
}

/* What a shell returns for a program that may not be started, and for one that is not found. */
enum { NOT_PERMITTED = 126, NOT_FOUND = 127 };

/* Returns the status of the program, or that of a shell that does not start it. */
static int run(const Ends *ends, const char *const *options)
{
    char  file[] = "/dev/stdin", program[] = "spirv-cross";
    char *words[MAX_WORDS + 3] = {program, file};
    for (size_t i = 0; i < MAX_WORDS && options[i]; i++)
        words[2 + i] = (char *)options[i];
    posix_spawn_file_actions_t actions;
    pid_t                      child;
    int                        status = 0;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends->in, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends->out, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends->messages, STDERR_FILENO);
    const int  failed = posix_spawnp(&child, program, &actions, NULL, words, environ);
    const bool began  = failed == 0;
    posix_spawn_file_actions_destroy(&actions);
    while (began && waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    if (!began)
        return failed == EPERM ? NOT_PERMITTED : NOT_FOUND;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

static KrsStatus translate(const uint32_t *words, size_t count, const char *const *options,
                           Text *to, Text *why)
{
    Ends ends;
    int  status = -1;
    if (open_ends(&ends) && write_all(ends.in, words, count * sizeof *words))
        status = run(&ends, options);
    if (status == 0)
        read_all(ends.out, to);
    else if (status == NOT_PERMITTED)
        text_add(why, "`spirv-cross`, which translates to this language, may not be started in the "
                      "sandbox of untrusted scenes; --untrusted=limits has none");
    else if (status == NOT_FOUND)
        text_add(why, "there is no `spirv-cross`, which translates to this language "
                      "(a package of that name)");
    else if (status > 0) {
        text_add(why, "`spirv-cross` refuses it: ");
        read_all(ends.messages, why);
    }
    close_ends(&ends);
    return status == 0 ? KRS_OK : status > 0 ? KRS_BAD_ARGUMENT : KRS_IO_ERROR;
}

KrsStatus cross_compile(const char *glsl, const char *const *options, Text *to, Text *why)
{
    uint32_t *words;
    size_t    count;
    char     *log = NULL;
    spirv_start();
    KrsStatus status = spirv_compile_functions(glsl, "export", &words, &count, &log);
    spirv_stop();
    if (status == KRS_OK) {
        status = translate(words, count, options, to, why);
        free(words);
    } else if (log)
        text_add(why, log);
    free(log);
    return status;
}
