/*
 * image_reading.c: PNG and EXR files are read as the numbers that were written, and broken ones are
 * refused.
 */
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/image/image.h"
#include "runtime/writer/exr.h"
#include "tests/support/bench.h"
#include "tests/support/folder.h"

enum { WIDTH = 7, HEIGHT = 5, PIXELS = WIDTH * HEIGHT, MAX_BYTES = 1 << 16 };

static Memory        memory;
static Arena         arena;
static unsigned char file[MAX_BYTES];
static size_t        length;
static Random        chance;

static int start(void **state)
{
    static jmp_buf out;
    memory = (Memory){.exhausted = &out};
    arena  = (Arena){.memory = &memory};
    return enter_folder(state);
}

static int stop(void **state)
{
    arena_free(&arena);
    return leave_folder(state);
}

static Image blank(ImageSpace space)
{
    return (Image){.arena = &arena, .space = space, .max_side = 100, .max_pixels = 1000};
}

/* ---- PNG ---- */

/* A form of PNG, and what it is read as. */
typedef struct Form {
    int  type, depth, interlace;
    bool gray, clear;
} Form;

static const Form forms[] = {
    {PNG_COLOR_TYPE_GRAY, 1, PNG_INTERLACE_NONE, true, false},
    {PNG_COLOR_TYPE_GRAY, 4, PNG_INTERLACE_NONE, true, false},
    {PNG_COLOR_TYPE_GRAY, 8, PNG_INTERLACE_NONE, true, false},
    {PNG_COLOR_TYPE_GRAY, 16, PNG_INTERLACE_ADAM7, true, false},
    {PNG_COLOR_TYPE_GRAY_ALPHA, 8, PNG_INTERLACE_NONE, true, true},
    {PNG_COLOR_TYPE_GRAY_ALPHA, 16, PNG_INTERLACE_NONE, true, true},
    {PNG_COLOR_TYPE_RGB, 8, PNG_INTERLACE_ADAM7, false, false},
    {PNG_COLOR_TYPE_RGB, 16, PNG_INTERLACE_NONE, false, false},
    {PNG_COLOR_TYPE_RGB_ALPHA, 8, PNG_INTERLACE_NONE, false, true},
    {PNG_COLOR_TYPE_RGB_ALPHA, 16, PNG_INTERLACE_ADAM7, false, true},
    {PNG_COLOR_TYPE_PALETTE, 8, PNG_INTERLACE_NONE, false, false},
};

static uint32_t  numbers[PIXELS * 4]; /* samples as the file has them */
static png_color palette[256];

static int samples_of(const Form *form)
{
    return form->type == PNG_COLOR_TYPE_PALETTE ? 1 : (form->gray ? 1 : 3) + form->clear;
}

static void put_bytes(png_structp png, png_bytep bytes, size_t count)
{
    (void)png;
    assert_true(length + count <= MAX_BYTES);
    memcpy(file + length, bytes, count);
    length += count;
}

static void flush(png_structp png) { (void)png; }

/* Packs a row of samples of 1, 4, 8 or 16 bits, the high ones first. */
static void pack_row(const Form *form, int y, unsigned char *row)
{
    int count = WIDTH * samples_of(form);
    memset(row, 0, WIDTH * 8);
    for (int i = 0; i < count; i++) {
        uint32_t number = numbers[y * count + i];
        if (form->depth == 16) {
            row[2 * i]     = (unsigned char)(number >> 8);
            row[2 * i + 1] = (unsigned char)number;
        } else {
            int bit = i * form->depth;
            row[bit / 8] |= (unsigned char)(number << (8 - form->depth - bit % 8));
        }
    }
}

static void write_png(const Form *form)
{
    static unsigned char rows[HEIGHT][WIDTH * 8];
    png_bytep            pointers[HEIGHT];
    png_structp          png  = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop            info = png_create_info_struct(png);
    length                    = 0;
    for (int i = 0; i < PIXELS * samples_of(form); i++)
        numbers[i] = (uint32_t)random_bits(&chance) & ((1u << form->depth) - 1);
    for (int y = 0; y < HEIGHT; y++) {
        pack_row(form, y, rows[y]);
        pointers[y] = rows[y];
    }
    png_set_write_fn(png, NULL, put_bytes, flush);
    png_set_IHDR(png, info, WIDTH, HEIGHT, form->depth, form->type, form->interlace,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (form->type == PNG_COLOR_TYPE_PALETTE)
        png_set_PLTE(png, info, palette, 256);
    png_set_rows(png, info, pointers);
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    png_destroy_write_struct(&png, &info);
}

/* IEC 61966-2-1 */
static double curve(double v) { return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4); }

