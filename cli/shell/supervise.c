/*
 * supervise.c: fork, wait, explain.
 *
 * Parent and child share one page of memory, which is how the parent knows how far the child
 * had come.  That page and the interrupt flag are the only variables of the command that are
 * global: a signal handler can reach nothing else.
 */
#include "cli/shell/supervise.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cli/sandbox/sandbox.h"
#include "cli/shell/console.h"
#include "cli/shell/crash_report.h"
#include "compiler/base/watchdog.h"
#include "compiler/base/unchecked.h"

/* Files that are removed when the command is killed; more of them are removed by the next run. */
enum { MAX_OPEN = 32 };

typedef struct Shared {
    atomic_int       stage;
    _Atomic uint64_t progress;  /* counts what is a step forward */
    atomic_int       resumable; /* whether a checkpoint is there */
    atomic_int       open;      /* files that are being written, each begun within the one before */
    char             temporary[MAX_OPEN][4096];
    char             size[256]; /* of what is compiled, in words */
    atomic_int       scarce;    /* the child crashed where an allocation had failed */
    atomic_int
         unchecked; /* calls that are running of libraries which use what they could not allocate */
    bool again;     /* a child before this one was late */
    double read_since;
    size_t read_length;
    char   read[1 << 16]; /* paths, each with a NUL */
} Shared;

static Shared               *shared;
static volatile sig_atomic_t interrupt_flag;

typedef struct StageInfo {
    const char *name, *doing;
    double      deadlines; /* how many it may take, or be without progress; 0: any time */
    bool        slow;      /* what takes long is the scene's fault, not a bug */
    bool        polite;    /* notices an interrupt by itself */
    bool        idle;      /* has nothing to do */
} StageInfo;

static const StageInfo stage_info[STAGE_COUNT] = {
    [STAGE_START]    = {"start", "starting", 0, false, false, false},
    [STAGE_COMPILE]  = {"compile", "compiling the scene", 1, true, false, false},
    [STAGE_SHADERS]  = {"shaders", "compiling the shaders", 1, true, false, false},
    [STAGE_DEVICE]   = {"device", "starting the device", 1, false, false, false},
    [STAGE_RENDER]   = {"render", "rendering", 2 * DEVICE_TIMEOUT, false, true, false},
    [STAGE_VALIDATE] = {"validate", "validating", 0, false, true, false},
    [STAGE_MESH]     = {"mesh", "making the mesh", 0, false, true, false},
    [STAGE_SLICE]    = {"slice", "making sections", 0, false, true, false},
    [STAGE_GRID]     = {"grid", "making the grid", 0, false, true, false},
    [STAGE_DENOISE]  = {"denoise", "denoising", 0, false, true, false},
    [STAGE_WRITE]    = {"write", "writing", 0, false, true, false},
    [STAGE_ANSWER]   = {"answer", "printing the answer", 0, false, false, false},
    [STAGE_WAIT]     = {"wait", "waiting for changes", 0, false, true, true},
};

/* The child. */

static void crash_for_test(RunStage stage)
{
    const char *setting = getenv("KRS_TEST_CRASH");
    size_t      length  = strlen(stage_info[stage].name);
    if (!setting || strncmp(setting, stage_info[stage].name, length) != 0)
        return;
    if (setting[length] == '\0')
        raise(SIGSEGV);
    if (strcmp(setting + length, ":hang") == 0)
        for (;;)
            pause();
    if (setting[length] == ':')
        raise(atoi(setting + length + 1));
}

void stage_note_progress(void) { atomic_fetch_add(&shared->progress, 1); }

/* Enters a stage; whoever sees the new stage sees the step, too. */
void stage_enter(RunStage stage)
{
    stage_note_progress();
    atomic_store(&shared->stage, (int)stage);
    crash_for_test(stage);
}

void stage_resumable(bool resumable) { atomic_store(&shared->resumable, resumable); }

void stage_size(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(shared->size, sizeof shared->size, format, arguments);
    va_end(arguments);
}

/* Returns the stage of the child, which may have written anything there. */
static const StageInfo *stage_now(void)
{
    const int stage = atomic_load(&shared->stage);
    return &stage_info[stage >= 0 && stage < STAGE_COUNT ? stage : STAGE_START];
}

