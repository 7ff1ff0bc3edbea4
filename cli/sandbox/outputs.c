/*
 * outputs.c: a process that may write no file asks its parent for outputs.
 *
 * A request is a verb and a name.  The parent knows from the command line which names are permitted, makes the temporary
 * file (atomic.h), and hands over its descriptor.  The child writes; then the parent flushes the file and puts it in place.
 */
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "cli/sandbox/sandbox.h"
#include "runtime/writer/atomic.h"

enum { MAX_BEGUN = 32, FIRST_OTHER = STDERR_FILENO + 1 };

typedef struct Request {
    OutputVerb verb;
    int        number;
    char       path[PATH_MAX];
} Request;

typedef struct Answer {
    int         number;
    int         reason; /* errno */
    OutputError error;
} Answer;

/* A file that is being written. */
typedef struct Begun {
    OutputFile *file;
    OutputError error;
} Begun;

struct Outputs {
    const SandboxNeeds *needs;
    int                 own, childs; /* the two ends */
    bool                serves;
    pthread_t           server;
    Begun               begun[MAX_BEGUN];
};

/* ---- names ---- */

/* Compares folders, which may have slashes at their end; "/" is none. */
static bool is_folder(const char *folder, const char *path, size_t length)
{
    size_t of_rule = strlen(folder);
    while (of_rule > 1 && folder[of_rule - 1] == '/')
        of_rule--;
    while (length > 1 && path[length - 1] == '/')
        length--;
    return of_rule == length && memcmp(folder, path, length) == 0;
}

static bool has_ending(const char *name, bool code)
{
    enum { DATA, CODE };
    static const struct {
        int         what;
        const char *text;
    } endings[] = {
#define ENDING(what, text) {what, text},
#include "cli/sandbox/endings.def"
    };
    const size_t length = strlen(name);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        const char  *text      = endings[i].text ? endings[i].text : "";
        const size_t of_ending = strlen(text);
        if (of_ending > 0 && length >= of_ending && (code || endings[i].what == DATA) &&
            strcmp(name + length - of_ending, text) == 0)
            return true;
    }
    return false;
}

static bool rule_permits(const OutputRule *rule, const char *path)
{
    const char  *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const size_t shared = strlen(rule->name);
    if (!is_folder(rule->folder, path, (size_t)(name - path)))
        return false;
    if (rule->whole)
        return strcmp(name, rule->name) == 0;
    if (strncmp(name, rule->name, shared) != 0)
        return false;
    return name[shared] == '\0' ||
           ((!rule->digits || (name[shared] >= '0' && name[shared] <= '9')) &&
            has_ending(name, rule->code));
}

static bool is_permitted(const SandboxNeeds *needs, const char *path)
{
    for (size_t i = 0; i < needs->outputs.count; i++)
        if (rule_permits(&needs->outputs.items[i], path))
            return true;
    return false;
}

/* Tells whether a folder is one in which any name is permitted, or the whole name of a rule. */
static bool is_permitted_folder(const SandboxNeeds *needs, const char *path)
{
    for (size_t i = 0; i < needs->outputs.count; i++)
        if (is_folder(needs->outputs.items[i].folder, path, strlen(path)))
            return true;
    return is_permitted(needs, path);
}

/* ---- the parent ---- */

Outputs *outputs_new(const SandboxNeeds *needs)
{
    int      ends[2];
    Outputs *outputs = calloc(1, sizeof *outputs);
    if (!outputs || socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) {
        free(outputs);
        return NULL;
    }
    outputs->needs  = needs;
    outputs->own    = ends[0];
    outputs->childs = ends[1];
    return outputs;
}

static bool fail(Answer *answer, const char *path, const char *why, int reason)
{
    answer->reason       = reason;
    answer->error.status = KRS_CANNOT_CREATE;
    snprintf(answer->error.message, sizeof answer->error.message, "cannot create `%.800s`: %s",
             path, why);
    return false;
}

/* Begins a file; returns its descriptor, or -1. */
static int begin(Outputs *outputs, const Request *request, Answer *answer)
{
    int number = 0;
    while (number < MAX_BEGUN && outputs->begun[number].file)
        number++;
    if (number == MAX_BEGUN) {
        fail(answer, request->path, "too many files are being written", EMFILE);
        return -1;
    }
    Begun *begun   = &outputs->begun[number];
    begun->file    = output_open(request->path, NULL, &begun->error);
    answer->error  = begun->error;
    answer->number = number;
    return begun->file ? output_descriptor(begun->file) : -1;
}

static void end(Outputs *outputs, const Request *request, Answer *answer)
{
    if (request->number < 0 || request->number >= MAX_BEGUN ||
        !outputs->begun[request->number].file) {
        fail(answer, "?", "no such file was begun", EINVAL);
        return;
    }
    Begun      *begun = &outputs->begun[request->number];
    OutputFile *file  = begun->file;
    begun->file       = NULL;
    if (request->verb == OUTPUT_ABANDON)
        output_abandon(file);
    else {
        if (request->verb == OUTPUT_COMMIT_FLEETING)
            output_is_fleeting(file);
        output_commit(file);
    }
    answer->error = begun->error;
}

