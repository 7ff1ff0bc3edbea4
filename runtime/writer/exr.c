/*
 * exr.c: writes OpenEXR files by OpenEXRCore, the C library underneath OpenEXR.
 *
 * Its own files are never flushed to the disk and stay behind after an error, so the bytes go
 * through a callback into an OutputFile, which knows better.  A chunk is 16 lines.  The library
 * wants packed samples, so each chunk's lines are copied into a block per channel first, which
 * is where floats become halves.
 */
#include "runtime/writer/exr.h"

#include <OpenEXR/openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ZIP_LEVEL = 4 }; /* zlib's 4: within 2 % of the size of 9 for renders, four times faster */

typedef struct ExrWriter {
    const Picture *picture;
    OutputFile    *file;
    OutputError   *error;
    exr_context_t  context;
    void         **blocks; /* packed lines of each channel, in the picture's order */
} ExrWriter;

uint16_t half_from_float(float number)
{
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    uint16_t sign = (uint16_t)(bits >> 16 & 0x8000);
    uint32_t size = bits & 0x7fffffff;
    if (size > 0x7f800000)
        return sign | 0x7e00; /* NaN, quiet */
    if (size == 0x7f800000)
        return sign | 0x7c00;
    if (size >= 0x477ff000)
        return sign | 0x7bff; /* would round past 65504 */
    if (size < 0x33000001)
        return sign; /* up to half of the smallest half, 2^-25, rounds to zero */

    /* `kept` holds the result and `lost` what is cut off, as a fraction of `unit`. */
    uint32_t kept, lost, unit;
    if (size < 0x38800000) { /* the result is subnormal: the leading 1 becomes explicit */
        uint32_t shift = 126 - (size >> 23);
        uint32_t fraction = (size & 0x7fffff) | 0x800000;
        kept = fraction >> shift;
        unit = 1u << shift;
        lost = fraction & (unit - 1);
    } else {
        kept = (size - 0x38000000) >> 13;
        unit = 1u << 13;
        lost = size & (unit - 1);
    }
    if (lost > unit / 2 || (lost == unit / 2 && (kept & 1)))
        kept++;
    return (uint16_t)(sign | kept);
}

static int64_t write_callback(exr_const_context_t context, void *user, const void *bytes,
                              uint64_t length, uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    ExrWriter *writer = user;
    if (output_write(writer->file, bytes, length, offset))
        return (int64_t)length;
    fail(context, EXR_ERR_WRITE_IO, "%s", writer->error->message);
    return -1;
}

/* The library reports through results too; without this handler it would also print. */
static void ignore_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context, (void)code, (void)message;
}

/* A result of the library; a failed write has already told its own reason. */
static bool exr_try(ExrWriter *writer, exr_result_t result)
{
    if (result == EXR_ERR_SUCCESS)
        return true;
    if (result == EXR_ERR_CORRUPT_CHUNK)
        result = EXR_ERR_OUT_OF_MEMORY; /* of a writer: zlib found no memory to compress a chunk */
    if (writer->error->status == KRS_OK) {
        writer->error->status =
            result == EXR_ERR_OUT_OF_MEMORY ? KRS_OUT_OF_MEMORY : KRS_INTERNAL;
        snprintf(writer->error->message, sizeof writer->error->message,
                 "cannot make an EXR file: %s", exr_get_default_error_message(result));
    }
    return false;
}

static bool write_layout(ExrWriter *writer)
{
    const Picture *picture = writer->picture;
    exr_attr_box2i_t display = {
        .max = {.x = (int32_t)picture->width - 1, .y = (int32_t)picture->height - 1}};
    exr_attr_box2i_t data = {
        .min = {.x = (int32_t)picture->crop_x, .y = (int32_t)picture->crop_y},
        .max = {.x = (int32_t)(picture->crop_x + picture->crop_width) - 1,
                .y = (int32_t)(picture->crop_y + picture->crop_height) - 1}};
    exr_attr_v2f_t center = {.x = 0, .y = 0};
    int part;
    if (!exr_try(writer, exr_add_part(writer->context, "krs", EXR_STORAGE_SCANLINE, &part)) ||
        !exr_try(writer, exr_initialize_required_attr(
                             writer->context, 0, &display, &data, 1, &center, 1,
                             EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_ZIP)) ||
        !exr_try(writer, exr_set_zip_compression_level(writer->context, 0, ZIP_LEVEL)))
        return false;

    static const exr_pixel_type_t types[] = {[SAMPLE_HALF] = EXR_PIXEL_HALF,
                                             [SAMPLE_FLOAT] = EXR_PIXEL_FLOAT,
                                             [SAMPLE_UINT] = EXR_PIXEL_UINT};
    for (size_t i = 0; i < picture->channel_count; i++)
        if (!exr_try(writer, exr_add_channel(writer->context, 0, picture->channels[i].name,
                                             types[picture->channels[i].type],
                                             EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1)))
            return false;
    return true;
}

static bool write_matrix(ExrWriter *writer, const char *name, const PictureMatrix *matrix)
{
    exr_attr_m44f_t attribute;
    if (!matrix)
        return true;
    memcpy(attribute.m, matrix->m, sizeof attribute.m); /* both row by row */
    return exr_try(writer, exr_attr_set_m44f(writer->context, 0, name, &attribute));
}

