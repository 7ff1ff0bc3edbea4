/*
 * false_color.c: depth, normals, numbers and steps as colours.
 */
#include "live/pictures/false_color.h"

#include <math.h>

const char *const shading_mode_names[SHADING_COUNT] = {
#define SHADING_MODE(id, name, about) name,
#include "live/pictures/shading_modes.def"
#undef SHADING_MODE
};

/* The least and the greatest of what a picture shows; and the depth in the middle. */
typedef struct Range {
    double low, high, middle;
} Range;

static void set(uint8_t *pixel, double r, double g, double b)
{
    const double rgb[3] = {r, g, b};
    for (int i = 0; i < 3; i++)
        pixel[i] = (uint8_t)(255 * fmin(fmax(rgb[i], 0), 1) + 0.5);
    pixel[3] = 255;
}

void heat_color(double part, uint8_t pixel[4])
{
    static const double colors[4][3] = {
        {0.05, 0.03, 0.25}, {0.55, 0.10, 0.50}, {0.95, 0.45, 0.25}, {0.98, 0.95, 0.55}};
    const double at = fmin(fmax(part, 0), 1) * 3;
    const int    i  = at < 2.999 ? (int)at : 2;
    const double t  = at - i;
    set(pixel, colors[i][0] + t * (colors[i + 1][0] - colors[i][0]),
        colors[i][1] + t * (colors[i + 1][1] - colors[i][1]),
        colors[i][2] + t * (colors[i + 1][2] - colors[i][2]));
}

/* Hues by the golden ratio: numbers next to each other are far apart. */
static void set_number(uint8_t *pixel, uint32_t number, double shade)
{
    double       whole;
    const double hue = modf(number * 0.61803398875 + 0.1, &whole) * 2 * M_PI;
    set(pixel, shade * (0.6 + 0.35 * cos(hue)), shade * (0.6 + 0.35 * cos(hue - 2.1)),
        shade * (0.6 + 0.35 * cos(hue + 2.1)));
}

/* Returns the geometric mean of the depths, or 1. */
static double middle_depth(const KrsPicture *picture)
{
    double       sum = 0, used = 0;
    const size_t count = (size_t)picture->window.width * picture->window.height;
    for (size_t i = 0; i < count; i++)
        if (isfinite(picture->depth[i]) && picture->depth[i] > 0) {
            sum += log(picture->depth[i]);
            used++;
        }
    return used > 0 ? exp(sum / used) : 1;
}

/* Shows depths by a number that grows with them up to 1: a floor to the horizon leaves the differences of what
   is near. */
static double value_at(const KrsPicture *picture, ShadingMode shading, double middle, size_t at)
{
    const double depth = fmax(picture->depth[at], 0);
    return shading == SHADING_DEPTH    ? depth / (depth + middle)
           : shading == SHADING_LEVELS ? picture->level[at]
                                       : picture->steps[at];
}

static Range find_range(const KrsPicture *picture, ShadingMode shading)
{
    Range range = {INFINITY, -INFINITY, shading == SHADING_DEPTH ? middle_depth(picture) : 1};
    const size_t count = (size_t)picture->window.width * picture->window.height;
    for (size_t i = 0; i < count; i++) {
        const double value = value_at(picture, shading, range.middle, i);
        if (!isfinite(value))
            continue;
        range.low  = fmin(range.low, value);
        range.high = fmax(range.high, value);
    }
    return range;
}

/* Returns a grey by how much a surface faces the viewer, which shows its shape where the colour is flat. */
static double shade_of(const KrsPicture *picture, size_t at)
{
    const float *n = &picture->normal[3 * at];
    const double z = n[0] * picture->world_to_camera[0][2] + n[1] * picture->world_to_camera[1][2] +
                     n[2] * picture->world_to_camera[2][2];
    return 0.35 + 0.65 * fabs(z);
}

static void color_pixel(const KrsPicture *picture, ShadingMode shading, Range range, size_t at,
                        double slope, uint8_t *pixel)
{
    const float *n    = &picture->normal[3 * at];
    const double size = fmax(range.high - range.low, 1e-9);
    const double part = (value_at(picture, shading, range.middle, at) - range.low) / size;
    if (shading == SHADING_STEPS)
        heat_color(part, pixel);
    else if (picture->component[at] == 0)
        set(pixel, 0.09, 0.095, 0.1);
    else if (shading == SHADING_DEPTH)
        set(pixel, 1 - 0.9 * part, 1 - 0.9 * part, 1 - 0.9 * part);
    else if (shading == SHADING_NORMALS)
        set(pixel, 0.5 + 0.5 * n[0], 0.5 + 0.5 * n[1], 0.5 + 0.5 * n[2]);
    else if (shading == SHADING_LEVELS)
        heat_color(part, pixel);
    else if (shading == SHADING_SLOPE)
        heat_color(slope, pixel);
    else
        set_number(pixel,
                   shading == SHADING_COMPONENTS ? picture->component[at] : picture->instance[at],
                   shade_of(picture, at));
}

void false_color(const KrsPicture *picture, ShadingMode shading, const float *slopes,
                 uint8_t *pixels)
{
    const Range  range = find_range(picture, shading);
    const size_t count = (size_t)picture->window.width * picture->window.height;
    for (size_t i = 0; i < count; i++)
        color_pixel(picture, shading, range, i, slopes ? slopes[i] : 0, pixels + 4 * i);
}
