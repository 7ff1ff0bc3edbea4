/*
 * blocks.h: the blocks that host and shaders exchange, and the constants that both need.
 *
 * C and GLSL read this one file.  Each struct is followed by its name in C and a check of its size.
 * GLSL's rules of alignment decide that size, so some members only fill gaps.
 */
#ifndef KRS_BLOCKS_H
#define KRS_BLOCKS_H

#ifdef __STDC_VERSION__ /* C */
#include <assert.h>
#include <stddef.h>
#include <stdint.h>
typedef uint32_t     uint;
typedef float        vec2[2], vec3[3], vec4[4];
typedef unsigned int uvec2[2], uvec3[3];
#define CONSTANT(name, value) enum { name = (value) }
#else
#define CONSTANT(name, value) const uint name = uint(value)
#endif

/* ---- Sizes ---- */

CONSTANT(TILE, 8);             /* side of a tile, in pixels */
CONSTANT(QUARTERS_OF_TILE, 4); /* each has a cone (hit_lists.glsl) */
CONSTANT(LIGHTS_AT_ONCE, 3);   /* lights of a dispatch of shade.comp */
CONSTANT(GROUP_LISTS, 9);      /* KRS_MAX_MARCH_GROUPS, and one for no group */
CONSTANT(MAX_CHAINED, 48);     /* most dispatches of a chain */

/* ---- Bindings in set 1, of pictures ---- */

CONSTANT(FRAME_BINDING, 0); /* a uniform buffer */
CONSTANT(ENDS_BINDING, 1);  /* storage buffers */
CONSTANT(HITS_BINDING, 2);
CONSTANT(RESULTS_BINDING, 3);
CONSTANT(CONTROL_BINDING, 4);
CONSTANT(INPUT_ROWS_BINDING, 5);
CONSTANT(QUEUE_BINDING, 6);
CONSTANT(TAKEN_BINDING, 7);
CONSTANT(INPUT_TEXELS_BINDING, 8); /* texels: lights and listed rays */
CONSTANT(TILES_BINDING, 9);        /* a storage buffer */
/* Some of the buffers once more, as texels.  Where the device reads too few texels (Gpu.texels) no
   texels are bound, and the inputs are a storage buffer. */
CONSTANT(END_TEXELS_BINDING, 10);
CONSTANT(HIT_TEXELS_BINDING, 11);
CONSTANT(PIXEL_LIST_TEXELS_BINDING, 12);
CONSTANT(RESULT_TEXELS_BINDING, 13);
CONSTANT(TILE_TEXELS_BINDING, 14);
CONSTANT(FRAME_TEXELS_BINDING, 15); /* with FRAME_TEXELS (frame.glsl) */
CONSTANT(CONTROL_TEXELS_BINDING, 16);
CONSTANT(SURFACE_TEXELS_BINDING, 17); /* with SURFACES (surfaces.glsl) */
CONSTANT(WORK_BINDING, 18);           /* a uniform buffer: one of the blocks of a dispatch */
CONSTANT(FRAME_BINDINGS, 19);         /* how many */

/* ---- Binding in set 0, of pictures: the table of a sky that is a picture ---- */

CONSTANT(SKY_BINDING, 3);

/* First are means of the sky: around normals, weighted by the cosine, and around directions by what
   surfaces mirror that are so rough.  They are pictures of all directions as well, of these widths,
   half as high.  Behind them is the sky itself.  Last are sums to choose directions by: of four cells
   between texels, of four of these, and so on.  The coarsest is first. */
CONSTANT(SKY_AROUND_WIDTH, 32);
CONSTANT(SKY_ROUGH_WIDTH, 64); /* roughness 1, 0.8, 0.6 and 0.4 */
CONSTANT(SKY_ROUGH_LEVELS, 4);
CONSTANT(SKY_SMOOTH_WIDTH, 128);   /* 0.2 */
CONSTANT(SKY_SMOOTHER_WIDTH, 256); /* 0.1 */
/* The rows at which these begin. */
CONSTANT(SKY_ROUGH, 512);
CONSTANT(SKY_SMOOTH, 512 + 4 * 2048);
CONSTANT(SKY_SMOOTHER, 512 + 4 * 2048 + 8192);
CONSTANT(SKY_ITSELF, 512 + 4 * 2048 + 8192 + 32768);