static double time_of(const struct timespec *time)
{
    return (double)time->tv_sec + 1e-9 * (double)time->tv_nsec;
}

void stage_forget(void)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME_COARSE, &now); /* as files have it */
    shared->read_length = 0;
    shared->read_since  = time_of(&now);
}

/* Notes a file that is read.  One for which there is no room is not seen again before the scene
   itself is saved. */
void stage_read(const char *path)
{
    const size_t length = strlen(path) + 1;
    if (length > sizeof shared->read - shared->read_length)
        return;
    memcpy(shared->read + shared->read_length, path, length);
    shared->read_length += length;
}

bool stage_again(VisitRead *visit, void *user, bool *changed)
{
    struct stat about;
    *changed = false;
    for (size_t at = 0; shared->again && at < shared->read_length;
         at += strlen(shared->read + at) + 1) {
        visit(user, shared->read + at); /* first: what happens from now on is told */
        if (stat(shared->read + at, &about) == 0 && time_of(&about.st_ctim) > shared->read_since)
            *changed = true;
    }
    return shared->again;
}

const volatile sig_atomic_t *interrupted(void) { return &interrupt_flag; }

static void interrupt_child(int signal_number)
{
    (void)signal_number;
    interrupt_flag = 1;
    if (!stage_info[atomic_load(&shared->stage)].polite)
        _exit(KRS_INTERRUPTED);
}

KrsStatus write_output(const char *path, Fill *fill, const void *user)
{
    OutputError error;
    stage_enter(STAGE_WRITE);
    OutputFile *file = output_open(path, &interrupt_flag, &error);
    if (file) {
        const int before = atomic_load(&shared->open);
        if (before < MAX_OPEN)
            snprintf(shared->temporary[before], sizeof shared->temporary[before], "%s",
                     output_temporary(file));
        atomic_store(&shared->open, before + 1);
        fill(user, file, &error); /* what goes wrong stands in `error` */
        output_commit(file);
        atomic_store(&shared->open, before);
    }
    if (error.status != KRS_OK && error.status != KRS_INTERRUPTED)
        say("%s", error.message);
    else if (error.warning[0])
        say("warning: %s", error.warning);
    return error.status;
}

typedef struct Bytes {
    const char *text;
    size_t      length;
} Bytes;

static bool fill_text(const void *user, OutputFile *file, OutputError *error)
{
    const Bytes *bytes = user;
    (void)error;
    return output_append(file, bytes->text, bytes->length);
}

KrsStatus write_output_text(const char *path, const char *text, size_t length)
{
    return write_output(path, fill_text, &(Bytes){text, length});
}

/* A signal that was ignored when we were started (nohup) stays ignored. */
static bool is_ignored(int number)
{
    struct sigaction now;
    return sigaction(number, NULL, &now) == 0 && now.sa_handler == SIG_IGN;
}

static void catch_signal(int number)
{
    struct sigaction action = {.sa_handler = interrupt_child, .sa_flags = SA_RESTART};
    if (!is_ignored(number))
        sigaction(number, &action, NULL);
}

/* Lowers a limit of the process: of memory that is written to (drivers of cards reserve far more than they use), or of
   the length of files, where SIGXFSZ is ignored, so that writing fails. */
static void lower_limit(int resource, uint64_t bytes)
{
    struct rlimit limit;
    if (bytes == 0 || getrlimit(resource, &limit) != 0 || limit.rlim_cur <= bytes)
        return;
    limit.rlim_cur = bytes;
    setrlimit(resource, &limit);
}

/* Libraries in C may use what they could not allocate.  Where nothing has failed since, that has left its mark;
   where they run on for long, they crash at an address near 0. */
static void note_crash(int number, siginfo_t *info, void *context)
{
    (void)context;
    bool nothing = number == SIGSEGV && info->si_code == SEGV_MAPERR &&
                   (uintptr_t)info->si_addr < 4096;
    if (errno == ENOMEM || (nothing && unchecked_runs()))
        atomic_store(&shared->scarce, 1);
    raise(number); /* the process ends by it as if nobody had looked */
}

