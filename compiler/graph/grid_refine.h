/*
 * grid_refine.h: the grid of a blend, with smaller cells, and lists of those members alone that change the
 * blend in a cell.
 */
#ifndef KRS_GRID_REFINE_H
#define KRS_GRID_REFINE_H

#include "compiler/graph/grid.h"
#include "compiler/graph/lanes.h"

/* How the members of a grid are joined, one after the other. */
typedef struct GridBlend {
    Op              op;      /* a smooth minimum of which the slope is 1 (blends.def), */
    double          width;   /* and its width */
    const LaneTape *tape;    /* its output is the distance of a member, */
    double         *scalars; /* with these scalars: tape->scalar_count for each */
    double          slope;   /* of all distances */
    double acts;   /* a member that is farther above what those before it make changes nothing */
    double reach;  /* as of the grid */
    double margin; /* likewise, as it was given */
} GridBlend;

/*
 * Each cell of a coarse grid becomes GRID_REFINED cells.  In each of them the members of its list make the
 * same of all points as all members of the coarse list do, where that is less than the clearance.  Elsewhere
 * that is no less than the clearance.
 */
void grid_refine(Grid *refined, const Grid *coarse, const GridBlend *blend, Arena *arena,
                 Arena *scratch);

#endif
