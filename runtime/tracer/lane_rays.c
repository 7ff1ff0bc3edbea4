/*
 * lane_rays.c: rays by lanes of the host.
 *
 * A tile of primary rays has 64x64 pixels, a block 4x4.  Rays of hits are begun by aim.comp, which has no scene, and
 * come in waves, in the order of their list; arrive.comp makes of them what secondary.comp would.  Tiles and waves are
 * dealt to all processors, and slices of them end often enough that progress is seen.
 */
#include "runtime/tracer/lane_rays.h"

#include <math.h>
#include <string.h>

#include "compiler/base/clock.h"
#include "runtime/tracer/lane_cameras.h"
#include "runtime/tracer/lane_deal.h"
#include "runtime/tracer/methods.h"
#include "runtime/tracer/rendering.h"
#include "runtime/tracer/view.h"

enum {
    SIDE          = 64,
    BLOCK_SIDE    = 4,
    RAYS_OF_WAVE  = BLOCKS_OF_WAVE * RAYS_OF_BLOCK,
    BYTES_OF_PART = BLOCKS_OF_WAVE * sizeof(RayBlock)
};
static_assert(SIDE * SIDE == BLOCKS_OF_TILE * RAYS_OF_BLOCK &&
                  BLOCK_SIDE * BLOCK_SIDE == RAYS_OF_BLOCK,
              "rays.h");

const char *lane_rays_refuse(const Job *job)
{
    const KrsRendering     *r       = job->rendering;
    const KrsRenderOptions *options = &job->options;
    if (!gpu_is_cpu(job->gpu))
        return "the device is not of type CPU";
    if (job->frame.snaps)
        return "the integrator is not `preview`";
    if (job->rays)
        return "there are rays of the caller";
    if (r->program->media)
        return "light goes through something";
    if (job_is_camera_relative(job))
        return "coordinates are so large that points are relative to another origin";
    if (r->zone_slots > 0 || options->depth || options->noise > 0)
        return "there are zones or depths of the caller, or samples end by noise";
    if (options->methods.trace != KRS_TRACE_AUTO || options->methods.even_hits > 0)
        return "rays go by another method than `auto`, as those to roots of polynomials do";
    return ray_field_refuses(r->scene);
}

bool lane_rays_find_normals(const Job *job)
{
    return job->options.methods.normals == KRS_NORMALS_OCTAHEDRON;
}

bool lane_rays_know_planes(const Job *job)
{
    return rendering_knows_planes(job->rendering) && job->begins_outside;
}

/* Tiles that are marched in one slice. */
typedef struct Slice {
    const Job       *job;
    RayField        *field;
    const WorkBlock *work;
    CameraRays       rays;
    const uint32_t  *slots;   /* of pixels whose paths go on */
    FrameBlock       box;     /* around what is marched */
    uint32_t across, tile[2]; /* of all tiles: in a row, and the first one's column and row */
    uint32_t items;           /* of rays of hits, or of paths */
    LaneDeal deal;
    uint64_t evaluations[MAX_PARTS];
    uint32_t max_steps[MAX_PARTS];
} Slice;

/* The first pixel of a block, counted in the picture. */
typedef struct Corner {
    uint32_t at[2];
} Corner;

static Corner corner_of(const Slice *slice, uint32_t tile, uint32_t block)
{
    return (Corner){
        {SIDE * (slice->tile[0] + tile % slice->across) + BLOCK_SIDE * lane_rays_column(block),
         SIDE * (slice->tile[1] + tile / slice->across) +
             BLOCK_SIDE * lane_rays_column(block >> 1)}};
}

/* Finds the pixel of a ray, counted in the band; false: it is outside of that. */
static bool find_pixel(const WorkBlock *work, Corner corner, uint32_t ray, uint32_t pixel[2])
{
    const uint32_t at[2] = {corner.at[0] + ray % BLOCK_SIDE, corner.at[1] + ray / BLOCK_SIDE};
    for (int k = 0; k < 2; k++)
        pixel[k] = at[k] - work->corner[k];
    return at[0] >= work->corner[0] && pixel[0] < work->extent[0] && at[1] >= work->corner[1] &&
           pixel[1] < work->extent[1];
}

