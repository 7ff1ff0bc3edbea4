/*
 * march.c: rays of a tile look for surfaces, in cells of space that are narrow around them.
 *
 * Of a bundle of rays all points at t from first to last are in a ball: around the one in the middle of the middle
 * ray, by how much origins and directions differ from its.  A unit vector that differs by d from another one differs in
 * length along that by no more than d squared.
 */
#include "rays/march.h"

#include <math.h>
#include <string.h>

#include "rays/ray_field.h"

/* Slabs of a tile, and parts of each in the next depth. */
enum { SLABS = 8, QUARTERS = 4, PARTS = 2 };
/* The least part of all slabs that is free. */
static const float NEAREST_SLAB = 1e-5f;

/* ---- bundles ---- */

/* Some blocks of a tile: their middle ray, and how much others differ from it at most. */
typedef struct Bundle {
    size_t first, count; /* of blocks */
    float  origin[3], direction[3], origins, directions;
    float  width, spread; /* of the widest pixel */
} Bundle;

typedef struct March {
    RayField      *field;
    CellWork      *work;
    const RaySet  *set;
    const RayRule *rule;
    RayBlock      *blocks;
    Bundle         bundles[LEAF_DEPTH + 1][BLOCKS_OF_TILE / QUARTERS]; /* by depth */
    uint64_t       evaluations;
} March;

static bool is_there(const RayBlock *block, int i)
{
    return block->state[i] == RAY_MARCHES || block->state[i] == RAY_IS_BESIDE;
}

/* Measures the bundle of the rays that march, and of those beside. */
static void measure_bundle(const RayBlock *blocks, Bundle *bundle)
{
    double sum[6] = {0}, rays = 0;
    float  origins = 0, directions = 0;
    for (size_t b = bundle->first; b < bundle->first + bundle->count; b++)
        for (int i = 0; i < RAYS_OF_BLOCK; i++) {
            const bool there = is_there(&blocks[b], i);
            for (int k = 0; k < 3 && there; k++) {
                sum[k] += (double)blocks[b].origin[k][i];
                sum[3 + k] += (double)blocks[b].direction[k][i];
            }
            rays += there;
        }
    for (int k = 0; k < 3; k++) {
        bundle->origin[k]    = (float)(sum[k] / fmax(rays, 1));
        bundle->direction[k] = (float)sum[3 + k];
    }
    const float length = sqrtf(bundle->direction[0] * bundle->direction[0] +
                               bundle->direction[1] * bundle->direction[1] +
                               bundle->direction[2] * bundle->direction[2]);
    for (int k = 0; k < 3; k++)
        bundle->direction[k] = length > 0 ? bundle->direction[k] / length : k == 0;
    for (size_t b = bundle->first; b < bundle->first + bundle->count; b++)
        for (int i = 0; i < RAYS_OF_BLOCK; i++) {
            float from = 0, aside = 0;
            for (int k = 0; k < 3; k++) {
                const float o = blocks[b].origin[k][i] - bundle->origin[k],
                            d = blocks[b].direction[k][i] - bundle->direction[k];
                from += o * o;
                aside += d * d;
            }
            const bool there = is_there(&blocks[b], i);
            origins          = there && from > origins ? from : origins;
            directions       = there && aside > directions ? aside : directions;
            bundle->width    = there ? fmaxf(bundle->width, blocks[b].width[i]) : bundle->width;
            bundle->spread   = there ? fmaxf(bundle->spread, blocks[b].spread[i]) : bundle->spread;
        }
    bundle->origins    = sqrtf(origins);
    bundle->directions = sqrtf(directions);
}

/* The ball of its points at t from first to last. */
static float ball_of(const Bundle *bundle, float first, float last, float middle[3])
{
    const float half = 0.5f * (last - first), at = first + half,
                lateral = last * bundle->directions;
    for (int k = 0; k < 3; k++)
        middle[k] = bundle->origin[k] + at * bundle->direction[k];
    return bundle->origins + 1.0001f * sqrtf(lateral * lateral + half * half +
                                             last * half * bundle->directions * bundle->directions);
}

static bool has_rays(const March *m, const Bundle *bundle, float first, float last)
{
    for (size_t b = bundle->first; b < bundle->first + bundle->count; b++)
        if (m->set->has(&m->blocks[b], first, last))
            return true;
    return false;
}

static void skip_rays(const March *m, const Bundle *bundle, float last)
{
    for (size_t b = bundle->first; b < bundle->first + bundle->count; b++)
        m->set->skip(&m->blocks[b], last);
}

/* ---- cells ---- */