/* ---- The frame and the dispatch ---- */

/* The rows of four numbers of the frame: the number of the row, then its members.  ONE is a vec4, TWO
   a vec3 and a float, THREE a vec2 and two floats; and there are rows of FLOATS and of UINTS. */
#define FRAME_ROWS(ONE, TWO, THREE, FLOATS, UINTS)                                                     \
    /* A sky that is a picture has: columns and rows, or 0; its rotation in radians; a factor. */      \
    /* It comes first: lavapipe compiles shaders anew for each value of a block's first number. */     \
    ONE(0, sky_map)                                                                                    \
    TWO(1, eye, farthest) /* no ray goes farther */                                                    \
    ONE(2, right)         /* to the edges of the picture; at distance 1 in perspective */              \
    ONE(3, up)                                                                                         \
    ONE(4, forward) /* unit */                                                                         \
    ONE(5, low)     /* a box around the scene */                                                       \
    ONE(6, high)                                                                                       \
    ONE(7, zenith)                                                                                     \
    ONE(8, horizon)                                                                                    \
    ONE(9, ground)                                                                                     \
    ONE(10, fog)       /* its color, its density at its base */                                        \
    ONE(11, fog_level) /* how fast it falls with the height, height of its base, 0, 0 */               \
    /* The size of the picture in pixels; a pixel at distance t is base + slope t wide. */             \
    THREE(12, size, pixel_base, pixel_slope)                                                           \
    /* Permitted distance of a hit from the surface, in pixels; the longest falling ray for */         \
    /* occlusion; radius of the taps for a normal, in pixels; mean irradiance by the sky, which */     \
    /* paths use. */                                                                                   \
    FLOATS(13, error, occlusion_reach, normal_reach, sky_power)                                        \
    /* Most steps of a ray; balls around what emits light; 1: hits are snapped (march_step.glsl); */   \
    /* where media begin in the inputs (volumes.glsl). */                                              \
    UINTS(14, max_steps, emissive_count, snaps, volumes_at)                                            \
    /* The lens, if LENS is set: its radius in `right` and `up`, 1 / the distance of what is sharp, */ \
    /* corners of the aperture; 0: it is round. */                                                     \
    ONE(15, lens)                                                                                      \
    /* How far the picture moves, in half widths and half heights; how far the eye of a panorama */    \
    /* is to the right, for stereo; 0. */                                                              \
    ONE(16, shift)

/* Members of a struct, of rows. */
#define MEMBER_OF_ONE(row, a) vec4 a;
#define MEMBERS_OF_TWO(row, a, b) \
    vec3  a;                      \
    float b;
#define MEMBERS_OF_THREE(row, a, b, c) \
    vec2  a;                           \
    float b, c;
#define MEMBERS_OF_FLOATS(row, a, b, c, d) float a, b, c, d;
#define MEMBERS_OF_UINTS(row, a, b, c, d)  uint a, b, c, d;

/* uniform FrameBlock, std140; lavapipe reads it as texels (frame.glsl). */
struct Frame {
    FRAME_ROWS(MEMBER_OF_ONE, MEMBERS_OF_TWO, MEMBERS_OF_THREE, MEMBERS_OF_FLOATS, MEMBERS_OF_UINTS)
};

/* uniform WorkBlock, std140. */
struct Work {
    uvec2 corner, extent;        /* of the band, in pixels */
    vec2  offset;                /* of the ray within its pixel */
    uint  steps;                 /* most steps of a lane in this dispatch */
    uint  first, groups, stride; /* workgroups [first, first + groups), by this stride */
};

/* The same, of next_dispatch.comp. */
struct NextDispatch {
    uint counter; /* items are `each` times this word of the control block; 0: `each` alone */
    uint each;
    uint resets;   /* 1: the counter is set to 0 afterwards */
    uint in_group; /* items of a workgroup */
    uint most;     /* most workgroups that may run at once */
    uint number;   /* number of the dispatch in its chain, from 1 */
    uint clears;   /* a counter to set to 0; 0: none */
};

