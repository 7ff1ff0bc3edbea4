/*
 * sandbox.h: a process that reads a stranger's scene can do little else.
 *
 * The child of supervise.h enters it before it reads anything (sandbox_enter).  From then on it
 *     - opens files for reading alone, in the folder of its scene and where libraries lie (Landlock, places.def);
 *     - opens no file for writing: it asks its parent, which makes outputs of the names that the command line permits,
 *       hands them over as open descriptors, and puts them in place (outputs.c);
 *     - makes the system calls of calls.def (seccomp): no network, no programs, no processes, no look into others;
 *     - has limits of memory, of the size of a file and of open files; those of time, of threads and of memory in files
 *       without names are for the parent to watch (sandbox_excess).
 */
#ifndef KRS_CLI_SANDBOX_H
#define KRS_CLI_SANDBOX_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

#include "compiler/base/arena.h"

/* Names that an output may have: those in `folder` that begin with `name` and have an ending of endings.def, or `name`
   alone.  "" is the current folder. */
typedef struct OutputRule {
    const char *folder, *name;
    bool        whole;  /* no other name than `name` */
    bool        digits; /* a number follows */
    bool        code;   /* endings of code are permitted */
} OutputRule;

/* What a command needs, as its command line says. */
typedef struct SandboxNeeds {
    struct {
        const char **items;
        size_t       count, capacity;
    } readable; /* files and folders */
    struct {
        OutputRule *items;
        size_t      count, capacity;
    } outputs;
    uint64_t memory, file; /* bytes; 0: no limit */
} SandboxNeeds;

/* Tells why this system has no sandbox; NULL: it has. */
const char *sandbox_missing(void);

/* The parent. */

typedef struct Outputs Outputs;

/* Makes the connection by which a child asks for outputs; NULL: it cannot. */
Outputs *outputs_new(const SandboxNeeds *needs);
/* Answers, in a thread of its own, until the child has ended; called once it was forked. */
bool outputs_serve(Outputs *outputs);
/* Waits for that.  What was not put in place is removed. */
void outputs_free(Outputs *outputs);

/* Tells of which of its limits a child has more: "more than 64 threads"; NULL: of none. */
const char *sandbox_excess(pid_t child, const SandboxNeeds *needs);

/* The child. */

/* Makes this process the one that asks, and closes all files but the standard streams and the connection to the parent. */
bool outputs_ask(Outputs *outputs);

/* Takes all rights away that are not listed.  False, with one line: that was not possible.  The process has one thread. */
bool sandbox_enter(const SandboxNeeds *needs, char why[256]);

#endif
