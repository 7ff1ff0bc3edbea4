/*
 * film.c: tone mapping, sRGB and dithering.
 */
#include "runtime/film/film.h"

#include <math.h>
#include <string.h>

const char *const tone_map_names[TONE_MAP_COUNT] = {"neutral", "aces", "none"};

bool tone_map_find(const char *name, ToneMap *tone_map)
{
    for (int i = 0; i < TONE_MAP_COUNT; i++)
        if (strcmp(name, tone_map_names[i]) == 0) {
            *tone_map = (ToneMap)i;
            return true;
        }
    return false;
}

/* fmin and fmax are calls, as they know what is no number; here there is nothing of that kind. */
static double least_of(double a, double b) { return a < b ? a : b; }
static double most_of(double a, double b) { return a > b ? a : b; }

/* Khronos PBR Neutral (2024): takes back the 4 % that a dielectric reflects head-on, leaves
   colours alone up to 0.76 and compresses and whitens what is brighter. */
static void apply_neutral(const double color[3], double out[3])
{
    const double start = 0.8 - 0.04, desaturation = 0.15;
    double least = least_of(color[0], least_of(color[1], color[2]));
    double offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
    double peak = most_of(color[0], most_of(color[1], color[2])) - offset;
    double top = peak, white = 0;
    if (peak >= start) {
        double room = 1 - start;
        top = 1 - room * room / (peak + room - start);
        white = 1 - 1 / (desaturation * (peak - top) + 1);
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

static const double aces_into[3][3] = {
    {0.59719, 0.35458, 0.04823},
    {0.07600, 0.90834, 0.01566},
    {0.02840, 0.13383, 0.83777},
};
static const double aces_back[3][3] = {
    {1.60475, -0.53108, -0.07367},
    {-0.10208, 1.10813, -0.00605},
    {-0.00327, -0.07276, 1.07602},
};

static void apply_aces(const double color[3], double out[3])
{
    double film[3];
    multiply(aces_into, color, film);
    for (int i = 0; i < 3; i++) {
        double v = film[i];
        film[i] = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    }
    multiply(aces_back, film, out);
}

static double clamp_unit(double value) { return value > 0 ? least_of(value, 1) : 0; }

/* Far beyond any curve's shoulder: keeps infinity from becoming a quotient of infinities. */
#define BRIGHTEST 1e9

void tone_map_apply(ToneMap tone_map, const double color[3], double out[3])
{
    double light[3];
    for (int i = 0; i < 3; i++)
        light[i] = color[i] > 0 ? least_of(color[i], BRIGHTEST) : 0;
    switch (tone_map) {
    case TONE_NEUTRAL: apply_neutral(light, out); break;
    case TONE_ACES:    apply_aces(light, out); break;
    default:           memcpy(out, light, sizeof light);
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

/* ---- Pictures ---- */

/* Bytes are what the definitions above give.  They are found in single precision, a run of pixels
   at a time, step by step and without branches, which compilers turn into vectors; where that
   could decide about a byte, the definitions are asked. */
enum { RUN = 64 };

typedef struct Run {
    float channel[3][RUN];
} Run;

static float lesser(float a, float b) { return a < b ? a : b; }
static float greater(float a, float b) { return a > b ? a : b; }

/* As tone_map_apply begins. */
static void run_light(Run *run, const float *from, size_t count, float gain)
{
    *run = (Run){0};
    for (size_t k = 0; k < count; k++)
        for (int i = 0; i < 3; i++)
            run->channel[i][k] = lesser(greater(gain * from[4 * k + i], 0), (float)BRIGHTEST);
}

/* As apply_neutral, by minima instead of questions: what is above its toe or its shoulder is so
   by them, too. */
static void run_neutral(Run *run)
{
    const float start = 0.76f, room = 0.24f, desaturation = 0.15f, tiny = 1e-30f;
    for (int k = 0; k < RUN; k++) {
        float red = run->channel[0][k], green = run->channel[1][k], blue = run->channel[2][k];
        float toe = lesser(lesser(red, lesser(green, blue)), 0.08f);
        float offset = toe - 6.25f * toe * toe;
        float peak = greater(red, greater(green, blue)) - offset;
        float top = lesser(peak, 1 - room * room / (greater(peak, start) + room - start));
        float colored = 1 / (desaturation * (peak - top) + 1);
        float scale = top / greater(peak, tiny) * colored, white = top * (1 - colored);
        run->channel[0][k] = (red - offset) * scale + white;
        run->channel[1][k] = (green - offset) * scale + white;
        run->channel[2][k] = (blue - offset) * scale + white;
    }
}

static float dot(const double row[3], float x, float y, float z)
{
    return (float)row[0] * x + (float)row[1] * y + (float)row[2] * z;
}

static float aces_curve(float v)
{
    return (v * (v + 0.0245786f) - 0.000090537f) / (v * (0.983729f * v + 0.4329510f) + 0.238081f);
}

/* As apply_aces. */
static void run_aces(Run *run)
{
    for (int k = 0; k < RUN; k++) {
        float red = run->channel[0][k], green = run->channel[1][k], blue = run->channel[2][k];
        float x = aces_curve(dot(aces_into[0], red, green, blue));
        float y = aces_curve(dot(aces_into[1], red, green, blue));
        float z = aces_curve(dot(aces_into[2], red, green, blue));
        run->channel[0][k] = dot(aces_back[0], x, y, z);
        run->channel[1][k] = dot(aces_back[1], x, y, z);
        run->channel[2][k] = dot(aces_back[2], x, y, z);
    }
}

/* 255 srgb_encode, by straight lines: of what is less than 2^-13 one, above 256 for each power of
   two, which are chosen by the first bits of a number; off by less than 2e-4. */
enum { LINE_SHIFT = 23 - 8, LINES_FIRST = (127 - 13) << 8, LINES = (13 << 8) + 2 };

typedef struct Line {
    float at_0, slope;
} Line;

static float float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static void lines_fill(Line lines[LINES])
{
    lines[0] = (Line){0, 255 * 12.92f};
    for (uint32_t i = 1; i < LINES; i++) {
        double from = float_of((LINES_FIRST + i - 1) << LINE_SHIFT);
        double to   = float_of((LINES_FIRST + i) << LINE_SHIFT);
        double low = 255 * srgb_encode(from), slope = (255 * srgb_encode(to) - low) / (to - from);
        lines[i] = (Line){(float)(low - slope * from), (float)slope};
    }
}

/* Of what is from 0 to 1. */
static float encode(const Line lines[LINES], float linear)
{
    int32_t number = (int32_t)(bits_of(linear) >> LINE_SHIFT) - (LINES_FIRST - 1);
    Line    line   = lines[number > 0 ? number : 0];
    return line.at_0 + line.slope * linear;
}

/* What is behind the point of a number from 0 on; floor is a call. */
static double fraction(double value) { return value - (double)(int32_t)value; }

/* Interleaved gradient noise (Jimenez 2014) in [0, 1): over any few neighbouring pixels its
   values are spread evenly, so that dithered areas keep their mean without clumps. */
static double noise(double x, double y)
{
    return fraction(52.9829189 * fraction(0.06711056 * x + 0.00583715 * y));
}

/* The channels' noise differs, by a shift, so that greys are dithered finer. */
static double noise_of(int channel, double x, double y)
{
    return noise(x + 47.0 * channel, y + 17.0 * channel);
}

static void run_noise(Run *run, double x, double y)
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < RUN; k++)
            run->channel[i][k] = (float)noise_of(i, x + k, y);
}

/* What the picture is made with. */
typedef struct Developing {
    ToneMap tone_map;
    double  gain;
    float   certain; /* so near to the middle between two bytes it is the lower one */
    Line    lines[LINES];
} Developing;

/* By definition. */
static uint8_t find_byte(const Developing *by, const float *from, int channel, double step)
{
    const double light[3] = {by->gain * from[0], by->gain * from[1], by->gain * from[2]};
    double       shown[3];
    tone_map_apply(by->tone_map, light, shown);
    return (uint8_t)(255 * srgb_encode(shown[channel]) + step);
}

/* At most RUN pixels of a row, from this place of the picture on. */
static void develop_run(const Developing *by, const float *from, size_t count, double x, double y,
                        uint8_t *rgb)
{
    Run run, step;
    run_light(&run, from, count, (float)by->gain);
    run_noise(&step, x, y);
    if (by->tone_map == TONE_NEUTRAL)
        run_neutral(&run);
    if (by->tone_map == TONE_ACES)
        run_aces(&run);
    for (size_t k = 0; k < count; k++)
        for (int i = 0; i < 3; i++) {
            float shown = lesser(greater(run.channel[i][k], 0), 1);
            float value = encode(by->lines, shown) + step.channel[i][k];
            int   byte = (int)value;
            if (fabsf(value - (float)byte - 0.5f) > by->certain)
                byte = find_byte(by, from + 4 * k, i, noise_of(i, x + (double)k, y));
            rgb[3 * k + i] = (uint8_t)byte;
        }
}

void film_to_srgb8(const KrsPicture *picture, const FilmOptions *options, uint8_t *rgb)
{
    const KrsWindow *window = &picture->window;
    Developing       by = {.tone_map = options->tone_map, .gain = exp2(options->exposure)};
    bool             usual = fabs(options->exposure) < 100; /* else floats may not have it */
    by.certain = usual ? 0.498f : -1; /* ten times what single precision is known to differ by */
    lines_fill(by.lines);
    for (uint32_t y = 0; y < window->height; y++)
        for (uint32_t x = 0; x < window->width; x += RUN) {
            size_t first = (size_t)y * window->width + x, left = window->width - x;
            develop_run(&by, &picture->color[4 * first], left < RUN ? left : RUN,
                        (double)window->x + x, (double)window->y + y, rgb + 3 * first);
        }
}
