/*
 * any_exr.c: reads all channels of an OpenEXR file.
 *
 * Files come from anywhere: the library checks what it decodes, sizes are checked here.
 */
#include "cli/denoise/any_exr.h"

#include <stdlib.h>
#include <string.h>

#include "cli/shell/console.h"
#include "compiler/base/exr_chunks.h"

enum { MAX_PIXELS = 1 << 28, ADDED = 3 };

/* The chunk that is read: where its first pixel is in the picture. */
typedef struct Reading {
    AnyExr *exr;
    bool    tiled;
    int32_t x, y;
} Reading;

static KrsStatus say_fault(const AnyExr *exr, exr_result_t result)
{
    say("cannot read `%s`: %s", exr->path, exr_chunks_fault(result));
    return result == EXR_ERR_OUT_OF_MEMORY ? KRS_OUT_OF_MEMORY : KRS_IO_ERROR;
}

static KrsStatus say_unusable(const AnyExr *exr, const char *what)
{
    say("cannot denoise `%s`: %s", exr->path, what);
    return KRS_IO_ERROR;
}

/* ---- header ---- */

static KrsStatus read_windows(AnyExr *exr, bool *tiled)
{
    exr_storage_t storage;
    int           parts = 0;
    if (exr_get_count(exr->context, &parts) != EXR_ERR_SUCCESS || parts != 1)
        return say_unusable(exr,
                            "it has several parts, which `exrmultipart -separate` makes files of");
    if (exr_get_storage(exr->context, 0, &storage) != EXR_ERR_SUCCESS ||
        (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED))
        return say_unusable(exr, "its pixels are deep, and have no single colour");
    if (exr_get_data_window(exr->context, 0, &exr->data) != EXR_ERR_SUCCESS ||
        exr_get_display_window(exr->context, 0, &exr->display) != EXR_ERR_SUCCESS)
        return say_unusable(exr, "its windows are missing");
    const int64_t width  = (int64_t)exr->data.max.x - exr->data.min.x + 1;
    const int64_t height = (int64_t)exr->data.max.y - exr->data.min.y + 1;
    if (width < 1 || height < 1 || width > MAX_PIXELS || height > MAX_PIXELS / width)
        return say_unusable(exr, "it has no pixels, or more than 268435456");
    exr->width  = (size_t)width;
    exr->height = (size_t)height;
    *tiled      = storage == EXR_STORAGE_TILED;
    return KRS_OK;
}

static KrsStatus read_channels(const Options *options, AnyExr *exr)
{
    static const SampleType  types[] = {[EXR_PIXEL_UINT]  = SAMPLE_UINT,
                                        [EXR_PIXEL_HALF]  = SAMPLE_HALF,
                                        [EXR_PIXEL_FLOAT] = SAMPLE_FLOAT};
    const exr_attr_chlist_t *list;
    if (exr_get_channels(exr->context, 0, &list) != EXR_ERR_SUCCESS || list->num_channels < 1)
        return say_unusable(exr, "it has no channels");
    const size_t room = (size_t)list->num_channels + ADDED;
    exr->channels     = arena_new_array(options->arena, PictureChannel, room);
    exr->planes       = arena_new_array(options->arena, float *, room);
    for (int i = 0; i < list->num_channels; i++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[i];
        if (entry->x_sampling != 1 || entry->y_sampling != 1)
            return say_unusable(exr, "channels have a number for several pixels");
        float *plane = calloc(exr->width * exr->height, sizeof *plane);
        if (!plane)
            return say_status(KRS_OUT_OF_MEMORY, exr->path);
        exr->planes[exr->count]     = plane;
        exr->channels[exr->count++] = (PictureChannel){
            .name    = arena_copy_text(options->arena, entry->name.str, (size_t)entry->name.length),
            .type    = types[entry->pixel_type],
            .samples = plane,
            .stride  = 1};
    }
    return KRS_OK;
}

/* ---- pixels ---- */

static float *plane_of(const AnyExr *exr, const char *name)
{
    size_t i = 0;
    while (strcmp(exr->channels[i].name, name) != 0)
        i++;
    return exr->planes[i];
}

