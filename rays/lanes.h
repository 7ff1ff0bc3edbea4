/*
 * lanes.h: what is done with all rays of a block at once, by each instruction set.
 */
#ifndef KRS_RAYS_LANES_H
#define KRS_RAYS_LANES_H

#include "rays/rays.h"

enum { RAY_SUMS = 7, RAY_SPREADS = 4 };

typedef struct RaySet {
    const char *name; /* as of LaneSet */
    /* Finds where the distance is evaluated next, at `last` at the farthest; returns how many rays
       march before that. */
    uint32_t (*place)(const RayBlock *block, float last, float at[RAYS_OF_BLOCK],
                      float points[3][RAYS_OF_BLOCK]);
    /* Takes the distances there, which are right up to the cap and change so fast at most. */
    void (*take)(RayBlock *block, const RayRule *rule, const float at[RAYS_OF_BLOCK], float last,
                 float cap, float slope, const float distances[RAYS_OF_BLOCK]);
    /* Nothing is before `last`. */
    void (*skip)(RayBlock *block, float last);
    /* Takes the distances for rays of hits. */
    void (*take_blocked)(RayBlock *block, const BlockRule *rule, const float at[RAYS_OF_BLOCK],
                         const float distances[RAYS_OF_BLOCK]);
    /* Adds up origins and directions of rays that march, and of those beside, and counts them. */
    void (*sum)(const RayBlock *block, float sums[RAY_SUMS][RAYS_OF_BLOCK]);
    /* Finds the greatest squares of how far these origins and directions are from given ones, and the widest pixels. */
    void (*spread)(const RayBlock *block, const float origin[3], const float direction[3],
                   float most[RAY_SPREADS][RAYS_OF_BLOCK]);
    /* Tells whether some ray marches between. */
    bool (*has)(const RayBlock *block, float first, float last);
} RaySet;

extern const RaySet ray_set_plain, ray_set_avx2, ray_set_avx512;
/* Returns the set of the instruction set that lane tapes are run by. */
const RaySet *ray_set_of_lanes(void);

#endif