/* Sanitizers have handlers of their own. */
static void note_crashes(void)
{
    static const int numbers[] = {SIGSEGV, SIGBUS, SIGABRT};
    struct sigaction action    = {.sa_sigaction = note_crash,
                                  .sa_flags     = (int)(SA_RESETHAND | SA_SIGINFO)},
                     now;
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (sigaction(numbers[i], NULL, &now) == 0 && now.sa_handler == SIG_DFL)
            sigaction(numbers[i], &action, NULL);
}

static _Noreturn void run_child(Options *options, Work *work, Outputs *outputs,
                                const sigset_t *mask)
{
    if (outputs && !outputs_ask(outputs)) {
        say("no sandbox for untrusted scenes: its files cannot be closed: %s", strerror(errno));
        _exit(KRS_INTERNAL);
    }
    lower_limit(RLIMIT_DATA, options->limits.memory);
    lower_limit(RLIMIT_FSIZE, options->limits.file);
    atomic_store(&shared->unchecked, 0);
    unchecked_count_at(&shared->unchecked);
    note_crashes();
    prctl(PR_SET_PDEATHSIG, SIGTERM); /* nobody would read what we do */
    catch_signal(SIGINT);
    catch_signal(SIGTERM);
    catch_signal(SIGHUP);
    sigprocmask(SIG_SETMASK, mask, NULL);
    stage_enter(STAGE_START);
    KrsStatus status  = work(options);
    KrsStatus printed = console_finish();
    exit(status == KRS_OK ? printed : status);
}

/* The parent. */

typedef struct Watch {
    pid_t       child;
    bool        interrupted, late, over; /* why we stopped the child; over: the limit of time */
    bool        exited;                  /* the child ended by itself */
    bool        warned; /* SIGUSR1 has come: the child is stopped at a checkpoint */
    const char *excess; /* what it has too much of, for which it was stopped */
    Watchdog    watchdog;
    double      interrupted_after; /* seconds of work */
} Watch;

static const char *signal_name(int signal_number)
{
    const char *name = sigabbrev_np(signal_number);
    return name ? name : "?";
}

/* Returns the bytes that a caller leaves us, 0 when that is no less than all; drivers and the
   libraries that they use crash when they are refused memory. */
static uint64_t memory_allowed(void)
{
    const uint64_t plenty = (uint64_t)4 << 30;
    struct rlimit  limit;
    bool           limited = getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur < plenty;
    return limited ? limit.rlim_cur : 0;
}

static double seconds_of(struct timeval time)
{
    return (double)time.tv_sec + 1e-6 * (double)time.tv_usec;
}

/* Tells whether the child's processor time was used up: the system says so by SIGXCPU, or kills as well. */
static bool is_out_of_time(const Watch *watch, int signal_number)
{
    struct rlimit limit;
    struct rusage used;
    if (signal_number != SIGKILL || getrlimit(RLIMIT_CPU, &limit) != 0 ||
        limit.rlim_cur == RLIM_INFINITY || getrusage(RUSAGE_CHILDREN, &used) != 0)
        return signal_number == SIGXCPU;
    /* The system counts in ticks; the last look knows of what a killed process may not have been charged. */
    const double seconds = fmax(seconds_of(used.ru_utime) + seconds_of(used.ru_stime),
                                watch->watchdog.last.processor);
    return seconds + 1 >= (double)limit.rlim_cur;
}

/* Reports a scene that takes too long to compile: it is large, which has a cure, or this is a bug. */
static int report_late(const Options *options, const StageInfo *stage)
{
    char story[256];
    if (atomic_load(&shared->unchecked) > 0) {
        say("gave up %s after %g seconds: the search of fonts does not end, probably for want of "
            "memory",
            stage->doing, options->deadline * stage->deadlines);
        return KRS_OUT_OF_MEMORY;
    }
    if (stage->slow) {
        shared->size[sizeof shared->size - 1] = '\0';
        say("gave up %s after %g seconds: %s; --deadline SECONDS allows it longer", stage->doing,
            options->deadline * stage->deadlines, shared->size);
        return KRS_BAD_SCENE;
    }
    snprintf(story, sizeof story, "gave up %s after %g seconds without progress", stage->doing,
             options->deadline * stage->deadlines);
    return report_bug(options, story);
}

