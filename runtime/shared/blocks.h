/*
 * blocks.h: what the host and the kernels hand to each other, and the numbers that both know.
 *
 * C and GLSL read this one file.  A struct is followed by its type for C and its size there, which
 * is that of GLSL's rules: so what GLSL aligns has members that stand for the gaps.
 */
#ifndef KRS_BLOCKS_H
#define KRS_BLOCKS_H

#ifdef __STDC_VERSION__ /* C */
#include <assert.h>
#include <stddef.h>
#include <stdint.h>
typedef uint32_t     uint;
typedef float        vec2[2], vec3[3], vec4[4];
typedef unsigned int uvec2[2];
#define CONSTANT(name, value) enum { name = (value) }
#else
#define CONSTANT(name, value) const uint name = uint(value)
#endif

/* ---- Sizes ---- */

CONSTANT(TILE, 8);             /* pixels a side */
CONSTANT(QUARTERS_OF_TILE, 4); /* each with a cone (hit_lists.glsl) */
CONSTANT(LIGHTS_AT_ONCE, 3);   /* of a dispatch of shade.comp */
CONSTANT(GROUP_LISTS, 9);      /* KRS_MOST_MARCH_GROUPS, and pixels of no group */
CONSTANT(MOST_CHAINED, 48);    /* dispatches of a chain */

/* ---- The frame and the dispatch ---- */

/* uniform FrameBlock, std140. */
struct Frame {
    vec3  eye;
    float farthest;  /* no ray goes farther */
    vec4  right, up; /* to the edges of the picture, at distance 1 where it is perspective */
    vec4  forward;   /* unit */
    vec4  low, high; /* a box around the scene */
    vec4  zenith, horizon, ground;
    vec2  size;       /* of the picture in pixels */
    float pixel_base; /* the width of a pixel at distance t is base + slope t */
    float pixel_slope;
    float error;           /* permitted distance from the surface, in pixels */
    float occlusion_reach; /* of the farthest occlusion tap */
    uint  most_steps;
    float normal_reach; /* how far around a hit its normal is looked for, in pixels */
};

/* push_constant WorkBlock, std430. */
struct Work {
    uvec2 corner, extent;        /* of the band, in pixels */
    vec2  offset;                /* of the ray within its pixel */
    uint  steps;                 /* of a lane in this dispatch */
    uint  first, groups, stride; /* groups [first, first + groups), in an order of this stride */
};

/* push_constant of next_dispatch.comp. */
struct NextDispatch {
    uint counter; /* items are `each` times this word of the control block; 0: just `each` */
    uint each;
    uint resets;   /* 1: the counter is 0 from then on */
    uint in_group; /* items of a group */
    uint most;     /* groups that may run at once */
    uint number;   /* of the dispatch in its chain, from 1 */
};

/* push_constant of point_query.comp. */
struct PointWork {
    uint count, taps; /* points; 1, or 7 with normals */
};

#ifdef __STDC_VERSION__
typedef struct Frame FrameBlock;
static_assert(sizeof(FrameBlock) == 176, "std140");
typedef struct Work WorkBlock;
static_assert(sizeof(WorkBlock) == 40, "std430");
typedef struct NextDispatch NextDispatchBlock;
static_assert(sizeof(NextDispatchBlock) == 24, "std430");
typedef struct PointWork PointWorkBlock;
static_assert(sizeof(PointWorkBlock) == 8, "std430");
#endif

/* ---- The control block ---- */

/* What the host tells a kernel.  What decides branches is here and not among the constants of a
   dispatch: lavapipe compiles a kernel anew, and keeps it, for every set of constants that decides
   one. */
#define CONTROL_MEMBERS                                                                            \
    uint projection;  /* PERSPECTIVE and so on */                                                  \
    uint phase;       /* of the kernel */                                                          \
    uint first_ray;   /* 1: it is the first of its pixel */                                        \
    uint light;       /* which one a dispatch is about, */                                         \
    uint lights;      /* of how many */                                                            \
    uint ray;         /* the number of the ray within its pixel */                                 \
    uint seed;        /* moves what is drawn by lot */                                             \
    uint starts_from; /* 1: rays start where beams of their tiles end, 2: of quarters of these, */ \
    uint listed;      /* and 1: there are rays in listed tiles only */                             \
    uint source;      /* of the items: ITEMS_..., */                                               \
    uint items;       /* how many there are, */                                                    \
    uint items_per_lane; /* and at most for a lane */                                              \
    uint reading;        /* where the queue or list that is read begins, */                        \
    uint writing;        /* and the one that is written */                                         \
    uint value;          /* VALUE_...: of a hit's LIGHTING that is looked for */                   \
    uint rows;           /* of results that are asked for: bit ROW_... of each */                  \
    uint by_march_group; /* 1: rays tell which march group they hit, and are listed by it */       \
    uint no_occlusion;   /* 1: occlusion is not looked for */                                      \
    uint window;  /* of tiles of beams, counted in the band, the first: column | row << 16, */     \
    uint across;  /* and how many in a row */                                                      \
    uint rays;    /* of each pixel */                                                              \
    uint filters; /* 1: neighbours share what their rays find (shared.glsl) */

