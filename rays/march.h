/*
 * march.h: a tile that is marched.
 */
#ifndef KRS_RAYS_MARCH_H
#define KRS_RAYS_MARCH_H

#include "compiler/graph/lanes/lane_cells.h"
#include "rays/lanes.h"

/* A cell that rays are in: its tape gives distances, in the rows of the work of this depth. */
typedef struct RayCell {
    const CellTape *tape;
    CellWork       *work;
    uint32_t        depth;
} RayCell;

static inline const float *ray_cell_run(const RayCell *cell, const float points[3][RAYS_OF_BLOCK])
{
    return cell_run(cell->tape, cell->work, cell->depth, (const float(*)[CELL_LANES])points);
}

/* normals.c: how far from hits at t, in parts of the reach of differences there, distances are asked for. */
#define TAPS_REACH 2.5f
/* Returns that reach where a pixel is so wide, and no coordinate is larger. */
float ray_normal_reach(const RayRule *rule, float width, float t, float largest);
/* Finds the normals of the rays that have hit since `before`, which has the states of then.  Returns how many
   distances were evaluated. */
uint64_t ray_normals(const RayCell *cell, const RayRule *rule, RayBlock *block,
                     const bool hits[RAYS_OF_BLOCK]);

#endif
