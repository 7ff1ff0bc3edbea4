/*
 * exr_zip.c: the method ZIP of OpenEXR, by libdeflate.
 *
 * OpenEXRCore compresses by zlib, which takes most of the time of a file.  libdeflate gives smaller
 * streams of the same format in half of the time.
 */
#include "runtime/writer/exr_zip.h"

#include <libdeflate.h>
#include <stdlib.h>

/* Files of level 1 are 1 % larger than those of 4, in three quarters of the time. */
static const int LEVEL = 1;

static bool reserve(ExrZip *zip, size_t bytes)
{
    if (!zip->compressor)
        zip->compressor = libdeflate_alloc_compressor(LEVEL);
    if (!zip->compressor || bytes <= zip->bytes)
        return zip->compressor != NULL;
    free(zip->differences);
    free(zip->compressed);
    zip->most        = libdeflate_zlib_compress_bound(zip->compressor, bytes);
    zip->differences = malloc(bytes);
    zip->compressed  = malloc(zip->most);
    zip->bytes       = zip->differences && zip->compressed ? bytes : 0;
    return zip->bytes > 0;
}

/* Writes the bytes at even places, and behind them those at odd places, each but the first as its
   difference from the one before, plus 128 (as in ImfZip.cpp of OpenEXR, which is the reference). */
static void find_differences(const unsigned char *packed, size_t bytes, unsigned char *differences)
{
    const size_t   half = (bytes + 1) / 2;
    unsigned char *odd  = differences + half;
    differences[0]      = packed[0];
    for (size_t i = 1; i < half; i++)
        differences[i] = (unsigned char)(packed[2 * i] - packed[2 * i - 2] + 128);
    if (bytes > 1)
        odd[0] = (unsigned char)(packed[1] - packed[2 * half - 2] + 128);
    for (size_t i = 1; i < bytes - half; i++)
        odd[i] = (unsigned char)(packed[2 * i + 1] - packed[2 * i - 1] + 128);
}

exr_result_t exr_zip(ExrZip *zip, exr_encode_pipeline_t *pipeline)
{
    const size_t bytes = pipeline->packed_bytes;
    if (!reserve(zip, bytes))
        return EXR_ERR_OUT_OF_MEMORY;
    find_differences(pipeline->packed_buffer, bytes, zip->differences);
    /* Readers know a chunk that is not compressed by its size. */
    const size_t compressed = libdeflate_zlib_compress(zip->compressor, zip->differences, bytes,
                                                       zip->compressed, zip->most);
    if (compressed > 0 && compressed < bytes) {
        pipeline->compressed_buffer = zip->compressed;
        pipeline->compressed_bytes  = compressed;
    } else {
        pipeline->compressed_buffer = pipeline->packed_buffer;
        pipeline->compressed_bytes  = bytes;
    }
    return EXR_ERR_SUCCESS;
}

void exr_zip_end(ExrZip *zip, exr_encode_pipeline_t *pipeline)
{
    pipeline->compressed_buffer = NULL;
    libdeflate_free_compressor(zip->compressor);
    free(zip->differences);
    free(zip->compressed);
    *zip = (ExrZip){0};
}
