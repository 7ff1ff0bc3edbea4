/*
 * lane_waves.h: how far a number is from the nearest multiple of a period, abs(a - c round(a / c)).
 *
 * Ranges of its steps alone know nothing of it in a box where the nearest multiple changes.
 */
#ifndef KRS_LANE_WAVES_H
#define KRS_LANE_WAVES_H

#include "compiler/graph/lanes/lanes.h"

typedef struct LaneWave {
    /* The operand `a`; NODE_NONE: it is no such distance, or ranges do not bound `a`. */
    uint32_t number;
    /* The nearest multiples are from `first` to `last` times the period. */
    double period, first, last;
} LaneWave;

/* Returns the wave that a step is in the box of a run of ranges. */
LaneWave lane_wave(const LaneTape *tape, const LaneRanges *ranges, const LaneStep *step);
/* Returns the range of a step, once those of the steps before are known; ANYTHING: it is no such
   distance. */
Range lane_wave_range(const LaneTape *tape, const LaneRanges *ranges, const LaneStep *step);

#endif
