/*
 * lane_outlines.h: what is known of the distance to an outline in a box: which of its curves may be the nearest,
 * and, where only one may, how the distance changes.
 */
#ifndef KRS_LANE_OUTLINES_H
#define KRS_LANE_OUTLINES_H

#include "compiler/graph/lanes/lanes.h"

/* Finds, after a run over a box, the instances that may be the nearest in it, of the call that is
   step `step`.  False: it is no outline, or there are more of them. */
bool lane_outline_instances(const LaneTape *tape, const LaneRanges *ranges, size_t step,
                            uint32_t instances[MAX_LANE_INSTANCES], uint32_t *count);
/* The straight instances that come near a box, if there is one, or two that meet.  A line is by x, by y and what is added; it
   is a distance, below 0 inside. */
typedef struct OutlineLines {
    double   lines[2][3];
    uint32_t count;
    bool     convex; /* where two meet: the inside is where both are below 0, else where one is */
} OutlineLines;
/* Finds the lines after a run over a box.  In the box the distance less `level` has the sign that
   the greater of the lines less `level`, or at a reflex corner the lesser, has; if the level is not
   above 0 at a convex corner, nor below at a reflex one.  False: more come near than that, or they
   are curved. */
bool lane_outline_lines(const LaneTape *tape, const LaneRanges *ranges, size_t step, double level,
                        OutlineLines *lines);

/* The derivatives of a distance by x and y of the point of the call. */
typedef struct OutlinePartials {
    Range first[2], second[2][2]; /* second[1][0] is not set */
    bool  known;
} OutlinePartials;
OutlinePartials lane_outline_partials(const LaneTape *tape, const LaneRanges *ranges, size_t step);

#endif
