/*
 * paths.h: names of files.
 */
#ifndef KRS_PATHS_H
#define KRS_PATHS_H

#include <stddef.h>

/* Returns the length of a path's folder with its last slash, in bytes. */
size_t path_folder_length(const char *path);
/* Removes "." and "name/.." from a path, in place: a file must have one name only, since it is known by its path. */
void path_simplify(char *path);
/* Returns the path of a file from the folder of another, `from`, for free().  Both are simplified.
   NULL: one begins at the root of all files and the other does not, or memory ran out. */
char *path_relative(const char *from, const char *path);

#endif
