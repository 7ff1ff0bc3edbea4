/*
 * png.c: reads PNG files with libpng, which reports errors by longjmp.
 *
 * A local variable may lose its value in the jump.  So whatever is used on both sides of a call of
 * libpng is in a PngReader.  All memory is of the arena, so nothing is left behind.
 */
#include <endian.h>
#include <png.h>
#include <setjmp.h>
#include <string.h>

#include "compiler/base/srgb.h"
#include "compiler/image/image.h"

typedef struct PngReader {
    Image               *image;
    const unsigned char *bytes;
    size_t               left;
    png_structp          png;
    png_infop            info;
    bool                 wide;     /* samples have 16 bits */
    uint32_t             channels; /* of the file: 1 to 4 */
    unsigned char       *pixels;
    float               *levels;    /* of each number that a sample may be: how bright it is */
    const char          *fault;     /* what is wrong should libpng find something, */
    bool                 cut_short; /* unless the file is */
} PngReader;

static void read_callback(png_structp png, png_bytep to, size_t length)
{
    PngReader *reader = png_get_io_ptr(png);
    if (length > reader->left)
        png_error(png, "the end");
    memcpy(to, reader->bytes, length);
    reader->bytes += length;
    reader->left -= length;
}

/* Tells whether a part, or the last of them, is behind the end: what libpng notices first depends on its version. */
static bool is_cut_short(const unsigned char *bytes, size_t length)
{
    uint32_t size;
    for (size_t at = 8; length >= 12 && at <= length - 12; at += 12 + (size_t)be32toh(size)) {
        memcpy(&size, bytes + at, sizeof size);
        if (memcmp(bytes + at + 4, "IEND", 4) == 0)
            return false;
        if (be32toh(size) > length - 12 - at)
            return true;
    }
    return true;
}

/* The words of libpng change with its version, and are of parts of the format. */
static _Noreturn void error_callback(png_structp png, png_const_charp message)
{
    PngReader *reader = png_get_error_ptr(png);
    (void)message;
    image_fail(reader->image, reader->cut_short ? "it ends too early" : reader->fault);
    png_longjmp(png, 1);
}

static void warning_callback(png_structp png, png_const_charp message) { (void)png, (void)message; }

static png_voidp allocate(png_structp png, png_alloc_size_t size)
{
    PngReader *reader = png_get_mem_ptr(png);
    return arena_alloc(reader->image->arena, 1, size);
}

static void release(png_structp png, png_voidp memory) { (void)png, (void)memory; }

/* Asks for 1 to 4 channels of 8 or 16 bits, whatever the form. */
static void ask_for_samples(PngReader *reader)
{
    png_set_expand(reader->png); /* palettes, fewer bits, a transparent colour */
    if (BYTE_ORDER == LITTLE_ENDIAN)
        png_set_swap(reader->png);
    png_set_interlace_handling(reader->png);
    png_read_update_info(reader->png, reader->info);
    reader->wide     = png_get_bit_depth(reader->png, reader->info) == 16;
    reader->channels = png_get_channels(reader->png, reader->info);
}

static bool read_header(PngReader *reader)
{
    Image *image = reader->image;
    png_set_user_limits(reader->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_read_fn(reader->png, reader, read_callback);
    reader->fault = "its header is damaged";
    png_read_info(reader->png, reader->info);
    image->width  = png_get_image_width(reader->png, reader->info);
    image->height = png_get_image_height(reader->png, reader->info);
    if (image->width > image->max_side || image->height > image->max_side)
        return image_fail(image, "it has too many pixels");
    ask_for_samples(reader);
    image->gray = reader->channels <= 2;
    return true;
}

static void read_pixels(PngReader *reader)
{
    const size_t row  = png_get_rowbytes(reader->png, reader->info);
    png_bytepp   rows = arena_new_array(reader->image->arena, png_bytep, reader->image->height);
    reader->pixels    = arena_alloc(reader->image->arena, reader->image->height, row);
    for (uint32_t y = 0; y < reader->image->height; y++)
        rows[y] = reader->pixels + y * row;
    reader->fault = "its pixels are damaged";
    png_read_image(reader->png, rows);
}

/* ---- from samples to numbers ---- */

static void make_levels(PngReader *reader)
{
    const uint32_t most = reader->wide ? UINT16_MAX : UINT8_MAX;
    reader->levels      = arena_new_array(reader->image->arena, float, most + 1);
    for (uint32_t i = 0; i <= most; i++) {
        double value      = (double)i / most;
        bool   linear     = reader->image->space == SPACE_LINEAR;
        reader->levels[i] = (float)(linear ? value : linear_of_srgb(value));
    }
}

static uint32_t sample_at(const PngReader *reader, size_t i)
{
    uint16_t wide;
    if (!reader->wide)
        return reader->pixels[i];
    memcpy(&wide, reader->pixels + 2 * i, sizeof wide);
    return wide;
}

static void convert(PngReader *reader)
{
    const Image   *image  = reader->image;
    const uint32_t colors = image->gray ? 1 : 3;
    const float    most   = reader->wide ? UINT16_MAX : UINT8_MAX;
    make_levels(reader);
    for (size_t i = 0; i < image_pixels(image); i++) {
        float       *to    = image->samples + i * image_channels(image);
        const size_t from  = i * reader->channels;
        const bool   clear = reader->channels > colors;
        const float  alpha = clear ? (float)sample_at(reader, from + colors) / most : 1;
        for (uint32_t k = 0; k < colors; k++)
            to[k] = alpha * reader->levels[sample_at(reader, from + k)];
        to[colors] = alpha;
    }
}

static bool read_file(PngReader *reader)
{
    if (setjmp(png_jmpbuf(reader->png)))
        return false;
    if (!read_header(reader) || !image_make(reader->image))
        return false;
    read_pixels(reader);
    convert(reader);
    return true;
}

bool image_read_png(Image *image, const unsigned char *bytes, size_t length)
{
    PngReader reader = {
        .image = image, .bytes = bytes, .left = length, .cut_short = is_cut_short(bytes, length)};
    reader.png  = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &reader, error_callback,
                                           warning_callback, &reader, allocate, release);
    reader.info = reader.png ? png_create_info_struct(reader.png) : NULL;
    if (!reader.info)
        return image_fail(image, "libpng cannot begin");
    return read_file(&reader);
}
