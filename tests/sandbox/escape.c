/*
 * escape.c: code that takes over the process in the sandbox: a library that is loaded before the others (LD_PRELOAD) and
 * goes to work as soon as the command has entered.
 *
 * ESCAPE names an attempt of escapes.def, or `refused`: all that are only refused.  A line for each says how it went.
 *
 * PLANT is a hole: `all`, `landlock` or `seccomp` is not entered although the command believes so.  VERSION is that of
 * Landlock on an older system, which does not know what later ones do; 0: it has none.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <linux/filter.h>
#include <linux/fs.h>
#include <linux/openat2.h>
#include <linux/sched.h>
#include <linux/seccomp.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/ipc.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/msg.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/sem.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/sysmacros.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <sys/xattr.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

extern char **environ;

enum { ANY = -1 };

/* ---- names ---- */

static const char *of(const char *format, long number, const char *name)
{
    static char path[4][128];
    static int  next;
    char       *to = path[next++ % 4];
    snprintf(to, sizeof path[0], format, number, name);
    return to;
}
static const char *of_parent(const char *name) { return of("/proc/%ld/%s", getppid(), name); }
static const char *of_task(const char *name)
{
    return of("/proc/self/task/%ld/%s", syscall(SYS_gettid), name);
}
static const char *of_descriptor(int file) { return of("/proc/self/fd/%ld%s", file, ""); }

/* ---- files ---- */

static long open_by_openat2(const char *path, uint64_t flags)
{
    struct open_how how = {.flags = flags, .mode = flags & O_CREAT ? 0600 : 0};
    return syscall(SYS_openat2, AT_FDCWD, path, &how, sizeof how);
}

static int create_and_remove(const char *path)
{
    const int file = open(path, O_RDWR | O_CREAT, 0600), reason = errno;
    if (file >= 0)
        unlink(path);
    errno = reason;
    return file;
}

static int change_flags(const char *path)
{
    int flags = FS_NOATIME_FL, file = open(path, O_RDONLY);
    return file < 0 ? 0 : ioctl(file, FS_IOC_SETFLAGS, &flags);
}

/* ---- requests to the parent, as cli/sandbox/outputs.c has them ---- */

enum {
    VERB_BEGIN,
    VERB_COMMIT,
    VERB_FLEETING,
    VERB_ABANDON,
    VERB_CHECK,
    VERB_FOLDER,
    VERB_READ,
    VERB_REMOVE
};

static struct {
    int  verb, number;
    char path[PATH_MAX];
} request;
static struct {
    int  number, reason, status;
    char message[2048];
} answer;

/* The only socket among the files that are open at the beginning. */
static int connection(void)
{
    static int found;
    for (int file = 3; found == 0 && file < 1024; file++) {
        struct sockaddr_un name;
        socklen_t          length = sizeof name;
        if (getsockname(file, (struct sockaddr *)&name, &length) == 0)
            found = file;
    }
    return found;
}

/* Sends the request; returns the descriptor that comes back or 0, or -1 where it is refused. */
static int send_request(void)
{
    char          control[CMSG_SPACE(sizeof(int))] = {0};
    struct iovec  vector                           = {&answer, sizeof answer};
    struct msghdr message                          = {.msg_iov        = &vector,
                                                      .msg_iovlen     = 1,
                                                      .msg_control    = control,
                                                      .msg_controllen = sizeof control};
    int           file = 0, to = connection();
    memset(&answer, 0, sizeof answer);
    if (send(to, &request, sizeof request, 0) != sizeof request || recvmsg(to, &message, 0) <= 0)
        return -1;
    struct cmsghdr *descriptor = CMSG_FIRSTHDR(&message);
    if (descriptor)
        memcpy(&file, CMSG_DATA(descriptor), sizeof file);
    errno = answer.reason ? answer.reason : EIO;
    return answer.status == 0 && answer.reason == 0 ? file : -1;
}

