/*
 * paths.c: names of files.
 */
#include "compiler/base/paths.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

size_t path_folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

void path_simplify(char *path)
{
    char *to = path;
    for (const char *from = path; *from;) {
        size_t length = strcspn(from, "/");
        bool   last   = from[length] == '\0';
        char  *back   = to > path ? to - 1 : NULL; /* goes to the start of the folder before */
        while (back && back > path && back[-1] != '/')
            back--;
        bool folder = back && !(to - back == 3 && strncmp(back, "../", 3) == 0) && back < to - 1;
        if (length == 2 && strncmp(from, "..", 2) == 0 && folder)
            to = back;
        else if (!(length == 1 && from[0] == '.' && !last)) {
            memmove(to, from, length + !last);
            to += length + !last;
        }
        from += length + !last;
    }
    *to = '\0';
}

/* Goes up from the folder to the last one that both paths share, and down to the file. */
char *path_relative(const char *from, const char *path)
{
    size_t length = path_folder_length(from), common = 0, levels = 0;
    char  *relative;
    if ((path[0] == '/') != (from[0] == '/' && length > 0))
        return NULL;
    for (size_t i = 0; i < length && path[i] == from[i]; i++)
        if (path[i] == '/')
            common = i + 1;
    for (size_t i = common; i < length; i++)
        levels += from[i] == '/';
    relative = malloc(3 * levels + strlen(path + common) + 1);
    if (!relative)
        return NULL;
    for (size_t i = 0; i < levels; i++)
        memcpy(relative + 3 * i, "../", 3);
    strcpy(relative + 3 * levels, path + common);
    return relative;
}
