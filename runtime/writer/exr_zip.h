/*
 * exr_zip.h: compresses chunks of OpenEXR files by libdeflate.
 */
#ifndef KRS_EXR_ZIP_H
#define KRS_EXR_ZIP_H

#include <OpenEXR/openexr.h>
#include <stdbool.h>

/* The memory of a thread for it, kept from chunk to chunk; zero to begin with. */
typedef struct ExrZip {
    struct libdeflate_compressor *compressor;
    unsigned char                *differences, *compressed;
    size_t                        bytes, most; /* that they have room for */
} ExrZip;

/* Compresses what `pipeline` has packed, as the method ZIP of OpenEXR has it.  The buffer that the
   pipeline then has is of `zip`.  Chunks that do not become smaller stay as they are. */
exr_result_t exr_zip(ExrZip *zip, exr_encode_pipeline_t *pipeline);

/* Takes the buffer back from the pipeline, and frees all. */
void exr_zip_end(ExrZip *zip, exr_encode_pipeline_t *pipeline);

#endif
