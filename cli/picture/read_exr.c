/*
 * read_exr.c: reads channels of scanline EXR files, as another renderer has named them.
 *
 * Files come from anywhere.  The library checks what it decodes; the sizes are checked here.
 */
#include "cli/picture/read_exr.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/shell/console.h"
#include "compiler/base/exr_chunks.h"

enum { MAX_WANTED = 4 };

/* A picture that is being read: `wanted` letters name channels, whose numbers go to `values`. */
typedef struct Reading {
    const char      *path;
    const char      *wanted; /* "Z" or "RGBA"; each stands alone, or behind a dot */
    size_t           count;  /* of letters */
    uint32_t         width, height;
    float           *values; /* `count` for each pixel of the display window */
    exr_context_t    context;
    exr_attr_box2i_t data, display;
    bool             found[MAX_WANTED];
    float           *lines[MAX_WANTED]; /* of a chunk */
} Reading;

static KrsStatus say_result(const Reading *r, exr_result_t result)
{
    say("cannot read `%s`: %s", r->path, exr_chunks_fault(result));
    return result == EXR_ERR_OUT_OF_MEMORY ? KRS_OUT_OF_MEMORY : KRS_IO_ERROR;
}

/* Returns the number of the letter that a channel has: "Z", "depth.Z"; the count of letters: none. */
static size_t letter_of(const Reading *r, const char *channel)
{
    const char *dot  = strrchr(channel, '.');
    const char *name = dot ? dot + 1 : channel;
    size_t      i    = 0;
    while (i < r->count && !(name[0] == r->wanted[i] && name[1] == '\0'))
        i++;
    return i;
}

/* Chooses one of several channels with a letter: the one without a layer, else the first. */
static void choose_channels(const Reading *r, const exr_decode_pipeline_t *pipeline,
                            int chosen[MAX_WANTED])
{
    for (size_t i = 0; i < r->count; i++)
        chosen[i] = -1;
    for (int c = 0; c < pipeline->channel_count; c++) {
        const char *name   = pipeline->channels[c].channel_name;
        size_t      letter = letter_of(r, name);
        if (letter < r->count && pipeline->channels[c].data_type != EXR_PIXEL_UINT &&
            (chosen[letter] < 0 || name[1] == '\0'))
            chosen[letter] = c;
    }
}

/* Tells the library where the lines of a chunk go; channels that nobody wants go nowhere. */
static void aim_channels(void *user, exr_decode_pipeline_t *pipeline)
{
    Reading *r = user;
    int      chosen[MAX_WANTED];
    choose_channels(r, pipeline, chosen);
    for (int c = 0; c < pipeline->channel_count; c++)
        pipeline->channels[c].decode_to_ptr = NULL;
    for (size_t i = 0; i < r->count; i++) {
        r->found[i] = chosen[i] >= 0;
        if (!r->found[i])
            continue;
        exr_coding_channel_info_t *channel = &pipeline->channels[chosen[i]];
        channel->decode_to_ptr             = (uint8_t *)r->lines[i];
        channel->user_bytes_per_element    = 4;
        channel->user_data_type            = EXR_PIXEL_FLOAT;
        channel->user_pixel_stride         = 4;
        channel->user_line_stride          = 4 * channel->width;
    }
}

/* Copies a chunk to the display window. */
static void take_lines(void *user, const exr_decode_pipeline_t *pipeline)
{
    Reading  *r     = user;
    const int width = r->data.max.x - r->data.min.x + 1, y = pipeline->chunk.start_y;
    for (int line = 0; line < pipeline->chunk.height; line++)
        for (int column = 0; column < width; column++) {
            int64_t x   = (int64_t)r->data.min.x + column - r->display.min.x;
            int64_t row = (int64_t)y + line - r->display.min.y;
            if (x < 0 || row < 0 || x >= r->width || row >= r->height)
                continue;
            float *to = &r->values[((size_t)row * r->width + (size_t)x) * r->count];
            for (size_t i = 0; i < r->count; i++)
                if (r->found[i])
                    to[i] = r->lines[i][(size_t)line * (size_t)width + (size_t)column];
                else if (r->wanted[i] == 'A')
                    to[i] = 1;
        }
}

