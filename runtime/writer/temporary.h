/*
 * temporary.h: the file that an output is written to before it gets its name.
 *
 * It is the user's alone, and locked for as long as somebody writes to it: one that is not locked
 * has no writer any more, on whatever machine that was.
 */
#ifndef KRS_TEMPORARY_H
#define KRS_TEMPORARY_H

#include <stdbool.h>
#include <sys/types.h>

/* Creates a file in a folder, with mode 0600, opened to read and write; -1 with errno set when it
   cannot be.  *path is malloc'ed. */
int temporary_create(const char *folder, char **path);

/* The permissions that a new file gets in that folder; 0600 when that cannot be found out. */
mode_t temporary_mode(const char *folder);

/* Removes the files of this user in that folder whose writers are gone. */
void temporary_clean(const char *folder);

#endif