static int ask_verb(int verb, const char *path, int number)
{
    memset(&request, 0, sizeof request);
    request.verb   = verb;
    request.number = number;
    snprintf(request.path, sizeof request.path, "%s", path);
    return send_request();
}
static int ask_for_file(const char *path)
{
    const int file = ask_verb(VERB_BEGIN, path, 0);
    if (file <= 0)
        fprintf(stderr, "%s is not even begun\n", path);
    return file;
}
static int ask(const char *path) { return ask_verb(VERB_BEGIN, path, 0); }

static int ask_without_end(void)
{
    request.verb = VERB_BEGIN;
    memset(request.path, 'x', sizeof request.path);
    return send_request();
}

/* More outputs at once than any command writes. */
static int ask_many(void)
{
    int last = 0, numbers[256], count = 0;
    while (last >= 0 && count < 256) {
        last = ask(of("scene-%ld%s", count, ".png"));
        if (last >= 0) {
            numbers[count++] = answer.number;
            close(last);
        }
    }
    const int reason = errno;
    for (int i = 0; i < count; i++)
        ask_verb(VERB_ABANDON, "", numbers[i]);
    errno = reason;
    return last;
}

/* ---- sockets ---- */

static const struct sockaddr_un elsewhere = {AF_UNIX, "\0krs-escape"};

static int connect_to_unix(int file)
{
    return connect(file, (const struct sockaddr *)&elsewhere, sizeof elsewhere);
}
static long send_to_unix(int file)
{
    return sendto(file, "x", 1, MSG_DONTWAIT, (const struct sockaddr *)&elsewhere,
                  sizeof elsewhere);
}

/* ---- processes ---- */

static long end_child(long process)
{
    if (process == 0)
        _exit(0);
    if (process > 0)
        waitpid((pid_t)process, NULL, 0);
    return process;
}

static int spawn(void)
{
    pid_t     process;
    const int failed = posix_spawn(&process, "/bin/true", NULL, NULL, (char *[]){"true", NULL},
                                   environ);
    if (!failed)
        waitpid(process, NULL, 0);
    errno = failed;
    return failed ? -1 : 0;
}

/* A copy of a program in a file without a name. */
static int run_in_memory(void)
{
    static char bytes[1 << 16];
    const int   from = open("/bin/true", O_RDONLY), to = memfd_create("true", 0);
    ssize_t     length;
    while ((length = read(from, bytes, sizeof bytes)) > 0)
        if (write(to, bytes, (size_t)length) != length)
            return 0;
    return fexecve(to, (char *[]){"true", NULL}, environ);
}

static long read_parent(void)
{
    int          here;
    struct iovec to = {&here, sizeof here}, from = {(void *)&environ, sizeof here};
    return process_vm_readv(getppid(), &to, 1, &from, 1, 0);
}

/* System calls by the numbers of 32-bit programs, which other filters would be for. */
static long call_by_old_numbers(void)
{
#ifdef __x86_64__
    return syscall(SYS_getpid | 0x40000000);
#else
    return kill(getpid(), SIGSYS);
#endif
}

/* ---- limits ---- */

static int take_memory(int kind, size_t bytes)
{
    enum { PIECE = 1 << 24 };
    size_t got  = 0;
    char  *last = NULL;
    while (got < bytes) {
        char *piece = mmap(NULL, PIECE, PROT_READ | PROT_WRITE, kind | MAP_ANONYMOUS, -1, 0);
        if (piece == MAP_FAILED)
            break;
        *(char **)piece = last;
        last            = piece;
        got += PIECE;
    }
    const int reason = errno;
    while (last) {
        char *before = *(char **)last;
        munmap(last, PIECE);
        last = before;
    }
    errno = reason;
    return got < bytes ? -1 : 0;
}

