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

/* Khronos PBR Neutral (2024): takes back the 4 % that a dielectric reflects head-on, leaves
   colours alone up to 0.76 and compresses and whitens what is brighter. */
static void apply_neutral(const double color[3], double out[3])
{
    const double start = 0.8 - 0.04, desaturation = 0.15;
    double least = fmin(color[0], fmin(color[1], color[2]));
    double offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
    double peak = fmax(color[0], fmax(color[1], color[2])) - offset;
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
    double film[3];
    multiply(into, color, film);
    for (int i = 0; i < 3; i++) {
        double v = film[i];
        film[i] = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    }
    multiply(back, film, out);
}

static double clamp_unit(double value) { return value > 0 ? fmin(value, 1) : 0; }

void tone_map_apply(ToneMap tone_map, const double color[3], double out[3])
{
    /* Far beyond any curve's shoulder: keeps infinity from becoming a quotient of infinities. */
    const double brightest = 1e9;
    double light[3];
    for (int i = 0; i < 3; i++)
        light[i] = color[i] > 0 ? fmin(color[i], brightest) : 0;
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

/* Interleaved gradient noise (Jimenez 2014) in [0, 1): over any few neighbouring pixels its
   values are spread evenly, so that dithered areas keep their mean without clumps. */
static double noise(double x, double y)
{
    double wave = 0.06711056 * x + 0.00583715 * y;
    double value = 52.9829189 * (wave - floor(wave));
    return value - floor(value);
}

void film_to_srgb8(const KrsPicture *picture, const FilmOptions *options, uint8_t *rgb)
{
    const KrsWindow *window = &picture->window;
    const double     gain = exp2(options->exposure);
    for (uint32_t y = 0; y < window->height; y++)
        for (uint32_t x = 0; x < window->width; x++) {
            size_t       index = (size_t)y * window->width + x;
            const float *from = &picture->color[4 * index];
            const double light[3] = {gain * from[0], gain * from[1], gain * from[2]};
            double       shown[3];
            tone_map_apply(options->tone_map, light, shown);
            for (int i = 0; i < 3; i++) {
                /* The channels' noise differs, by a shift, so that greys are dithered finer. */
                double step = noise(window->x + x + 47.0 * i, window->y + y + 17.0 * i);
                rgb[3 * index + i] = (uint8_t)(255 * srgb_encode(shown[i]) + step);
            }
        }
}
