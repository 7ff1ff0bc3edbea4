/*
 * waves.h: rays of hits, to lights and from mirrors, that are marched together.
 */
#ifndef KRS_RAYS_WAVES_H
#define KRS_RAYS_WAVES_H

#include "rays/lanes.h"
#include "rays/space.h"

/* Blocks of such rays, all of which go by one step at a time. */
typedef struct Wave {
    RayField        *field;
    size_t           part;
    Space           *space;
    CellWork        *work;
    const BlockRule *rule; /* of rays that are blocked or not */
    const RayRule *march; /* of rays that look for surfaces; NULL: these do not, and go by `rule` */
    RayBlock      *blocks;
    uint64_t       evaluations;
    float          at[BLOCKS_OF_WAVE][RAYS_OF_BLOCK], points[BLOCKS_OF_WAVE][3][RAYS_OF_BLOCK],
        distances[BLOCKS_OF_WAVE][RAYS_OF_BLOCK];
    bool     marched[BLOCKS_OF_WAVE][RAYS_OF_BLOCK]; /* of rays of hits: they were to be marched, */
    float    ends[BLOCKS_OF_WAVE][RAYS_OF_BLOCK];    /* as far as here */
    int32_t *first_rays; /* of each cube: the first of those that ask now; -1: none */
    int32_t  next[BLOCKS_OF_WAVE * RAYS_OF_BLOCK];              /* ray in the same cube; -1: none */
    uint32_t cubes[BLOCKS_OF_WAVE * RAYS_OF_BLOCK], cube_count; /* that rays are in */
    uint32_t live[BLOCKS_OF_WAVE], live_count;                  /* blocks with rays that march */
} Wave;

#endif
