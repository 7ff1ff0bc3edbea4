/*
 * atomic.c: writes a temporary file, flushes it and renames it.
 *
 * Writes are gathered in a buffer as long as each begins where the one before ended.  The EXR
 * library writes its header a few bytes at a time.  The order at the end matters.  The bytes must
 * be on the disk before the name refers to them.  The folder, which holds the name, is flushed
 * last.
 */
#include "runtime/writer/atomic.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "compiler/base/sandbox.h"
#include "runtime/writer/real_path.h"
#include "runtime/writer/temporary.h"

enum { BUFFER_SIZE = 1 << 16 };

struct OutputFile {
    OutputError                 *error;
    const volatile sig_atomic_t *cancelled;
    char                        *shown;  /* the path as the user gave it */
    char                        *target; /* with symbolic links followed */
    char                        *folder;
    char                        *temporary; /* path of the temporary file, in `folder` */
    char                        *known_as;  /* the same for other processes */
    int fd, held; /* `held`: a folder that was reached without links, or -1 */
    /* The target is no regular file: it is not renamed over, and the temporary file is in
       TMPDIR. */
    bool direct;
    bool fleeting; /* it is not flushed */
    bool asked;    /* another process has made it, and ends it */
    int  number;   /* what it is called there */
    /* The target exists; the new file takes over owner and permissions from `before`. */
    bool        exists;
    struct stat before;
    mode_t      mode; /* permissions of a new target */
    uint64_t    end;  /* size of the file so far */
    uint64_t    buffered_at;
    size_t      buffered;
    char        buffer[BUFFER_SIZE];
};

/* Set once, when the process begins. */
static atomic_bool links_are_forbidden;

/* Who makes outputs in place of this process, or NULL; set once, when the process begins. */
static _Atomic(OutputAsk *) other;

void output_ask(OutputAsk *ask) { atomic_store(&other, ask); }

void output_forbid_links(void) { atomic_store(&links_are_forbidden, true); }

static const char *explain(int reason)
{
    const bool forbidden = atomic_load(&links_are_forbidden);
    if (forbidden && reason == ELOOP)
        return "there is a symbolic link, and outputs of untrusted scenes go through none";
    if (forbidden && reason == EPERM)
        return "there is something else than a file";
    return strerror(reason);
}

static bool output_fail(OutputError *error, KrsStatus status, const char *path, int reason)
{
    if (error->status != KRS_OK)
        return false; /* the first failure is the one to report */
    error->status = status;
    if (status == KRS_INTERRUPTED)
        snprintf(error->message, sizeof error->message, "interrupted while writing `%s`", path);
    else if (reason == ENOMEM)
        snprintf(error->message, sizeof error->message, "out of memory while writing `%s`", path);
    else
        snprintf(error->message, sizeof error->message, "%s `%s`: %s",
                 status == KRS_CANNOT_CREATE ? "cannot create" : "error while writing", path,
                 explain(reason));
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
    if (file->held >= 0)
        close(file->held);
    free(file->shown);
    free(file->target);
    free(file->folder);
    free(file->temporary);
    free(file->known_as);
    free(file);
}

bool output_is_same(const char *a, const char *b)
{
    char *first = real_path(a), *second = real_path(b);
    bool  same = strcmp(a, b) == 0 || (first && second && strcmp(first, second) == 0);
    free(first);
    free(second);
    return same;
}

static bool is_standard_output(const char *path) { return strcmp(path, OUTPUT_STANDARD) == 0; }

/* Tells whether standard output can be written: a caller may have closed it. */
static bool check_standard_output(OutputFile *file)
{
    const int flags = fcntl(STDOUT_FILENO, F_GETFL);
    if (flags >= 0 && (flags & O_ACCMODE) != O_RDONLY)
        return true;
    errno = EBADF;
    return fail_write(file);
}

/* Opens the folder of a path through no link. */
static int hold_folder(const char *path)
{
    char       *folder = path_folder(path);
    int         held   = folder ? open_folder_without_links(folder) : -1;
    int         reason = folder ? errno : ENOMEM;
    struct stat about;
    if (held < 0 && reason == ENOTDIR && stat(folder, &about) == 0 && S_ISDIR(about.st_mode))
        reason = ELOOP; /* a link that leads to a folder is none, where openat2 is missing */
    free(folder);
    errno = reason;
    return held;
}

