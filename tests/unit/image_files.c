/*
 * image_files.c: image files read back the same, and whatever goes wrong while they are written
 * leaves the folder as it was.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <OpenEXR/openexr.h>
#include <errno.h>
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/half.h"
#include "runtime/writer/exr.h"
#include "runtime/writer/png.h"
#include "tests/support/processors.h"
#include "tests/unit/file_faults.h"

/* ---- half precision ---- */

static double half_value(uint16_t half)
{
    int    exponent = half >> 10 & 31, fraction = half & 1023;
    double size = exponent ? ldexp(1024 + fraction, exponent - 25) : ldexp(fraction, -24);
    return half & 0x8000 ? -size : size;
}

static void halves_round_to_nearest_even(void **state)
{
    (void)state;
    for (uint16_t half = 0; half < 0x7bff; half++) {
        float low = (float)half_value(half), high = (float)half_value(half + 1);
        float middle = (low + high) / 2; /* exact: a float has room for one more bit */
        assert_int_equal(half_from_float(low), half);
        assert_int_equal(half_from_float(-low), half | 0x8000);
        assert_int_equal(half_from_float(middle), half & 1 ? half + 1 : half);
        assert_int_equal(half_from_float(nextafterf(middle, 0)), half);
        assert_int_equal(half_from_float(nextafterf(middle, INFINITY)), half + 1);
    }
}

static void halves_of_extreme_numbers(void **state)
{
    (void)state;
    assert_int_equal(half_from_float(65504), 0x7bff);
    assert_int_equal(half_from_float(65536), 0x7bff);
    assert_int_equal(half_from_float(-3e38f), 0xfbff);
    assert_int_equal(half_from_float(INFINITY), 0x7c00);
    assert_int_equal(half_from_float(-INFINITY), 0xfc00);
    assert_int_equal(half_from_float(NAN) & 0x7fff, 0x7e00);
    assert_int_equal(half_from_float(1e-30f), 0);
    assert_int_equal(half_from_float(-0.0f), 0x8000);
}

/* ---- a picture with a channel of each type, cropped, its colours interleaved ---- */

enum { WIDTH = 37, HEIGHT = 203, CROP_X = 5, CROP_Y = 7, FULL_WIDTH = 50, FULL_HEIGHT = 220 };

typedef struct Sample {
    float          color[WIDTH * HEIGHT][4];
    float          depth[WIDTH * HEIGHT];
    uint32_t       id[WIDTH * HEIGHT];
    uint8_t        rgb[WIDTH * HEIGHT * 3];
    PictureChannel channels[4];
    PictureText    texts[2];
    PictureMatrix  matrix;
    Picture        picture;
} Sample;

static Sample *sample_new(void)
{
    Sample *sample = calloc(1, sizeof *sample);
    assert_non_null(sample);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        for (size_t c = 0; c < 4; c++)
            sample->color[i][c] = (float)((i * 7919 + c * 104729) % 1000) / 256;
        sample->depth[i] = i % 11 == 0 ? INFINITY : 1 + (float)i / 3;
        sample->id[i]    = (uint32_t)(i * 2654435761u);
    }
    for (size_t i = 0; i < sizeof sample->rgb; i++)
        sample->rgb[i] = (uint8_t)(i * 31 + i / 256);
    for (int i = 0; i < 16; i++)
        sample->matrix.m[i / 4][i % 4] = (float)i;
    sample->channels[0] = (PictureChannel){"R", SAMPLE_HALF, &sample->color[0][0], 4};
    sample->channels[1] = (PictureChannel){"G", SAMPLE_HALF, &sample->color[0][1], 4};
    sample->channels[2] = (PictureChannel){"Z", SAMPLE_FLOAT, sample->depth, 1};
    sample->channels[3] = (PictureChannel){"id.component", SAMPLE_UINT, sample->id, 1};
    sample->texts[0]    = (PictureText){"krs:scene", "0123456789abcdef"};
    sample->texts[1]    = (PictureText){"software", "krs"};
    sample->picture     = (Picture){.width           = FULL_WIDTH,
                                    .height          = FULL_HEIGHT,
                                    .crop_x          = CROP_X,
                                    .crop_y          = CROP_Y,
                                    .crop_width      = WIDTH,
                                    .crop_height     = HEIGHT,
                                    .channels        = sample->channels,
                                    .channel_count   = 4,
                                    .texts           = sample->texts,
                                    .text_count      = 2,
                                    .world_to_camera = &sample->matrix};
    return sample;
}