static int judge_death(const Options *options, const Watch *watch, int signal_number)
{
    char             story[256];
    const StageInfo *stage = stage_now();
    const char      *doing = stage->doing;
    if (watch->interrupted)
        return KRS_INTERRUPTED;
    if (watch->over) {
        say("stopped while %s: --limit time=%g allows no longer", doing, options->limits.time);
        return KRS_BAD_SCENE;
    }
    if (watch->excess) {
        say("stopped while %s: %s", doing, watch->excess);
        return KRS_BAD_SCENE;
    }
    if (watch->late)
        return report_late(options, stage);
    if (signal_number == SIGSYS && options->needs) {
        snprintf(story, sizeof story,
                 "stopped while %s: a system call was tried that the sandbox forbids", doing);
        return report_bug(options, story);
    }
    if (is_out_of_time(watch, signal_number)) {
        say("stopped while %s: the processor time that `ulimit -t` allows is used up", doing);
        return KRS_INTERRUPTED;
    }
    if (signal_number == SIGKILL) {
        say("killed by the system while %s, probably for want of memory", doing);
        return KRS_OUT_OF_MEMORY;
    }
    if (signal_number == SIGINT || signal_number == SIGTERM || signal_number == SIGHUP)
        return KRS_INTERRUPTED;
    uint64_t limit = options->limits.memory, allowed = limit ? limit : memory_allowed();
    if (allowed > 0) {
        say("crashed while %s (SIG%s), probably for want of memory: %s allows %llu MiB", doing,
            signal_name(signal_number), limit ? "--limit" : "`ulimit -v`",
            (unsigned long long)(allowed >> 20));
        return KRS_OUT_OF_MEMORY;
    }
    if (atomic_load(&shared->scarce)) {
        say("crashed while %s (SIG%s), for want of memory", doing, signal_name(signal_number));
        return KRS_OUT_OF_MEMORY;
    }
    snprintf(story, sizeof story, "crashed while %s (SIG%s)", doing, signal_name(signal_number));
    return report_bug(options, story);
}

/* Looks at what the child has done since the last time; returns its stage. */
static const StageInfo *observe(Watch *watch)
{
    /* The stage comes first: a new one with the steps of the old would be late. */
    const StageInfo *stage  = stage_now();
    ProcessSample    sample = {.idle     = stage->idle && !watch->interrupted,
                               .progress = atomic_load(&shared->progress)};
    watchdog_sample(watch->child, &watch->watchdog.last, &sample);
    watchdog_add(&watch->watchdog, &sample);
    if (sample.idle)
        watch->watchdog.worked = 0; /* limits hold for what comes next */
    return stage;
}

/* Ends a child that takes too long. */
static void check_time(const Options *options, Watch *watch, const StageInfo *stage)
{
    const double force = 10; /* seconds from an interrupt on: a slice and a file */
    if (watch->interrupted && watch->watchdog.worked - watch->interrupted_after > force)
        kill(watch->child, SIGKILL);
    if (watch->interrupted || watch->late || watch->over || watch->excess)
        return;
    watch->excess = options->needs ? sandbox_excess(watch->child, options->needs) : NULL;
    watch->over   = options->limits.time > 0 && watch->watchdog.worked > options->limits.time;
    watch->late   = !watch->over && stage->deadlines > 0 &&
                  watch->watchdog.fruitless > stage->deadlines * options->deadline;
    if (watch->over || watch->late || watch->excess)
        kill(watch->child, SIGKILL);
}

static void interrupt(Watch *watch, int number)
{
    if (!watch->interrupted)
        watch->interrupted_after = watch->watchdog.worked;
    watch->interrupted = true;
    kill(watch->child, number);
}

/* Stops the child and this process, until somebody continues this one.  Ctrl-Z has stopped the child already. */
static void stop_with_child(const Watch *watch)
{
    sigset_t stop;
    sigemptyset(&stop);
    sigaddset(&stop, SIGTSTP);
    kill(watch->child, SIGTSTP);
    raise(SIGTSTP);
    sigprocmask(SIG_UNBLOCK, &stop, NULL);
    sigprocmask(SIG_BLOCK, &stop, NULL);
    kill(watch->child, SIGCONT);
}

