/*
 * atomic.h: an output file appears whole or not at all.
 *
 * What is written goes to a temporary file in the folder of the target; committing flushes it
 * to the disk and renames it over the target, so a reader sees the old file or the new one and
 * nothing between.  Whatever goes wrong before, the target stays as it was.  A file that takes the
 * place of another keeps its owner and permissions; until then it is the user's alone.  A symbolic
 * link is followed, also one that leads to nothing yet.  A target that
 * cannot be renamed over (a pipe, a terminal, /dev/full) is written in one go when committing.
 */
#ifndef KRS_ATOMIC_H
#define KRS_ATOMIC_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "compiler/krs.h"

/* One line for the user: "cannot create `a/b.exr`: No such file or directory". */
typedef struct OutputError {
    KrsStatus status; /* KRS_OK as long as nothing has gone wrong */
    char      message[1024];
    char      warning[1024]; /* the file is there, but: empty when there is nothing to say */
} OutputError;

typedef struct OutputFile OutputFile;

/* Starts the file that shall be called `path`.  NULL, and words in *error, when it cannot be
   created (KRS_CANNOT_CREATE) or there is no memory.  When *cancelled becomes nonzero, writing
   stops with KRS_INTERRUPTED; `cancelled` may be NULL.  `error` must live as long as the file
   and is where its later mistakes go too. */
OutputFile *output_open(const char *path, const volatile sig_atomic_t *cancelled,
                        OutputError *error);

/* The name of the temporary file, for whoever cleans up should the process be killed. */
const char *output_temporary(const OutputFile *file);

/* Puts bytes at an offset; a file may be written in any order.  After the first mistake nothing
   more is written and every call returns false. */
bool output_write(OutputFile *file, const void *bytes, size_t length, uint64_t offset);
/* Puts bytes behind the last ones. */
bool output_append(OutputFile *file, const void *bytes, size_t length);

/* Flush, rename, flush the folder; returns error->status.  The file is gone after either of
   these two, and so is the temporary. */
KrsStatus output_commit(OutputFile *file);
void      output_abandon(OutputFile *file);

/* A whole text at once. */
KrsStatus output_text(const char *path, const char *text, size_t length,
                      const volatile sig_atomic_t *cancelled, OutputError *error);

/* Whether output_open would be refused now: asked before hours of work.  Removes on the way what
   killed writers have left in that folder. */
KrsStatus output_check(const char *path, OutputError *error);

/* Whether two paths lead to the same file, which need not exist. */
bool output_is_same(const char *a, const char *b);

#endif