static bool write_attributes(ExrWriter *writer)
{
    const Picture *picture = writer->picture;
    const exr_attr_chromaticities_t rec709 = {
        .red_x = 0.64f, .red_y = 0.33f, .green_x = 0.3f, .green_y = 0.6f,
        .blue_x = 0.15f, .blue_y = 0.06f, .white_x = 0.3127f, .white_y = 0.329f};
    if (!exr_try(writer, exr_attr_set_chromaticities(writer->context, 0, "chromaticities",
                                                     &rec709)) ||
        !write_matrix(writer, "worldToCamera", picture->world_to_camera) ||
        !write_matrix(writer, "worldToNDC", picture->world_to_ndc))
        return false;
    for (size_t i = 0; i < picture->text_count; i++)
        if (!exr_try(writer, exr_attr_set_string(writer->context, 0, picture->texts[i].name,
                                                 picture->texts[i].value)))
            return false;
    return true;
}

/* Lines [first, first + count) of a channel, packed as they stand in the file. */
static void pack_lines(const Picture *picture, const PictureChannel *channel, size_t first,
                       size_t count, void *block)
{
    size_t samples = count * picture->crop_width;
    size_t start = first * picture->crop_width;
    if (channel->type == SAMPLE_UINT) {
        const uint32_t *source = (const uint32_t *)channel->samples + start * channel->stride;
        uint32_t *target = block;
        for (size_t i = 0; i < samples; i++)
            target[i] = source[i * channel->stride];
        return;
    }
    const float *source = (const float *)channel->samples + start * channel->stride;
    if (channel->type == SAMPLE_HALF) {
        uint16_t *target = block;
        for (size_t i = 0; i < samples; i++)
            target[i] = half_from_float(source[i * channel->stride]);
    } else {
        float *target = block;
        for (size_t i = 0; i < samples; i++)
            target[i] = source[i * channel->stride];
    }
}

/* The library sorts channels by name; ours are found by theirs. */
static void pack_chunk(ExrWriter *writer, exr_encode_pipeline_t *pipeline)
{
    const Picture *picture = writer->picture;
    size_t first = (size_t)pipeline->chunk.start_y - picture->crop_y;
    for (int c = 0; c < pipeline->channel_count; c++) {
        exr_coding_channel_info_t *target = &pipeline->channels[c];
        size_t i = 0;
        while (strcmp(picture->channels[i].name, target->channel_name) != 0)
            i++;
        pack_lines(picture, &picture->channels[i], first, (size_t)target->height,
                   writer->blocks[i]);
        target->encode_from_ptr = writer->blocks[i];
        target->user_bytes_per_element = target->bytes_per_element;
        target->user_data_type = target->data_type;
        target->user_pixel_stride = target->bytes_per_element;
        target->user_line_stride = target->bytes_per_element * target->width;
    }
}

/* Encodes one chunk; `pipeline` keeps its buffers from chunk to chunk. */
static bool write_chunk(ExrWriter *writer, exr_encode_pipeline_t *pipeline, int y, bool first)
{
    exr_context_t context = writer->context;
    exr_chunk_info_t chunk;
    if (!exr_try(writer, exr_write_scanline_chunk_info(context, 0, y, &chunk)) ||
        !exr_try(writer, first ? exr_encoding_initialize(context, 0, &chunk, pipeline)
                               : exr_encoding_update(context, 0, &chunk, pipeline)))
        return false;
    pack_chunk(writer, pipeline);
    if (first && !exr_try(writer, exr_encoding_choose_default_routines(context, 0, pipeline)))
        return false;
    return exr_try(writer, exr_encoding_run(context, 0, pipeline));
}

static bool write_chunks(ExrWriter *writer)
{
    const Picture *picture = writer->picture;
    int32_t lines;
    if (!exr_try(writer, exr_get_scanlines_per_chunk(writer->context, 0, &lines)))
        return false;
    for (size_t i = 0; i < picture->channel_count; i++) {
        writer->blocks[i] = malloc((size_t)lines * picture->crop_width * sizeof(float));
        if (!writer->blocks[i])
            return exr_try(writer, EXR_ERR_OUT_OF_MEMORY);
    }
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    bool done = true;
    for (uint32_t y = 0; done && y < picture->crop_height; y += (uint32_t)lines)
        done = write_chunk(writer, &pipeline, (int)(picture->crop_y + y), y == 0);
    exr_encoding_destroy(writer->context, &pipeline);
    return done;
}

bool exr_write(const Picture *picture, OutputFile *file, OutputError *error)
{
    ExrWriter writer = {.picture = picture, .file = file, .error = error};
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = ignore_message;
    setup.user_data = &writer;
    setup.write_fn = write_callback;

    writer.blocks = calloc(picture->channel_count, sizeof *writer.blocks);
    if (!writer.blocks)
        return exr_try(&writer, EXR_ERR_OUT_OF_MEMORY);
    bool done = exr_try(&writer, exr_start_write(&writer.context, "picture",
                                                 EXR_WRITE_FILE_DIRECTLY, &setup));
    if (done) {
        done = write_layout(&writer) && write_attributes(&writer) &&
               exr_try(&writer, exr_write_header(writer.context)) && write_chunks(&writer);
        exr_result_t finished = exr_finish(&writer.context); /* writes the table of chunks */
        done = done && exr_try(&writer, finished);
    }
    for (size_t i = 0; i < picture->channel_count; i++)
        free(writer.blocks[i]);
    free(writer.blocks);
    return done;
}
