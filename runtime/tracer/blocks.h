/*
 * blocks.h: what host and kernels hand to each other, as shaders/frame.glsl and its neighbours
 * declare it.
 */
#ifndef KRS_BLOCKS_H
#define KRS_BLOCKS_H

#include <assert.h>
#include <stdint.h>

/* uniform Frame, std140. */
typedef struct FrameBlock {
    float    eye[3], farthest;
    float    right[4], up[4], forward[4];
    float    low[4], high[4];
    float    zenith[4], horizon[4], ground[4];
    float    size[2];
    float    pixel_base, pixel_slope;
    float    error, occlusion_reach;
    uint32_t most_steps;
    float    normal_reach;
} FrameBlock;
static_assert(sizeof(FrameBlock) == 176, "std140");

/* Phases of the kernels. */
enum { QUARTERS_OF_TILE = 4 }; /* each with a cone (hit_lists.glsl) */
enum { TRACE_RAYS, TRACE_BEAMS_32, TRACE_BEAMS_8, TRACE_BEAMS_4 };
enum { RAYS_CONES, RAYS_TO_LIGHT, RAYS_OVER_HEMISPHERE };
enum { SHADOW_NEAR, SHADOW_WIDE };
enum { OCCLUSION_AT_SPARSE_PIXELS, OCCLUSION_WIDER, OCCLUSION_UPSAMPLED, OCCLUSION_OF_REMAINING };
enum { BACKGROUND_FIRST, BACKGROUND_SUN };
/* Of hit_lists.glsl; from LIST_SHARED on words of shared.glsl, for whole tiles, and then the list
   of quarters of tiles. */
enum { LIST_ALL, LIST_SPARSE, LIST_REMAINING, LIST_WIDE, LIST_OF_MARCH_GROUP, LIST_SHARED = 13 };
enum { SHARED_LISTS = 2 };

enum { LIGHTS_AT_ONCE = 3 };             /* of a dispatch of shade.comp */
enum { VALUE_OCCLUSION, VALUE_VISIBLE }; /* that and the next ones of those lights */
enum { ITEMS_FRESH, ITEMS_QUEUED, ITEMS_UNTAKEN };
enum { LIGHT_POSITIONAL = 1, LIGHT_CASTS_SHADOWS = 2 };

/* push_constant Work. */
typedef struct WorkBlock {
    uint32_t corner[2], extent[2];
    float    offset[2];
    uint32_t steps;
    uint32_t first, groups, stride;
} WorkBlock;
static_assert(sizeof(WorkBlock) == 40, "std430");

/* Light, std430. */
typedef struct LightBlock {
    float    vector[3], softness;
    float    color[3];
    uint32_t kind; /* LIGHT_... */
} LightBlock;
static_assert(sizeof(LightBlock) == 32, "std430");

/* Dispatches of a chain, at most. */
enum { MOST_CHAINED = 48 };

/* buffer Control, std430. */
typedef struct ControlBlock {
    uint32_t projection; /* the enum of KrsCamera */
    uint32_t phase;
    uint32_t first_ray;
    uint32_t light, lights;
    uint32_t ray;
    uint32_t seed;
    uint32_t starts_from, listed;
    uint32_t source; /* ITEMS_... */
    uint32_t items, items_per_lane;
    uint32_t reading, writing;
    uint32_t value; /* VALUE_... */
    uint32_t rows;  /* bits of ResultRow */
    uint32_t by_march_group;
    uint32_t no_occlusion; /* 1: no occlusion */
    uint32_t window, across;
    uint32_t rays;    /* of each pixel */
    uint32_t filters; /* 1: neighbours share */
    /* counted by the kernels: */
    uint32_t queued, untaken, tiles, hit_count, sparse, remaining, unresolved, evaluations,
        most_evaluations;
    uint32_t wide, quarters;
    uint32_t of_march_group[9]; /* KRS_MOST_MARCH_GROUPS and 1 */
    /* by plan.comp: the groups of the next dispatch, the one of the chain where it stopped, and how
       many groups each had: */
    uint32_t groups[3], stopped, ran[MOST_CHAINED];
} ControlBlock;

/* Results of results.glsl: rows of four numbers, each for all pixels of a band. */
typedef enum ResultRow {
    ROW_COLORS,
    ROW_POSITIONS, /* position, depth; infinite where nothing is */
    ROW_NORMALS,   /* normal, component */
    ROW_ALBEDOS,   /* albedo, level */
    ROW_COUNTS,    /* instance, steps */
    RESULT_ROWS
} ResultRow;
enum { RESULT_NUMBERS = 4, RESULT_BYTES = 4 * RESULT_NUMBERS, DEPTH_NUMBER = 3 };

/* Only their sizes matter to the host. */
enum { STATE_MISS = 2 }; /* a packed ray that took no step (frame.glsl) */
enum { END_BYTES = 8, HIT_BYTES = 32, MARCH_BYTES = 32, TILE = 8 };

/* Points and Answer of point_query.comp. */
typedef struct PointBlock {
    float point[4];
} PointBlock;

typedef struct AnswerBlock {
    float    color[3], distance;
    float    emission[3], surface_distance;
    float    roughness, metallic;
    uint32_t component, level;
    uint32_t instance, unused[3];
    float    normal[3], unused_too;
    float    gradient[3], unused_three;
} AnswerBlock;
static_assert(sizeof(AnswerBlock) == 96, "std430");

/* Two rows of QueryRays and one of RayHits of query.comp. */
typedef struct QueryRayBlock {
    float origin[3], end;
    float direction[3], kind;
} QueryRayBlock;
/* Of a ray: it begins in the open; or somewhere, and ends somewhere; or at what is the end of all
   solids, so that it has left them there. */
enum { ENDS_ANYWHERE, BEGINS_OUTSIDE, ENDS_AT_WALLS };

enum { QUERY_MARCHING, QUERY_HIT, QUERY_MISS }; /* the states of frame.glsl */
/* Bits among the steps of a ray that began so near to a surface that rounding may have decided on
   which side: that it did, and that the side was the inner one. */
#define QUERY_SIDE_UNKNOWN  0x80000000u
#define QUERY_BEGINS_INSIDE 0x40000000u
typedef struct RayHitBlock {
    float    t;
    uint32_t state, point, steps;
} RayHitBlock;

#endif