static KrsStatus read_chunks(Reading *r)
{
    const ExrChunks chunks = {r->context, r->data, aim_channels, take_lines, r};
    const size_t    width  = (size_t)(r->data.max.x - r->data.min.x) + 1;
    int32_t         lines  = 0;
    exr_result_t    result = exr_get_scanlines_per_chunk(r->context, 0, &lines);
    if (result != EXR_ERR_SUCCESS)
        return say_result(r, result);
    for (size_t i = 0; i < r->count; i++)
        if (!(r->lines[i] = calloc(width * (size_t)lines, sizeof(float))))
            return say_status(KRS_OUT_OF_MEMORY, r->path);
    result = exr_chunks_read(&chunks, lines);
    return result == EXR_ERR_SUCCESS ? KRS_OK : say_result(r, result);
}

static KrsStatus say_unusable(const Reading *r, const char *what)
{
    say("cannot use `%s`: %s", r->path, what);
    return KRS_IO_ERROR;
}

/* Reads the windows, and makes room for the values, each `otherwise`. */
static KrsStatus check_layout(const Options *options, Reading *r, float otherwise)
{
    const size_t  numbers = (size_t)r->width * r->height * r->count;
    exr_storage_t storage;
    if (exr_get_storage(r->context, 0, &storage) != EXR_ERR_SUCCESS ||
        storage != EXR_STORAGE_SCANLINE)
        return say_unusable(r, "it is not in scanlines, as `exrmakescanline` or `oiiotool "
                               "--scanline` write it");
    if (exr_get_data_window(r->context, 0, &r->data) != EXR_ERR_SUCCESS ||
        exr_get_display_window(r->context, 0, &r->display) != EXR_ERR_SUCCESS)
        return say_unusable(r, "its windows are missing");
    int64_t width  = (int64_t)r->display.max.x - r->display.min.x + 1;
    int64_t height = (int64_t)r->display.max.y - r->display.min.y + 1;
    if ((int64_t)r->data.max.x - r->data.min.x >= 4 * KRS_MAX_SIDE)
        return say_unusable(r, "its lines are too long");
    if (width != r->width || height != r->height)
        return say_usage(options, "`%s` has %lldx%lld pixels, and the picture %ux%u: give --size",
                         r->path, (long long)width, (long long)height, r->width, r->height);
    if (!(r->values = malloc(numbers * sizeof(float))))
        return say_status(KRS_OUT_OF_MEMORY, r->path);
    for (size_t i = 0; i < numbers; i++)
        r->values[i] = otherwise;
    return KRS_OK;
}

static KrsStatus read_picture(const Options *options, Reading *r, float otherwise)
{
    exr_context_initializer_t setup  = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_result_t              result = exr_chunks_open(&r->context, r->path, setup);
    if (result != EXR_ERR_SUCCESS)
        return say_result(r, result);
    KrsStatus status = check_layout(options, r, otherwise);
    if (status == KRS_OK)
        status = read_chunks(r);
    exr_finish(&r->context);
    for (size_t i = 0; i < r->count; i++)
        free(r->lines[i]);
    for (size_t i = 0; i < r->count && status == KRS_OK; i++)
        if (!r->found[i] && r->wanted[i] != 'A')
            status = say_unusable(r, r->count == 1 ? "it has no channel Z"
                                                   : "it has not all of the channels R, G, B");
    if (status != KRS_OK) {
        free(r->values);
        r->values = NULL;
    }
    return status;
}

KrsStatus read_depth(const Options *options, const char *path, uint32_t width, uint32_t height,
                     float **depth)
{
    Reading   r      = {.path = path, .wanted = "Z", .count = 1, .width = width, .height = height};
    KrsStatus status = read_picture(options, &r, INFINITY);
    *depth           = r.values;
    return status;
}

KrsStatus read_plate(const Options *options, const char *path, uint32_t width, uint32_t height,
                     float (**plate)[4])
{
    Reading   r = {.path = path, .wanted = "RGBA", .count = 4, .width = width, .height = height};
    KrsStatus status = read_picture(options, &r, 0);
    *plate           = (float(*)[4])r.values;
    return status;
}
