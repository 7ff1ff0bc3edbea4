/*
 * sandbox.c: opens files below a folder, and none outside of it; folders through no links.
 */
#include "compiler/base/sandbox.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <linux/openat2.h>
#include <stdbool.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

/* O_NONBLOCK: opening a device or a pipe must not block.  The caller checks the kind of file. */
static const int READ_FLAGS = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;

/* Removes "." and "name/.." from a path; false when it leads out of the folder.  The simple path
   names the same file, since links are not followed. */
static bool simplify(const char *path, char simple[PATH_MAX])
{
    size_t length = 0;
    if (path[0] == '/' || strlen(path) >= PATH_MAX)
        return false;
    simple[0] = '\0';
    while (*path) {
        size_t name_length = strcspn(path, "/");
        if (name_length == 2 && strncmp(path, "..", 2) == 0) {
            char *slash = strrchr(simple, '/');
            if (length == 0)
                return false;
            length         = slash ? (size_t)(slash - simple) : 0;
            simple[length] = '\0';
        } else if (name_length > 0 && !(name_length == 1 && path[0] == '.')) {
            if (length > 0)
                simple[length++] = '/';
            memcpy(simple + length, path, name_length);
            length += name_length;
            simple[length] = '\0';
        }
        path += name_length + (path[name_length] == '/');
    }
    return true;
}

/* Opens one component of a path; the last one is the file. */
static int open_step(int folder, const char *name, bool last)
{
    int  flags = last ? READ_FLAGS | O_NOFOLLOW : O_PATH | O_CLOEXEC | O_NOFOLLOW | O_DIRECTORY;
    int  fd    = openat(folder, name, flags);
    char link[1];
    if (fd < 0 && (errno == ELOOP || errno == ENOTDIR)) {
        int reason = errno;
        errno      = readlinkat(folder, name, link, sizeof link) >= 0 ? EXDEV : reason;
    }
    return fd;
}

int sandbox_open_by_steps(int root, const char *path)
{
    char simple[PATH_MAX], *name = simple;
    int  folder = root;
    if (!simplify(path, simple)) {
        errno = EXDEV;
        return -1;
    }
    for (;;) {
        size_t length = strcspn(name, "/");
        bool   last   = name[length] == '\0';
        name[length]  = '\0';
        int next      = open_step(folder, length > 0 ? name : ".", last);
        int reason    = errno;
        if (folder != root)
            close(folder);
        errno = reason;
        if (last || next < 0)
            return next;
        folder = next;
        name += length + 1;
    }
}

int sandbox_open(int root, const char *path)
{
    struct open_how how = {.flags   = (unsigned)READ_FLAGS,
                           .resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS};
    for (int attempt = 0; attempt < 10; attempt++) {
        int fd = (int)syscall(SYS_openat2, root, path, &how, sizeof how);
        if (fd >= 0 || errno != EAGAIN)
            return fd >= 0 || (errno != ENOSYS && errno != EPERM)
                       ? fd
                       : sandbox_open_by_steps(root, path);
    }
    return sandbox_open_by_steps(root, path); /* EAGAIN: other processes keep renaming folders */
}

/* Returns the rest of an absolute path that leads below the current folder; NULL: it does not. */
static const char *below_current_folder(const char *path)
{
    char         here[PATH_MAX];
    const size_t length = getcwd(here, sizeof here) ? strlen(here) : 0;
    if (length < 2 || strncmp(path, here, length) != 0 || (path[length] != '/' && path[length]))
        return NULL;
    return path + length + strspn(path + length, "/");
}

int open_folder_by_steps(const char *path)
{
    int folder = open(path[0] == '/' ? "/" : ".", O_PATH | O_CLOEXEC | O_DIRECTORY);
    for (path += strspn(path, "/"); *path && folder >= 0; path += strspn(path, "/")) {
        char         name[NAME_MAX + 1];
        const size_t length = strcspn(path, "/");
        const int    before = folder;
        folder              = -1;
        errno               = ENAMETOOLONG;
        if (length <= NAME_MAX) {
            memcpy(name, path, length);
            name[length] = '\0';
            folder       = open_step(before, name, false);
        }
        const int reason = errno;
        close(before);
        errno = reason == EXDEV ? ELOOP : reason;
        path += length;
    }
    return folder;
}

int open_folder_without_links(const char *path)
{
    char            simple[PATH_MAX];
    const char     *below = path[0] == '/' ? below_current_folder(path) : path, *from = path;
    struct open_how how = {.flags   = O_PATH | O_CLOEXEC | O_DIRECTORY,
                           .resolve = RESOLVE_NO_SYMLINKS | RESOLVE_NO_MAGICLINKS};
    if (below && simplify(below, simple)) {
        how.resolve |= RESOLVE_BENEATH;
        from = simple[0] ? simple : ".";
    }
    for (int attempt = 0; attempt < 10; attempt++) {
        const int fd = (int)syscall(SYS_openat2, AT_FDCWD, from, &how, sizeof how);
        if (fd >= 0 || (errno != EAGAIN && errno != ENOSYS && errno != EPERM))
            return fd;
        if (errno != EAGAIN)
            break;
    }
    return open_folder_by_steps(from);
}
