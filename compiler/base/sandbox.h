/*
 * sandbox.h: opens files below a folder, and none outside of it.
 */
#ifndef KRS_SANDBOX_H
#define KRS_SANDBOX_H

/* Opens a file for reading.  Its path is relative to the open folder `root`.  Returns -1 and sets
   errno on failure: to EXDEV where the path, or a symbolic link on it, leads out of the folder. */
int sandbox_open(int root, const char *path);
/* Returns the same for systems without openat2.  Folders are opened one by one, and symbolic links
   are not followed: they fail with EXDEV too. */
int sandbox_open_by_steps(int root, const char *path);

/* Opens a folder, as a place of which files are made (O_PATH), through no symbolic link: what is below the current
   folder is opened below it.  -1 and errno: ELOOP or ENOTDIR where a link is on the path. */
int open_folder_without_links(const char *path);
/* Returns the same for systems without openat2. */
int open_folder_by_steps(const char *path);

#endif
