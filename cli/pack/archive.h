/*
 * archive.h: ZIP archives whose bytes depend on nothing but the files in them.
 */
#ifndef KRS_ARCHIVE_H
#define KRS_ARCHIVE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct ArchiveFile {
    const char *name;
    const char *bytes;
    size_t      length;
} ArchiveFile;

/* Takes the next bytes of an archive; false: it wants no more. */
typedef bool ArchiveSink(void *user, const void *bytes, size_t count);

/* Writes an archive of files in this order, each of the earliest time that there is.  False: the sink failed, or
   memory has run out. */
bool archive_write(const ArchiveFile *files, size_t count, ArchiveSink *sink, void *user);

#endif
