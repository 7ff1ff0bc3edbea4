/*
 * temporary.c: the file that an output is written to before it gets its name.
 */
#include "runtime/writer/temporary.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { ATTEMPTS = 1000 };

static const char prefix[] = ".krs-", ending[] = ".tmp";

/* Creates a file under a new name; -1 when it cannot.  No name is used twice: a process that found
   an abandoned file could otherwise remove another file of that name.  The target's name is not
   part of it, since that may already have the longest permitted length. */
static int create(const char *folder, mode_t mode, char **path)
{
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        struct timespec now;
        clock_gettime(CLOCK_REALTIME, &now);
        if (asprintf(path, "%s/%s%ld-%llx%09lx-%d%s", folder, prefix, (long)getpid(),
                     (unsigned long long)now.tv_sec, now.tv_nsec, attempt, ending) < 0) {
            *path = NULL;
            errno = ENOMEM;
            return -1;
        }
        int fd = open(*path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
        if (fd >= 0)
            return fd;
        free(*path);
        *path = NULL;
        if (errno != EEXIST)
            break;
    }
    return -1;
}

/* Locks a new file; false where another process has removed it as abandoned before it was locked.
   On file systems without locks that other process cannot lock it either. */
static bool lock(int fd)
{
    struct stat info;
    if (flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return false;
    return fstat(fd, &info) == 0 && info.st_nlink > 0;
}

int temporary_create(const char *folder, char **path)
{
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        int fd = create(folder, 0600, path);
        if (fd < 0 || lock(fd))
            return fd;
        close(fd);
        unlink(*path);
        free(*path);
        *path = NULL;
    }
    errno = EAGAIN;
    return -1;
}

/* The user's mask cannot be read without setting it, and an access control list of the folder may
   decide instead.  So the permissions are read from an empty file that is created for that. */
mode_t temporary_mode(const char *folder)
{
    struct stat info;
    mode_t      mode = 0600;
    char       *path;
    int         fd = create(folder, 0666, &path);
    if (fd < 0)
        return mode;
    if (fstat(fd, &info) == 0)
        mode = info.st_mode & 0777;
    close(fd);
    unlink(path);
    free(path);
    return mode;
}

static bool is_temporary(const char *name)
{
    size_t length = strlen(name), before = sizeof prefix - 1, behind = sizeof ending - 1;
    return length > before + behind && strncmp(name, prefix, before) == 0 && name[before] >= '0' &&
           name[before] <= '9' && strcmp(name + length - behind, ending) == 0;
}

static void remove_abandoned(int folder, const char *name)
{
    struct stat info;
    int         fd = openat(folder, name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0)
        return;
    if (fstat(fd, &info) == 0 && S_ISREG(info.st_mode) && info.st_uid == geteuid() &&
        flock(fd, LOCK_EX | LOCK_NB) == 0)
        unlinkat(folder, name, 0);
    close(fd);
}

void temporary_clean(const char *folder)
{
    DIR *listing = opendir(folder);
    if (!listing)
        return; /* may be written to, but not listed */
    for (const struct dirent *found; (found = readdir(listing));)
        if (is_temporary(found->d_name))
            remove_abandoned(dirfd(listing), found->d_name);
    closedir(listing);
}
