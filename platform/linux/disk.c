/*
 * disk.c: reads files of the system.
 */
#include "compiler/base/disk.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "compiler/base/paths.h"
#include "compiler/base/sandbox.h"
#include "compiler/base/source.h"

/* ---- bytes ---- */

/* Reads a stream to its end, or one byte past the limit, since devices have no end. */
static char *read_stream(FILE *file, size_t *length, const char **reason)
{
    char  *text     = NULL;
    size_t capacity = 0;
    *reason         = NULL;
    while (*length <= MAX_FILE_BYTES) {
        if (*length == capacity) {
            capacity     = capacity ? 2 * capacity : 16384;
            capacity     = capacity <= MAX_FILE_BYTES ? capacity : MAX_FILE_BYTES + 1;
            char *larger = realloc(text, capacity);
            *reason      = larger ? NULL : source_no_memory;
            if (!larger)
                break;
            text = larger;
        }
        size_t count = fread(text + *length, 1, capacity - *length, file);
        *length += count;
        if (count == 0) {
            *reason = !ferror(file) ? NULL : errno == ENOMEM ? source_no_memory : strerror(errno);
            break;
        }
    }
    return text;
}

Loaded disk_read_open(int fd)
{
    Loaded loaded = {.reason = source_no_memory};
    FILE  *file   = fdopen(fd, "rb");
    if (!file) {
        close(fd);
        return loaded;
    }
    loaded.owned = read_stream(file, &loaded.length, &loaded.reason);
    fclose(file);
    if (loaded.reason) {
        free(loaded.owned);
        loaded.owned = NULL;
    }
    loaded.text = loaded.owned;
    return loaded;
}

Loaded disk_read(const char *path)
{
    struct stat about;
    int         fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd < 0)
        return (Loaded){.reason = strerror(errno)};
    if (fstat(fd, &about) == 0 && S_ISDIR(about.st_mode)) {
        close(fd);
        return (Loaded){.reason = "it is a folder"};
    }
    return disk_read_open(fd);
}

/* ---- below a root ---- */

int disk_open_root(const char *root) { return open(root, O_PATH | O_DIRECTORY | O_CLOEXEC); }

void disk_close_root(int root) { close(root); }

char *disk_folder_below(const char *root, const char *scene)
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

Loaded disk_read_below(int root, const char *path)
{
    struct stat about;
    const int   fd = sandbox_open(root, path);
    if (fd < 0 && errno == EXDEV)
        return (Loaded){.reason = "it is outside of the root", .outside = true};
    if (fd < 0)
        return (Loaded){.reason = strerror(errno)};
    if (fstat(fd, &about) == 0 && S_ISREG(about.st_mode))
        return disk_read_open(fd);
    close(fd);
    return (Loaded){.reason = "it is not a regular file"};
}
