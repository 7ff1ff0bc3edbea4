/*
 * false_color.h: what else than light a picture may show.
 */
#ifndef KRS_FALSE_COLOR_H
#define KRS_FALSE_COLOR_H

#include "krs/vulkan.h"

typedef enum ShadingMode {
#define SHADING_MODE(id, name, about) SHADING_##id,
#include "live/pictures/shading_modes.def"
#undef SHADING_MODE
    SHADING_COUNT
} ShadingMode;
extern const char *const shading_mode_names[SHADING_COUNT];

/* Fills four bytes for each pixel of a picture with all AOVs; `shading` is not SHADING_LIGHT.
   `slopes` has a number for each pixel, for SHADING_SLOPE alone. */
void false_color(const KrsPicture *picture, ShadingMode shading, const float *slopes,
                 uint8_t *pixels);
/* Fills four bytes for a part of the most: dark blue, magenta, orange, yellow, each brighter than
   the one before. */
void heat_color(double part, uint8_t pixel[4]);

#endif