/* The same, of point_query.comp. */
struct PointWork {
    uint  count, taps; /* points; distances for each: 1, or 7 with normals */
    float min_step;    /* to a tap for a normal */
};

#ifdef __STDC_VERSION__
typedef struct Frame FrameBlock;
#define ROW_BEGINS(row, a)                  static_assert(offsetof(FrameBlock, a) == 16 * (row), "std140");
#define ROW_OF_TWO_BEGINS(row, a, b)        ROW_BEGINS(row, a)
#define ROW_OF_THREE_BEGINS(row, a, b, c)   ROW_BEGINS(row, a)
#define ROW_OF_FOUR_BEGINS(row, a, b, c, d) ROW_BEGINS(row, a)
FRAME_ROWS(ROW_BEGINS, ROW_OF_TWO_BEGINS, ROW_OF_THREE_BEGINS, ROW_OF_FOUR_BEGINS,
           ROW_OF_FOUR_BEGINS)
static_assert(sizeof(FrameBlock) == 272, "std140");
typedef struct Work WorkBlock;
static_assert(sizeof(WorkBlock) == 40, "std430");
typedef struct NextDispatch NextDispatchBlock;
static_assert(sizeof(NextDispatchBlock) == 28, "std430");
typedef struct PointWork PointWorkBlock;
static_assert(sizeof(PointWorkBlock) == 12, "std430");
#endif

/* ---- The control block ---- */

/* What the host tells a shader, in rows of four numbers as above.  Values that decide branches are
   here, not among the constants of a dispatch.  For each set of constants that decides a branch
   lavapipe would compile the shader again, and keep it. */
#define CONTROL_ROWS(FLOATS, UINTS)                                                                 \
    /* projection: PERSPECTIVE and so on */                                                         \
    /* phase: of the shader, see below */                                                           \
    /* first_ray: 1: this is the first ray of each pixel */                                         \
    /* light: number of the light that a dispatch is about */                                       \
    UINTS(0, projection, phase, first_ray, light)                                                   \
    /* lights: number of all lights */                                                              \
    /* ray: number of the ray within its pixel */                                                   \
    /* seed: of random numbers */                                                                   \
    /* starts_from: rays start at 1: the ends of beams of tiles, 2: of their quarters */            \
    UINTS(1, lights, ray, seed, starts_from)                                                        \
    /* listed: 1: only listed tiles have rays */                                                    \
    /* source: of the items: ITEMS_... */                                                           \
    /* items: number of items */                                                                    \
    /* items_per_lane: at most */                                                                   \
    UINTS(2, listed, source, items, items_per_lane)                                                 \
    /* reading: where the queue or list that is read begins */                                      \
    /* writing: where the queue that is written begins */                                           \
    /* value: VALUE_...: the number of LIGHTING that is computed */                                 \
    /* rows: wanted rows of results: bit ROW_... of each */                                         \
    UINTS(3, reading, writing, value, rows)                                                         \
    /* by_march_group: 1: hits know their march group, and are listed by it */                      \
    /* no_occlusion: 1: there is no occlusion */                                                    \
    /* window: column | row << 16 of the first tile with a beam, in the band */                     \
    /* across: tiles with beams in a row */                                                         \
    UINTS(4, by_march_group, no_occlusion, window, across)                                          \
    /* rays: of each pixel */                                                                       \
    /* filters: 1: neighbours share what their rays find (shared.glsl) */                           \
    /* no_background: 1: where nothing is hit there is no light */                                  \
    /* limits: where depths of pixels begin in the inputs (limit.comp) */                           \
    UINTS(5, rays, filters, no_background, limits)                                                  \
    /* sampled_at: where words of quarters begin in `tiles`; 0: all pixels get rays */              \
    /* of_paths: 1: the rays are those of paths that have begun (MIXED_RAYS) */                     \
    /* color_row: the row of results to which light is added: ROW_... */                            \
    /* separate: 1: the light of each light has a row of results of its own */                      \
    UINTS(6, sampled_at, of_paths, color_row, separate)                                             \
    /* count: of the lights that a pass of shade.comp adds */                                       \
    /* caught: the row of results of light on the plate; 0: it catches none */                      \
    /* plate_planes: where planes of the plate begin in the inputs (plate.glsl) */                  \
    /* plate_map: where its map begins there (plate_rays.glsl); 0: there is none */                 \
    UINTS(7, count, caught, plate_planes, plate_map)                                                \
    /* max_radiance: of a ray: more is clamped */                                                   \
    /* noise: error at which samples of a pixel end */                                              \
    /* noise_floor: light to which the error of black pixels is relative */                         \
    /* plate_roughness, plate_reflectance: of the plate; head on, 0: it mirrors nothing */          \
    FLOATS(8, max_radiance, noise, noise_floor, plate_roughness)                                    \
    /* photons: where those of this sample begin in the inputs (photons.glsl); 0: there are none */ \
    FLOATS(9, plate_reflectance, gap_a, gap_b, gap_c)                                               \
    UINTS(10, photons, gap_d, gap_e, gap_f)

