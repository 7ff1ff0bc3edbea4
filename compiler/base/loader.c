/*
 * loader.c: reads the texts of a scene and of the files that it uses.
 */
#include "compiler/base/loader.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "compiler/base/beneath.h"
#include "compiler/base/source.h"

/* The length of a path's folder with its last slash, in bytes. */
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

/* A file must have one name only, since it is known by its path. */
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

/* The path from the root to the scene's folder: "" or "a/b/"; NULL if that is not in the root. */
static char *find_scene_folder(const char *root, const char *scene)
{
    size_t length = folder_length(scene);
    char  *folder = length ? strndup(scene, length) : strdup(".");
    char  *whole = realpath(root, NULL), *real = folder ? realpath(folder, NULL) : NULL;
    char  *found = NULL;
    size_t start = whole && strcmp(whole, "/") != 0 ? strlen(whole) : 0;
    if (whole && real && strncmp(real, whole, start) == 0 &&
        (real[start] == '/' || real[start] == '\0')) {
        const char *rest = real + start + (real[start] == '/');
        if (asprintf(&found, "%s%s", rest, *rest ? "/" : "") < 0)
            found = NULL;
    }
    free(folder);
    free(whole);
    free(real);
    return found;
}

bool loader_open(Loader *loader, const char *root, const char *scene)
{
    loader->confined     = root != NULL;
    loader->root         = -1;
    loader->scene        = strdup(scene);
    loader->scene_folder = NULL;
    if (!loader->scene)
        return false;
    path_simplify(loader->scene);
    if (root) {
        loader->root         = open(root, O_PATH | O_DIRECTORY | O_CLOEXEC);
        loader->scene_folder = find_scene_folder(root, scene);
    }
    return true;
}

void loader_close(Loader *loader)
{
    if (loader->root >= 0)
        close(loader->root);
    free(loader->scene);
    free(loader->scene_folder);
    *loader = (Loader){.root = -1};
}

/* The path from the root to a file.  `path` begins as the scene's path does.  The result goes up
   from the scene's folder to the last folder that both paths share, and down to the file.  NULL if
   the file may be outside of the root, or if there is no memory. */
static char *path_from_root(const Loader *loader, const char *path)
{
    const char *folder = loader->scene;
    size_t      length = folder_length(folder), common = 0;
    char       *whole = NULL, *up;
    if (!loader->scene_folder || (path[0] == '/') != (folder[0] == '/' && length > 0))
        return NULL;
    for (size_t i = 0; i < length && path[i] == folder[i]; i++)
        if (path[i] == '/')
            common = i + 1;
    size_t levels = 0;
    for (size_t i = common; i < length; i++)
        levels += folder[i] == '/';
    up = malloc(3 * levels + 1);
    if (!up)
        return NULL;
    for (size_t i = 0; i < levels; i++)
        memcpy(up + 3 * i, "../", 3);
    up[3 * levels] = '\0';
    if (asprintf(&whole, "%s%s%s", loader->scene_folder, up, path + common) < 0)
        whole = NULL;
    free(up);
    return whole;
}

/* Reads a file by its path from the root, which is freed here.  NULL: the file is outside. */
static Loaded read_confined(const Loader *loader, char *path)
{
    struct stat about;
    Loaded      loaded = {.reason = "it is outside of the root", .outside = true};
    int         fd     = path && loader->root >= 0 ? open_beneath(loader->root, path) : -1;
    if (path && loader->root >= 0 && (fd >= 0 || errno != EXDEV))
        loaded = (Loaded){.reason = fd < 0 ? strerror(errno) : "it is not a regular file"};
    if (fd >= 0 && fstat(fd, &about) == 0 && S_ISREG(about.st_mode))
        loaded.owned = source_read_open(fd, &loaded.length, &loaded.reason);
    else if (fd >= 0)
        close(fd);
    loaded.text = loaded.owned;
    free(path);
    return loaded;
}

static Loaded read_file(const char *path)
{
    Loaded loaded = {0};
    loaded.owned  = source_read(path, &loaded.length, &loaded.reason);
    loaded.text   = loaded.owned;
    return loaded;
}

static void tell_observer(const Loader *loader, const char *path)
{
    if (loader->observer)
        loader->observer(loader->observer_user, path);
}

Loaded loader_read_scene(const Loader *loader, const char *path)
{
    char *whole = NULL;
    tell_observer(loader, path);
    if (!loader->confined)
        return read_file(path);
    if (loader->scene_folder &&
        asprintf(&whole, "%s%s", loader->scene_folder, path + folder_length(path)) < 0)
        whole = NULL;
    return read_confined(loader, whole);
}

Loaded loader_read(const Loader *loader, const char *path)
{
    Loaded loaded = {0};
    tell_observer(loader, path);
    if (!loader->supplier)
        return loader->confined ? read_confined(loader, path_from_root(loader, path))
                                : read_file(path);
    loaded.text   = loader->supplier(loader->user, path, &loaded.length);
    loaded.reason = loaded.text ? NULL : "it is not supplied";
    return loaded;
}