/* What channel k of a pixel was written as, from 0 to 1; the last one is alpha. */
static double written(const Form *form, int pixel, int k)
{
    int    count = samples_of(form), colors = form->gray ? 1 : 3;
    double most = (1 << form->depth) - 1;
    if (form->type == PNG_COLOR_TYPE_PALETTE) {
        const png_color *color   = &palette[numbers[pixel]];
        const int        parts[] = {color->red, color->green, color->blue, 255};
        return parts[k] / 255.0;
    }
    return k == colors && !form->clear ? 1 : numbers[pixel * count + k] / most;
}

static void check_png(const Form *form, ImageSpace space)
{
    Image image = blank(space);
    if (!image_read(&image, file, length))
        fail_msg("%s", image.fault);
    assert_int_equal(image.width, WIDTH);
    assert_int_equal(image.height, HEIGHT);
    assert_int_equal(image.gray, form->gray);
    int colors = form->gray ? 1 : 3;
    for (int i = 0; i < PIXELS; i++) {
        const float *sample = image.samples + i * (colors + 1);
        double       alpha  = written(form, i, colors);
        assert_true(fabs(sample[colors] - alpha) < 1e-7);
        for (int k = 0; k < colors; k++) {
            double value = written(form, i, k);
            double level = space == SPACE_LINEAR ? value : curve(value);
            assert_true(fabs(sample[k] - alpha * level) < 1e-6);
        }
    }
}

static void png_files_are_read_as_written(void **state)
{
    (void)state;
    for (int i = 0; i < 256; i++)
        palette[i] = (png_color){(png_byte)random_bits(&chance), (png_byte)random_bits(&chance),
                                 (png_byte)random_bits(&chance)};
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        write_png(&forms[i]);
        check_png(&forms[i], SPACE_OF_FILE);
        check_png(&forms[i], SPACE_LINEAR);
    }
}

/* ---- EXR ---- */

static float values[PIXELS][4];

static void write_exr(const char *const *names, const SampleType *types, uint32_t count)
{
    PictureChannel channels[4];
    OutputError    error;
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 4; k++)
            values[i][k] = (float)floor(random_between(&chance, -200, 1000)) / 16;
    for (uint32_t k = 0; k < count; k++)
        channels[k] = (PictureChannel){names[k], types[k], &values[0][k], 4};
    Picture     picture = {.width         = WIDTH,
                           .height        = HEIGHT,
                           .crop_width    = WIDTH,
                           .crop_height   = HEIGHT,
                           .channels      = channels,
                           .channel_count = count};
    OutputFile *output  = output_open("a.exr", NULL, &error);
    assert_non_null(output);
    assert_true(exr_write(&picture, output, &error));
    assert_int_equal(output_commit(output), KRS_OK);
    FILE *stream = fopen("a.exr", "rb");
    length       = fread(file, 1, sizeof file, stream);
    fclose(stream);
}

static void check_exr(bool gray, const int places[4])
{
    Image image = blank(SPACE_OF_FILE);
    if (!image_read(&image, file, length))
        fail_msg("%s", image.fault);
    assert_int_equal(image.gray, gray);
    int count = gray ? 2 : 4;
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < count; k++) {
            float wanted = places[k] < 0 ? (k == count - 1 ? 1 : 0) : values[i][places[k]];
            assert_true(image.samples[i * count + k] == wanted);
        }
}

