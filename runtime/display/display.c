/*
 * display.c: from light to bytes: white balance, the curve of sRGB, and dithering.
 */
#include "runtime/display/display.h"

#include <math.h>

#include "compiler/base/parallel.h"
#include "compiler/base/srgb.h"

/* A table of srgb_of_linear over the square root of its argument, in which the curve is nearly
   straight.  It is linear in each of PIECES pieces; the error is below 3e-7. */
enum { PIECES = 4096 };
typedef struct Encoding {
    double at[PIECES + 2];
} Encoding;

static void encoding_fill(Encoding *encoding)
{
    for (int i = 0; i <= PIECES + 1; i++)
        encoding->at[i] = srgb_of_linear((double)i / PIECES * i / PIECES);
}

/* Returns the encoded value of a number in [0, 1], by the table. */
static double encode(const Encoding *encoding, double linear)
{
    double place = sqrt(linear) * PIECES;
    int    piece = (int)place;
    double below = encoding->at[piece];
    return below + (place - piece) * (encoding->at[piece + 1] - below);
}

/* Returns the byte that the definition of sRGB gives.  Where an error of the table could change it,
   srgb_of_linear itself decides. */
static uint8_t to_byte(const Encoding *encoding, double linear, double step)
{
    const double doubt = 1e-3;
    double       value = 255 * encode(encoding, linear) + step, behind = value - (int)value;
    if (behind < doubt || behind > 1 - doubt)
        value = 255 * srgb_of_linear(linear) + step;
    return (uint8_t)value;
}

/* Returns the fractional part of a number that is not negative; floor would be a call. */
static double fraction(double value) { return value - (double)(int64_t)value; }

/* Returns interleaved gradient noise (Jimenez 2014) in [0, 1).  Among a few neighbouring pixels its
   values are evenly spread, so dithered areas keep their mean and have no clumps. */
static double noise(double x, double y)
{
    return fraction(52.9829189 * fraction(0.06711056 * x + 0.00583715 * y));
}

/* A picture that all processors convert, each some rows. */
typedef struct Conversion {
    const KrsPicture     *picture;
    const DisplayOptions *options;
    uint32_t              channels;
    uint8_t              *pixels;
    double                gain;
    bool                  tinted;
    ColorMatrix           balance;
    Encoding              encoding;
} Conversion;

static void convert_pixel(const Conversion *c, uint32_t x, uint32_t y)
{
    const KrsWindow *window   = &c->picture->window;
    const size_t     index    = (size_t)y * window->width + x;
    const float     *from     = &c->picture->color[4 * index];
    const double     light[3] = {c->gain * from[0], c->gain * from[1], c->gain * from[2]};
    double           white[3], shown[3];
    if (c->tinted)
        color_multiply(c->balance.m, light, white);
    tone_map_apply(c->options->tone_map, c->tinted ? white : light, shown);
    for (int i = 0; i < 3; i++) {
        /* The noise of each channel is shifted, so that greys are dithered more finely. */
        double step = noise(window->x + x + 47.0 * i, window->y + y + 17.0 * i);
        c->pixels[c->channels * index + i] = to_byte(&c->encoding, shown[i], step);
    }
    if (c->channels == 4)
        c->pixels[4 * index + 3] = 255;
}

static void convert_rows(void *task, size_t part, size_t parts)
{
    const Conversion *c      = task;
    const size_t      height = c->picture->window.height;
    for (size_t y = part_begin(height, part, parts); y < part_begin(height, part + 1, parts); y++)
        for (uint32_t x = 0; x < c->picture->window.width; x++)
            convert_pixel(c, x, (uint32_t)y);
}

void display_to_srgb8(const KrsPicture *picture, const DisplayOptions *options, uint32_t channels,
                      uint8_t *pixels)
{
    Conversion conversion = {.picture  = picture,
                             .options  = options,
                             .channels = channels,
                             .pixels   = pixels,
                             .gain     = exp2(options->exposure),
                             .tinted   = options->white_balance.kelvins > 0,
                             .balance  = white_balance_matrix(options->white_balance)};
    encoding_fill(&conversion.encoding);
    run_in_parallel(convert_rows, &conversion);
}
