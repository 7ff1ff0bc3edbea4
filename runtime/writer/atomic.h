/*
 * atomic.h: an output file appears whole or not at all.
 *
 * Output goes to a temporary file in the folder of the target.  Committing flushes it to the disk
 * and renames it over the target.  So a reader sees the old file or the new one, never a mixture.
 * If anything fails before, the target stays as it was.
 *
 * Until it is renamed the file is readable by the user alone; then it takes over owner and
 * permissions of the file that it replaces.  Symbolic links are followed, also those to a file that
 * does not exist yet.  A target that cannot be renamed over (a pipe, a terminal, /dev/full, standard output) is
 * written when committing.
 */
#ifndef KRS_ATOMIC_H
#define KRS_ATOMIC_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "krs/krs.h"

/* The path of standard output: what is written goes where other output of the process goes. */
#define OUTPUT_STANDARD "/dev/stdout"

/* One line for the user, such as "cannot create `a/b.exr`: No such file or directory". */
typedef struct OutputError {
    KrsStatus status; /* KRS_OK as long as nothing has gone wrong */
    char      message[1024];
    char      warning[1024]; /* what failed after the file was in place; may be empty */
} OutputError;

typedef struct OutputFile OutputFile;

/* Starts a file that will be called `path`.  NULL, with the reason in *error, when it cannot be
   created (KRS_CANNOT_CREATE) or there is no memory.  When *cancelled becomes nonzero, writing
   stops with KRS_INTERRUPTED; `cancelled` may be NULL.  Later failures go to *error, too, which
   must live as long as the file. */
OutputFile *output_open(const char *path, const volatile sig_atomic_t *cancelled,
                        OutputError *error);

/* Returns the path of the temporary file, for a caller that must remove it when the process is
   killed. */
const char *output_temporary(const OutputFile *file);

/* Writes bytes at an offset; offsets may come in any order.  After the first failure nothing more
   is written, and every call returns false. */
bool output_write(OutputFile *file, const void *bytes, size_t length, uint64_t offset);
/* Writes bytes at the end of the file. */
bool output_append(OutputFile *file, const void *bytes, size_t length);

/* The file will soon be replaced: it need not survive a power failure, and is not flushed. */
void output_is_fleeting(OutputFile *file);

/* Both end the file: they free `file`, and no temporary file remains.  output_commit flushes the
   file, renames it and flushes the folder; it returns error->status. */
KrsStatus output_commit(OutputFile *file);
void      output_abandon(OutputFile *file);

/* Writes a whole file that consists of one text. */
KrsStatus output_text(const char *path, const char *text, size_t length,
                      const volatile sig_atomic_t *cancelled, OutputError *error);

/* Forbids links from now on: outputs of this process go through no symbolic link, neither in a
   folder's place nor in the file's, and replace nothing but regular files; standard output is none
   of them.  It is for scenes of strangers, who may have put links beside them.  It holds for the
   whole process, so that no writer can forget it. */
void output_forbid_links(void);

/* A process that may write no file asks another one, which does what a verb says and returns a descriptor or -1: the child of
   the command in its sandbox (cli/sandbox).  *number is that of a file between OUTPUT_BEGIN and its end. */
typedef enum OutputVerb {
    OUTPUT_BEGIN, /* opens a temporary file */
    OUTPUT_COMMIT,
    OUTPUT_COMMIT_FLEETING,
    OUTPUT_ABANDON,
    OUTPUT_CHECK,
    OUTPUT_FOLDER,
    OUTPUT_READ,
    OUTPUT_REMOVE
} OutputVerb;
typedef int OutputAsk(OutputVerb verb, const char *path, int *number, OutputError *error);

/* Asks for outputs from now on, except for standard output; set once, when the process begins. */
void output_ask(OutputAsk *ask);

/* Returns the descriptor that the temporary file is written by. */
int output_descriptor(const OutputFile *file);

/* Opens an output of before for reading, by the same rules; -1 and errno. */
int output_read(const char *path);
/* Removes one; 0, or -1 and errno. */
int output_remove(const char *path);

/* Makes a folder if it is missing, but not the folders above it, by the same rules. */
KrsStatus output_make_folder(const char *path, OutputError *error);

/* Checks whether a file can be created, before hours of work are spent on it.  Also removes the
   temporary files that killed processes have left in that folder. */
KrsStatus output_check(const char *path, OutputError *error);

/* Tells whether two paths lead to the same file, which need not exist. */
bool output_is_same(const char *a, const char *b);

#endif
