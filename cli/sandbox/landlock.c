/*
 * landlock.c: rights to files that a process gives away.
 *
 * Versions differ in what they can take away.  What one does not know is taken away by seccomp as well, but for signals
 * and abstract sockets, for which there are no calls then either.
 */
#include "cli/sandbox/landlock.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/landlock.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

/* The form of version 6; older systems want that what they do not know is 0. */
typedef struct Rights {
    uint64_t files, network, scopes;
} Rights;

/* What each version has added. */
static const struct {
    int    version;
    Rights rights;
} added[] = {
    {1, {(UINT64_C(1) << 13) - 1, 0, 0}},
    {2, {UINT64_C(1) << 13, 0, 0}}, /* another folder */
    {3, {UINT64_C(1) << 14, 0, 0}}, /* truncating */
    {4, {0, 3, 0}},                 /* TCP: bind and connect */
    {5, {UINT64_C(1) << 15, 0, 0}}, /* ioctl of devices */
    {6, {0, 0, 3}},                 /* abstract sockets and signals */
};

int landlock_version(void)
{
    const long version = syscall(SYS_landlock_create_ruleset, NULL, (size_t)0,
                                 LANDLOCK_CREATE_RULESET_VERSION);
    return version > 0 ? (int)version : 0;
}

/* Lets a file be read, or all in a folder. */
static bool permit(int rules, const char *path)
{
    struct stat about;
    const int   place = open(path, O_PATH | O_CLOEXEC);
    if (place < 0)
        return errno != ENOMEM && errno != EMFILE && errno != ENFILE;
    const bool folder = fstat(place, &about) == 0 && S_ISDIR(about.st_mode);
    const struct landlock_path_beneath_attr below = {
        .allowed_access = LANDLOCK_ACCESS_FS_READ_FILE | (folder ? LANDLOCK_ACCESS_FS_READ_DIR : 0),
        .parent_fd      = place};
    const bool done = syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &below,
                              0) == 0;
    close(place);
    return done;
}

bool landlock_enter(const char *const *readable, unsigned count)
{
    const int version = landlock_version();
    Rights    rights  = {0};
    for (size_t i = 0; i < sizeof added / sizeof *added; i++)
        if (added[i].version <= version) {
            rights.files |= added[i].rights.files;
            rights.network |= added[i].rights.network;
            rights.scopes |= added[i].rights.scopes;
        }
    const int rules = (int)syscall(SYS_landlock_create_ruleset, &rights, sizeof rights, 0);
    bool      done  = rules >= 0;
    for (unsigned i = 0; i < count && done; i++)
        done = permit(rules, readable[i]);
    done = done && prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           syscall(SYS_landlock_restrict_self, rules, 0) == 0;
    const int reason = errno;
    if (rules >= 0)
        close(rules);
    errno = reason;
    return done;
}
