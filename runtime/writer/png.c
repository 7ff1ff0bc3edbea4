/*
 * png.c: writes PNG files with libpng, which reports errors by longjmp.
 *
 * A local variable may lose its value in the jump.  So whatever is used on both sides of a call of
 * libpng is in a PngWriter or an argument.
 */
#include "runtime/writer/png.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct PngWriter {
    OutputFile  *file;
    OutputError *error;
    png_structp  png;
    png_infop    info;
    png_textp    texts;
    double       per_metre;
} PngWriter;

static void write_callback(png_structp png, png_bytep bytes, size_t length)
{
    PngWriter *writer = png_get_io_ptr(png);
    if (!output_append(writer->file, bytes, length))
        png_error(png, writer->error->message);
}

/* The file is flushed once, when it is committed. */
static void flush_callback(png_structp png) { (void)png; }

static _Noreturn void error_callback(png_structp png, png_const_charp message)
{
    PngWriter *writer = png_get_error_ptr(png);
    if (writer->error->status == KRS_OK) {
        /* libpng has no error codes.  The second text is its message when its list of texts cannot
           grow. */
        bool memory           = strstr(message, "emory") || strstr(message, "too many text chunks");
        writer->error->status = memory ? KRS_OUT_OF_MEMORY : KRS_INTERNAL;
        snprintf(writer->error->message, sizeof writer->error->message,
                 "cannot make a PNG file: %s", message);
    }
    png_longjmp(png, 1);
}

static void warning_callback(png_structp png, png_const_charp message) { (void)png, (void)message; }

static bool fail_memory(OutputError *error)
{
    error->status = KRS_OUT_OF_MEMORY;
    snprintf(error->message, sizeof error->message, "out of memory while writing a PNG file");
    return false;
}

/* Writes texts as iTXt, because names may be UTF-8. */
static void write_texts(PngWriter *writer, const Picture *picture)
{
    for (size_t i = 0; i < picture->text_count; i++) {
        const PictureText *text = &picture->texts[i];
        bool software    = strcmp(text->name, "software") == 0; /* PNG spells it with a capital */
        writer->texts[i] = (png_text){
            .compression = PNG_ITXT_COMPRESSION_NONE,
            .key         = (char *)(software ? "Software" : text->name),
            .text        = (char *)text->value,
            .itxt_length = strlen(text->value),
        };
    }
    png_set_text(writer->png, writer->info, writer->texts, (int)picture->text_count);
}

static void begin_file(PngWriter *writer, const Picture *picture, int color_type)
{
    png_set_write_fn(writer->png, writer, write_callback, flush_callback);
    png_set_user_limits(writer->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(writer->png, writer->info, picture->crop_width, picture->crop_height, 8,
                 color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(writer->png, 2);
}

/* Writes the texts, and the pixels behind all that comes before them. */
static void write_rows(PngWriter *writer, const Picture *picture, const uint8_t *pixels,
                       size_t bytes)
{
    write_texts(writer, picture);
    png_write_info(writer->png, writer->info);
    for (uint32_t y = 0; y < picture->crop_height; y++)
        png_write_row(writer->png, pixels + (size_t)y * picture->crop_width * bytes);
    png_write_end(writer->png, writer->info);
}

/* Writes the file; false when libpng has jumped out. */
static bool write_file(PngWriter *writer, const Picture *picture, const uint8_t *rgb)
{
    if (setjmp(png_jmpbuf(writer->png)) != 0)
        return false;
    begin_file(writer, picture, PNG_COLOR_TYPE_RGB);
    png_set_sRGB_gAMA_and_cHRM(writer->png, writer->info, PNG_sRGB_INTENT_PERCEPTUAL);
    /* Files are from a tenth smaller to a third larger than at the default level with a filter
       chosen for each row.  They take a sixth of the time. */
    png_set_filter(writer->png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    if (picture->crop_x || picture->crop_y)
        png_set_oFFs(writer->png, writer->info, (png_int_32)picture->crop_x,
                     (png_int_32)picture->crop_y, PNG_OFFSET_PIXEL);
    write_rows(writer, picture, rgb, 3);
    return true;
}

/* Does the same.  A mask is no light: it has no curve.  Most of its rows are as those above them. */
static bool write_mask(PngWriter *writer, const Picture *picture, const uint8_t *gray)
{
    const double most = PNG_UINT_31_MAX;
    if (setjmp(png_jmpbuf(writer->png)) != 0)
        return false;
    begin_file(writer, picture, PNG_COLOR_TYPE_GRAY);
    png_set_filter(writer->png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
    if (writer->per_metre >= 1 && writer->per_metre < most)
        png_set_pHYs(writer->png, writer->info, (png_uint_32)(writer->per_metre + 0.5),
                     (png_uint_32)(writer->per_metre + 0.5), PNG_RESOLUTION_METER);
    write_rows(writer, picture, gray, 1);
    return true;
}

typedef bool WritePixels(PngWriter *writer, const Picture *picture, const uint8_t *pixels);

static bool write_png(PngWriter writer, const Picture *picture, const uint8_t *pixels,
                      WritePixels *write)
{
    writer.texts = calloc(picture->text_count + 1, sizeof *writer.texts);
    if (!writer.texts)
        return fail_memory(writer.error);
    writer.png  = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, error_callback,
                                          warning_callback);
    writer.info = writer.png ? png_create_info_struct(writer.png) : NULL;
    bool done   = writer.info ? write(&writer, picture, pixels) : fail_memory(writer.error);
    if (writer.png)
        png_destroy_write_struct(&writer.png, &writer.info);
    free(writer.texts);
    return done;
}

bool png_write(const Picture *picture, const uint8_t *rgb, OutputFile *file, OutputError *error)
{
    return write_png((PngWriter){.file = file, .error = error}, picture, rgb, write_file);
}

bool png_write_mask(const Picture *picture, const uint8_t *gray, double per_metre, OutputFile *file,
                    OutputError *error)
{
    return write_png((PngWriter){.file = file, .error = error, .per_metre = per_metre}, picture,
                     gray, write_mask);
}
