/*
 * text_file.h: reads and writes whole files.
 */
#ifndef KRS_TEXT_FILE_H
#define KRS_TEXT_FILE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct Bytes {
    char  *text;
    size_t length;
} Bytes;

/* Reads a regular file: a pipe may never end.  The caller frees the text, which is NULL before, whatever is
   returned. */
bool text_file_read(const char *path, Bytes *bytes);
/* A new file, or one in place of an old one, appears whole or not at all (runtime/writer/atomic.h). */
bool text_file_write(const char *path, const Bytes *bytes);

#endif
