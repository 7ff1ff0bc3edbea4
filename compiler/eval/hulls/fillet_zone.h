/*
 * fillet_zone.h: where a fillet can add something to two parts.
 */
#ifndef KRS_FILLET_ZONE_H
#define KRS_FILLET_ZONE_H

#include "compiler/eval/elaborate.h"

/* A ball. */
typedef struct ZoneCell {
    double centre[3], radius;
} ZoneCell;

/* A box; and, where the parts are known now, balls that hold all that is added. */
typedef struct FilletZone {
    Box  box;
    bool known;
    struct {
        ZoneCell *items;
        size_t    count, capacity;
    } cells;
} FilletZone;

/* Finds a box outside of which the circular blend of two parts does not differ from their union.  It looks at
   `most` points. */
FilletZone fillet_zone(Elaboration *e, const Shape *a, const Shape *b, double width, Box box,
                       size_t most);
/* Tells whether a convex function of the point, with slope 1, may be above 0 there. */
bool zone_goes_beyond(Elaboration *e, const FilletZone *zone, Node distance);
/* Does the same of dot(normal, p) - offset, in numbers. */
bool zone_goes_beyond_plane(const FilletZone *zone, const double normal[3], double offset);

#endif
