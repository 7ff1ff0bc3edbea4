/*
 * beneath.h: files within a folder, and never one outside of it.
 */
#ifndef KRS_BENEATH_H
#define KRS_BENEATH_H

/* Opens a file to be read, by a path that is relative to the open folder `root`; -1 with errno,
   which is EXDEV where the path, or a symbolic link on it, leads out of the folder. */
int open_beneath(int root, const char *path);
/* The same where the system cannot see to that: folder by folder, and no link is followed, for which
   errno is EXDEV as well. */
int open_beneath_by_steps(int root, const char *path);

#endif