static void take_signal(Watch *watch, int number)
{
    if (number == SIGINT || number == SIGTERM || number == SIGHUP)
        interrupt(watch, number);
    if (number == SIGTSTP)
        stop_with_child(watch);
    watch->warned = watch->warned || number == SIGUSR1;
}

/* Passes signals on and watches the child's work until it has ended; returns how. */
static int wait_for_child(const Options *options, Watch *watch, const sigset_t *signals)
{
    int ended;
    while (waitpid(watch->child, &ended, WNOHANG) == 0) {
        const struct timespec pause = {.tv_nsec = 100 * 1000 * 1000};
        take_signal(watch, sigtimedwait(signals, NULL, &pause));
        if (watch->warned && !watch->interrupted && atomic_load(&shared->resumable))
            interrupt(watch, SIGTERM);
        check_time(options, watch, observe(watch));
    }
    return ended;
}

/* A signal that is ignored would still be taken once it is blocked. */
static void add_signal(sigset_t *signals, int number)
{
    if (!is_ignored(number))
        sigaddset(signals, number);
}

/* Chooses the signals that this process waits for.  SIGUSR1 is ignored by both processes (main.c),
   and yet taken here. */
static void choose_signals(sigset_t *signals)
{
    sigemptyset(signals);
    add_signal(signals, SIGINT);
    add_signal(signals, SIGTERM);
    add_signal(signals, SIGHUP);
    add_signal(signals, SIGTSTP);
    sigaddset(signals, SIGUSR1);
    sigaddset(signals, SIGCHLD);
    signal(SIGCHLD, SIG_DFL); /* ignored, children could not be waited for */
}

/* Removes what a child has left that is no output.  A child in a sandbox has made no file. */
static void remove_temporaries(const Options *options)
{
    for (int i = 0; !options->needs && i < atomic_load(&shared->open) && i < MAX_OPEN; i++)
        unlink(shared->temporary[i]);
    atomic_store(&shared->open, 0);
}

static KrsStatus say_no_process(void)
{
    say("cannot start a process: %s", strerror(errno));
    return KRS_OUT_OF_MEMORY; /* or as many processes as the user may have */
}

/* Runs one child; returns its status. */
static int run(Options *options, Work *work, const sigset_t *signals, const sigset_t *before,
               Watch *watch)
{
    Outputs *outputs = options->needs ? outputs_new(options->needs) : NULL;
    *watch           = (Watch){.child = options->needs && !outputs ? -1 : fork()};
    if (watch->child == 0)
        run_child(options, work, outputs, before);
    if (watch->child > 0 && outputs && !outputs_serve(outputs))
        kill(watch->child, SIGKILL);
    if (watch->child < 0) {
        const KrsStatus status = say_no_process();
        outputs_free(outputs);
        return status;
    }
    const int ended = wait_for_child(options, watch, signals);
    outputs_free(outputs);
    watch->exited    = WIFEXITED(ended);
    const int status = watch->exited ? WEXITSTATUS(ended)
                                     : judge_death(options, watch, WTERMSIG(ended));
    remove_temporaries(options);
    return status;
}

/* Tells whether what took too long is one text of many: the next one may be better. */
static bool runs_again(const Options *options, const Watch *watch)
{
    shared->again = options->command == COMMAND_WATCH && !watch->interrupted &&
                    (watch->over || (watch->late && stage_now()->slow)) && shared->read_length > 0;
    return shared->again;
}

int supervise(Options *options, Work *work)
{
    shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) {
        say("out of memory");
        return KRS_OUT_OF_MEMORY;
    }
    sigset_t signals, before;
    choose_signals(&signals);
    sigprocmask(SIG_BLOCK, &signals, &before);

    Watch watch;
    int   status;
    do
        status = run(options, work, &signals, &before, &watch);
    while (runs_again(options, &watch));
    const bool resumable = atomic_load(&shared->resumable) != 0;
    if (status == KRS_INTERRUPTED)
        say("%s", resumable ? "interrupted; the same command goes on from here" : "interrupted");
    if (resumable && (status == KRS_INTERRUPTED || (watch.exited && status == KRS_INTERNAL)))
        status = KRS_RESUMABLE; /* the latter: a device that is lost */
    munmap(shared, sizeof *shared);
    return status;
}