/* What the shaders count, and what next_dispatch.comp says of the next dispatch. */
#define COUNTER_MEMBERS                                                                            \
    uint queued;                      /* rays that go on in another dispatch */                    \
    uint untaken;                     /* items that no lane has begun */                           \
    uint tiles;                       /* listed tiles */                                           \
    uint hit_count, sparse;           /* pixels that hit something; sparse pixels among them */    \
    uint remaining;                   /* pixels that need rays or a mean of their own */           \
    uint unresolved;                  /* rays that ran out of steps */                             \
    uint evaluations;                 /* of distances, by beams and rays */                        \
    uint max_evaluations;             /* by one ray */                                             \
    uint wide;                        /* pixels that need a wide mean of a shadow (shadow.comp) */ \
    uint quarters;                    /* quarters of tiles in which something is hit */            \
    uint of_march_group[GROUP_LISTS]; /* pixels that hit something, by march group */              \
    uint groups[3];                   /* workgroups of the next dispatch */                        \
    uint stopped;                     /* the dispatch at which the chain stopped; 0: none */       \
    uint ran[MAX_CHAINED];            /* workgroups that each dispatch had */                      \
    uint clamped;                     /* rays whose light was clamped */                           \
    uint sampled;                     /* pixels whose samples go on */

/* buffer ControlBlock, std430: the counters follow these members. */
struct Control {
    CONTROL_ROWS(MEMBERS_OF_FLOATS, MEMBERS_OF_UINTS)
};

/* Indices of some words of the control block, for next_dispatch.comp. */
CONSTANT(ITEMS_WORD, 10);
CONSTANT(GROUPS_WORD, 64);
CONSTANT(STOPPED_WORD, 67);
CONSTANT(RAN_WORD, 68);

#ifdef __STDC_VERSION__
typedef struct ControlBlock {
    CONTROL_ROWS(MEMBERS_OF_FLOATS, MEMBERS_OF_UINTS)
    COUNTER_MEMBERS
} ControlBlock;
static_assert(sizeof(ControlBlock) == (44 + 26 + MAX_CHAINED) * sizeof(uint32_t), "std430");
#define ROW_OF_CONTROL_BEGINS(row, a, b, c, d) \
    static_assert(offsetof(ControlBlock, a) == 16 * (row), "std430");
CONTROL_ROWS(ROW_OF_CONTROL_BEGINS, ROW_OF_CONTROL_BEGINS)
static_assert(sizeof(struct Control) == offsetof(ControlBlock, queued), "the host's part");
#endif

/* projection */
CONSTANT(PERSPECTIVE, 0);
CONSTANT(ORTHOGRAPHIC, 1);
CONSTANT(PANORAMA, 2);
CONSTANT(LISTED, 3); /* no camera: a list has the ray of each pixel */

