/*
 * grid_sift.h: a coarse grid for a blend whose reach is far, or infinite.
 */
#ifndef KRS_GRID_SIFT_H
#define KRS_GRID_SIFT_H

#include "compiler/graph/instances/grid_blend.h"

/* Makes a grid that is to be refined (grid_refine.h).  Its lists, which are in the arena `scratch`,
   are found by halving a cube around all.  False: that would take too long. */
bool grid_sift(Grid *coarse, const Box *boxes, uint32_t count, const GridBlend *blend,
               Arena *scratch);

#endif