typedef enum Form { EXR, PNG } Form;

static KrsStatus write_sample(const Sample *sample, Form form, const char *path)
{
    OutputError error;
    OutputFile *file = output_open(path, NULL, &error);
    if (!file)
        return error.status;
    bool written = form == EXR ? exr_write(&sample->picture, file, &error)
                               : png_write(&sample->picture, sample->rgb, file, &error);
    assert_int_equal(written, error.status == KRS_OK);
    KrsStatus status = output_commit(file);
    if (status != KRS_OK)
        assert_non_null(strstr(error.message, path));
    return status;
}

/* Returns one channel of an EXR file, in the file's own type. */
static void *read_channel(exr_context_t context, const char *name, size_t bytes)
{
    char                 *plane    = calloc(WIDTH * HEIGHT, bytes);
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    int32_t               lines;
    assert_int_equal(exr_get_scanlines_per_chunk(context, 0, &lines), 0);
    for (int y = 0; y < HEIGHT; y += lines) {
        exr_chunk_info_t chunk;
        assert_int_equal(exr_read_scanline_chunk_info(context, 0, CROP_Y + y, &chunk), 0);
        assert_int_equal(y == 0 ? exr_decoding_initialize(context, 0, &chunk, &pipeline)
                                : exr_decoding_update(context, 0, &chunk, &pipeline),
                         0);
        for (int c = 0; c < pipeline.channel_count; c++) {
            exr_coding_channel_info_t *channel = &pipeline.channels[c];
            bool                       ours    = strcmp(channel->channel_name, name) == 0;
            channel->decode_to_ptr     = ours ? (uint8_t *)plane + (size_t)y * WIDTH * bytes : NULL;
            channel->user_pixel_stride = (int32_t)bytes;
            channel->user_line_stride  = (int32_t)(WIDTH * bytes);
        }
        if (y == 0)
            assert_int_equal(exr_decoding_choose_default_routines(context, 0, &pipeline), 0);
        assert_int_equal(exr_decoding_run(context, 0, &pipeline), 0);
    }
    exr_decoding_destroy(context, &pipeline);
    return plane;
}

static void check_exr_header(exr_context_t context, const Sample *sample)
{
    exr_attr_box2i_t window;
    assert_int_equal(exr_get_display_window(context, 0, &window), 0);
    assert_int_equal(window.min.x, 0);
    assert_int_equal(window.max.x, FULL_WIDTH - 1);
    assert_int_equal(window.max.y, FULL_HEIGHT - 1);
    assert_int_equal(exr_get_data_window(context, 0, &window), 0);
    assert_int_equal(window.min.x, CROP_X);
    assert_int_equal(window.min.y, CROP_Y);
    assert_int_equal(window.max.x, CROP_X + WIDTH - 1);
    assert_int_equal(window.max.y, CROP_Y + HEIGHT - 1);

    exr_attr_m44f_t matrix;
    assert_int_equal(exr_attr_get_m44f(context, 0, "worldToCamera", &matrix), 0);
    assert_memory_equal(matrix.m, sample->matrix.m, sizeof matrix.m);
    assert_int_equal(exr_attr_get_m44f(context, 0, "worldToNDC", &matrix), EXR_ERR_NO_ATTR_BY_NAME);
    exr_attr_chromaticities_t colors;
    assert_int_equal(exr_attr_get_chromaticities(context, 0, "chromaticities", &colors), 0);
    assert_true(colors.red_x == 0.64f && colors.white_y == 0.329f);
    int32_t     length;
    const char *text;
    assert_int_equal(exr_attr_get_string(context, 0, "krs:scene", &length, &text), 0);
    assert_string_equal(text, "0123456789abcdef");
}

