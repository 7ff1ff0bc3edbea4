/*
 * display.c: tone mapping, sRGB and dithering.
 */
#include "runtime/display/display.h"

#include <math.h>
#include <string.h>

#include "compiler/base/parallel.h"

const char *const tone_map_names[TONE_MAP_COUNT] = {
#define TONE_MAP(id, name, about) name,
#include "runtime/display/tone_maps.def"
#undef TONE_MAP
};

bool tone_map_find(const char *name, ToneMap *tone_map)
{
    for (int i = 0; i < TONE_MAP_COUNT; i++)
        if (strcmp(name, tone_map_names[i]) == 0) {
            *tone_map = (ToneMap)i;
            return true;
        }
    return false;
}

/* fmin and fmax are calls, since they must treat NaN; here there is none. */
static double least_of(double a, double b) { return a < b ? a : b; }
static double most_of(double a, double b) { return a > b ? a : b; }

/* Khronos PBR Neutral (2024).  It subtracts the 4 % that a dielectric reflects head-on, leaves
   colours up to 0.76 as they are, and compresses and whitens brighter ones. */
static void apply_neutral(const double color[3], double out[3])
{
    const double start = 0.8 - 0.04, desaturation = 0.15;
    double       least  = least_of(color[0], least_of(color[1], color[2]));
    double       offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
    double       peak   = most_of(color[0], most_of(color[1], color[2])) - offset;
    double       top = peak, white = 0;
    if (peak >= start) {
        double room = 1 - start;
        top         = 1 - room * room / (peak + room - start);
        white       = 1 - 1 / (desaturation * (peak - top) + 1);
    }
    double scale = peak > 0 ? top / peak : 1;
    for (int i = 0; i < 3; i++)
        out[i] = (color[i] - offset) * scale * (1 - white) + top * white;
}

static void multiply(const double matrix[3][3], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = matrix[i][0] * v[0] + matrix[i][1] * v[1] + matrix[i][2] * v[2];
}

static void apply_aces(const double color[3], double out[3])
{
    static const double into[3][3] = {
        {0.59719, 0.35458, 0.04823},
        {0.07600, 0.90834, 0.01566},
        {0.02840, 0.13383, 0.83777},
    };
    static const double back[3][3] = {
        {1.60475, -0.53108, -0.07367},
        {-0.10208, 1.10813, -0.00605},
        {-0.00327, -0.07276, 1.07602},
    };
    double curved[3];
    multiply(into, color, curved);
    for (int i = 0; i < 3; i++) {
        double v  = curved[i];
        curved[i] = (v * (v + 0.0245786) - 0.000090537) /
                    (v * (0.983729 * v + 0.4329510) + 0.238081);
    }
    multiply(back, curved, out);
}

/* The curve of AgX over the logarithm of light; the sigmoid of the original has no simple powers. */
static double agx_curve(double x)
{
    return -0.00232 +
           x * (0.1191 + x * (0.4298 + x * (-6.868 + x * (31.96 + x * (-40.14 + x * 15.5)))));
}

/* Light is cut to 10 stops below middle grey (0.18) and 6.5 above. */
static double agx_logarithm(double light)
{
    const double low = -12.47393, high = 4.026069;
    double       stops = log2(most_of(light, 1e-10));
    return (least_of(most_of(stops, low), high) - low) / (high - low);
}

