/*
 * loader.c: reads the texts of a scene and of the files that it uses.
 */
#include "compiler/base/loader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/paths.h"

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
        loader->root         = disk_open_root(root);
        loader->scene_folder = disk_folder_below(root, scene);
    }
    return true;
}

void loader_close(Loader *loader)
{
    if (loader->root >= 0)
        disk_close_root(loader->root);
    free(loader->scene);
    free(loader->scene_folder);
    *loader = (Loader){.root = -1};
}

/* Returns the path from the root to a file.  `path` begins as the scene's path does.  NULL if the
   file may be outside of the root, or if there is no memory. */
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
    const Loaded outside = {.reason = "it is outside of the root", .outside = true};
    const Loaded loaded = path && loader->root >= 0 ? disk_read_below(loader->root, path) : outside;
    free(path);
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
        return disk_read(path);
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
                                : disk_read(path);
    loaded.text   = loader->supplier(loader->user, path, &loaded.length);
    loaded.reason = loaded.text ? NULL : "it is not supplied";
    return loaded;
}
