/*
 * landlock.h: Landlock, as systems know it whose headers are older (landlock(7)).
 */
#ifndef KRS_CLI_LANDLOCK_H
#define KRS_CLI_LANDLOCK_H

#include <stdbool.h>

/* Returns the version of Landlock that the system has; 0: none. */
int landlock_version(void);

/* Permits the process and its threads to read these files and folders, and nothing else that Landlock knows of.  What
   is missing is passed over.  False and errno: that was not possible. */
bool landlock_enter(const char *const *readable, unsigned count);

#endif
