/*
 * false_color.h: what else than light a picture may show.
 */
#ifndef KRS_FALSE_COLOR_H
#define KRS_FALSE_COLOR_H

#include "krs/vulkan.h"

typedef enum Look {
#define LOOK(id, name, about) LOOK_##id,
#include "live/pictures/looks.def"
#undef LOOK
    LOOK_COUNT
} Look;
extern const char *const look_names[LOOK_COUNT];

/* Four bytes for each pixel of a picture with all planes; `look` is not LOOK_LIGHT.  `slopes` has a
   number for each pixel, for LOOK_SLOPE alone. */
void false_color(const KrsPicture *picture, Look look, const float *slopes, uint8_t *pixels);

#endif