/* Marches the rays of a block up to `last`. */
static void march_block(March *m, const CellTape *tape, RayBlock *block, float last)
{
    const RayCell cell = {tape, m->work, LEAF_DEPTH + 1};
    bool          hits[RAYS_OF_BLOCK];
    float         at[RAYS_OF_BLOCK], points[3][RAYS_OF_BLOCK];
    uint32_t      rays;
    for (int i = 0; i < RAYS_OF_BLOCK; i++)
        hits[i] = block->state[i] != RAY_HITS;
    while ((rays = m->set->place(block, last, at, points)) > 0) {
        const float *distances = ray_cell_run(&cell, (const float(*)[RAYS_OF_BLOCK])points);
        m->set->take(block, m->rule, at, last, tape->cap, distances);
        m->evaluations += rays;
    }
    for (int i = 0; i < RAYS_OF_BLOCK; i++)
        hits[i] = hits[i] && block->state[i] == RAY_HITS;
    if (m->rule->normal_reach > 0)
        m->evaluations += ray_normals(&cell, m->rule, block, hits);
}

static void march_blocks(March *m, const CellTape *tape, const Bundle *bundle, float first,
                         float last)
{
    for (size_t b = bundle->first; b < bundle->first + bundle->count; b++)
        if (m->set->has(&m->blocks[b], first, last))
            march_block(m, tape, &m->blocks[b], last);
}

/* Cells that are bounded at once. */
typedef struct Cells {
    const Bundle *bundle[CELL_LANES];
    float         first[CELL_LANES], last[CELL_LANES];
    float         radius[CELL_LANES], taps[CELL_LANES]; /* of the ball, and around it for normals */
    float         points[3][CELL_LANES];
    int           count;
} Cells;

/* How far from a hit in the ball distances are asked for. */
static float taps_of(const March *m, const Bundle *bundle, float last, const float middle[3],
                     float radius)
{
    float largest = radius;
    if (m->rule->normal_reach == 0)
        return 0;
    for (int k = 0; k < 3; k++)
        largest = fmaxf(
            largest, fmaxf(fabsf(middle[k]) + radius, fabsf(bundle->origin[k]) + bundle->origins));
    return TAPS_REACH *
           ray_normal_reach(m->rule, bundle->width + bundle->spread * last, last, largest);
}

static void add_cell(const March *m, Cells *cells, const Bundle *bundle, float first, float last)
{
    const int i = cells->count++;
    float     middle[3];
    cells->bundle[i] = bundle;
    cells->first[i]  = first;
    cells->last[i]   = last;
    cells->radius[i] = ball_of(bundle, first, last, middle);
    cells->taps[i]   = taps_of(m, bundle, last, middle, cells->radius[i]);
    for (int k = 0; k < 3; k++)
        cells->points[k][i] = middle[k];
}

static void march_cells(March *m, const CellTape *tape, uint32_t depth, Cells *cells);

/* Goes on within a cell that may have a surface. */
static void enter(March *m, const CellTape *tape, uint32_t depth, const Bundle *bundle, float first,
                  float last)
{
    Cells cells = {.count = 0};
    if (depth == LEAF_DEPTH) {
        march_blocks(m, tape, bundle, first, last);
        return;
    }
    const Bundle *parts = &m->bundles[depth + 1][QUARTERS * (bundle - m->bundles[depth])];
    for (int q = 0; q < QUARTERS; q++)
        for (int s = 0; s < PARTS && parts[q].count > 0; s++)
            add_cell(m, &cells, &parts[q], first + (last - first) * (float)s / PARTS,
                     s + 1 < PARTS ? first + (last - first) * (float)(s + 1) / PARTS : last);
    march_cells(m, tape, depth + 1, &cells);
}

/* Bounds the cells, which lie in a cell with this tape, and enters those in which there may be a surface, one after the
   other.  Those of one bundle follow each other, the nearest first. */
static void march_cells(March *m, const CellTape *tape, uint32_t depth, Cells *cells)
{
    float values[CELL_LANES];
    for (int i = cells->count; i < CELL_LANES; i++)
        for (int k = 0; k < 3; k++)
            cells->points[k][i] = cells->points[k][0];
    memcpy(values, cell_run(tape, m->work, depth, (const float(*)[CELL_LANES])cells->points),
           sizeof values);
    for (int i = 0; i < cells->count; i++) {
        const float first = cells->first[i], last = cells->last[i];
        if (!has_rays(m, cells->bundle[i], first, last))
            continue;
        /* Rays go by this: no surface is nearer than the distance. */
        if (fminf(values[i], tape->cap) > cells->radius[i] + m->field->margin) {
            skip_rays(m, cells->bundle[i], last);
            continue;
        }
        const CellMark mark   = cell_mark(m->work);
        const CellTape pruned = cell_prune(tape, m->work, depth, (uint32_t)i,
                                           cells->radius[i] + cells->taps[i], m->field->margin);
        enter(m, &pruned, depth, cells->bundle[i], first, last);
        cell_release(m->work, mark);
    }
}

/* ---- tiles ---- */

/* Blocks [first, first + size) as far as there are any. */
static Bundle bundle_of(size_t first, size_t size, size_t count)
{
    return (Bundle){.first = first,
                    .count = first >= count         ? 0
                             : first + size > count ? count - first
                                                    : size};
}

