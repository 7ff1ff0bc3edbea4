/*
 * overlap.h: how many boxes have a point in common.
 */
#ifndef KRS_OVERLAP_H
#define KRS_OVERLAP_H

#include <stdint.h>

#include "compiler/base/arena.h"
#include "compiler/graph/range.h"

/* Returns the most boxes around one point when each is larger by `grown` on every side, or somewhat
   more: it is found in time that is about linear.  Empty boxes are around none. */
uint32_t max_overlap(const Box *boxes, uint32_t count, double grown, Arena *scratch);

#endif