/* Does what is asked; returns a descriptor for the child, which is to be closed here if `*ours`, or -1. */
static int answer_request(Outputs *outputs, const Request *request, Answer *answer, bool *ours)
{
    const char *path      = request->path;
    const bool  permitted = request->verb == OUTPUT_FOLDER
                                ? is_permitted_folder(outputs->needs, path)
                                : is_permitted(outputs->needs, path);
    int         file      = -1;
    *ours                 = false;
    if (request->verb == OUTPUT_COMMIT || request->verb == OUTPUT_COMMIT_FLEETING ||
        request->verb == OUTPUT_ABANDON) {
        end(outputs, request, answer);
        return -1;
    }
    if (!permitted) {
        fail(answer, path, "the sandbox writes what the command line names alone", EACCES);
        return -1;
    }
    switch (request->verb) {
    case OUTPUT_BEGIN: return begin(outputs, request, answer);
    case OUTPUT_CHECK: output_check(path, &answer->error); break;
    case OUTPUT_FOLDER: output_make_folder(path, &answer->error); break;
    case OUTPUT_READ:
        file           = output_read(path);
        answer->reason = file < 0 ? errno : 0;
        *ours          = true;
        break;
    case OUTPUT_REMOVE: answer->reason = output_remove(path) == 0 ? 0 : errno; break;
    default: break;
    }
    return file;
}

/* Sends bytes, and a descriptor unless that is -1. */
static bool put(int to, const void *bytes, size_t length, int file)
{
    struct iovec                  vector  = {(void *)bytes, length};
    struct msghdr                 message = {.msg_iov = &vector, .msg_iovlen = 1};
    _Alignas(struct cmsghdr) char control[CMSG_SPACE(sizeof file)] = {0};
    if (file >= 0) {
        message.msg_control        = control;
        message.msg_controllen     = sizeof control;
        struct cmsghdr *descriptor = CMSG_FIRSTHDR(&message);
        descriptor->cmsg_level     = SOL_SOCKET;
        descriptor->cmsg_type      = SCM_RIGHTS;
        descriptor->cmsg_len       = CMSG_LEN(sizeof file);
        memcpy(CMSG_DATA(descriptor), &file, sizeof file);
    }
    ssize_t sent;
    while ((sent = sendmsg(to, &message, MSG_NOSIGNAL)) < 0 && errno == EINTR)
        ;
    return sent == (ssize_t)length;
}

/* Receives as many bytes, and a descriptor, or -1, in *file.  What else came along is dropped by the system. */
static bool get(int from, void *bytes, size_t length, int *file)
{
    struct iovec                  vector                            = {bytes, length};
    _Alignas(struct cmsghdr) char control[CMSG_SPACE(sizeof *file)] = {0};
    struct msghdr                 message = {.msg_iov = &vector, .msg_iovlen = 1};
    if (file) {
        message.msg_control    = control;
        message.msg_controllen = sizeof control;
        *file                  = -1;
    }
    ssize_t got;
    while ((got = recvmsg(from, &message, MSG_CMSG_CLOEXEC)) < 0 && errno == EINTR)
        ;
    const struct cmsghdr *descriptor = file && got >= 0 ? CMSG_FIRSTHDR(&message) : NULL;
    if (descriptor && descriptor->cmsg_level == SOL_SOCKET && descriptor->cmsg_type == SCM_RIGHTS)
        memcpy(file, CMSG_DATA(descriptor), sizeof *file);
    return got == (ssize_t)length;
}

static void *serve(void *user)
{
    Outputs *outputs = user;
    Request  request;
    bool     goes_on = true;
    while (goes_on && get(outputs->own, &request, sizeof request, NULL)) {
        Answer answer = {.number = -1};
        bool   ours;
        request.path[sizeof request.path - 1] = '\0';
        const int file                        = answer_request(outputs, &request, &answer, &ours);
        goes_on                               = put(outputs->own, &answer, sizeof answer, file);
        if (file >= 0 && ours)
            close(file);
    }
    return NULL;
}

bool outputs_serve(Outputs *outputs)
{
    close(outputs->childs);
    outputs->childs = -1;
    outputs->serves = pthread_create(&outputs->server, NULL, serve, outputs) == 0;
    return outputs->serves;
}

void outputs_free(Outputs *outputs)
{
    if (!outputs)
        return;
    if (outputs->childs >= 0)
        close(outputs->childs);
    shutdown(outputs->own, SHUT_RDWR);
    if (outputs->serves)
        pthread_join(outputs->server, NULL);
    for (int i = 0; i < MAX_BEGUN; i++)
        if (outputs->begun[i].file)
            output_abandon(outputs->begun[i].file);
    close(outputs->own);
    free(outputs);
}

/* ---- the child ---- */

/* The end of the connection, set once, before there are other threads; they take turns. */
static int             connection = -1;
static pthread_mutex_t turn       = PTHREAD_MUTEX_INITIALIZER;

/* Asks the parent (OutputAsk of atomic.h). */
static int ask(OutputVerb verb, const char *path, int *number, OutputError *error)
{
    Request request = {.verb = verb, .number = *number};
    Answer  answer  = {.number = -1};
    int     file    = -1;
    if (strlen(path) >= sizeof request.path) {
        fail(&answer, path, strerror(ENAMETOOLONG), ENAMETOOLONG);
    } else {
        memcpy(request.path, path, strlen(path) + 1);
        pthread_mutex_lock(&turn);
        const bool answered = put(connection, &request, sizeof request, -1) &&
                              get(connection, &answer, sizeof answer, &file);
        pthread_mutex_unlock(&turn);
        if (!answered)
            fail(&answer, path, "the process that writes is gone", EPIPE);
    }
    *number = answer.number;
    *error  = answer.error;
    errno   = answer.reason;
    return file;
}

/* Closes all files but the standard streams and one.  close_range was new in Linux 5.9, which is older than Landlock. */
static bool close_others(unsigned kept)
{
    return (kept == FIRST_OTHER || syscall(SYS_close_range, FIRST_OTHER, kept - 1, 0) == 0) &&
           syscall(SYS_close_range, kept + 1, ~0u, 0) == 0;
}

bool outputs_ask(Outputs *outputs)
{
    connection = outputs->childs;
    output_ask(ask);
    return close_others((unsigned)connection);
}
