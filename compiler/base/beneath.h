/*
 * beneath.h: opens files below a folder, and none outside of it.
 */
#ifndef KRS_BENEATH_H
#define KRS_BENEATH_H

/* Opens a file for reading.  Its path is relative to the open folder `root`.  Returns -1 and sets
   errno on failure: to EXDEV where the path, or a symbolic link on it, leads out of the folder. */
int open_beneath(int root, const char *path);
/* The same for systems without openat2.  Folders are opened one by one, and symbolic links are not
   followed: they fail with EXDEV too. */
int open_beneath_by_steps(int root, const char *path);

#endif