static void check_exr(const Sample *sample)
{
    exr_context_t context;
    assert_int_equal(write_sample(sample, EXR, "a.exr"), KRS_OK);
    assert_int_equal(exr_start_read(&context, "a.exr", NULL), 0);
    check_exr_header(context, sample);

    uint16_t *red = read_channel(context, "R", 2), *green = read_channel(context, "G", 2);
    float    *depth = read_channel(context, "Z", 4);
    uint32_t *id    = read_channel(context, "id.component", 4);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        assert_int_equal(red[i], half_from_float(sample->color[i][0]));
        assert_int_equal(green[i], half_from_float(sample->color[i][1]));
    }
    assert_memory_equal(depth, sample->depth, sizeof sample->depth);
    assert_memory_equal(id, sample->id, sizeof sample->id);
    free(red);
    free(green);
    free(depth);
    free(id);
    exr_finish(&context);
}

static void exr_reads_back(void **state)
{
    (void)state;
    Sample *sample = sample_new();
    check_exr(sample);
    free(sample);
}

static size_t read_file(const char *path, char *bytes, size_t size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t length = fread(bytes, 1, size, file);
    fclose(file);
    assert_true(length < size);
    return length;
}

/* Chunks that compression does not make smaller are stored as they are. */
static void noise_reads_back(void **state)
{
    enum { SIZE = 1 << 20 };
    (void)state;
    Sample  *sample = sample_new();
    char    *bytes  = malloc(SIZE);
    uint64_t random = 1;
    assert_non_null(bytes);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        for (int c = 0; c < 4; c++) {
            random        = random * 6364136223846793005u + 1442695040888963407u;
            uint16_t half = (uint16_t)(random >> 48);
            if ((half & 0x7c00) == 0x7c00)
                half ^= 0x4000; /* it was infinite, or no number */
            if (c < 2)
                sample->color[i][c] = (float)half_value(half);
            else
                memcpy(c == 2 ? (void *)&sample->depth[i] : &sample->id[i], (uint8_t *)&random + 4,
                       4);
        }
    check_exr(sample);
    assert_in_range(read_file("a.exr", bytes, SIZE), WIDTH * HEIGHT * 12,
                    WIDTH * HEIGHT * 12 + 2000);
    free(bytes);
    free(sample);
}

/* With one processor there is one worker; the file must be that of any number. */
static void workers_are_not_seen(void **state)
{
    enum { SIZE = 1 << 20 };
    (void)state;
    Sample   *sample = sample_new();
    char     *alone = malloc(SIZE), *together = malloc(SIZE);
    cpu_set_t all;
    assert_true(alone && together);
    assert_int_equal(use_one_processor(&all), 0);
    assert_int_equal(write_sample(sample, EXR, "alone.exr"), KRS_OK);
    assert_int_equal(use_processors(&all), 0);
    size_t length = read_file("alone.exr", alone, SIZE);
    for (int i = 0; i < 20; i++) {
        assert_int_equal(write_sample(sample, EXR, "together.exr"), KRS_OK);
        assert_int_equal(read_file("together.exr", together, SIZE), length);
        assert_memory_equal(together, alone, length);
    }
    free(together);
    free(alone);
    free(sample);
}

static void png_reads_back(void **state)
{
    (void)state;
    Sample *sample = sample_new();
    assert_int_equal(write_sample(sample, PNG, "a.png"), KRS_OK);
    FILE       *file = fopen("a.png", "rb");
    png_structp png  = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop   info = png_create_info_struct(png);
    png_init_io(png, file);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);

    assert_int_equal(png_get_image_width(png, info), WIDTH);
    assert_int_equal(png_get_image_height(png, info), HEIGHT);
    assert_int_equal(png_get_color_type(png, info), PNG_COLOR_TYPE_RGB);
    assert_int_equal(png_get_bit_depth(png, info), 8);
    assert_int_equal(png_get_x_offset_pixels(png, info), CROP_X);
    assert_int_equal(png_get_y_offset_pixels(png, info), CROP_Y);
    int       intent, count;
    png_textp texts;
    assert_true(png_get_sRGB(png, info, &intent) != 0);
    png_get_text(png, info, &texts, &count);
    assert_int_equal(count, 2);
    assert_string_equal(texts[0].key, "krs:scene");
    assert_string_equal(texts[0].text, "0123456789abcdef");
    assert_string_equal(texts[1].key, "Software");
    png_bytepp rows = png_get_rows(png, info);
    for (size_t y = 0; y < HEIGHT; y++)
        assert_memory_equal(rows[y], sample->rgb + y * WIDTH * 3, WIDTH * 3);
    png_destroy_read_struct(&png, &info, NULL);
    fclose(file);
    free(sample);
}

