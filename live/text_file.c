/*
 * text_file.c: reads and writes whole files.
 */
#include "live/text_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool text_file_read(const char *path, Bytes *bytes)
{
    FILE  *file = fopen(path, "rb");
    char   part[4096];
    size_t got;
    if (!file)
        return false;
    FILE *out = open_memstream(&bytes->text, &bytes->length);
    while (out && (got = fread(part, 1, sizeof part, file)) > 0)
        fwrite(part, 1, got, out);
    const bool good = out && !ferror(file);
    fclose(file);
    return out && fclose(out) == 0 && good;
}

bool text_file_write(const char *path, const Bytes *bytes)
{
    struct stat info;
    char       *real = realpath(path, NULL), *name = NULL;
    const bool  old = real && stat(real, &info) == 0;
    if (!real && errno == ENOENT)
        real = strdup(path);
    bool      good = real && asprintf(&name, "%s.%ld", real, (long)getpid()) > 0;
    const int fd   = good ? open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666) : -1;
    FILE     *file = fd >= 0 ? fdopen(fd, "wb") : NULL;
    if (file) {
        good = fwrite(bytes->text, 1, bytes->length, file) == bytes->length &&
               (!old || fchmod(fd, info.st_mode & 07777) == 0);
        good = fclose(file) == 0 && good;
        good = good && rename(name, real) == 0;
        if (!good)
            unlink(name);
    }
    free(real);
    free(name);
    return file && good;
}
