/*
 * rays.h: rays of a scene by lanes of the host, without shaders.
 *
 * A tile has blocks of rays that are near each other.  It is marched slab by slab: in each slab of depth the tile, then
 * its quarters, then theirs are balls of space, with short tapes of their own (graph/lanes/lane_cells.h).
 * A ray goes on as by runtime/shaders/march_step.glsl, where the march is described: what is hit is the same, but for
 * rounding and within the permitted error.
 */
#ifndef KRS_RAYS_RAYS_H
#define KRS_RAYS_RAYS_H

#include <stddef.h>
#include <stdint.h>

#include "krs/krs.h"

/* A tile is as many blocks at most; a quarter of it, and a quarter of that, are consecutive. */
enum { RAYS_OF_BLOCK = 16, BLOCKS_OF_TILE = 256 };
/* Rays of hits come in waves of as many blocks at most. */
enum { BLOCKS_OF_WAVE = 1024 };

/* RAY_IS_BESIDE: nobody asks for it, but cells are as wide as if somebody did, so that others do not depend on that. */
typedef enum RayState {
    RAY_MARCHES,
    RAY_HITS,
    RAY_MISSES,
    RAY_REFINES,
    RAY_IS_ABSENT,
    RAY_IS_BESIDE
} RayState;

/* A lane for each ray. */
typedef struct RayBlock {
    float origin[3][RAYS_OF_BLOCK], direction[3][RAYS_OF_BLOCK]; /* unit */
    /* Nothing is before the start, and nothing is asked behind the end; where a plane is met that is no part of the
       distance, infinite: nowhere. */
    float start[RAYS_OF_BLOCK], end[RAYS_OF_BLOCK], plane[RAYS_OF_BLOCK];
    float width[RAYS_OF_BLOCK], spread[RAYS_OF_BLOCK]; /* of a pixel: width + spread t */
    /* The results. */
    uint32_t state[RAYS_OF_BLOCK],
        steps[RAYS_OF_BLOCK]; /* before: RAY_MARCHES, _IS_ABSENT or _IS_BESIDE */
    float    t[RAYS_OF_BLOCK], side[RAYS_OF_BLOCK]; /* -1: inside of a solid, 1: outside of all */
    uint32_t unresolved[RAYS_OF_BLOCK];             /* it ran out of steps */
    float    normal[3][RAYS_OF_BLOCK], evenness[RAYS_OF_BLOCK]; /* of hits, if they are wanted */
    /* Rays of hits have these: how high they begin, the error of coordinates, the cosine to the
       normal; of cones the radius at distance 1 and what must be empty around them; the least
       step. */
    float lift[RAYS_OF_BLOCK], rounding[RAYS_OF_BLOCK], facing[RAYS_OF_BLOCK];
    float cone[RAYS_OF_BLOCK], margin[RAYS_OF_BLOCK], least[RAYS_OF_BLOCK];
    /* Their distance at the start, relative to the true one; 1: the last step was the least one. */
    float ratio[RAYS_OF_BLOCK], took_least[RAYS_OF_BLOCK];
    /* The state of the march: the empty length around t, the next step, how the former changes
       along the ray. */
    float clearance[RAYS_OF_BLOCK], step[RAYS_OF_BLOCK], slope[RAYS_OF_BLOCK];
} RayBlock;

typedef struct RayRule {
    float    error; /* permitted, in pixels */
    uint32_t max_steps;
    float    normal_reach; /* of the differences for normals, in pixels; 0: none are wanted */
    bool     plain;        /* nothing is finer than a pixel but edges (KrsProgram.plain) */
    bool from_surfaces; /* rays begin at hits, on the `side` that is given, and may be wide there */
} RayRule;

/* Rays of hits are blocked where they are inside of a solid, cones where they are not empty (secondary.comp). */
typedef struct BlockRule {
    bool  cones, over_hemisphere;
    float growth; /* of the least step, with each */
    float far; /* rays over the hemisphere that recede take steps as long as they are so far away */
} BlockRule;

/* Distances of a state of a scene. */
typedef struct RayField RayField;

/* Makes a field; `planes`: those that are components are left out of the distance, and met at
   once.  NULL: memory has run out. */
RayField *ray_field_new(KrsState *state, bool planes);
void      ray_field_free(RayField *field);
/* Begins another picture of the same values: forgets parts of space where there is no room for others. */
void ray_field_begin(RayField *field);
/* Returns why rays of a scene cannot be marched, in words of its author; NULL: they can. */
const char *ray_field_refuses(const KrsScene *scene);

/* Finds where rays meet planes, up to `farthest`. */
void ray_field_meet_planes(RayField *field, size_t part, float farthest, RayBlock *block);
/* Marches the rays of a tile, in one of the parts of run_in_parallel.  Returns how many distances were evaluated. */
uint64_t ray_field_march(RayField *field, size_t part, RayBlock *blocks, size_t count,
                         const RayRule *rule);

/* Marches rays of mirrors, which go anywhere: up to BLOCKS_OF_WAVE blocks, in the order of any list. */
uint64_t ray_field_follow(RayField *field, size_t part, RayBlock *blocks, size_t count,
                          const RayRule *rule);

/* Returns the same for rays of hits, of which `side` is given: RAY_HITS is blocked, RAY_MISSES is
   not. */
uint64_t ray_field_block(RayField *field, size_t part, RayBlock *blocks, size_t count,
                         const BlockRule *rule);

#endif
