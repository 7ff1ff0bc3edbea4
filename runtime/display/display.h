/*
 * display.h: from scene-linear light to what a screen shows.
 */
#ifndef KRS_DISPLAY_H
#define KRS_DISPLAY_H

#include "runtime/display/white_balance.h"
#include "krs/vulkan.h"

/* Curves from [0, infinity) to [0, 1]. */
typedef enum ToneMap {
#define TONE_MAP(id, name, about) TONE_##id,
#include "runtime/display/tone_maps.def"
#undef TONE_MAP
    TONE_MAP_COUNT
} ToneMap;
extern const char *const tone_map_names[TONE_MAP_COUNT]; /* "neutral", "aces" and so on */

typedef struct DisplayOptions {
    ToneMap      tone_map;
    double       exposure; /* in stops */
    WhiteBalance white_balance;
} DisplayOptions;

/* False when no curve has that name. */
bool tone_map_find(const char *name, ToneMap *tone_map);

/* Applies a curve to a linear Rec.709 colour.  Each component of the result is in [0, 1], and 0
   where the colour's is NaN. */
void tone_map_apply(ToneMap tone_map, const double color[3], double out[3]);

/* The sRGB transfer function, [0, 1] to [0, 1]. */
double srgb_encode(double linear);

/* Converts the picture's window to 8-bit sRGB, three bytes a pixel.  Dithering hides the steps
   between levels; it depends only on the pixel's position in the whole picture.  The picture must
   have the colour plane. */
void display_to_srgb8(const KrsPicture *picture, const DisplayOptions *options, uint8_t *rgb);
/* The same with this many bytes a pixel, 3 or 4; the fourth is 255. */
void display_to_channels(const KrsPicture *picture, const DisplayOptions *options,
                         uint32_t channels, uint8_t *pixels);

#endif
