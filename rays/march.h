/*
 * march.h: rays that look for surfaces.
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

static inline const float *ray_cell_run_wide(const RayCell *cell, float points[3][CELL_WIDE],
                                             size_t blocks)
{
    return cell_run_wide(cell->tape, cell->work, cell->depth, (const float(*)[CELL_WIDE])points,
                         blocks);
}

/* Begins the rays of a block. */
void ray_begin_block(const RayRule *rule, RayBlock *block);
/* Ends those that have hit nothing, or meet their plane.  Returns how many distances were evaluated. */
uint64_t ray_end_block(const RayField *field, size_t part, const RayRule *rule, RayBlock *block);

/* normals.c: how far from hits at t, in parts of the reach of differences there, distances are asked for. */
#define TAPS_REACH 2.5f
/* Returns that reach where a pixel is so wide, and no coordinate is larger. */
float ray_normal_reach(const RayRule *rule, float width, float t, float largest);
typedef struct RayHit {
    RayBlock *block;
    int       lane;
} RayHit;
/* Finds the normals of rays that have hit.  Returns how many distances were evaluated. */
uint64_t ray_normals(const RayCell *cell, const RayRule *rule, const RayHit *hits, size_t count);

#endif