/* Says that the lines of a chunk go to their places. */
static void place_lines(void *user, exr_decode_pipeline_t *pipeline)
{
    const Reading *r     = user;
    const AnyExr  *exr   = r->exr;
    const int32_t  y     = r->tiled ? r->y : pipeline->chunk.start_y - exr->data.min.y;
    const size_t   first = (size_t)y * exr->width + (size_t)r->x;
    for (int c = 0; c < pipeline->channel_count; c++) {
        exr_coding_channel_info_t *channel = &pipeline->channels[c];
        channel->decode_to_ptr          = (uint8_t *)(plane_of(exr, channel->channel_name) + first);
        channel->user_bytes_per_element = 4;
        channel->user_data_type         = channel->data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT
                                                                               : EXR_PIXEL_FLOAT;
        channel->user_pixel_stride      = 4;
        channel->user_line_stride       = (int32_t)(4 * exr->width);
    }
}

static void take_nothing(void *user, const exr_decode_pipeline_t *pipeline)
{
    (void)user, (void)pipeline;
}

static exr_result_t read_tile(Reading *r, int32_t column, int32_t row)
{
    exr_decode_pipeline_t pipeline = {0}; /* what its initializer says, in all versions */
    exr_chunk_info_t      chunk;
    exr_const_context_t   context = r->exr->context;
    exr_result_t          result  = exr_read_tile_chunk_info(context, 0, column, row, 0, 0, &chunk);
    if (result == EXR_ERR_SUCCESS)
        result = exr_decoding_initialize(context, 0, &chunk, &pipeline);
    if (result == EXR_ERR_SUCCESS) {
        place_lines(r, &pipeline);
        result = exr_decoding_choose_default_routines(context, 0, &pipeline);
    }
    if (result == EXR_ERR_SUCCESS)
        result = exr_decoding_run(context, 0, &pipeline);
    exr_decoding_destroy(context, &pipeline);
    return result;
}

/* Reads the tiles of the finest level. */
static exr_result_t read_tiles(Reading *r)
{
    int32_t      width = 0, height = 0;
    exr_result_t result = exr_get_tile_sizes(r->exr->context, 0, 0, 0, &width, &height);
    if (result == EXR_ERR_SUCCESS && (width < 1 || height < 1))
        result = EXR_ERR_INVALID_ATTR;
    for (int64_t y = 0; result == EXR_ERR_SUCCESS && y < (int64_t)r->exr->height; y += height)
        for (int64_t x = 0; result == EXR_ERR_SUCCESS && x < (int64_t)r->exr->width; x += width) {
            r->x   = (int32_t)x;
            r->y   = (int32_t)y;
            result = read_tile(r, (int32_t)(x / width), (int32_t)(y / height));
        }
    return result;
}

static exr_result_t read_lines(Reading *r)
{
    const ExrChunks chunks = {r->exr->context, r->exr->data, place_lines, take_nothing, r};
    int32_t         lines  = 0;
    exr_result_t    result = exr_get_scanlines_per_chunk(r->exr->context, 0, &lines);
    return result == EXR_ERR_SUCCESS ? exr_chunks_read(&chunks, lines) : result;
}

KrsStatus any_exr_read(const Options *options, const char *path, AnyExr *exr)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    Reading                   r     = {.exr = exr};
    *exr                            = (AnyExr){.path = path};
    exr_result_t result             = exr_chunks_open(&exr->context, path, setup);
    if (result != EXR_ERR_SUCCESS)
        return say_fault(exr, result);
    KrsStatus status = read_windows(exr, &r.tiled);
    if (status == KRS_OK)
        status = read_channels(options, exr);
    if (status != KRS_OK)
        return status;
    result = r.tiled ? read_tiles(&r) : read_lines(&r);
    return result == EXR_ERR_SUCCESS ? KRS_OK : say_fault(exr, result);
}

void any_exr_free(AnyExr *exr)
{
    for (size_t i = 0; i < exr->count; i++)
        free(exr->planes[i]);
    if (exr->context)
        exr_finish(&exr->context);
}
