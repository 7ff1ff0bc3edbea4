/*
 * pixels.h: which part is seen at each pixel: one without which something else is.
 */
#ifndef KRS_PROFILE_PIXELS_H
#define KRS_PROFILE_PIXELS_H

#include "profile/rows.h"

typedef struct Pixels {
    size_t  count;
    size_t *part;    /* of each pixel, or NO_PART */
    size_t *changed; /* by each part: how many pixels show something else without it, */
    size_t *depth;   /* and how many parts are around it */
} Pixels;

Pixels pixels_new(size_t count, const Parts *parts, Arena *arena);
/* Takes pixels for a part, whose depths are others in a picture without it.  Where several parts could have one, it is
   that of the innermost, then of the one with the fewest. */
void pixels_take(Pixels *pixels, const KrsPicture *whole, const KrsPicture *without, size_t part);
/* Returns the row of each pixel from 1, which may be that of a part around the one that is seen; 0:
   none. */
uint32_t *pixels_rows(const Pixels *pixels, const Parts *parts, const PartProfile *found,
                      const Profile *profile, Arena *arena);

#endif
