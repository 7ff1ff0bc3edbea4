/*
 * real_path.h: where symbolic links lead.
 */
#ifndef KRS_REAL_PATH_H
#define KRS_REAL_PATH_H

/* Returns the folder of a path, "." without one, for free(); NULL: without memory. */
char *path_folder(const char *path);
/* Returns the real path of a file, which need not exist, with all links followed, for free(); NULL
   with errno set. */
char *real_path(const char *path);

#endif
