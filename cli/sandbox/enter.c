/*
 * enter.c: takes all rights away from a process that are not in places.def and calls.def, and sets its limits.
 */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <termios.h>
#include <unistd.h>

#include "cli/sandbox/landlock.h"
#include "cli/sandbox/sandbox.h"

const char *sandbox_missing(void)
{
    if (landlock_version() == 0)
        return "this system has no Landlock (Linux from 5.13 on, if it is switched on)";
    if (prctl(PR_GET_SECCOMP, 0, 0, 0, 0) < 0)
        return "this system has no seccomp";
    return NULL;
}

/* ---- files ---- */

enum { MAX_PLACES = 256, MAX_FILES = 256 };

typedef struct Places {
    const char *items[MAX_PLACES];
    unsigned    count;
    char       *made[MAX_PLACES]; /* for free() */
    unsigned    made_count;
} Places;

static void add(Places *places, const char *path)
{
    if (places->count < MAX_PLACES)
        places->items[places->count++] = path;
}

static void add_made(Places *places, char *path)
{
    if (!path || places->made_count == MAX_PLACES) {
        free(path);
        return;
    }
    places->made[places->made_count++] = path;
    add(places, path);
}

/* Adds `path` in the folder that a variable names, or else `otherwise` in the folder of the user. */
static void add_of_home(Places *places, const char *variable, const char *path,
                        const char *otherwise)
{
    const char *folder = variable ? getenv(variable) : NULL, *home = getenv("HOME");
    char       *whole = NULL;
    if (folder && folder[0] == '/') {
        if (asprintf(&whole, "%s/%s", folder, path) < 0)
            whole = NULL;
    } else if (home && home[0] == '/' && asprintf(&whole, "%s/%s", home, otherwise) < 0)
        whole = NULL;
    add_made(places, whole);
}

/* Adds what a variable lists.  Of a file, all in its folder: what is said there of a library leads there. */
static void add_listed(Places *places, const char *variable)
{
    const char *list = getenv(variable);
    while (list && *list) {
        const size_t length = strcspn(list, ":");
        char        *path   = strndup(list, length);
        DIR         *folder = path ? opendir(path) : NULL;
        char        *slash  = path && !folder ? strrchr(path, '/') : NULL;
        if (folder)
            closedir(folder);
        if (slash && slash > path)
            *slash = '\0';
        add_made(places, path);
        list += length + (list[length] == ':');
    }
}

static bool confine_files(const SandboxNeeds *needs)
{
    Places places = {.count = 0};
#define PLACE(path, why)                           add(&places, path);
#define HOME_PLACE(variable, path, otherwise, why) add_of_home(&places, variable, path, otherwise);
#define LISTED_PLACE(variable, why)                add_listed(&places, variable);
#include "cli/sandbox/places.def"
    for (size_t i = 0; i < needs->readable.count; i++)
        add(&places, needs->readable.items[i]);
    const bool done   = landlock_enter(places.items, places.count);
    const int  reason = errno;
    for (unsigned i = 0; i < places.made_count; i++)
        free(places.made[i]);
    errno = reason;
    return done;
}

/* ---- system calls ---- */

/* What becomes of calls that calls.def does not name. */
#define OTHER_CALLS SCMP_ACT_ERRNO(ENOSYS)

/* Adds a rule; a call that this processor or this libseccomp does not know needs none. */
static bool rule(scmp_filter_ctx filter, uint32_t action, const char *name, unsigned conditions,
                 const struct scmp_arg_cmp *condition)
{
    const int call = seccomp_syscall_resolve_name(name);
    if (call == __NR_SCMP_ERROR || action == OTHER_CALLS)
        return true;
    const int failed = seccomp_rule_add_array(filter, action, call, conditions, condition);
    if (failed)
        errno = -failed;
    return !failed;
}