static void aim(const CameraRays *rays, const uint32_t pixel[2], RayBlock *block, uint32_t i)
{
    const CameraRay ray = camera_ray(rays, pixel);
    for (int k = 0; k < 3; k++) {
        block->origin[k][i]    = ray.origin[k];
        block->direction[k][i] = ray.direction[k];
    }
    block->width[i]  = ray.width;
    block->spread[i] = ray.spread;
}

/* Clips a ray to a box as clip_to of frame.glsl does. */
static void clip(const float low[3], const float high[3], float farthest, RayBlock *block,
                 uint32_t ray)
{
    float first = 0, last = farthest;
    for (int k = 0; k < 3; k++) {
        const float along = block->direction[k][ray], safe = fabsf(along) < 1e-18f ? 1e-18f : along;
        const float a = (low[k] - block->origin[k][ray]) / safe,
                    b = (high[k] - block->origin[k][ray]) / safe;
        first         = fmaxf(first, fminf(a, b));
        last          = fminf(last, fmaxf(a, b));
    }
    block->start[ray] = first;
    block->end[ray]   = last;
}

static void begin_block(const Slice *slice, Corner corner, RayBlock *block)
{
    for (uint32_t i = 0; i < RAYS_OF_BLOCK; i++) {
        uint32_t       pixel[2];
        const bool     asked = find_pixel(slice->work, corner, i, pixel);
        const uint32_t at[2] = {corner.at[0] + i % BLOCK_SIDE, corner.at[1] + i / BLOCK_SIDE};
        const bool there = at[0] < slice->job->options.width && at[1] < slice->job->options.height;
        if (there)
            aim(&slice->rays, at, block, i);
        block->state[i] = asked ? RAY_MARCHES : there ? RAY_IS_BESIDE : RAY_IS_ABSENT;
        if (there)
            clip(slice->box.low, slice->box.high, slice->job->frame.farthest, block, i);
    }
}

uint32_t lane_rays_column(uint32_t number)
{
    uint32_t column = 0;
    for (uint32_t bit = 0; bit < 16; bit++)
        column |= (number >> 2 * bit & 1) << bit;
    return column;
}

void lane_rays_pixel(const WorkBlock *work, uint32_t slot, uint32_t pixel[2])
{
    const uint32_t across = (work->extent[0] + TILE - 1) / TILE, tile = slot / (TILE * TILE);
    pixel[0] = tile % across * TILE + slot % TILE;
    pixel[1] = tile / across * TILE + slot / TILE % TILE;
}

uint32_t lane_rays_slot(const WorkBlock *work, const uint32_t pixel[2])
{
    const uint32_t across = (work->extent[0] + TILE - 1) / TILE;
    return TILE * TILE * (pixel[1] / TILE * across + pixel[0] / TILE) + pixel[1] % TILE * TILE +
           pixel[0] % TILE;
}

const float (*lane_rays_path(const Job *job, const WorkBlock *work, const uint32_t pixel[2]))[4]
{
    const float(*hits)[4] = job->rendering->band.hits.bytes;
    const size_t index    = (size_t)pixel[1] * work->extent[0] + pixel[0];
    return hits + (size_t)HIT_ROWS * TILE * TILE * tiles_of_band(work) + PATH_ROWS * index;
}

/* Begins the ray of a path. */
static void begin_path(const Slice *slice, const uint32_t pixel[2], RayBlock *block, uint32_t i)
{
    const float(*path)[4] = lane_rays_path(slice->job, slice->work, pixel);
    for (int k = 0; k < 3; k++) {
        block->origin[k][i]    = path[PATH_ORIGIN][k];
        block->direction[k][i] = path[PATH_DIRECTION][k];
    }
    block->width[i]  = path[PATH_ORIGIN][3];
    block->spread[i] = path[PATH_DIRECTION][3];
    block->side[i]   = path[PATH_TOWARD][3] < 0 ? -1.0f : 1.0f;
    block->state[i]  = RAY_MARCHES;
    clip(slice->box.low, slice->box.high, slice->job->frame.farthest, block, i);
}