/* phase, of trace.comp */
CONSTANT(TRACE_RAYS, 0);
CONSTANT(TRACE_BEAMS_32, 1);
CONSTANT(TRACE_BEAMS_8, 2);
CONSTANT(TRACE_BEAMS_4, 3);
/* phase, of background.comp */
CONSTANT(BACKGROUND_FIRST, 0);
CONSTANT(BACKGROUND_SUN, 1); /* the disc of one more light, without the sky */
/* phase, of secondary.comp */
CONSTANT(RAYS_CONES, 0);
CONSTANT(RAYS_TO_LIGHT, 1);
CONSTANT(RAYS_OVER_HEMISPHERE, 2);
CONSTANT(RAYS_AS_CHOSEN, 3); /* to the lights that paths have chosen */
/* phase, of escape.comp */
CONSTANT(ESCAPE_TO_LIGHTS, 0);
CONSTANT(ESCAPE_TO_SKY, 1); /* surfaces have shown what mirrors lights, as in previews */
/* phase, of scatter.comp, and of shade.comp with MIRRORS */
CONSTANT(PATHS_GO_ON, 0);
CONSTANT(PATHS_END, 1);
/* phase, of penumbrae.comp */
CONSTANT(PENUMBRAE_COUNTED, 0);
CONSTANT(PENUMBRAE_SPREAD, 1);
/* phase, of shadow.comp */
CONSTANT(SHADOW_NEAR, 0);
CONSTANT(SHADOW_WIDE, 1);
/* phase, of occlusion.comp */
CONSTANT(OCCLUSION_AT_SPARSE_PIXELS, 0);
CONSTANT(OCCLUSION_WIDER, 1);
CONSTANT(OCCLUSION_UPSAMPLED, 2);
CONSTANT(OCCLUSION_OF_REMAINING, 3);

/* phase, of noise.comp */
CONSTANT(NOISE_BEGINS, 0);
CONSTANT(NOISE_ENDS_SAMPLES, 1);
CONSTANT(NOISE_LISTS, 2);
CONSTANT(NOISE_SPREADS, 3);
CONSTANT(NOISE_RESTORES, 4);

/* source */
CONSTANT(ITEMS_FRESH, 0);
CONSTANT(ITEMS_QUEUED, 1);
CONSTANT(ITEMS_UNTAKEN, 2);

/* value; VALUE_VISIBLE + i is for light i of those that are shaded together */
CONSTANT(VALUE_OCCLUSION, 0);
CONSTANT(VALUE_VISIBLE, 1);

/* ---- Rays, hits and lists ---- */

/* The state of a ray. */
CONSTANT(STATE_MARCHING, 0);
CONSTANT(STATE_HIT, 1);
/* This is also what pack_ray (frame.glsl) makes of a miss without a step. */
CONSTANT(STATE_MISS, 2);
CONSTANT(STATE_REFINING, 3);
/* Stands in place of the march group of what a ray has hit, where that is the plate of another
   renderer. */
CONSTANT(MARCH_GROUP_OF_PLATE, 15);

/* The rows of a hit, of four numbers each.  FACING: the normal, towards the side that the ray comes
   from, and how even the surface is within the pixel (1: flat).  LIGHTING: openness to the sky
   (1: nothing is occluded), and the visible fractions of the lights that are shaded together. */
CONSTANT(FACING, 0);
CONSTANT(LIGHTING, 1);
CONSTANT(HIT_ROWS, 2);

/* The rows of four numbers of a surface that the host has found (rays/surfaces.h): of what all materials have, or
   of layers, too. */
CONSTANT(PLAIN_SURFACE_ROWS, 4);
CONSTANT(SURFACE_ROWS, 11);

/* The rows of a path, behind those of all hits (frame.glsl).  PATH_ORIGIN: where its ray begins, and
   the width there.  PATH_DIRECTION: unit, and the growth of the width.  PATH_WEIGHT: the part of
   the light from there that reaches the eye, and the probability density of the direction; 0: it
   is the camera's.  PATH_LIGHT: what a light adds if nothing is in between, and its distance.
   Before that, where a medium scatters: the place, and the medium.  PATH_TOWARD: the direction to that light, and the side on which the ray begins: 1 outside of all
   solids, -1 inside of one, 0: the path has ended; with media more (media.glsl).  PATH_SURFACE: where
   the path was scattered last, and the side on which the ray to the light begins. */
