/*
 * excess.c: what the parent of a sandbox watches, since the system has no limit for it.
 *
 * RLIMIT_NPROC counts all processes of a user, and none of root's; memory in files without names (memfd_create) counts
 * for nobody.
 */
#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/sandbox/sandbox.h"

/* Counts entries of a folder of /proc. */
static long count_threads(pid_t child)
{
    char path[64];
    long count = 0;
    snprintf(path, sizeof path, "/proc/%ld/task", (long)child);
    DIR *folder = opendir(path);
    for (const struct dirent *entry; folder && (entry = readdir(folder));)
        count += entry->d_name[0] != '.';
    if (folder)
        closedir(folder);
    return count;
}

/* Returns the bytes of files of the process that no folder has. */
static uint64_t bytes_without_names(pid_t child)
{
    char     path[64];
    uint64_t bytes = 0;
    snprintf(path, sizeof path, "/proc/%ld/fd", (long)child);
    DIR *folder = opendir(path);
    for (const struct dirent *entry; folder && (entry = readdir(folder));) {
        struct stat about;
        if (fstatat(dirfd(folder), entry->d_name, &about, 0) == 0 && S_ISREG(about.st_mode) &&
            about.st_nlink == 0)
            bytes += (uint64_t)about.st_blocks * 512;
    }
    if (folder)
        closedir(folder);
    return bytes;
}

const char *sandbox_excess(pid_t child, const SandboxNeeds *needs)
{
    const long processors = sysconf(_SC_NPROCESSORS_CONF);
    if (count_threads(child) > 64 + 16 * processors)
        return "it has more threads than the sandbox permits";
    if (needs->memory > 0 && bytes_without_names(child) > needs->memory)
        return "it has more memory in files without names than --limit memory allows";
    return NULL;
}