/* Stores the ray of a pixel as pack_ray of frame.glsl packs it. */
static void store_ray(Slice *slice, size_t part, const uint32_t pixel[2], const RayBlock *block,
                      uint32_t i)
{
    float(*hits)[4]    = slice->job->rendering->band.hits.bytes;
    uint32_t(*ends)[2] = slice->job->rendering->band.ends.bytes;
    uint32_t *end      = ends[(size_t)pixel[1] * slice->work->extent[0] + pixel[0]];
    memcpy(&end[0], &block->t[i], sizeof *end);
    end[1] = (block->state[i] == RAY_HITS ? STATE_HIT : STATE_MISS) |
             (block->side[i] < 0 ? 4u : 0u) | (block->unresolved[i] ? 8u : 0u) |
             block->steps[i] << 8;
    float *facing = hits[(size_t)HIT_ROWS * lane_rays_slot(slice->work, pixel) + FACING];
    for (int k = 0; k < 3; k++)
        facing[k] = block->normal[k][i];
    facing[3] = block->evenness[i];
    if (block->steps[i] > slice->max_steps[part])
        slice->max_steps[part] = block->steps[i];
}

static void store_block(Slice *slice, size_t part, Corner corner, const RayBlock *block)
{
    uint32_t pixel[2];
    for (uint32_t i = 0; i < RAYS_OF_BLOCK; i++)
        if (find_pixel(slice->work, corner, i, pixel))
            store_ray(slice, part, pixel, block, i);
}

static RayRule rule_of(const Job *job, bool of_paths)
{
    return (RayRule){.error         = (float)job->options.error,
                     .max_steps     = job->options.methods.max_steps,
                     .normal_reach  = lane_rays_find_normals(job) ? job->frame.normal_reach : 0,
                     .plain         = job->rendering->program->plain,
                     .from_surfaces = of_paths};
}

/* Begins blocks [first, first + count) of a tile. */
static void begin_blocks(const Slice *slice, size_t part, uint32_t tile, uint32_t first,
                         uint32_t count, RayBlock *blocks)
{
    for (uint32_t b = 0; b < count; b++) {
        begin_block(slice, corner_of(slice, tile, first + b), &blocks[b]);
        ray_field_meet_planes(slice->field, part, slice->job->frame.farthest, &blocks[b]);
    }
}

static void march_tiles(void *task, size_t part, size_t parts)
{
    Slice        *slice  = task;
    const RayRule rule   = rule_of(slice->job, false);
    RayBlock     *blocks = slice->deal.memory[part];
    (void)parts;
    for (uint32_t tile; lane_deal_next(&slice->deal, &tile);) {
        begin_blocks(slice, part, tile, 0, BLOCKS_OF_TILE, blocks);
        slice->evaluations[part] += ray_field_march(slice->field, part, blocks, BLOCKS_OF_TILE,
                                                    &rule);
        for (uint32_t b = 0; b < BLOCKS_OF_TILE; b++)
            store_block(slice, part, corner_of(slice, tile, b), &blocks[b]);
    }
}

/* Returns how many of a list are in a wave of it. */
static uint32_t count_of_wave(const Slice *slice, uint32_t wave)
{
    const uint32_t left = slice->items - wave * RAYS_OF_WAVE;
    return left < RAYS_OF_WAVE ? left : RAYS_OF_WAVE;
}

static void march_paths(void *task, size_t part, size_t parts)
{
    Slice        *slice  = task;
    const RayRule rule   = rule_of(slice->job, true);
    RayBlock     *blocks = slice->deal.memory[part];
    (void)parts;
    for (uint32_t wave; lane_deal_next(&slice->deal, &wave);) {
        const uint32_t *slots = slice->slots + wave * RAYS_OF_WAVE,
                       items  = count_of_wave(slice, wave),
                       count  = (items + RAYS_OF_BLOCK - 1) / RAYS_OF_BLOCK;
        uint32_t pixel[2];
        for (uint32_t i = 0; i < count * RAYS_OF_BLOCK; i++) {
            RayBlock *block = &blocks[i / RAYS_OF_BLOCK];
            lane_rays_pixel(slice->work, slots[i < items ? i : 0], pixel);
            begin_path(slice, pixel, block, i % RAYS_OF_BLOCK);
            if (i >= items)
                block->state[i % RAYS_OF_BLOCK] = RAY_IS_ABSENT;
        }
        for (uint32_t b = 0; b < count; b++)
            ray_field_meet_planes(slice->field, part, slice->job->frame.farthest, &blocks[b]);
        slice->evaluations[part] += ray_field_follow(slice->field, part, blocks, count, &rule);
        for (uint32_t i = 0; i < items; i++) {
            lane_rays_pixel(slice->work, slots[i], pixel);
            store_ray(slice, part, pixel, &blocks[i / RAYS_OF_BLOCK], i % RAYS_OF_BLOCK);
        }
    }
}