CONSTANT(PATH_ORIGIN, 0);
CONSTANT(PATH_DIRECTION, 1);
CONSTANT(PATH_WEIGHT, 2);
CONSTANT(PATH_LIGHT, 3);
CONSTANT(PATH_TOWARD, 4);
CONSTANT(PATH_SURFACE, 5);
CONSTANT(PATH_ROWS, 6);

/* Rows of rays of hits that lanes of the host march, by the numbers of their items, behind those of all paths, if pixels
   have paths (frame.glsl).  LANE_START: where
   it begins, and where it ends.  LANE_AHEAD: its direction, and the cosine to the normal.  LANE_SCALE: how high it begins,
   the width of a pixel there, the error of coordinates, and the side of the hit.  LANE_CONE: the radius of a cone at
   distance 1, its margin, the least step, and how it begins.  LANE_LIGHT: the depth of the hit (shared.glsl), the radius of
   the light, and how far that is.  LANE_FOUND: where it has ended; 1: it is blocked; 1: it ran out of steps. */
CONSTANT(LANE_START, 0);
CONSTANT(LANE_AHEAD, 1);
CONSTANT(LANE_SCALE, 2);
CONSTANT(LANE_CONE, 3);
CONSTANT(LANE_LIGHT, 4);
CONSTANT(LANE_FOUND, 5);
CONSTANT(LANE_ROWS, 6);
/* How a ray begins: it is marched, or it is known without a march that it is free, blocked, or behind its surface. */
CONSTANT(LANE_MARCHES, 0);
CONSTANT(LANE_IS_FREE, 1);
CONSTANT(LANE_IS_BLOCKED, 2);
CONSTANT(LANE_BELOW_HORIZON, 3);

/* Lists of pixels (hit_lists.glsl), each with room for all pixels of the band.  LIST_OF_MARCH_GROUP
   is the first of GROUP_LISTS lists. */
CONSTANT(LIST_ALL, 0);
CONSTANT(LIST_SPARSE, 1);
CONSTANT(LIST_TO_LIGHTS, 1); /* of paths: pixels with a ray to a light; `sparse` counts them */
CONSTANT(LIST_REMAINING, 2);
CONSTANT(LIST_IN_VOLUMES, 2); /* of paths: pixels whose light a medium scatters */
CONSTANT(LIST_WIDE, 3);
CONSTANT(LIST_OF_MARCH_GROUP, 4);
/* Behind these lists are words of shared.glsl, with room for whole tiles: of rays, and of means
   over rays.  The codes of means are all from closed to open. */
CONSTANT(LIST_SHARED, 13);
CONSTANT(RAYS_SHARED, 0);
CONSTANT(MEANS_SHARED, 1);
CONSTANT(SHARED_LISTS, 2);
/* Behind these are words of quarters of tiles.  They are the list of those with hits, a bit for
   each pixel that hits, and what is known of a light there. */
CONSTANT(LISTED_QUARTERS, 0);
CONSTANT(HITS_OF_QUARTERS, 1);
CONSTANT(LIGHT_OF_QUARTERS, 2);
CONSTANT(LIGHT_AROUND_QUARTERS, 3); /* the same, with what is known of quarters around */

/* Results: each row has four numbers for every pixel of a band.  Where nothing is hit the component
   is 0, and all rows but colour and steps are void. */
CONSTANT(ROW_COLORS, 0);    /* floats, summed over the rays */
CONSTANT(ROW_POSITIONS, 1); /* floats: position, depth; infinite where nothing is hit */
CONSTANT(ROW_NORMALS, 2);   /* floats, and the component; 0: nothing is hit */
CONSTANT(ROW_ALBEDOS, 3);   /* floats, and the level */
CONSTANT(ROW_COUNTS, 4);    /* the instance, the steps of the ray */
CONSTANT(ROW_NOISE, 5);     /* estimated error; the samples of a pixel that has ended, else 0 */
/* Floats.  Of a pixel whose samples go on: sums of its colour when its error was estimated last, and
   the variance of the mean.  Of another: sums of its colour and alpha. */
CONSTANT(ROW_EARLIER, 6);
CONSTANT(RESULT_ROWS, 7);
/* Behind these is a row for each light, where they are separate: floats, summed over the rays.
   Then ROW_COLORS has the rest.  Last are two rows of light on a white plate, where that catches
   shadows: as it is, and as it would be without the scene.  Behind them are two of what a glossy
   plate mirrors. */
