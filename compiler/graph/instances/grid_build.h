/*
 * grid_build.h: builds grids of boxes (graph/grid.h).
 */
#ifndef KRS_GRID_BUILD_H
#define KRS_GRID_BUILD_H

#include "compiler/graph/grid.h"

/*
 * Builds a grid of `count` boxes, at least one.  The clearance is more than `margin`, by a part of a cell,
 * wherever a list does not have all instances, and NOWHERE where it does: taps for normals need more.  Where a box or
 * the margin is infinite there is one cell for all of space, its size is infinite, and its list has all
 * instances.  Empty boxes are in no list.  Shaders read `texels` of 16 bytes for each entry of a list, at
 * least one: the more, the fewer entries there are.
 */
void grid_build(Grid *grid, const Box *boxes, uint32_t count, double reach, double margin,
                uint32_t texels, Arena *arena, Arena *scratch);

/* The limits of a grid: cells, and entries of all lists together. */
typedef struct GridLimits {
    double cells, entries;
} GridLimits;

/* Returns the limits of a grid that is built for each frame, of so many boxes. */
GridLimits grid_limits_of_frame(uint32_t count);

/* Does the same as grid_build, within limits that one cell for all is always within. */
void grid_build_within(Grid *grid, const Box *boxes, uint32_t count, double reach, double margin,
                       GridLimits most, Arena *arena, Arena *scratch);

/*
 * Does the same with large cells, for grid_refine.  False: all of space would be one cell, or lists
 * would be so long that refining them takes too long; then there is no grid.
 */
bool grid_build_coarse(Grid *grid, const Box *boxes, uint32_t count, double reach, double margin,
                       Arena *arena, Arena *scratch);

/* The cells that a cell becomes when a grid is refined, along each axis and in all. */
enum { GRID_REFINED_ALONG = 4, GRID_REFINED = 64 };

/* Instances in the plane z = 0, of which the nearest one decides. */
typedef struct GridInstances {
    double (*distance)(const void *instances, uint32_t instance, const double point[2]);
    const void *instances;
} GridInstances;

/*
 * Does the same for instances in that plane, with one layer of cells.  Where something is so near
 * to a cell that it may be in it, the list has all instances that are nearest anywhere in the cell;
 * its clearance is NOWHERE. So no instance is in a cell with another clearance.
 */
void grid_build_flat(Grid *grid, const Box *boxes, uint32_t count, double margin, uint32_t texels,
                     GridInstances instances, Arena *arena, Arena *scratch);

bool grid_box_is_empty(const Box *box);

/* ---- for grids of blends: grid_refine.c, grid_sift.c ---- */

#define FLOAT_MISSES 0x1p-21 /* several roundings in single precision, of coordinates */
#define ROUNDED_DOWN (1 - 0x1p-22)

/* Lists are filled in three steps: first[] has the length of each; between these two the next place in it. */
void grid_begin_lists(Grid *grid, Arena *arena);
void grid_end_lists(Grid *grid);

/* Finds where the cells, or few, of a grid are that will be refined; false: there are too many
   boxes, or one is endless. */
bool grid_place_coarse(Grid *grid, const Box *boxes, uint32_t count, double reach, double margin,
                       bool few, Arena *scratch);

#endif
