/*
 * tone_maps.h: curves from light, [0, infinity), to what a screen shows, [0, 1]: the rows of
 * choices.def.
 */
#ifndef KRS_TONE_MAPS_H
#define KRS_TONE_MAPS_H

#include <stdbool.h>

typedef enum ToneMap {
#define KRS_TONE_MAP(id, name, about) TONE_##id,
#include "krs/choices.def"
    TONE_MAP_COUNT
} ToneMap;

/* Finds a curve; false when none has that name. */
bool tone_map_find(const char *name, ToneMap *tone_map);

/* Applies a curve to a linear Rec.709 colour.  Each component of the result is in [0, 1], and 0
   where the colour's is NaN. */
void tone_map_apply(ToneMap tone_map, const double color[3], double out[3]);

#endif
