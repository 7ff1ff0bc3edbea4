/*
 * archive.c: ZIP archives whose bytes depend on nothing but the files in them, by libzip.
 */
#include "cli/pack/archive.h"

#include <zip.h>

/* Adds a file to the archive. */
static bool add_file(zip_t *archive, const ArchiveFile *file)
{
    enum { FIRST_DAY = 1 << 5 | 1 };
    zip_source_t *source = zip_source_buffer(archive, file->bytes, file->length, 0);
    zip_int64_t number = source ? zip_file_add(archive, file->name, source, ZIP_FL_ENC_UTF_8) : -1;
    if (source && number < 0)
        zip_source_free(source);
    return number >= 0 && zip_file_set_dostime(archive, (zip_uint64_t)number, 0, FIRST_DAY, 0) == 0;
}

/* Consumes the archive, whose bytes are then in its source. */
static bool fill_archive(zip_t *archive, const ArchiveFile *files, size_t count)
{
    bool good = true;
    for (size_t i = 0; i < count && good; i++)
        good = add_file(archive, &files[i]);
    if (good && zip_close(archive) == 0)
        return true;
    zip_discard(archive);
    return false;
}

static bool pass_on(zip_source_t *source, ArchiveSink *sink, void *user)
{
    char        piece[1 << 14];
    zip_int64_t got;
    if (zip_source_open(source) != 0)
        return false;
    while ((got = zip_source_read(source, piece, sizeof piece)) > 0)
        if (!sink(user, piece, (size_t)got))
            break;
    zip_source_close(source);
    return got == 0;
}

bool archive_write(const ArchiveFile *files, size_t count, ArchiveSink *sink, void *user)
{
    zip_source_t *source = zip_source_buffer_create(NULL, 0, 0, NULL);
    if (!source)
        return false;
    zip_source_keep(source); /* archives free their source */
    zip_t     *archive = zip_open_from_source(source, ZIP_TRUNCATE, NULL);
    const bool good = archive && fill_archive(archive, files, count) && pass_on(source, sink, user);
    zip_source_free(source);
    if (!archive)
        zip_source_free(source);
    return good;
}
