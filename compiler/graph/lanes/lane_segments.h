/*
 * lane_segments.h: distances to segments, which have no corners but at the segments themselves.
 *
 * They are |q - t d|, where t = q.d / d.d is clamped.  Where t meets the end of its range the derivative of t d jumps
 * along d, at a right angle to q - t d: so the derivative of the length does not jump.
 */
#ifndef KRS_LANE_SEGMENTS_H
#define KRS_LANE_SEGMENTS_H

#include "compiler/graph/lanes/lanes.h"

/* Finds the components of q, if a step is such a length: its derivatives are those of |q - t d|
   with t held where it is.  False: it is none. */
bool lane_from_segment(const LaneTape *tape, const LaneStep *step, uint32_t from[MAX_OPERANDS]);

#endif