/* The matrices go to Rec.2020 and to a narrower gamut within, and back to a wider one. */
static void apply_agx(const double color[3], double out[3])
{
    static const double wide[3][3]   = {{0.6274039, 0.3292830, 0.0433131},
                                        {0.0690973, 0.9195404, 0.0113623},
                                        {0.0163914, 0.0880133, 0.8955953}};
    static const double inset[3][3]  = {{0.856627153315983, 0.0951212405381588, 0.0482516061458583},
                                        {0.137318972929847, 0.761241990602591, 0.101439036467562},
                                        {0.11189821299995, 0.0767994186031903, 0.811302368396859}};
    static const double outset[3][3] = {
        {1.1271005818144368, -0.1106066430966032, -0.0164939387178346},
        {-0.1413297634984383, 1.157823702216272, -0.0164939387178343},
        {-0.1413297634984383, -0.1106066430966029, 1.2519364065950405}};
    static const double narrow[3][3] = {{1.6604910, -0.5876411, -0.0728499},
                                        {-0.1245505, 1.1328999, -0.0083494},
                                        {-0.0181508, -0.1005789, 1.1187297}};
    double              in_wide[3], curved[3], shown[3];
    multiply(wide, color, in_wide);
    multiply(inset, in_wide, curved);
    for (int i = 0; i < 3; i++)
        curved[i] = agx_curve(agx_logarithm(curved[i]));
    multiply(outset, curved, shown);
    for (int i = 0; i < 3; i++)
        shown[i] = pow(most_of(shown[i], 0), 2.2);
    multiply(narrow, shown, out);
}

static double clamp_unit(double value) { return value > 0 ? least_of(value, 1) : 0; }

void tone_map_apply(ToneMap tone_map, const double color[3], double out[3])
{
    /* Far beyond any curve's shoulder.  It keeps infinity from becoming infinity / infinity. */
    const double brightest = 1e9;
    double       light[3];
    for (int i = 0; i < 3; i++)
        light[i] = color[i] > 0 ? least_of(color[i], brightest) : 0;
    switch (tone_map) {
    case TONE_NEUTRAL: apply_neutral(light, out); break;
    case TONE_ACES: apply_aces(light, out); break;
    case TONE_AGX: apply_agx(light, out); break;
    default: memcpy(out, light, sizeof light);
    }
    for (int i = 0; i < 3; i++)
        out[i] = clamp_unit(out[i]);
}

double srgb_encode(double linear)
{
    if (linear >= 1) /* the formula gives a little less */
        return 1;
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

/* A table of srgb_encode over the square root of its argument, in which the curve is nearly
   straight.  It is linear in each of PIECES pieces; the error is below 3e-7. */
enum { PIECES = 4096 };
typedef struct Encoding {
    double at[PIECES + 2];
} Encoding;

static void encoding_fill(Encoding *encoding)
{
    for (int i = 0; i <= PIECES + 1; i++)
        encoding->at[i] = srgb_encode((double)i / PIECES * i / PIECES);
}

/* The encoded value of a number in [0, 1], by the table. */
static double encode(const Encoding *encoding, double linear)
{
    double place = sqrt(linear) * PIECES;
    int    piece = (int)place;
    double below = encoding->at[piece];
    return below + (place - piece) * (encoding->at[piece + 1] - below);
}

/* The byte that the definition of sRGB gives.  Where an error of the table could change it,
   srgb_encode itself decides. */
static uint8_t to_byte(const Encoding *encoding, double linear, double step)
{
    const double doubt = 1e-3;
    double       value = 255 * encode(encoding, linear) + step, behind = value - (int)value;
    if (behind < doubt || behind > 1 - doubt)
        value = 255 * srgb_encode(linear) + step;
    return (uint8_t)value;
}

/* The fractional part of a number that is not negative; floor would be a call. */
static double fraction(double value) { return value - (double)(int64_t)value; }

/* Interleaved gradient noise (Jimenez 2014) in [0, 1).  Among a few neighbouring pixels its values
   are evenly spread, so dithered areas keep their mean and have no clumps. */
static double noise(double x, double y)
{
    return fraction(52.9829189 * fraction(0.06711056 * x + 0.00583715 * y));
}

void display_to_srgb8(const KrsPicture *picture, const DisplayOptions *options, uint8_t *rgb)
{
    display_to_channels(picture, options, 3, rgb);
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
        multiply(c->balance.m, light, white);
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

void display_to_channels(const KrsPicture *picture, const DisplayOptions *options,
                         uint32_t channels, uint8_t *pixels)
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
