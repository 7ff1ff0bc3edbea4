/*
 * display.h: from scene-linear light to what a screen shows.
 */
#ifndef KRS_DISPLAY_H
#define KRS_DISPLAY_H

#include "runtime/display/tone_maps.h"
#include "runtime/display/white_balance.h"
#include "krs/vulkan.h"

typedef struct DisplayOptions {
    ToneMap      tone_map;
    double       exposure; /* in stops */
    WhiteBalance white_balance;
} DisplayOptions;

/* Returns the sRGB transfer function, [0, 1] to [0, 1]. */
double srgb_encode(double linear);

/* Converts the picture's window to 8-bit sRGB, three bytes a pixel.  Dithering hides the steps
   between levels; it depends only on the pixel's position in the whole picture.  The picture must
   have the colour AOV. */
void display_to_srgb8(const KrsPicture *picture, const DisplayOptions *options, uint8_t *rgb);
/* Does the same with this many bytes a pixel, 3 or 4; the fourth is 255. */
void display_to_channels(const KrsPicture *picture, const DisplayOptions *options,
                         uint32_t channels, uint8_t *pixels);

#endif