CONSTANT(ROW_OF_LIGHTS, 7);
CONSTANT(CAUGHT_ROWS, 2);

/* The map of a plate is a row for each pixel of the whole picture: three floats of its colour, and how
   near its surface is, a float whose lowest bits say which neighbours belong to the same surface.
   Behind them is a row for each block of pixels, with how near the nearest of them is. */
CONSTANT(PLATE_JOINS_RIGHT, 1);
CONSTANT(PLATE_JOINS_BELOW, 2);
CONSTANT(PLATE_BLOCK, 16); /* side of a block, in pixels */
/* The least samples of a pixel, which may end when they are a power of two.  The error is estimated
   from half as many on, by means of two halves. */
CONSTANT(MIN_NOISE_SAMPLES, 16);
CONSTANT(FIRST_NOISE_SAMPLES, 4);

struct Light {
    vec3  vector;   /* direction towards the light (unit), or its position */
    float softness; /* angular diameter in radians, or radius */
    vec3  color;
    uint  kind;  /* the bits below, and its type (light_types.def) times LIGHT_FIRST_TYPE */
    vec3  right; /* of a light that shines to one side, as long as its type says */
    float inner; /* of a spot: the cosine within which it has its full light, */
    vec3  up;    /* likewise; the cross product of both is where it shines */
    float outer; /* and the one outside of which it has none */
};
CONSTANT(LIGHT_ROWS, 4);
CONSTANT(LIGHT_POSITIONAL, 1);
CONSTANT(LIGHT_CASTS_SHADOWS, 2);
CONSTANT(LIGHT_SPOT, 4);
CONSTANT(LIGHT_FIRST_TYPE, 8);
/* Before the lights are the albedos of albedos.h: ALBEDO_SIDE * ALBEDO_SIDE rows.  Behind them are balls,
   and then the wide albedos: a row for each cosine, roughness and anisotropy. */
CONSTANT(ALBEDO_SIDE, 64);
CONSTANT(ALBEDO_ROWS, 4096);
CONSTANT(MAX_EMISSIVE, 32); /* KRS_MAX_EMISSIVE */
CONSTANT(EMISSIVE_ROWS, 2);
CONSTANT(WIDE_ALBEDOS_AT, 4096 + 2 * 32);
CONSTANT(WIDE_COSINES, 12);
CONSTANT(WIDE_ROUGHNESSES, 16);
CONSTANT(WIDE_ANISOTROPIES, 5);
CONSTANT(LIGHTS_AT, 4096 + 2 * 32 + 12 * 16 * 5); /* the row of the first light */

/* A medium among the inputs.  Behind all of them are bounds of densities in cells, two cells in a row: for
   each the least and the most. */
struct VolumeBox {
    vec3  low;    /* a corner of the box */
    uint  before; /* components that count as shown before it */
    vec3  cell;   /* the sides of a cell */
    uint  first;  /* row of the first cell, counted from where media begin */
    uvec3 cells;  /* in each direction */
    uint  gap_a;
};
CONSTANT(VOLUME_ROWS, 3);

/* A ball around something that emits light (emissive.glsl). */
struct EmissiveBall {
    vec3  middle;
    float radius;
    float radiance; /* about that of its disc */
    float gap_a, gap_b, gap_c;
};

/* A photon, in two rows.  Before photons.comp: where it begins, its light; its direction, and what it has of the
   light's intensity or irradiance.  After it: where it has ended, its direction; its light, and the normal there,
   directions packed by pack_direction (photons.glsl).

   The photons of a sample among the inputs: a row with the radius of their blur, 1 / the side of a cell, the number
   of buckets less 1, and the row of the first photon; numbers of the first photon of each bucket, four in a row, and
   of the end of the last; and the photons, bucket by bucket. */
CONSTANT(PHOTONS, 65536); /* of a sample */
CONSTANT(PHOTON_ROWS, 2);
CONSTANT(PHOTON_BUCKETS, 65536);
CONSTANT(PHOTON_STARTS_AT, 1);
CONSTANT(PHOTONS_AT, 1 + 65536 / 4 + 1);
CONSTANT(PHOTON_INPUT_ROWS, 1 + 65536 / 4 + 1 + 2 * 65536);