/* What the kernels count, and what next_dispatch.comp says of the next dispatch. */
#define COUNTER_MEMBERS                                                                         \
    uint queued;            /* rays that need another dispatch, */                              \
    uint untaken;           /* and items that nobody has begun */                               \
    uint tiles;             /* listed tiles, */                                                 \
    uint hit_count, sparse; /* pixels that see something (hit_lists.glsl), */                   \
    uint remaining;         /* and those that need rays of their own */                         \
    uint unresolved;        /* rays that ran out of steps */                                    \
    uint evaluations;       /* distances spent on beams and rays; the most on one */            \
    uint most_evaluations;                                                                      \
    uint wide;     /* pixels that need a wide mean of a shadow (shadow.comp), */                \
    uint quarters; /* and quarters of tiles that see something */                               \
    uint of_march_group[GROUP_LISTS]; /* pixels that see something, by their march group */     \
    uint groups[3];                   /* of the next dispatch */                                \
    uint stopped;                     /* the dispatch of the chain where it stopped; 0: none */ \
    uint ran[MOST_CHAINED];           /* how many groups each had */

/* buffer ControlBlock, std430: both, one behind the other. */
struct Control {
    CONTROL_MEMBERS
};

/* Some of its words by their numbers, for next_dispatch.comp. */
CONSTANT(ITEMS_WORD, 10);
CONSTANT(GROUPS_WORD, 42);
CONSTANT(STOPPED_WORD, 45);
CONSTANT(RAN_WORD, 46);

#ifdef __STDC_VERSION__
typedef struct ControlBlock {
    CONTROL_MEMBERS
    COUNTER_MEMBERS
} ControlBlock;
static_assert(sizeof(ControlBlock) == (22 + 24 + MOST_CHAINED) * sizeof(uint32_t), "std430");
static_assert(sizeof(struct Control) == offsetof(ControlBlock, queued), "the host's part");
#endif

/* projection */
CONSTANT(PERSPECTIVE, 0);
CONSTANT(ORTHOGRAPHIC, 1);
CONSTANT(PANORAMA, 2);
CONSTANT(LISTED, 3); /* no camera: each pixel has a ray in a list */

/* phase of trace.comp, */
CONSTANT(TRACE_RAYS, 0);
CONSTANT(TRACE_BEAMS_32, 1);
CONSTANT(TRACE_BEAMS_8, 2);
CONSTANT(TRACE_BEAMS_4, 3);
/* of background.comp, */
CONSTANT(BACKGROUND_FIRST, 0);
CONSTANT(BACKGROUND_SUN, 1); /* about the light alone */
/* of secondary.comp, */
CONSTANT(RAYS_CONES, 0);
CONSTANT(RAYS_TO_LIGHT, 1);
CONSTANT(RAYS_OVER_HEMISPHERE, 2);
/* of shadow.comp, */
CONSTANT(SHADOW_NEAR, 0);
CONSTANT(SHADOW_WIDE, 1);
/* and of occlusion.comp */
CONSTANT(OCCLUSION_AT_SPARSE_PIXELS, 0);
CONSTANT(OCCLUSION_WIDER, 1);
CONSTANT(OCCLUSION_UPSAMPLED, 2);
CONSTANT(OCCLUSION_OF_REMAINING, 3);

/* source */
CONSTANT(ITEMS_FRESH, 0);
CONSTANT(ITEMS_QUEUED, 1);
CONSTANT(ITEMS_UNTAKEN, 2);

/* value; that and the next ones are of the lights that are shaded at once */
CONSTANT(VALUE_OCCLUSION, 0);
CONSTANT(VALUE_VISIBLE, 1);

/* ---- Rays, hits and lists ---- */

/* What became of a ray. */
CONSTANT(STATE_MARCHING, 0);
CONSTANT(STATE_HIT, 1);
CONSTANT(STATE_MISS, 2); /* a packed ray that took no step is just that (frame.glsl) */
CONSTANT(STATE_REFINING, 3);

/* The rows of a hit: */
CONSTANT(FACING, 0);   /* normal, towards the side that the ray comes from; how even the surface is
                          within a pixel, 1: flat */
CONSTANT(LIGHTING, 1); /* occlusion, 1: open, and before that is known how steep the distance is
                          there; how much of the lights that are shaded at once is visible */
