/*
 * grid_refine.h: the grid of a blend, with smaller cells, and lists of those instances alone that change the
 * blend in a cell.
 */
#ifndef KRS_GRID_REFINE_H
#define KRS_GRID_REFINE_H

#include "compiler/graph/instances/grid_blend.h"

/*
 * Refines a coarse grid: each cell becomes GRID_REFINED cells.  In each of them the instances of
 * its list make the same of all points as all instances of the coarse list do, where that is less
 * than the clearance.  Elsewhere that is no less than the clearance.
 */
void grid_refine(Grid *refined, const Grid *coarse, const GridBlend *blend, Arena *arena,
                 Arena *scratch);

/* Lists of refined cells are empty where results are no less than this. */
double grid_empty_from(const GridBlend *blend, const Grid *coarse);

#endif