static void exr_files_are_read_as_written(void **state)
{
    (void)state;
    static const char *const colors[] = {"R", "G", "B", "A"}, *const heights[] = {"Y"},
                             *const some[] = {"G", "Z", "A"}, *const depth[] = {"Z"};
    const SampleType halves[] = {SAMPLE_HALF, SAMPLE_HALF, SAMPLE_HALF, SAMPLE_HALF};
    const SampleType floats[] = {SAMPLE_FLOAT, SAMPLE_FLOAT, SAMPLE_FLOAT, SAMPLE_FLOAT};
    write_exr(colors, halves, 4);
    check_exr(false, (int[]){0, 1, 2, 3});
    write_exr(colors, floats, 3);
    check_exr(false, (int[]){0, 1, 2, -1});
    write_exr(heights, floats, 1);
    check_exr(true, (int[]){0, -1, 0, 0});
    write_exr(some, halves, 3);
    check_exr(false, (int[]){-1, 0, -1, 2});
    write_exr(depth, floats, 1);
    Image image = blank(SPACE_OF_FILE);
    assert_false(image_read(&image, file, length));
    assert_non_null(strstr(image.fault, "channel"));
}

/* ---- what is broken ---- */

/* What may be said of a file: words of libraries change with their versions, and speak of parts of formats. */
static bool is_told(const char *fault)
{
    static const char *const faults[] = {
        "it ends too early",
        "its header is damaged",
        "its pixels are damaged",
        "its compression is not known",
        "it has no pixels",
        "it has too many pixels",
        "it has too many pixels, or none",
        "it is neither a PNG nor an OpenEXR file",
        "it is not of scanlines: tiles and deep pixels are not read",
        "it has neither the channels R, G, B nor the channel Y",
        "a channel has fewer samples than pixels",
        "a channel has whole numbers",
    };
    for (size_t i = 0; fault && i < sizeof faults / sizeof *faults; i++)
        if (strcmp(fault, faults[i]) == 0)
            return true;
    return false;
}

/* Whatever is read is finite, and as large as it says. */
static void look_at(size_t bytes)
{
    static volatile double sum;
    Image                  image = blank(SPACE_OF_FILE);
    ArenaMark              mark  = arena_mark(&arena);
    if (image_read(&image, file, bytes))
        for (size_t i = 0; i < image_pixels(&image) * image_channels(&image); i++) {
            assert_true(isfinite(image.samples[i]));
            sum += image.samples[i];
        }
    else
        assert_true(is_told(image.fault));
    arena_rewind(&arena, mark);
}

static void break_file(void)
{
    for (size_t i = 0; i < length; i++)
        look_at(i);
    for (int trial = 0; trial < 3000; trial++) {
        unsigned char *at = &file[random_below(&chance, (int)length)], before = *at;
        *at ^= (unsigned char)(1 << random_below(&chance, 8));
        look_at(length);
        *at = before;
    }
}

static void broken_files_are_refused(void **state)
{
    (void)state;
    static const char *const colors[] = {"R", "G", "B"};
    const SampleType         halves[] = {SAMPLE_HALF, SAMPLE_HALF, SAMPLE_HALF};
    write_png(&forms[6]);
    for (size_t i = 12; i < length; i++) {
        Image image = blank(SPACE_OF_FILE);
        assert_true(image_read(&image, file, i) || strcmp(image.fault, "it ends too early") == 0);
    }
    break_file();
    write_exr(colors, halves, 3);
    break_file();
}

static void what_is_no_picture_is_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {"", "GIF89a", "\x89PNG\r\n\x1a\n", "\x76\x2f\x31\x01"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        Image image = blank(SPACE_OF_FILE);
        assert_false(image_read(&image, (const unsigned char *)texts[i], strlen(texts[i])));
        assert_true(is_told(image.fault));
    }
    write_png(&forms[2]);
    Image image      = blank(SPACE_OF_FILE);
    image.max_pixels = PIXELS - 1;
    assert_false(image_read(&image, file, length));
    assert_string_equal(image.fault, "it has too many pixels");
    image          = blank(SPACE_OF_FILE);
    image.max_side = WIDTH - 1;
    assert_false(image_read(&image, file, length));
    assert_string_equal(image.fault, "it has too many pixels");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(png_files_are_read_as_written, start, stop),
        cmocka_unit_test_setup_teardown(exr_files_are_read_as_written, start, stop),
        cmocka_unit_test_setup_teardown(broken_files_are_refused, start, stop),
        cmocka_unit_test_setup_teardown(what_is_no_picture_is_refused, start, stop),
    };
    return cmocka_run_group_tests_name("image reading", tests, NULL, NULL);
}