/* The ray of a pixel, given by the caller.  Listed rays lie behind the lights and room for
   LIGHTS_AT_ONCE more. */
struct ListedRay {
    vec3  origin;
    float width;     /* of the ray at its origin */
    vec3  direction; /* unit */
    float spread;    /* growth of the width for each unit of length */
};

#ifdef __STDC_VERSION__
enum { RESULT_NUMBERS = 4, RESULT_BYTES = 4 * RESULT_NUMBERS, DEPTH_NUMBER = 3 };
/* The host needs only the size of packed values, and of those in rows. */
enum { END_BYTES = 8, HIT_BYTES = 16 * HIT_ROWS, PATH_ROW_BYTES = 16, MARCH_BYTES = 32 };
enum { SURFACE_ROW_BYTES = 16 };
typedef struct Light LightBlock;
static_assert(sizeof(LightBlock) == 16 * LIGHT_ROWS, "std430");
typedef struct EmissiveBall EmissiveBlock;
static_assert(sizeof(EmissiveBlock) == 16 * EMISSIVE_ROWS, "std430");
typedef struct VolumeBox VolumeBlock;
static_assert(sizeof(VolumeBlock) == 16 * VOLUME_ROWS, "std430");
enum { WIDE_ALBEDO_ROWS = WIDE_COSINES * WIDE_ROUGHNESSES * WIDE_ANISOTROPIES };
static_assert(WIDE_ALBEDOS_AT == ALBEDO_ROWS + EMISSIVE_ROWS * MAX_EMISSIVE, "rows of inputs");
static_assert(LIGHTS_AT == WIDE_ALBEDOS_AT + WIDE_ALBEDO_ROWS, "rows of inputs");
typedef struct ListedRay ListedRayBlock;
static_assert(sizeof(ListedRayBlock) == 32, "std430");
#endif

/* ---- Points and rays that a program asks about ---- */

/* Bindings in set 1 for queries.  The frame, the control block and the items that lanes have taken
   have the same bindings as for pictures. */
CONSTANT(POINTS_BINDING, 1);
CONSTANT(ANSWERS_BINDING, 2);
CONSTANT(RAY_HITS_BINDING, 3);
CONSTANT(QUERY_RAYS_BINDING, 5);

/* A point for point_query.comp, std430; answers.h has the block of its answers. */
struct Point {
    vec3  point;
    float gap_a;
    vec3  direction; /* of the ray that sees it; 0: nobody looks */
    float gap_b;
};

/* A ray for query.comp, std430. */
struct QueryRay {
    vec3  origin;
    float end;       /* the ray goes no farther */
    vec3  direction; /* unit */
    float kind;      /* see below */
};
/* The kind of a ray.  ENDS_ANYWHERE: it may begin and end anywhere.  BEGINS_OUTSIDE: it begins
   outside of all solids.  ENDS_AT_WALLS: all solids end where it ends, so it has left them
   there. */
CONSTANT(ENDS_ANYWHERE, 0);
CONSTANT(BEGINS_OUTSIDE, 1);
CONSTANT(ENDS_AT_WALLS, 2);

struct RayHit {
    float t;
    uint  state; /* STATE_...; STATE_MARCHING if the ray was given up */
    uint  point; /* index of the hit among the points for point_query.comp */
    uint  steps; /* number of steps, and the bits below */
};
/* Bits of `steps`.  The first: the ray began so near to a surface that rounding may have decided on
   which side.  The second: the side was the inner one. */
#define QUERY_SIDE_UNKNOWN  0x80000000u
#define QUERY_BEGINS_INSIDE 0x40000000u

#ifdef __STDC_VERSION__
typedef struct Point PointBlock;
static_assert(sizeof(PointBlock) == 32, "std430");
typedef struct QueryRay QueryRayBlock;
static_assert(sizeof(QueryRayBlock) == 32, "std430");
typedef struct RayHit RayHitBlock;
static_assert(sizeof(RayHitBlock) == 16, "std430");
#endif

#endif