static void equal_pictures_are_equal_files(void **state)
{
    (void)state;
    Sample     *sample = sample_new();
    char       *bytes[4];
    long        lengths[4];
    const char *paths[] = {"a.exr", "b.exr", "a.png", "b.png"};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(write_sample(sample, i < 2 ? EXR : PNG, paths[i]), KRS_OK);
        FILE *file = fopen(paths[i], "rb");
        fseek(file, 0, SEEK_END);
        lengths[i] = ftell(file);
        rewind(file);
        bytes[i] = malloc((size_t)lengths[i]);
        assert_int_equal(fread(bytes[i], 1, (size_t)lengths[i], file), lengths[i]);
        fclose(file);
    }
    for (int i = 0; i < 4; i += 2) {
        assert_int_equal(lengths[i], lengths[i + 1]);
        assert_memory_equal(bytes[i], bytes[i + 1], (size_t)lengths[i]);
    }
    for (int i = 0; i < 4; i++)
        free(bytes[i]);
    free(sample);
}

/* ---- calls that fail ---- */

/* Makes each call fail in turn, until a write succeeds because there is no such call any more;
   returns how many there were. */
static int fail_in_turn(const Sample *sample, Form form, Call call, int reason)
{
    for (int countdown = 1;; countdown++) {
        put("old", "before");
        memset(faults.seen, 0, sizeof faults.seen);
        faults.armed     = true;
        faults.call      = call;
        faults.countdown = countdown;
        faults.reason    = reason;
        KrsStatus status = write_sample(sample, form, "old");
        faults.armed     = false;
        assert_int_equal(count_files(), 1); /* no temporary is left */
        if (status == KRS_OK)
            return countdown - 1;
        assert_int_equal(status, KRS_IO_ERROR);
        assert_holds("old", "before");
    }
}

static void every_failing_call_is_told(void **state)
{
    (void)state;
    Sample   *sample    = sample_new();
    const int reasons[] = {ENOSPC, EIO, EFBIG, EDQUOT};
    faults.short_writes = true; /* more calls to fail */
    for (size_t i = 0; i < sizeof reasons / sizeof *reasons; i++)
        for (Form form = EXR; form <= PNG; form++) {
            assert_true(fail_in_turn(sample, form, CALL_PWRITE, reasons[i]) >= 3);
            assert_int_equal(fail_in_turn(sample, form, CALL_FSYNC, reasons[i]), 1);
            assert_int_equal(fail_in_turn(sample, form, CALL_RENAME, reasons[i]), 1);
        }
    free(sample);
}

static void interrupted_calls_are_repeated(void **state)
{
    (void)state;
    Sample *sample      = sample_new();
    faults.short_writes = true;
    assert_int_equal(fail_in_turn(sample, EXR, CALL_PWRITE, EINTR), 0);
    free(sample);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(halves_round_to_nearest_even),
        cmocka_unit_test(halves_of_extreme_numbers),
        IN_FOLDER(exr_reads_back),
        IN_FOLDER(noise_reads_back),
        IN_FOLDER(workers_are_not_seen),
        IN_FOLDER(png_reads_back),
        IN_FOLDER(equal_pictures_are_equal_files),
        IN_FOLDER(every_failing_call_is_told),
        IN_FOLDER(interrupted_calls_are_repeated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