static bool add_rules(scmp_filter_ctx filter)
{
    const uint64_t all_bits = UINT64_MAX, low_bits = UINT32_MAX, own_process = (uint64_t)getpid();
    const uint64_t writing = O_ACCMODE | O_CREAT | O_TRUNC;
    const int      version = landlock_version();
    bool           good    = true;
#define ALL_BITS    all_bits
#define LOW_BITS    low_bits
#define OWN_PROCESS own_process
#define WRITING     writing
#define WHERE(number, mask, value) \
    1, (const struct scmp_arg_cmp[]) { SCMP_CMP(number, SCMP_CMP_MASKED_EQ, mask, value) }
#define ALLOW(name, why) good = good && rule(filter, SCMP_ACT_ALLOW, #name, 0, NULL);
#define ALLOW_IF(name, number, mask, value, why) \
    good = good && rule(filter, SCMP_ACT_ALLOW, #name, WHERE(number, mask, value));
#define ALLOW_WITH(name, least, why) \
    good = good && (version < (least) || rule(filter, SCMP_ACT_ALLOW, #name, 0, NULL));
#define REFUSE_IF(name, number, mask, value, error, why) \
    good = good && rule(filter, SCMP_ACT_ERRNO(error), #name, WHERE(number, mask, value));
#define REFUSE(name, error, why) good = good && rule(filter, SCMP_ACT_ERRNO(error), #name, 0, NULL);
#define KILL(name, why)          good = good && rule(filter, SCMP_ACT_KILL_PROCESS, #name, 0, NULL);
#include "cli/sandbox/calls.def"
    return good;
}

static bool confine_calls(void)
{
    scmp_filter_ctx filter = seccomp_init(OTHER_CALLS);
    int             failed = ENOMEM;
    if (!filter) {
        errno = failed;
        return false;
    }
    bool good = seccomp_attr_set(filter, SCMP_FLTATR_ACT_BADARCH, SCMP_ACT_KILL_PROCESS) == 0 &&
                seccomp_attr_set(filter, SCMP_FLTATR_CTL_TSYNC, 1) == 0 && add_rules(filter);
    if (good) {
        failed = -seccomp_load(filter);
        good   = failed == 0;
        errno  = failed;
    }
    seccomp_release(filter);
    return good;
}

/* ---- limits ---- */

static bool limit(int resource, uint64_t most)
{
    struct rlimit now;
    if (getrlimit((__rlimit_resource_t)resource, &now) != 0)
        return false;
    now.rlim_max = now.rlim_max < most ? now.rlim_max : most;
    now.rlim_cur = now.rlim_cur < now.rlim_max ? now.rlim_cur : now.rlim_max;
    return setrlimit((__rlimit_resource_t)resource, &now) == 0;
}

/* Limits addresses as well as memory, since memory that is shared counts as no data.  Threads and allocators
   reserve more addresses than they use, for each processor. */
static bool set_limits(const SandboxNeeds *needs)
{
    const uint64_t reserved = ((uint64_t)4 << 30) + ((uint64_t)sysconf(_SC_NPROCESSORS_CONF) << 28);
    bool           good     = limit(RLIMIT_CORE, 0) && limit(RLIMIT_NOFILE, MAX_FILES);
    if (needs->memory > 0)
        good = good && limit(RLIMIT_DATA, needs->memory) &&
               limit(RLIMIT_AS, needs->memory + reserved);
    return good && (needs->file == 0 || limit(RLIMIT_FSIZE, needs->file));
}

bool sandbox_enter(const SandboxNeeds *needs, char why[256])
{
    const char *step = "limits cannot be set";
    bool        good = set_limits(needs) && prctl(PR_SET_PDEATHSIG, SIGKILL) == 0;
    if (good) {
        step = "Landlock refuses";
        good = confine_files(needs);
    }
    if (good) {
        step = "seccomp refuses";
        good = confine_calls();
    }
    if (!good)
        snprintf(why, 256, "%s: %s", step, strerror(errno));
    return good;
}
