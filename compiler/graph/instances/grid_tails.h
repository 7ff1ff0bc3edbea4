/*
 * grid_tails.h: lists of a blend that fades, from the nearest instances on, so that loops may end early.
 *
 * Such a blend is the width times -log of the sum of e^(-d / width) over the distances d.  Of a cell with a list, `middles`
 * has the result in its middle, m.  `tails` has for each entry what it and all entries behind it make of the sum of
 * e^((m - d) / width) there.  Away from the middle a sum grows by the factor e^(slope * way / width) at most.
 */
#ifndef KRS_GRID_TAILS_H
#define KRS_GRID_TAILS_H

#include "compiler/graph/instances/grid_blend.h"

/* Tells whether sums are numbers of single precision anywhere in a cell of this size. */
bool grid_may_have_tails(const GridBlend *blend, double size);

/* Sorts the lists of a refined grid and finds its tails; `tails` has the distances of instances in the middles of cells before.  Single precision
   may find a point of a cell so far outside. */
void grid_find_tails(Grid *refined, const GridBlend *blend, double pad, Arena *arena,
                     Arena *scratch);

#endif