/* Finds a target that is reached through no link.  Its folder stays open, and is named by its descriptor: what
   takes the place of its name later does not matter. */
static bool find_without_links(OutputFile *file)
{
    struct stat *info  = &file->before;
    const char  *slash = strrchr(file->shown, '/'), *name = slash ? slash + 1 : file->shown;
    if (strcmp(name, "") == 0 || strcmp(name, ".") == 0 || strcmp(name, "..") == 0) {
        errno = EISDIR;
        return fail_create(file);
    }
    file->held = hold_folder(file->shown);
    if (file->held < 0)
        return fail_create(file);
    if (asprintf(&file->folder, "/proc/self/fd/%d", file->held) < 0)
        file->folder = NULL;
    if (!file->folder || asprintf(&file->target, "%s/%s", file->folder, name) < 0) {
        file->target = NULL;
        errno        = ENOMEM;
        return fail_create(file);
    }
    file->exists = lstat(file->target, info) == 0;
    if (file->exists && !S_ISREG(info->st_mode)) {
        errno = S_ISLNK(info->st_mode) ? ELOOP : S_ISDIR(info->st_mode) ? EISDIR : EPERM;
        return fail_create(file);
    }
    return !file->exists || faccessat(AT_FDCWD, file->target, W_OK, AT_SYMLINK_NOFOLLOW) == 0 ||
           fail_create(file);
}

/* Finds the target: the file that a symbolic link leads to is replaced, not the link. */
static bool find_target(OutputFile *file)
{
    struct stat *info   = &file->before;
    size_t       length = strlen(file->shown);
    if (is_standard_output(file->shown) && !check_standard_output(file))
        return false;
    if (atomic_load(&links_are_forbidden) && !is_standard_output(file->shown))
        return find_without_links(file);
    file->exists = stat(file->shown, info) == 0;
    if (length == 0 || (file->exists && S_ISDIR(info->st_mode)) || file->shown[length - 1] == '/') {
        errno = length == 0 ? ENOENT : EISDIR;
        return fail_create(file);
    }
    if (file->exists && access(file->shown, W_OK) != 0)
        return fail_create(file);
    file->direct = is_standard_output(file->shown) || (file->exists && !S_ISREG(info->st_mode));
    file->target = file->direct ? strdup(file->shown) : real_path(file->shown);
    if (!file->target)
        return fail_create(file);

    const char *spool = getenv("TMPDIR");
    if (!spool || !*spool)
        spool = "/tmp";
    file->folder = file->direct ? strdup(spool) : path_folder(file->target);
    return file->folder || fail_create(file);
}

/* Creates the temporary file with mode 0600, so that nobody else can read it.  The permissions for
   a new target are found out before; they are set when committing. */
static bool create_temporary(OutputFile *file)
{
    if (!file->exists)
        file->mode = temporary_mode(file->folder);
    file->fd = temporary_create(file->folder, &file->temporary);
    if (file->fd < 0)
        return fail_create(file);
    char    folder[PATH_MAX];
    ssize_t length = file->held >= 0 ? readlink(file->folder, folder, sizeof folder - 1) : -1;
    if (length >= 0) {
        folder[length] = '\0';
        if (asprintf(&file->known_as, "%s%s", folder, strrchr(file->temporary, '/')) < 0)
            file->known_as = NULL;
    }
    return true;
}

/* Writes what goes to standard output into memory first: this process may make no file. */
static bool make_in_memory(OutputFile *file)
{
    file->direct = true;
    file->target = strdup(file->shown);
    file->fd     = file->target ? memfd_create("output", MFD_CLOEXEC) : -1;
    return file->fd >= 0 || fail_create(file);
}

static bool ask_for(OutputFile *file, OutputAsk *ask)
{
    file->asked = true;
    file->fd    = ask(OUTPUT_BEGIN, file->shown, &file->number, file->error);
    return file->fd >= 0 && file->error->status == KRS_OK;
}

static bool begin(OutputFile *file)
{
    OutputAsk *ask = atomic_load(&other);
    if (!ask)
        return find_target(file) && create_temporary(file);
    return is_standard_output(file->shown) ? check_standard_output(file) && make_in_memory(file)
                                           : ask_for(file, ask);
}

