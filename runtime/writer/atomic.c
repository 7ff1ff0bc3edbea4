/*
 * atomic.c: temporary file, flush, rename.
 *
 * Writes are gathered in a buffer as long as each begins where the one before ended, because
 * the EXR library writes its header a few bytes at a time.  The order at the end matters: the
 * bytes must be on the disk before the name points to them, and the folder, which holds the
 * name, is flushed last.
 */
#include "runtime/writer/atomic.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { BUFFER_SIZE = 1 << 16, ATTEMPTS = 1000 };

struct OutputFile {
    OutputError *error;
    const volatile sig_atomic_t *cancelled;
    char    *shown;     /* the path as the user gave it */
    char    *target;    /* with symbolic links followed */
    char    *folder;
    char    *temporary; /* spool file in case of a direct target, else in `folder` */
    int      fd;
    bool     direct;    /* the target is no regular file */
    uint64_t end;       /* where the longest write so far ended */
    uint64_t buffered_at;
    size_t   buffered;
    char     buffer[BUFFER_SIZE];
};

static bool output_fail(OutputError *error, KrsStatus status, const char *path, int reason)
{
    if (error->status != KRS_OK)
        return false; /* the first mistake is the one to tell */
    error->status = status;
    if (status == KRS_INTERRUPTED)
        snprintf(error->message, sizeof error->message, "interrupted while writing `%s`", path);
    else if (reason == ENOMEM)
        snprintf(error->message, sizeof error->message, "out of memory while writing `%s`", path);
    else
        snprintf(error->message, sizeof error->message, "%s `%s`: %s",
                 status == KRS_CANNOT_CREATE ? "cannot create" : "error while writing", path,
                 strerror(reason));
    if (reason == ENOMEM)
        error->status = KRS_OUT_OF_MEMORY;
    return false;
}

static bool fail_create(OutputFile *file)
{
    return output_fail(file->error, KRS_CANNOT_CREATE, file->shown, errno);
}

static bool fail_write(OutputFile *file)
{
    return output_fail(file->error, KRS_IO_ERROR, file->shown, errno);
}

static void output_free(OutputFile *file)
{
    if (file->fd >= 0)
        close(file->fd);
    free(file->shown);
    free(file->target);
    free(file->folder);
    free(file->temporary);
    free(file);
}

static char *folder_of(const char *path)
{
    char *copy = strdup(path);
    char *folder = copy ? strdup(dirname(copy)) : NULL;
    free(copy);
    return folder;
}

/* Where the bytes will go in the end: the file behind a symbolic link is replaced, not the
   link. */
static bool find_target(OutputFile *file)
{
    struct stat info;
    if (file->shown[0] == '\0') {
        errno = ENOENT;
        return fail_create(file);
    }
    if (stat(file->shown, &info) == 0) {
        if (S_ISDIR(info.st_mode)) {
            errno = EISDIR;
            return fail_create(file);
        }
        if (access(file->shown, W_OK) != 0)
            return fail_create(file);
        file->direct = !S_ISREG(info.st_mode);
        file->target = file->direct ? strdup(file->shown) : realpath(file->shown, NULL);
    } else if (errno == ENOENT) {
        file->target = strdup(file->shown); /* may also be a link that leads nowhere */
    }
    if (!file->target)
        return fail_create(file);

    const char *spool = getenv("TMPDIR");
    if (!spool || !*spool)
        spool = "/tmp";
    file->folder = file->direct ? strdup(spool) : folder_of(file->target);
    return file->folder || fail_create(file);
}

/* The name does not contain the target's, which may already be as long as a name can be. */
static bool create_temporary(OutputFile *file)
{
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        free(file->temporary);
        if (asprintf(&file->temporary, "%s/.krs-%ld-%d.tmp", file->folder, (long)getpid(),
                     attempt) < 0) {
            file->temporary = NULL;
            errno = ENOMEM;
            return fail_create(file);
        }
        file->fd = open(file->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file->fd >= 0)
            return true;
        if (errno != EEXIST)
            break;
    }
    return fail_create(file);
}

OutputFile *output_open(const char *path, const volatile sig_atomic_t *cancelled,
                        OutputError *error)
{
    *error = (OutputError){0};
    OutputFile *file = calloc(1, sizeof *file);
    if (!file) {
        output_fail(error, KRS_OUT_OF_MEMORY, path, ENOMEM);
        return NULL;
    }
    *file = (OutputFile){.error = error, .cancelled = cancelled, .fd = -1, .shown = strdup(path)};
    if (!file->shown) {
        output_fail(error, KRS_OUT_OF_MEMORY, path, ENOMEM);
        output_free(file);
        return NULL;
    }
    if (!find_target(file) || !create_temporary(file)) {
        output_free(file);
        return NULL;
    }
    return file;
}

