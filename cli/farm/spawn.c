/*
 * spawn.c: runs this program once more.
 */
#include "cli/farm/spawn.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cli/shell/console.h"
#include "cli/shell/supervise.h"

void spawn_add(Arena *arena, Words *words, const char *word)
{
    array_push(arena, words, (char *)word);
}

void spawn_begin(Arena *arena, Words *words, const char *command, const char *file)
{
    spawn_add(arena, words, "krs");
    spawn_add(arena, words, command);
    spawn_add(arena, words, file);
}

static int wait_for(pid_t process)
{
    const struct timespec pause = {.tv_nsec = 20000000};
    bool                  told  = false;
    for (int status;;) {
        const pid_t ended = waitpid(process, &status, WNOHANG);
        if (ended == process)
            return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        if (ended < 0 && errno != EINTR)
            return KRS_INTERNAL;
        if (*interrupted() && !told)
            kill(process, SIGTERM);
        told = told || *interrupted();
        stage_note_progress();
        nanosleep(&pause, NULL);
    }
}

int spawn_run(const Options *options, Words *words, const char *log)
{
    extern char              **environ;
    posix_spawn_file_actions_t files;
    pid_t                      process;
    spawn_add(options->arena, words, NULL);
    posix_spawn_file_actions_init(&files);
    if (log)
        posix_spawn_file_actions_addopen(&files, STDERR_FILENO, log, O_WRONLY | O_CREAT | O_TRUNC,
                                         0666);
    const int failed = posix_spawn(&process, "/proc/self/exe", &files, NULL, words->items, environ);
    posix_spawn_file_actions_destroy(&files);
    if (!failed)
        return wait_for(process);
    say("cannot start krs: %s", strerror(failed));
    return KRS_INTERNAL;
}
