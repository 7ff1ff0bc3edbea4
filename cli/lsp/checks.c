/*
 * checks.c: a whole check of a document in a process of its own.
 *
 * A check may take long, and what takes long here is a picture that nobody waits for: the next change of a text ends it.
 */
#include "cli/lsp/server.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

/* A check takes that long at most. */
enum { MAX_SECONDS = 60 };

static void run_check(Service *service, const char *path, int pipe)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    signal(SIGALRM, SIG_DFL);
    alarm(MAX_SECONDS);
    const char *found = service_check(service, path);
    size_t      left  = found ? strlen(found) : 0;
    while (left > 0) {
        const ssize_t put = write(pipe, found, left);
        if (put <= 0)
            _exit(1);
        found += put;
        left -= (size_t)put;
    }
    _exit(0);
}

bool check_start(Check *check, Service *service, const char *path)
{
    int ends[2];
    if (pipe(ends) != 0)
        return false;
    check->length  = 0;
    check->process = fork();
    if (check->process == 0) {
        close(ends[0]);
        close(STDIN_FILENO);
        close(STDOUT_FILENO);
        run_check(service, path, ends[1]);
    }
    close(ends[1]);
    check->pipe = ends[0];
    if (check->process < 0) {
        close(ends[0]);
        check->process = 0;
        return false;
    }
    return true;
}

/* Waits for the process; true: it ended by itself, and well. */
static bool end(Check *check)
{
    int status = 1;
    close(check->pipe);
    while (waitpid(check->process, &status, 0) < 0 && errno == EINTR)
        ;
    check->process = 0;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

static bool make_room(Check *check)
{
    enum { READ_BYTES = 1 << 14 };
    if (check->capacity - check->length > READ_BYTES)
        return true;
    const size_t capacity = 2 * check->capacity + 2 * READ_BYTES;
    char        *found    = realloc(check->found, capacity);
    if (found) {
        check->found    = found;
        check->capacity = capacity;
    }
    return found != NULL;
}

bool check_read(Check *check)
{
    ssize_t got = 0;
    if (make_room(check))
        got = read(check->pipe, check->found + check->length, check->capacity - check->length - 1);
    if (got > 0) {
        check->length += (size_t)got;
        return false;
    }
    if (got < 0 && errno == EINTR)
        return false;
    if (check->found)
        check->found[check->length] = '\0';
    if (!end(check) || check->length == 0) {
        free(check->found);
        check->found    = NULL;
        check->capacity = check->length = 0;
    }
    return true;
}

void check_stop(Check *check)
{
    if (check->process == 0)
        return;
    kill(check->process, SIGKILL);
    end(check);
}