CONSTANT(HIT_ROWS, 2);

/* Lists of pixels (hit_lists.glsl), each with room for all; of those by groups the first. */
CONSTANT(LIST_ALL, 0);
CONSTANT(LIST_SPARSE, 1);
CONSTANT(LIST_REMAINING, 2);
CONSTANT(LIST_WIDE, 3);
CONSTANT(LIST_OF_MARCH_GROUP, 4);
/* Behind them, with room for whole tiles: words of shared.glsl, of rays and of means of these,
   whose codes are all from closed to open; */
CONSTANT(LIST_SHARED, 13);
CONSTANT(RAYS_SHARED, 0);
CONSTANT(MEANS_SHARED, 1);
CONSTANT(SHARED_LISTS, 2);
/* and words of quarters of tiles: the list of those with hits; a bit for each pixel that is one;
   what is known of a light there. */
CONSTANT(LISTED_QUARTERS, 0);
CONSTANT(HITS_OF_QUARTERS, 1);
CONSTANT(LIGHT_OF_QUARTERS, 2);

/* Results: rows of four numbers, each for all pixels of a band. */
CONSTANT(ROW_COLORS, 0);    /* floats, summed over the rays */
CONSTANT(ROW_POSITIONS, 1); /* floats: position; depth.  Infinite where nothing is */
CONSTANT(ROW_NORMALS, 2);   /* floats, and component, 0: nothing, all else but colour and steps is
                               void */
CONSTANT(ROW_ALBEDOS, 3);   /* floats, and level */
CONSTANT(ROW_COUNTS, 4);    /* instance; steps */
CONSTANT(RESULT_ROWS, 5);

struct Light {
    vec3  vector;   /* towards it (unit), or its position */
    float softness; /* angular diameter, or radius */
    vec3  color;
    uint  kind; /* bits: */
};
CONSTANT(LIGHT_POSITIONAL, 1);
CONSTANT(LIGHT_CASTS_SHADOWS, 2);

/* A ray of a pixel that the caller gives, behind the lights and LIGHTS_AT_ONCE more. */
struct ListedRay {
    vec3  origin;
    float width;     /* of the ray there, */
    vec3  direction; /* unit */
    float spread;    /* and how much wider it gets for each unit */
};

#ifdef __STDC_VERSION__
enum { RESULT_NUMBERS = 4, RESULT_BYTES = 4 * RESULT_NUMBERS, DEPTH_NUMBER = 3 };
/* Of what is packed, or is in rows, only the size matters to the host. */
enum { END_BYTES = 8, HIT_BYTES = 16 * HIT_ROWS, MARCH_BYTES = 32 };
typedef struct Light LightBlock;
static_assert(sizeof(LightBlock) == 32, "std430");
typedef struct ListedRay ListedRayBlock;
static_assert(sizeof(ListedRayBlock) == 32, "std430");
#endif

/* ---- Points and rays that a program asks about ---- */

/* Where set 1 has them.  Frame, control block and what lanes have taken are where they are for
   pictures (frame.glsl). */
CONSTANT(POINTS_BINDING, 1);
CONSTANT(ANSWERS_BINDING, 2);
CONSTANT(RAY_HITS_BINDING, 3);
CONSTANT(QUERY_RAYS_BINDING, 5);

/* Of point_query.comp, std430; answers.h has what it says. */
struct Point {
    vec3  point;
    float gap_a;
};

/* Of query.comp, std430. */
struct QueryRay {
    vec3  origin;
    float end;       /* no farther than this */
    vec3  direction; /* unit */
    float kind;
};
/* kind: of a ray; it begins in the open; or somewhere, and ends somewhere; or at what is the end of
   all solids, so that it has left them there. */
CONSTANT(ENDS_ANYWHERE, 0);
CONSTANT(BEGINS_OUTSIDE, 1);
CONSTANT(ENDS_AT_WALLS, 2);

struct RayHit {
    float t;
    uint  state; /* STATE_...; of a ray that was given up STATE_MARCHING */
    uint  point; /* its point among those for point_query.comp */
    uint  steps; /* and these bits: */
};
/* The ray began so near to a surface that rounding may have decided on which side: that it did, and
   that the side was the inner one. */
#define QUERY_SIDE_UNKNOWN  0x80000000u
#define QUERY_BEGINS_INSIDE 0x40000000u

#ifdef __STDC_VERSION__
typedef struct Point PointBlock;
static_assert(sizeof(PointBlock) == 16, "std430");
typedef struct QueryRay QueryRayBlock;
static_assert(sizeof(QueryRayBlock) == 32, "std430");
typedef struct RayHit RayHitBlock;
static_assert(sizeof(RayHitBlock) == 16, "std430");
#endif

#endif
