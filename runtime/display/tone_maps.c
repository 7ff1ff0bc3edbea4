/*
 * tone_maps.c: tone maps, a function each.
 *
 * curve_NAME gets numbers from 0 to BRIGHTEST.  What it gives is cut to [0, 1].
 */
#include "runtime/display/tone_maps.h"

#include <math.h>
#include <string.h>

#include "compiler/base/minmax.h"
#include "runtime/display/white_balance.h"

/* Far beyond any curve's shoulder.  It keeps infinity from becoming infinity / infinity. */
static const double BRIGHTEST = 1e9;

/* Khronos PBR Neutral (2024).  It subtracts the 4 % that a dielectric reflects head-on, leaves
   colours up to 0.76 as they are, and compresses and whitens brighter ones. */
static void curve_neutral(const double color[3], double out[3])
{
    const double start = 0.8 - 0.04, desaturation = 0.15;
    double       least  = min2(color[0], min2(color[1], color[2]));
    double       offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
    double       peak   = max2(color[0], max2(color[1], color[2])) - offset;
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

static void curve_aces(const double color[3], double out[3])
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
    color_multiply(into, color, curved);
    for (int i = 0; i < 3; i++) {
        double v  = curved[i];
        curved[i] = (v * (v + 0.0245786) - 0.000090537) /
                    (v * (0.983729 * v + 0.4329510) + 0.238081);
    }
    color_multiply(back, curved, out);
}

/* Returns the curve of AgX over the logarithm of light; the sigmoid of the original has no simple
   powers. */
static double agx_curve(double x)
{
    return -0.00232 +
           x * (0.1191 + x * (0.4298 + x * (-6.868 + x * (31.96 + x * (-40.14 + x * 15.5)))));
}

/* Returns the logarithm of light, which is cut to 10 stops below middle grey (0.18) and 6.5 above. */
static double agx_logarithm(double light)
{
    const double low = -12.47393, high = 4.026069;
    double       stops = log2(max2(light, 1e-10));
    return (min2(max2(stops, low), high) - low) / (high - low);
}

/* The matrices go to Rec.2020 and to a narrower gamut within, and back to a wider one. */
static void curve_agx(const double color[3], double out[3])
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
    color_multiply(wide, color, in_wide);
    color_multiply(inset, in_wide, curved);
    for (int i = 0; i < 3; i++)
        curved[i] = agx_curve(agx_logarithm(curved[i]));
    color_multiply(outset, curved, shown);
    for (int i = 0; i < 3; i++)
        shown[i] = pow(max2(shown[i], 0), 2.2);
    color_multiply(narrow, shown, out);
}

static void curve_none(const double color[3], double out[3])
{
    memcpy(out, color, 3 * sizeof *out);
}

/* ---- all of them ---- */

static const struct {
    const char *name;
    void (*curve)(const double color[3], double out[3]);
} tone_maps[TONE_MAP_COUNT] = {
#define KRS_TONE_MAP(id, name, about) {#name, curve_##name},
#include "krs/choices.def"
};

bool tone_map_find(const char *name, ToneMap *tone_map)
{
    for (int i = 0; i < TONE_MAP_COUNT; i++)
        if (strcmp(name, tone_maps[i].name) == 0) {
            *tone_map = (ToneMap)i;
            return true;
        }
    return false;
}

static double clamp_unit(double value) { return value > 0 ? min2(value, 1) : 0; }

void tone_map_apply(ToneMap tone_map, const double color[3], double out[3])
{
    double light[3];
    for (int i = 0; i < 3; i++)
        light[i] = color[i] > 0 ? min2(color[i], BRIGHTEST) : 0;
    tone_maps[tone_map].curve(light, out);
    for (int i = 0; i < 3; i++)
        out[i] = clamp_unit(out[i]);
}
