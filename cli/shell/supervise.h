/*
 * supervise.h: the work is done in a child process, so that a crash of a driver ends in a
 * sentence and an exit status instead of silence, and leaves no half-written file.
 */
#ifndef KRS_SUPERVISE_H
#define KRS_SUPERVISE_H

#include <signal.h>

#include "cli/options/options.h"
#include "runtime/writer/atomic.h"

/* The stages of the child; the parent names the one in which it died. */
typedef enum RunStage {
    STAGE_START,
    STAGE_COMPILE,
    STAGE_SHADERS,
    STAGE_DEVICE,
    STAGE_RENDER,
    STAGE_VALIDATE,
    STAGE_MESH,
    STAGE_SLICE,
    STAGE_GRID,
    STAGE_DENOISE,
    STAGE_WRITE,
    STAGE_ANSWER,
    STAGE_WAIT,
    STAGE_COUNT
} RunStage;

typedef KrsStatus Work(Options *options);

/* Runs `work` in a child and returns the exit status of the command:
     - what `work` returns;
     - 70 after a crash, or when a device makes no progress for several of options->deadline, with
       a line on standard error and a folder that keeps what is needed to see it again;
     - 1 when compiling takes longer than options->deadline, or all longer than its limit; `krs watch` says so, and
       goes on in another child, where the limit holds for each picture;
     - 71 when the system killed the child, which it does for want of memory;
     - 130 after SIGINT, SIGTERM or SIGHUP, which are passed on; 75 where a checkpoint is there.
   Times are those of work (watchdog.h): a process that is stopped, or gets no processor, is not late, and one in
   STAGE_WAIT has nothing to do.  SIGTSTP stops both processes.  SIGUSR1, by which batch systems announce the end, is
   SIGTERM as soon as there is a checkpoint; without --resume there is none, and it is ignored. */
int supervise(Options *options, Work *work);

/* The following are for the child. */

/* Tells the parent.  For the tests, the environment variable KRS_TEST_CRASH=STAGE makes the
   process crash on entering a stage (start, compile, shaders, device, render, validate, mesh,
   slice, grid, denoise, write, answer, wait); STAGE:9 sends itself that signal instead, STAGE:hang never returns. */
void stage_enter(RunStage stage);

/* Tells the parent that the work of this stage goes on: the deadline begins anew. */
void stage_note_progress(void);
/* Tells whether a checkpoint is there from which the same command goes on: then an interrupt ends it with
   status 75. */
void stage_resumable(bool resumable);
/* Tells how large what is compiled is, should it take too long: "`a.krs` has 12 bytes". */
void stage_size(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A process of `krs watch` that is late is ended, which is said, and another one takes its place
   and waits (STAGE_WAIT).  stage_read notes a file that is read, for that; stage_forget forgets all
   of them, as a reading begins. */
void stage_read(const char *path);
void stage_forget(void);
/* Tells whether this process is such another one; then `visit` is called for the files that the one
   before read, and `changed` says whether one was written since its reading began. */
typedef bool VisitRead(void *user, const char *path);
bool         stage_again(VisitRead *visit, void *user, bool *changed);

/* Is nonzero once the user has asked to stop.  In STAGE_RENDER, STAGE_VALIDATE, STAGE_MESH,
   STAGE_SLICE, STAGE_GRID, STAGE_DENOISE, STAGE_WRITE and STAGE_WAIT it is for the work to notice; in the others
   the process just ends. */
const volatile sig_atomic_t *interrupted(void);

/* Writes an output file by `fill`, in STAGE_WRITE, and says why when it cannot be.  The parent
   removes the temporary if the child does not live to do so. */
typedef bool Fill(const void *user, OutputFile *file, OutputError *error);
KrsStatus    write_output(const char *path, Fill *fill, const void *user);
/* Does the same for a text. */
KrsStatus write_output_text(const char *path, const char *text, size_t length);

#endif
