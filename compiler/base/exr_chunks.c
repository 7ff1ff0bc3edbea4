/*
 * exr_chunks.c: reads the chunks of scanlines of an OpenEXR file.
 */
#include "compiler/base/exr_chunks.h"

#include <stdbool.h>

/* Ignores messages: errors are also results. */
static void ignore_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context, (void)code, (void)message;
}

exr_result_t exr_chunks_open(exr_context_t *context, const char *name,
                             exr_context_initializer_t setup)
{
    setup.error_handler_fn = ignore_message;
    *context               = NULL;
    return exr_start_read(context, name, &setup);
}

static exr_result_t read_chunk(const ExrChunks *chunks, int y, exr_decode_pipeline_t *pipeline)
{
    exr_chunk_info_t chunk;
    const bool       first  = y == chunks->window.min.y;
    exr_result_t     result = exr_read_scanline_chunk_info(chunks->context, 0, y, &chunk);
    if (result == EXR_ERR_SUCCESS)
        result = first ? exr_decoding_initialize(chunks->context, 0, &chunk, pipeline)
                       : exr_decoding_update(chunks->context, 0, &chunk, pipeline);
    if (result != EXR_ERR_SUCCESS)
        return result;
    chunks->place(chunks->user, pipeline);
    if (first)
        result = exr_decoding_choose_default_routines(chunks->context, 0, pipeline);
    if (result == EXR_ERR_SUCCESS)
        result = exr_decoding_run(chunks->context, 0, pipeline);
    if (result == EXR_ERR_SUCCESS)
        chunks->take(chunks->user, pipeline);
    return result;
}

const char *exr_chunks_fault(exr_result_t result)
{
    switch (result) {
    case EXR_ERR_OUT_OF_MEMORY: return "there is not enough memory for it";
    case EXR_ERR_READ_IO: return "it ends too early";
    case EXR_ERR_FEATURE_NOT_IMPLEMENTED: return "its compression is not known";
    case EXR_ERR_BAD_CHUNK_LEADER:
    case EXR_ERR_CORRUPT_CHUNK:
    case EXR_ERR_INCORRECT_CHUNK:
    case EXR_ERR_INVALID_SAMPLE_DATA: return "its pixels are damaged";
    case EXR_ERR_FILE_ACCESS: return "it cannot be opened";
    default: return "its header is damaged";
    }
}

exr_result_t exr_chunks_read(const ExrChunks *chunks, int32_t lines)
{
    exr_decode_pipeline_t pipeline = {0}; /* what its initializer says, in all versions */
    exr_result_t          result   = EXR_ERR_SUCCESS;
    for (int64_t y = chunks->window.min.y; y <= chunks->window.max.y && result == EXR_ERR_SUCCESS;
         y += lines)
        result = read_chunk(chunks, (int)y, &pipeline);
    exr_decoding_destroy(chunks->context, &pipeline);
    return result;
}
