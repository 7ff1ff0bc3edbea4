/*
 * folder.h: an empty folder for each test of a group, which is the current one.
 */
#ifndef SUPPORT_FOLDER_H
#define SUPPORT_FOLDER_H

#include <stddef.h>

extern char folder[];

/* For cmocka: makes the folder, and removes it with all that is in it. */
int enter_folder(void **state);
int leave_folder(void **state);

#endif
