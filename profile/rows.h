/*
 * rows.h: from what is known of each part to the rows of a profile.
 */
#ifndef KRS_PROFILE_ROWS_H
#define KRS_PROFILE_ROWS_H

#include "profile/types.h"

/* The costs of a part.  An heir is what others are cut from, or cut to: without it nothing is left
   of the part around it, so that cannot tell what it costs.  It gets what the others leave. */
typedef struct PartProfile {
    bool     heir;
    bool     asked, compiled, timed; /* asked: it is shown, or in a part that was opened */
    double   expected, saved, ms;    /* shares of the frame, and milliseconds */
    PartCost cost;
} PartProfile;

/* Takes what another part adds from what one does. */
void part_cost_subtract(PartCost *cost, const PartCost *other);
/* Makes the rows: a part that has parts with rows leaves its place to them, and to the rest of it.  `profile` has the
   whole. */
void profile_rows(const Parts *parts, const PartProfile *found, Arena *arena, Profile *profile);

#endif
