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

#include "compiler/base/sandbox.h"
#include "compiler/base/paths.h"
#include "compiler/base/source.h"

/* The path from the root to the scene's folder: "" or "a/b/"; NULL if that is not in the root. */
static char *find_scene_folder(const char *root, const char *scene)
{
    size_t length = path_folder_length(scene);
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

/* The path from the root to a file.  `path` begins as the scene's path does.  NULL if the file may be outside of
   the root, or if there is no memory. */
static char *path_from_root(const Loader *loader, const char *path)
{
    char *relative = loader->scene_folder ? path_relative(loader->scene, path) : NULL,
         *whole    = NULL;
    if (relative && asprintf(&whole, "%s%s", loader->scene_folder, relative) < 0)
        whole = NULL;
    free(relative);
    return whole;
}

/* Reads a file by its path from the root, which is freed here.  NULL: the file is outside. */
static Loaded read_confined(const Loader *loader, char *path)
{
    struct stat about;
    Loaded      loaded = {.reason = "it is outside of the root", .outside = true};
    int         fd     = path && loader->root >= 0 ? sandbox_open(loader->root, path) : -1;
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
        asprintf(&whole, "%s%s", loader->scene_folder, path + path_folder_length(path)) < 0)
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