static void divide_tile(March *m, size_t count)
{
    size_t size = BLOCKS_OF_TILE, bundles = 1;
    for (int depth = 0; depth <= LEAF_DEPTH; depth++, size /= QUARTERS, bundles *= QUARTERS)
        for (size_t i = 0; i < bundles; i++) {
            m->bundles[depth][i] = bundle_of(i * size, size, count);
            measure_bundle(m->blocks, &m->bundles[depth][i]);
        }
}

/* Begins all rays; where they are marched. */
static void begin(March *m, size_t count, float *first, float *last)
{
    *first = HUGE_VALF;
    *last  = 0;
    for (size_t b = 0; b < count; b++) {
        RayBlock *block = &m->blocks[b];
        for (int i = 0; i < RAYS_OF_BLOCK; i++) {
            block->t[i]         = block->start[i];
            block->end[i]       = fminf(block->end[i], block->plane[i]);
            block->side[i]      = block->start[i] > 0 ? 1 : 0;
            block->clearance[i] = block->step[i] = 0;
            block->slope[i]                      = -1 / (1 - 0.3f);
            block->steps[i] = block->unresolved[i] = 0;
            if (block->state[i] == RAY_IS_ABSENT)
                continue;
            if (!(block->start[i] <= block->end[i]))
                block->state[i] = block->state[i] == RAY_MARCHES ? RAY_MISSES : RAY_IS_ABSENT;
            if (is_there(block, i)) {
                *first = fminf(*first, block->start[i]);
                *last  = fmaxf(*last, block->end[i]);
            }
        }
    }
}

/* How far from their origin the rays of a tile are free, but no less than `least`. */
static float free_from(const March *m, const CellTape *tape, float least)
{
    const Bundle *all = &m->bundles[0][0];
    float         points[3][CELL_LANES];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < CELL_LANES; i++)
            points[k][i] = all->origin[k];
    const float *distances = cell_run(tape, m->work, 0, (const float(*)[CELL_LANES])points);
    return fmaxf(distances[0] - all->origins - m->field->margin, least);
}

/* Returns where slab `number` begins: slabs are longer where rays are wider.  From within the box these begin `clear`
   away, and each slab is so many times as long as the one before. */
static float slab_at(float first, float last, float clear, int number)
{
    const float even = first < last ? sqrtf(first / last) : 1, part = (float)number / SLABS;
    if (number == 0 || number == SLABS)
        return number == 0 ? first : last;
    return clear > 0 ? clear * powf(last / clear, part)
                     : first + (last - first) * part * (even + (1 - even) * part);
}

/* Ends the rays of a block.  Those that hit nothing else meet their plane. */
static void end_block(March *m, RayBlock *block, const RayCell *planes)
{
    bool meets[RAYS_OF_BLOCK];
    for (int i = 0; i < RAYS_OF_BLOCK; i++) {
        const bool ends = block->state[i] == RAY_MARCHES || block->state[i] == RAY_REFINES;
        block->state[i] = ends ? (uint32_t)RAY_MISSES : block->state[i];
        meets[i]        = block->state[i] == RAY_MISSES && !block->unresolved[i] &&
                   block->plane[i] < HUGE_VALF;
        if (meets[i]) {
            block->state[i] = RAY_HITS;
            block->t[i]     = block->plane[i];
            block->side[i]  = 1;
        }
    }
    if (m->rule->normal_reach > 0 && m->field->planes)
        m->evaluations += ray_normals(planes, m->rule, block, meets);
}

/* Marches rays that have begun, between first and last. */
static void march_tile(March *m, const CellTape *tape, size_t count, float first, float last)
{
    Cells cells = {.count = 0};
    if (!(first <= last))
        return;
    divide_tile(m, count);
    last *= 1.0001f;
    const float clear = first == 0 ? fminf(free_from(m, tape, NEAREST_SLAB * last), last) : 0;
    for (int s = 0; s < SLABS; s++)
        add_cell(m, &cells, &m->bundles[0][0], slab_at(first, last, clear, s),
                 slab_at(first, last, clear, s + 1));
    march_cells(m, tape, 0, &cells);
}

uint64_t ray_field_march(RayField *field, size_t part, RayBlock *blocks, size_t count,
                         const RayRule *rule)
{
    const RayCell planes = {&field->plane_distance.cells, field->plane_distance.works[part], 0};
    March         m      = {.field  = field,
                            .work   = field->distance.works[part],
                            .set    = field->set,
                            .rule   = rule,
                            .blocks = blocks};
    float         first, last;
    begin(&m, count, &first, &last);
    march_tile(&m, &field->distance.cells, count, first, last);
    for (size_t b = 0; b < count; b++)
        end_block(&m, &blocks[b], &planes);
    return m.evaluations;
}
