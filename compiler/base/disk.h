/*
 * disk.h: files of the system, where it has some.
 */
#ifndef KRS_DISK_H
#define KRS_DISK_H

#include <stdbool.h>
#include <stddef.h>

/* The content of a file. */
typedef struct Loaded {
    const char *text; /* NULL: it could not be read */
    size_t      length;
    const char *reason;  /* why it could not be read; a static text */
    bool        outside; /* the file is outside of the root */
    char       *owned;   /* to be freed when the text is no longer needed */
} Loaded;

/* The largest file that anyone takes: a picture or a font. */
enum { MAX_FILE_BYTES = 64 << 20 };

/* Reads a file.  Of one longer than MAX_FILE_BYTES one byte more than that is read: `length` then shows
   that it is too long. */
Loaded disk_read(const char *path);
/* Returns the same for an open file, which is closed. */
Loaded disk_read_open(int file);

/* Opens a folder that nothing may be read outside of; -1: there is none. */
int  disk_open_root(const char *root);
void disk_close_root(int root);
/* Reads a file by its path from that folder. */
Loaded disk_read_below(int root, const char *path);
/* Returns the path from a root to the folder of a scene, "" or "a/b/", for free(); NULL: that is
   not in there. */
char *disk_folder_below(const char *root, const char *scene);

#endif
