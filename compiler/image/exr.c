/*
 * exr.c: reads OpenEXR files with OpenEXRCore, the C library underneath OpenEXR.
 *
 * The library has memory of its own, so the arena, which may leave by longjmp, is asked for memory
 * only while no file is open: a first look finds the size, a second one reads the pixels.
 */
#include <string.h>

#include "compiler/base/srgb.h"
#include "compiler/base/exr_chunks.h"
#include "compiler/image/image.h"

typedef struct ExrReader {
    Image               *image;
    const unsigned char *bytes;
    size_t               length;
    exr_context_t        context;
    exr_attr_box2i_t     window;
    int32_t              lines;  /* of a chunk */
    float               *planes; /* those of each channel */
} ExrReader;

static int64_t read_callback(exr_const_context_t context, void *user, void *to, uint64_t length,
                             uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    const ExrReader *reader = user;
    (void)context, (void)fail;
    if (offset >= reader->length)
        return 0;
    uint64_t left = reader->length - offset, count = length < left ? length : left;
    memcpy(to, reader->bytes + offset, count);
    return (int64_t)count;
}

static int64_t size_callback(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((const ExrReader *)user)->length;
}

static bool exr_try(ExrReader *reader, exr_result_t result)
{
    return result == EXR_ERR_SUCCESS || image_fail(reader->image, exr_chunks_fault(result));
}

static bool begin(ExrReader *reader)
{
    exr_context_initializer_t options = EXR_DEFAULT_CONTEXT_INITIALIZER;
    options.user_data                 = reader;
    options.read_fn                   = read_callback;
    options.size_fn                   = size_callback;
    return exr_try(reader, exr_chunks_open(&reader->context, "texture", options));
}

/* ---- channels ---- */

/* Returns where a channel's samples go in a pixel; -1: nowhere. */
static int place_of(bool gray, const char *name)
{
    static const char *const colors[] = {"R", "G", "B", "A"}, *const grays[] = {"Y", "A"};
    for (int i = 0; i < (gray ? 2 : 4); i++)
        if (strcmp(gray ? grays[i] : colors[i], name) == 0)
            return i;
    return -1;
}

/* Finds the channels of colours, or the gray, and alpha; other channels are left out. */
static bool find_channels(ExrReader *reader)
{
    const exr_attr_chlist_t *channels;
    bool                     red = false, gray = false;
    if (!exr_try(reader, exr_get_channels(reader->context, 0, &channels)))
        return false;
    for (int i = 0; i < channels->num_channels; i++) {
        const exr_attr_chlist_entry_t *channel = &channels->entries[i];
        const char                    *name    = channel->name.str;
        red                                    = red || place_of(false, name) >= 0;
        gray                                   = gray || strcmp(name, "Y") == 0;
        if (place_of(false, name) < 0 && place_of(true, name) < 0)
            continue;
        if (channel->x_sampling != 1 || channel->y_sampling != 1)
            return image_fail(reader->image, "a channel has fewer samples than pixels");
        if (channel->pixel_type == EXR_PIXEL_UINT)
            return image_fail(reader->image, "a channel has whole numbers");
    }
    reader->image->gray = gray;
    return red || gray ||
           image_fail(reader->image, "it has neither the channels R, G, B nor the channel Y");
}

static bool read_header(ExrReader *reader)
{
    exr_storage_t storage;
    if (!exr_try(reader, exr_get_storage(reader->context, 0, &storage)) ||
        !exr_try(reader, exr_get_data_window(reader->context, 0, &reader->window)))
        return false;
    if (storage != EXR_STORAGE_SCANLINE)
        return image_fail(reader->image,
                          "it is not of scanlines: tiles and deep pixels are not read");
    const exr_attr_box2i_t *window = &reader->window;
    const int64_t           width  = (int64_t)window->max.x - window->min.x + 1;
    const int64_t           height = (int64_t)window->max.y - window->min.y + 1;
    if (width < 1 || height < 1 || width > reader->image->max_side ||
        height > reader->image->max_side)
        return image_fail(reader->image, "it has too many pixels, or none");
    reader->image->width  = (uint32_t)width;
    reader->image->height = (uint32_t)height;
    return find_channels(reader) &&
           exr_try(reader, exr_get_scanlines_per_chunk(reader->context, 0, &reader->lines));
}

/* ---- pixels ---- */

/* Finds where the lines of a chunk go, channel by channel: the library mixes channels up that it is to
   interleave, and fails where it is to leave some out.  So what is not wanted goes into a plane behind the
   others. */
static float *lines_of(const ExrReader *reader, int place)
{
    size_t plane = place >= 0 ? (size_t)place : image_channels(reader->image);
    return reader->planes + plane * (size_t)reader->lines * reader->image->width;
}

static void place_channels(void *user, exr_decode_pipeline_t *pipeline)
{
    const ExrReader *reader = user;
    for (int c = 0; c < pipeline->channel_count; c++) {
        exr_coding_channel_info_t *channel = &pipeline->channels[c];
        int                        place   = place_of(reader->image->gray, channel->channel_name);
        channel->decode_to_ptr             = (uint8_t *)lines_of(reader, place);
        channel->user_pixel_stride         = sizeof(float);
        channel->user_line_stride          = (int32_t)(sizeof(float) * reader->image->width);
        if (channel->data_type != EXR_PIXEL_UINT)
            channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = sizeof(float);
    }
}

static void take_channel(const ExrReader *reader, const exr_decode_pipeline_t *pipeline, int place)
{
    const Image   *image    = reader->image;
    const uint32_t channels = image_channels(image);
    const size_t   first    = (size_t)(pipeline->chunk.start_y - reader->window.min.y);
    const size_t   left     = image->height - first;
    const size_t   lines    = (size_t)reader->lines < left ? (size_t)reader->lines : left;
    const size_t   count    = lines * image->width;
    float         *to       = image->samples + first * image->width * channels + place;
    for (size_t i = 0; i < count; i++)
        to[i * channels] = lines_of(reader, place)[i];
}

static void take_chunk(void *user, const exr_decode_pipeline_t *pipeline)
{
    const ExrReader *reader = user;
    for (int c = 0; c < pipeline->channel_count; c++) {
        int place = place_of(reader->image->gray, pipeline->channels[c].channel_name);
        if (place >= 0)
            take_channel(reader, pipeline, place);
    }
}

static bool read_pixels(ExrReader *reader)
{
    const ExrChunks chunks = {reader->context, reader->window, place_channels, take_chunk, reader};
    return exr_try(reader, exr_chunks_read(&chunks, reader->lines));
}

/* Opens the file, once for each of the two looks. */
static bool look(ExrReader *reader, bool (*at)(ExrReader *reader))
{
    bool good = begin(reader) && at(reader);
    if (reader->context)
        exr_finish(&reader->context);
    return good;
}

static void make_linear(Image *image)
{
    const uint32_t channels = image_channels(image);
    for (size_t i = 0; i < image_pixels(image); i++)
        for (uint32_t k = 0; k + 1 < channels; k++) {
            float *sample = &image->samples[i * channels + k];
            *sample       = (float)linear_of_srgb(*sample);
        }
}

bool image_read_exr(Image *image, const unsigned char *bytes, size_t length)
{
    ExrReader reader = {.image = image, .bytes = bytes, .length = length};
    if (!look(&reader, read_header) || !image_make(image))
        return false;
    size_t plane  = (size_t)reader.lines * image->width;
    reader.planes = arena_new_array(image->arena, float, plane *(image_channels(image) + 1));
    if (!look(&reader, read_pixels))
        return false;
    if (image->space == SPACE_SRGB)
        make_linear(image);
    return true;
}
