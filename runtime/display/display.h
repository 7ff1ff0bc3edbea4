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

/* Converts the picture's window to 8-bit sRGB, 3 or 4 bytes a pixel; the fourth is 255.  Dithering
   hides the steps between levels; it depends only on the pixel's position in the whole picture.
   The picture must have the colour AOV. */
void display_to_srgb8(const KrsPicture *picture, const DisplayOptions *options, uint32_t channels,
                      uint8_t *pixels);

#endif
