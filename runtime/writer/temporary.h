/*
 * temporary.h: the file that an output is written to before it gets its name.
 *
 * It is readable by its user alone, and locked as long as a process writes to it.  One without a
 * lock has no writer any more, on whatever machine the writer ran.
 */
#ifndef KRS_TEMPORARY_H
#define KRS_TEMPORARY_H

#include <stdbool.h>
#include <sys/types.h>

/* Creates a file in a folder, with mode 0600, opened to read and write; -1 with errno set when it
   cannot be.  *path is malloc'ed. */
int temporary_create(const char *folder, char **path);

/* Returns the permissions that a new file gets in that folder; 0600 when they cannot be found out. */
mode_t temporary_mode(const char *folder);

/* Removes this user's temporary files in that folder whose writers have ended. */
void temporary_clean(const char *folder);

#endif