static void begin_secondary(const Slice *slice, const float (*rows)[4], uint32_t item,
                            RayBlock *block, uint32_t i)
{
    const float(*ray)[4] = rows + (size_t)LANE_ROWS * item;
    const bool there     = item < slice->items;
    block->state[i]      = !there                              ? RAY_IS_ABSENT
                           : ray[LANE_CONE][3] == LANE_MARCHES ? RAY_MARCHES
                                                               : RAY_MISSES;
    if (!there)
        return;
    for (int k = 0; k < 3; k++) {
        block->origin[k][i]    = ray[LANE_START][k];
        block->direction[k][i] = ray[LANE_AHEAD][k];
    }
    block->end[i]      = ray[LANE_START][3];
    block->facing[i]   = ray[LANE_AHEAD][3];
    block->lift[i]     = ray[LANE_SCALE][0];
    block->width[i]    = ray[LANE_SCALE][1];
    block->rounding[i] = ray[LANE_SCALE][2];
    block->side[i]     = ray[LANE_SCALE][3];
    block->cone[i]     = ray[LANE_CONE][0];
    block->margin[i]   = ray[LANE_CONE][1];
    block->least[i]    = ray[LANE_CONE][2];
}

static BlockRule block_rule_of(const Job *job)
{
    /* These numbers are those of secondary_rays.glsl. */
    const float         growth = 1.008f, growth_of_sky = 1.08f, far_reaches = 60;
    const ControlBlock *control    = job->rendering->control.bytes;
    const bool          hemisphere = control->phase == RAYS_OVER_HEMISPHERE;
    return (BlockRule){.cones           = control->phase == RAYS_CONES,
                       .over_hemisphere = hemisphere,
                       .growth          = hemisphere ? growth_of_sky : growth,
                       .far             = far_reaches * job->frame.occlusion_reach};
}

static void march_items(void *task, size_t part, size_t parts)
{
    Slice          *slice  = task;
    const BlockRule rule   = block_rule_of(slice->job);
    RayBlock       *blocks = slice->deal.memory[part];
    float(*rows)[4]        = slice->job->rendering->band.hits.bytes;
    rows += (size_t)(HIT_ROWS + (slice->job->rendering->program->mirrors ? PATH_ROWS : 0)) * TILE *
            TILE * tiles_of_band(slice->work);
    (void)parts;
    for (uint32_t wave; lane_deal_next(&slice->deal, &wave);) {
        const uint32_t first = wave * RAYS_OF_WAVE, items = count_of_wave(slice, wave),
                       count = (items + RAYS_OF_BLOCK - 1) / RAYS_OF_BLOCK;
        for (uint32_t i = 0; i < count * RAYS_OF_BLOCK; i++)
            begin_secondary(slice, (const float(*)[4])rows, first + i, &blocks[i / RAYS_OF_BLOCK],
                            i % RAYS_OF_BLOCK);
        slice->evaluations[part] += ray_field_block(slice->field, part, blocks, count, &rule);
        for (uint32_t i = 0; i < items; i++) {
            const RayBlock *block = &blocks[i / RAYS_OF_BLOCK];
            float          *found = rows[(size_t)LANE_ROWS * (first + i) + LANE_FOUND];
            found[0]              = block->t[i % RAYS_OF_BLOCK];
            found[1]              = block->state[i % RAYS_OF_BLOCK] == RAY_HITS;
            found[2]              = (float)block->unresolved[i % RAYS_OF_BLOCK];
        }
    }
}

/* Adds what shaders would have counted; background.comp counts those that are unresolved. */
static void add_counts(Job *job, const Slice *slice)
{
    ControlBlock *control = job->rendering->control.bytes;
    for (size_t i = 0; i < MAX_PARTS; i++) {
        control->evaluations += (uint32_t)slice->evaluations[i];
        if (slice->max_steps[i] > control->max_evaluations)
            control->max_evaluations = slice->max_steps[i];
    }
}