OutputFile *output_open(const char *path, const volatile sig_atomic_t *cancelled,
                        OutputError *error)
{
    *error           = (OutputError){0};
    OutputFile *file = calloc(1, sizeof *file);
    if (!file) {
        output_fail(error, KRS_OUT_OF_MEMORY, path, ENOMEM);
        return NULL;
    }
    *file = (OutputFile){
        .error = error, .cancelled = cancelled, .fd = -1, .held = -1, .shown = strdup(path)};
    if (!file->shown) {
        output_fail(error, KRS_OUT_OF_MEMORY, path, ENOMEM);
        output_free(file);
        return NULL;
    }
    if (!begin(file)) {
        output_free(file);
        return NULL;
    }
    return file;
}

int output_descriptor(const OutputFile *file) { return file->fd; }

const char *output_temporary(const OutputFile *file)
{
    return file->known_as ? file->known_as : file->temporary ? file->temporary : "";
}

/* Writes all bytes, in as many calls as that takes.  `offset` < 0: the target has no offsets. */
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
                errno = EIO; /* no progress and no reason: do not try forever */
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
    size_t length  = file->buffered;
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

/* Copies the temporary file to a target such as a pipe, which cannot be written in any order. */
static bool copy_to_target(OutputFile *file)
{
    int target = is_standard_output(file->target) ? fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0)
                                                  : open(file->target, O_WRONLY | O_CLOEXEC);
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

/* Records what failed after the whole file was in place. */
static void warn(OutputFile *file, const char *words)
{
    OutputError *error = file->error;
    if (error->warning[0] == '\0')
        snprintf(error->warning, sizeof error->warning, "`%s` is written, but %s: %s", file->shown,
                 words, strerror(errno));
}

/* Gives the new file the owner, group and permissions of the file that it replaces.  Where the
   group cannot be kept, the group gets the permissions of all others. */
static void copy_mode(OutputFile *file)
{
    const struct stat *before = &file->before;
    struct stat        now    = {0};
    mode_t             mode   = file->exists ? before->st_mode & 0777 : file->mode;
    bool               known  = file->exists && fstat(file->fd, &now) == 0;
    if (known && now.st_uid != before->st_uid && fchown(file->fd, before->st_uid, (gid_t)-1) != 0)
        /* Root alone may change the owner; else the file belongs to the writer. */
        errno = 0;
    if (known && now.st_gid != before->st_gid && fchown(file->fd, (uid_t)-1, before->st_gid) != 0)
        mode = (mode & ~(mode_t)0070) | (mode & 0007) << 3;
    if (fchmod(file->fd, mode) != 0)
        warn(file, "its permissions could not be set");
}

/* Flushes the folder.  Some file systems cannot (EINVAL) and keep the order by themselves. */
static void flush_folder(OutputFile *file)
{
    int folder = open(file->folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0 && errno == EACCES)
        return; /* may be written to, but not opened */
    if (folder < 0 || (fsync(folder) != 0 && errno != EINVAL))
        warn(file, "its name may not survive a power failure");
    if (folder >= 0)
        close(folder);
}

/* Flushes, closes and renames the file.  Without a lock it would count as abandoned (temporary.h),
   so a second descriptor of the open file keeps the lock until the name is changed. */
static bool put_in_place(OutputFile *file)
{
    copy_mode(file);
    int  held = fcntl(file->fd, F_DUPFD_CLOEXEC, 0), fd = file->fd;
    bool done = file->fleeting || fsync(fd) == 0 || fail_write(file);
    file->fd  = held;
    done      = (close(fd) == 0 || fail_write(file)) && done;
    if (done && file->cancelled && *file->cancelled)
        done = output_fail(file->error, KRS_INTERRUPTED, file->shown, 0);
    return done && (rename(file->temporary, file->target) == 0 || fail_write(file));
}

void output_is_fleeting(OutputFile *file) { file->fleeting = true; }

/* Lets the other process put a file in place. */
static KrsStatus commit_there(OutputFile *file)
{
    OutputError *error = file->error;
    OutputAsk   *ask   = atomic_load(&other);
    ask(file->fleeting ? OUTPUT_COMMIT_FLEETING : OUTPUT_COMMIT, "", &file->number, error);
    output_free(file);
    return error->status;
}