static int take_addresses(void)
{
    void *all = mmap(NULL, (size_t)1 << 42, PROT_READ | PROT_WRITE,
                     MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (all == MAP_FAILED)
        return -1;
    munmap(all, (size_t)1 << 42);
    return 0;
}

static int take_descriptors(void)
{
    int last = 0, highest = 0;
    while (highest < 4096 && (last = dup(2)) >= 0)
        highest = last;
    const int reason = errno;
    for (int file = connection() + 1; file <= highest; file++)
        close(file);
    errno = reason;
    return last;
}

static void *wait_for_ever(void *unused)
{
    (void)unused;
    for (;;)
        pause();
    return NULL;
}

static int take_threads(void)
{
    pthread_attr_t small;
    pthread_t      thread;
    pthread_attr_init(&small);
    pthread_attr_setstacksize(&small, 1 << 16);
    for (int i = 0; i < 4096; i++)
        if (pthread_create(&thread, &small, wait_for_ever, NULL) != 0)
            break;
    sleep(5);
    return 0;
}

static int take_files(size_t bytes)
{
    static char piece[1 << 20];
    memset(piece, 1, sizeof piece);
    for (size_t got = 0; got < bytes;) {
        const int file = memfd_create("escape", 0);
        ssize_t   put;
        while ((put = write(file, piece, sizeof piece)) > 0 && got < bytes)
            got += (size_t)put;
        if (put <= 0 && lseek(file, 0, SEEK_CUR) == 0)
            return -1;
    }
    sleep(5);
    return 0;
}

static int take_time(void)
{
    for (volatile unsigned i = 0;; i++)
        ;
    return 0;
}

/* ---- the hook ---- */

static void say(const char *name, bool through)
{
    char      line[128];
    const int length = through ? snprintf(line, sizeof line, "%s through\n", name)
                               : snprintf(line, sizeof line, "%s refused %s\n", name,
                                          strerrorname_np(errno));
    if (write(2, line, (size_t)length) != length)
        _exit(9);
}

static void try_one(const char *name, int error, long result)
{
    if (result < 0 && error != ANY && errno != error) {
        char      line[128];
        const int length = snprintf(line, sizeof line, "%s refused %s instead of %s\n", name,
                                    strerrorname_np(errno), strerrorname_np(error));
        if (write(2, line, (size_t)length) != length)
            _exit(9);
    } else
        say(name, result >= 0);
}

static void escape(const char *wanted)
{
#define ESCAPE(name, error, attempt)         \
    if (strcmp(wanted, "refused") == 0) {    \
        errno             = 0;               \
        const long result = (long)(attempt); \
        try_one(#name, error, result);       \
    }
#define DEADLY(name, attempt)       \
    if (strcmp(wanted, #name) == 0) \
        say(#name, (long)(attempt) >= 0);
#define BEYOND(name, words, attempt) \
    if (strcmp(wanted, #name) == 0)  \
        say(#name, (long)(attempt) >= 0);
#include "escapes.def"
    _exit(0);
}

static bool is_planted(const char *layer)
{
    const char *plant = getenv("PLANT");
    return plant && (strcmp(plant, layer) == 0 || strcmp(plant, "all") == 0);
}

/* Stands in the place of libseccomp's function, which is the last step into the sandbox. */
int seccomp_load(void *filter)
{
    const char *wanted  = getenv("ESCAPE");
    int (*load)(void *) = (int (*)(void *))dlsym(RTLD_NEXT, "seccomp_load");
    const int failed    = is_planted("seccomp") ? 0 : load(filter);
    if (!failed && wanted)
        escape(wanted);
    return failed;
}

/* Stands in the place of libc's function, by which Landlock is called. */
long syscall(long number, ...)
{
    static long (*call)(long, ...);
    long    given[6];
    va_list arguments;
    va_start(arguments, number);
    for (int i = 0; i < 6; i++)
        given[i] = va_arg(arguments, long);
    va_end(arguments);
    if (!call)
        call = (long (*)(long, ...))dlsym(RTLD_NEXT, "syscall");
    if (number == SYS_landlock_create_ruleset && given[0] == 0 && getenv("VERSION")) {
        const long version = atol(getenv("VERSION"));
        errno              = ENOSYS;
        return version > 0 ? version : -1;
    }
    if (number == SYS_landlock_restrict_self && is_planted("landlock"))
        return 0;
    return call(number, given[0], given[1], given[2], given[3], given[4], given[5]);
}