/* Places the box of what is marched: rays meet planes without a march. */
static void place_box(Slice *slice)
{
    const Job *job = slice->job;
    double     low[3], high[3];
    slice->box = job->frame;
    job_find_rest(job, low, high);
    if (lane_rays_know_planes(job))
        view_place_box(&job->view, low, high, &slice->box);
}

static uint32_t waves_of(uint32_t items) { return (items + RAYS_OF_WAVE - 1) / RAYS_OF_WAVE; }

static bool march_camera_rays(Job *job, Slice *slice)
{
    const WorkBlock *work = slice->work;
    uint32_t         tiles[2];
    for (int k = 0; k < 2; k++) {
        slice->tile[k] = work->corner[k] / SIDE;
        tiles[k]       = (work->corner[k] + work->extent[k] - 1) / SIDE - slice->tile[k] + 1;
    }
    slice->across = tiles[0];
    return lane_deal(job, &slice->deal, KRS_PHASE_PRIMARY, tiles[0] * tiles[1], BYTES_OF_PART,
                     march_tiles, slice);
}

bool lane_rays_march(Job *job, RayField *field, const WorkBlock *work, const LanePaths *paths)
{
    Slice slice = {.job = job, .field = field, .work = work, .rays = camera_rays(job, work)};
    place_box(&slice);
    if (paths) {
        slice.slots = paths->slots;
        slice.items = paths->count;
    }
    const bool good = paths ? lane_deal(job, &slice.deal, KRS_PHASE_BOUNCES, waves_of(paths->count),
                                        BYTES_OF_PART, march_paths, &slice)
                            : march_camera_rays(job, &slice);
    add_counts(job, &slice);
    return good;
}

/* Returns the milliseconds of this thread. */
static double thread_ms(void) { return 1e3 * clock_seconds(CLOCK_THREAD_CPUTIME_ID); }

/* Quarters of tiles are taken far apart, as some have nothing; before them a smaller part, where a quarter would take too
   long. */
bool lane_rays_try(Job *job, RayField *field, double budget_ms, LaneTrial *trial)
{
    enum { FIRST = 4, QUARTER = BLOCKS_OF_TILE / 4 };
    const uint32_t size[2] = {job->options.width, job->options.height};
    WorkBlock      whole   = {.extent = {size[0], size[1]}, .offset = {0.5f, 0.5f}};
    Slice slice = {.job = job, .field = field, .work = &whole, .rays = camera_rays(job, &whole)};
    const RayRule rule   = rule_of(job, false);
    RayBlock     *blocks = gpu_alloc(job->gpu, QUARTER, sizeof *blocks, "march rays");
    uint32_t      tried = 0, count = FIRST;
    double        rays = 0;
    if (!blocks)
        return false;
    place_box(&slice);
    slice.rays.through_middle = false; /* as most are */
    slice.across              = (size[0] + SIDE - 1) / SIDE;
    const uint32_t tiles      = slice.across * ((size[1] + SIDE - 1) / SIDE);
    const uint64_t step       = rendering_spread(job->rendering, tiles);
    const double   start      = thread_ms();
    for (*trial = (LaneTrial){0}; tried < tiles && trial->ms < budget_ms;
         tried++, count = QUARTER) {
        const uint32_t tile = (uint32_t)((tiles / 2 + tried * step) % tiles);
        begin_blocks(&slice, 0, tile, tried % 4 * QUARTER, count, blocks);
        trial->evaluations += (double)ray_field_march(field, 0, blocks, count, &rule);
        trial->ms = thread_ms() - start;
        rays += (double)count * RAYS_OF_BLOCK;
    }
    const double times = (double)size[0] * size[1] / rays;
    trial->ms *= times;
    trial->evaluations *= times;
    gpu_release(job->gpu, blocks);
    return true;
}

bool lane_rays_march_secondary(Job *job, RayField *field, KrsPhase phase, uint32_t items,
                               const WorkBlock *work)
{
    Slice slice = {.job = job, .field = field, .work = work, .items = items};
    return lane_deal(job, &slice.deal, phase, waves_of(items), BYTES_OF_PART, march_items, &slice);
}
