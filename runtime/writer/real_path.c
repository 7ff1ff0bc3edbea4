/*
 * real_path.c: where symbolic links lead.
 */
#include "runtime/writer/real_path.h"

#include <errno.h>
#include <libgen.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_LINKS = 40 };

char *path_folder(const char *path)
{
    char *copy   = strdup(path);
    char *folder = copy ? strdup(dirname(copy)) : NULL;
    free(copy);
    return folder;
}

/* Returns "real/folder/name" of a file that does not exist, in a folder that does. */
static char *real_path_of_missing(const char *path)
{
    char *folder = path_folder(path), *real = folder ? realpath(folder, NULL) : NULL, *place = NULL;
    const char *slash = strrchr(path, '/');
    if (real &&
        asprintf(&place, "%s/%s", strcmp(real, "/") == 0 ? "" : real, slash ? slash + 1 : path) < 0)
        place = NULL;
    free(folder);
    free(real);
    return place;
}

/* Returns the path that a symbolic link refers to; NULL when `path` is no link. */
static char *follow_link(const char *path)
{
    char    to[PATH_MAX], *folder, *place = NULL;
    ssize_t length = readlink(path, to, sizeof to - 1);
    if (length < 0)
        return NULL;
    to[length] = '\0';
    if (to[0] == '/')
        return strdup(to);
    folder = path_folder(path);
    if (folder && asprintf(&place, "%s/%s", folder, to) < 0)
        place = NULL;
    free(folder);
    return place;
}

char *real_path(const char *path)
{
    char *place = strdup(path);
    if (!place)
        return NULL;
    for (int links = 0; links < MAX_LINKS; links++) {
        char *real = realpath(place, NULL), *next = NULL;
        bool  missing = !real && errno == ENOENT;
        if (missing && !(next = follow_link(place)) && errno != ENOMEM)
            real = real_path_of_missing(place);
        free(place);
        if (!next)
            return real;
        place = next;
    }
    free(place);
    errno = ELOOP;
    return NULL;
}
