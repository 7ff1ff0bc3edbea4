/*
 * exr_chunks.h: reads the chunks of scanlines of an OpenEXR file, one after the other, with
 * OpenEXRCore.  Files come from anywhere: the library checks what it decodes, and says nothing.
 */
#ifndef KRS_EXR_CHUNKS_H
#define KRS_EXR_CHUNKS_H

#include <OpenEXR/openexr.h>

typedef struct ExrChunks {
    exr_context_t    context;
    exr_attr_box2i_t window; /* of the data */
    /* Says for each channel of a chunk where its lines go; then takes them from there. */
    void (*place)(void *user, exr_decode_pipeline_t *pipeline);
    void (*take)(void *user, const exr_decode_pipeline_t *pipeline);
    void *user;
} ExrChunks;

/* Opens a file for reading, from a stream if the setup has one. */
exr_result_t exr_chunks_open(exr_context_t *context, const char *name,
                             exr_context_initializer_t setup);
/* Returns what is wrong with a file, in our words: those of the library change with its version. */
const char *exr_chunks_fault(exr_result_t result);
/* Reads all chunks, of `lines` lines each but the last. */
exr_result_t exr_chunks_read(const ExrChunks *chunks, int32_t lines);

#endif