KrsStatus output_commit(OutputFile *file)
{
    OutputError *error = file->error;
    if (error->status == KRS_OK && flush_buffer(file)) {
        if (file->asked)
            return commit_there(file);
        if (file->direct) {
            copy_to_target(file);
        } else if (put_in_place(file)) {
            if (!file->fleeting)
                flush_folder(file);
            output_free(file);
            return error->status;
        }
    }
    output_abandon(file);
    return error->status;
}

void output_abandon(OutputFile *file)
{
    OutputAsk  *ask = atomic_load(&other);
    OutputError ignored;
    if (file->asked)
        ask(OUTPUT_ABANDON, "", &file->number, &ignored);
    if (file->temporary)
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

/* Asks another process for what has no descriptor. */
static KrsStatus ask_status(OutputVerb verb, const char *path, OutputError *error)
{
    OutputAsk *ask  = atomic_load(&other);
    int        none = -1;
    ask(verb, path, &none, error);
    return error->status;
}

KrsStatus output_check(const char *path, OutputError *error)
{
    if (atomic_load(&other) && !is_standard_output(path))
        return ask_status(OUTPUT_CHECK, path, error);
    OutputFile *file = output_open(path, NULL, error);
    if (file) {
        if (file->folder)
            temporary_clean(file->folder);
        output_abandon(file);
    }
    return error->status;
}

/* Makes a folder, through no link where that is forbidden. */
static bool make_folder(const char *path)
{
    if (!atomic_load(&links_are_forbidden))
        return mkdir(path, 0777) == 0;
    const char *slash  = strrchr(path, '/');
    const int   held   = hold_folder(path);
    const bool  made   = held >= 0 && mkdirat(held, slash ? slash + 1 : path, 0777) == 0;
    const int   reason = errno;
    if (held >= 0)
        close(held);
    errno = reason;
    return made;
}

KrsStatus output_make_folder(const char *path, OutputError *error)
{
    struct stat info;
    *error = (OutputError){0};
    if (atomic_load(&other))
        return ask_status(OUTPUT_FOLDER, path, error);
    if (make_folder(path))
        return KRS_OK;
    int reason = errno;
    if (reason == EEXIST) {
        if (stat(path, &info) == 0 && S_ISDIR(info.st_mode))
            return KRS_OK;
        reason = ENOTDIR;
    }
    output_fail(error, KRS_CANNOT_CREATE, path, reason);
    return error->status;
}

/* Asks another process for what can fail with errno alone. */
static int ask_errno(OutputVerb verb, const char *path)
{
    OutputAsk  *ask  = atomic_load(&other);
    int         none = -1;
    OutputError ignored;
    errno = 0;
    return ask(verb, path, &none, &ignored);
}

/* Opens the folder of a path, as the rules for links want it. */
static int hold_folder_of(const char *path)
{
    if (atomic_load(&links_are_forbidden))
        return hold_folder(path);
    char *folder = path_folder(path);
    int   held   = folder ? open(folder, O_PATH | O_DIRECTORY | O_CLOEXEC) : -1;
    free(folder);
    return held;
}

int output_read(const char *path)
{
    if (atomic_load(&other))
        return ask_errno(OUTPUT_READ, path);
    const char *slash  = strrchr(path, '/');
    const int   held   = hold_folder_of(path);
    const int   links  = atomic_load(&links_are_forbidden) ? O_NOFOLLOW : 0;
    const int   file   = held < 0 ? -1
                                  : openat(held, slash ? slash + 1 : path,
                                           O_RDONLY | O_CLOEXEC | O_NONBLOCK | links);
    const int   reason = errno;
    if (held >= 0)
        close(held);
    errno = reason;
    return file;
}

int output_remove(const char *path)
{
    if (atomic_load(&other)) {
        ask_errno(OUTPUT_REMOVE, path);
        return errno == 0 ? 0 : -1;
    }
    const char *slash  = strrchr(path, '/');
    const int   held   = hold_folder_of(path);
    const int   failed = held < 0 ? -1 : unlinkat(held, slash ? slash + 1 : path, 0);
    const int   reason = errno;
    if (held >= 0)
        close(held);
    errno = reason;
    return failed;
}
