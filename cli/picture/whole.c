/*
 * whole.c: whether a file is a picture to its end.
 */
#include "cli/picture/whole.h"

#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/picture/picture.h"
#include "compiler/base/exr_chunks.h"

/* A PNG ends with an empty chunk of its own. */
static bool is_whole_png(const char *path, off_t length)
{
    static const unsigned char begin[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    static const unsigned char end[12]  = {0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xAE, 0x42, 0x60, 0x82};
    unsigned char              first[sizeof begin], last[sizeof end];
    const int                  file  = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    const bool                 whole = file >= 0 && length >= (off_t)(sizeof begin + sizeof end) &&
                       pread(file, first, sizeof first, 0) == sizeof first &&
                       pread(file, last, sizeof last, length - (off_t)sizeof end) == sizeof last &&
                       memcmp(first, begin, sizeof begin) == 0 &&
                       memcmp(last, end, sizeof end) == 0;
    if (file >= 0)
        close(file);
    return whole;
}

/* Tells whether all chunks that the table of an EXR lists are in the file. */
static bool has_all_chunks(exr_const_context_t context, off_t length)
{
    exr_storage_t    storage;
    exr_attr_box2i_t window;
    int32_t          lines;
    if (exr_get_storage(context, 0, &storage) != EXR_ERR_SUCCESS ||
        storage != EXR_STORAGE_SCANLINE ||
        exr_get_data_window(context, 0, &window) != EXR_ERR_SUCCESS ||
        exr_get_scanlines_per_chunk(context, 0, &lines) != EXR_ERR_SUCCESS || lines < 1)
        return false;
    for (int64_t y = window.min.y; y <= window.max.y; y += lines) {
        exr_chunk_info_t chunk;
        if (exr_read_scanline_chunk_info(context, 0, (int)y, &chunk) != EXR_ERR_SUCCESS ||
            chunk.data_offset > (uint64_t)length ||
            chunk.packed_size > (uint64_t)length - chunk.data_offset)
            return false;
    }
    return true;
}

static bool is_whole_exr(const char *path, off_t length)
{
    exr_context_t context = NULL;
    const bool    opened  = exr_chunks_open(
                                &context, path,
                                (exr_context_initializer_t)EXR_DEFAULT_CONTEXT_INITIALIZER) ==
                        EXR_ERR_SUCCESS;
    const bool whole = opened && has_all_chunks(context, length);
    if (opened)
        exr_finish(&context);
    return whole;
}

bool picture_is_whole(const char *path)
{
    struct stat about;
    if (stat(path, &about) != 0 || !S_ISREG(about.st_mode))
        return false;
    return file_form(path) == FORM_EXR ? is_whole_exr(path, about.st_size)
                                       : is_whole_png(path, about.st_size);
}