const char *output_temporary(const OutputFile *file) { return file->temporary; }

/* Writes all of it, however many calls that takes; `offset` < 0 is a target without offsets. */
static bool write_fully(OutputFile *file, int fd, const char *bytes, size_t length, int64_t offset)
{
    while (length > 0) {
        if (file->cancelled && *file->cancelled)
            return output_fail(file->error, KRS_INTERRUPTED, file->shown, 0);
        ssize_t written = offset < 0 ? write(fd, bytes, length) : pwrite(fd, bytes, length, offset);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0) {
            if (written == 0)
                errno = EIO; /* no progress and no reason: do not spin */
            return fail_write(file);
        }
        bytes += written;
        length -= (size_t)written;
        if (offset >= 0)
            offset += written;
    }
    return true;
}

static bool flush_buffer(OutputFile *file)
{
    size_t length = file->buffered;
    file->buffered = 0;
    return write_fully(file, file->fd, file->buffer, length, (int64_t)file->buffered_at);
}

bool output_write(OutputFile *file, const void *bytes, size_t length, uint64_t offset)
{
    if (file->error->status != KRS_OK)
        return false;
    if (offset + length > file->end)
        file->end = offset + length;
    bool joins = offset == file->buffered_at + file->buffered;
    if ((!joins || file->buffered + length > BUFFER_SIZE) && !flush_buffer(file))
        return false;
    if (length > BUFFER_SIZE)
        return write_fully(file, file->fd, bytes, length, (int64_t)offset);
    if (file->buffered == 0)
        file->buffered_at = offset;
    memcpy(file->buffer + file->buffered, bytes, length);
    file->buffered += length;
    return true;
}

bool output_append(OutputFile *file, const void *bytes, size_t length)
{
    return output_write(file, bytes, length, file->end);
}

/* A pipe cannot be written in any order, so its bytes waited in a spool file. */
static bool copy_to_target(OutputFile *file)
{
    int target = open(file->target, O_WRONLY | O_CLOEXEC);
    if (target < 0)
        return fail_create(file);
    bool done = true;
    for (uint64_t at = 0; done && at < file->end;) {
        ssize_t length = pread(file->fd, file->buffer, BUFFER_SIZE, (off_t)at);
        if (length < 0 && errno == EINTR)
            continue;
        if (length <= 0) {
            if (length == 0)
                errno = EIO;
            done = fail_write(file);
            break;
        }
        done = write_fully(file, target, file->buffer, (size_t)length, -1);
        at += (uint64_t)length;
    }
    if (close(target) != 0 && done)
        done = fail_write(file);
    return done;
}

static bool close_temporary(OutputFile *file)
{
    int fd = file->fd;
    file->fd = -1;
    return close(fd) == 0 || fail_write(file);
}

/* Some file systems cannot flush a folder (EINVAL) and keep the order by themselves. */
static bool flush_folder(OutputFile *file)
{
    int folder = open(file->folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0)
        return errno == EACCES || fail_write(file); /* may write there, but not look */
    bool done = fsync(folder) == 0 || errno == EINVAL || fail_write(file);
    close(folder);
    return done;
}

KrsStatus output_commit(OutputFile *file)
{
    OutputError *error = file->error;
    bool written = error->status == KRS_OK && flush_buffer(file);
    if (written && file->direct) {
        written = copy_to_target(file);
    } else if (written) {
        written = fsync(file->fd) == 0 || fail_write(file);
        written = written && close_temporary(file);
        if (written && file->cancelled && *file->cancelled)
            written = output_fail(error, KRS_INTERRUPTED, file->shown, 0);
        if (written && rename(file->temporary, file->target) == 0) {
            flush_folder(file);
            output_free(file);
            return error->status;
        }
        if (written)
            fail_write(file);
    }
    output_abandon(file);
    return error->status;
}

void output_abandon(OutputFile *file)
{
    unlink(file->temporary);
    output_free(file);
}

KrsStatus output_text(const char *path, const char *text, size_t length,
                      const volatile sig_atomic_t *cancelled, OutputError *error)
{
    OutputFile *file = output_open(path, cancelled, error);
    if (!file)
        return error->status;
    output_append(file, text, length);
    return output_commit(file);
}

KrsStatus output_check(const char *path, OutputError *error)
{
    OutputFile *file = output_open(path, NULL, error);
    if (file)
        output_abandon(file);
    return error->status;
}
