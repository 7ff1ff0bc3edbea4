/*
 * lane_cuts.h: max(a, 0) + min(a, 0), which is a.
 *
 * The distance to a box adds a length outside and a maximum inside.  On one of its faces they are the two
 * parts of the same number, so the sum is as smooth as that is.
 */
#ifndef KRS_LANE_CUTS_H
#define KRS_LANE_CUTS_H

#include "compiler/graph/lanes/lanes.h"

/* Returns the operand of a length that alone is not 0 all over the box of the ranges; NODE_NONE:
   there is no such. */
uint32_t lane_only_operand(const LaneTape *tape, const LaneRanges *ranges, const LaneStep *step);
/* Returns the number that a sum of two parts is; NODE_NONE: it is no such sum. */
uint32_t lane_sum_of_cuts(const LaneTape *tape, const LaneRanges *ranges, const LaneStep *step);

#endif
