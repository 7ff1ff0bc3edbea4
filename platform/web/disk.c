/*
 * disk.c: a page has no files but those that it supplies.
 */
#include "compiler/base/disk.h"

static Loaded nothing(void) { return (Loaded){.reason = "it is not supplied"}; }

Loaded disk_read(const char *path)
{
    (void)path;
    return nothing();
}

Loaded disk_read_open(int file)
{
    (void)file;
    return nothing();
}

int disk_open_root(const char *root)
{
    (void)root;
    return -1;
}

void disk_close_root(int root) { (void)root; }

Loaded disk_read_below(int root, const char *path)
{
    (void)root, (void)path;
    return nothing();
}

char *disk_folder_below(const char *root, const char *scene)
{
    (void)root, (void)scene;
    return NULL;
}
