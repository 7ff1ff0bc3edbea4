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

#include "compiler/base/elementary.h"
#include "rays/ray_field.h"

/* Slabs of a tile, and parts of each in the next depth. */
enum { SLABS = 8, QUARTERS = 4, PARTS = 2 };
/* A cell with a shorter tape is not divided. */
enum { SHORT_TAPE = 32 };
/* A tape has become shorter if it takes less than this part of the steps. */
static const float SHORTER = 0.85f;
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

/* Finds the mean of the rays that march, and of those beside. */
static void find_middle(const March *m, Bundle *bundle)
{
    float  sums[RAY_SUMS][RAYS_OF_BLOCK] = {{0}};
    double all[RAY_SUMS] = {0}, square = 0;
    for (size_t b = bundle->first; b < bundle->first + bundle->count; b++)
        m->set->sum(&m->blocks[b], sums);
    for (int k = 0; k < RAY_SUMS; k++)
        for (int i = 0; i < RAYS_OF_BLOCK; i++)
            all[k] += (double)sums[k][i];
    for (int k = 0; k < 3; k++)
        square += all[3 + k] * all[3 + k];
    for (int k = 0; k < 3; k++) {
        bundle->origin[k]    = (float)(all[k] / fmax(all[6], 1));
        bundle->direction[k] = square > 0 ? (float)(all[3 + k] / sqrt(square)) : k == 0;
    }
}

static float greatest(const float row[RAYS_OF_BLOCK])
{
    float most = 0;
    for (int i = 0; i < RAYS_OF_BLOCK; i++)
        most = fmaxf(most, row[i]);
    return most;
}

static void measure_bundle(const March *m, Bundle *bundle)
{
    float most[RAY_SPREADS][RAYS_OF_BLOCK] = {{0}};
    find_middle(m, bundle);
    for (size_t b = bundle->first; b < bundle->first + bundle->count; b++)
        m->set->spread(&m->blocks[b], bundle->origin, bundle->direction, most);
    bundle->origins    = sqrtf(greatest(most[0]));
    bundle->directions = sqrtf(greatest(most[1]));
    bundle->width      = greatest(most[2]);
    bundle->spread     = greatest(most[3]);
}

/* Returns the ball of its points at t from first to last. */
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

/* Blocks of rays that march together. */
typedef struct Marching {
    RayBlock *blocks[CELL_BLOCKS];
    float     at[CELL_BLOCKS][RAYS_OF_BLOCK];
    size_t    count;
} Marching;

/* Leaves those that have rays before `last`; writes where these ask. */
static void place_blocks(March *m, Marching *all, float last, float points[3][CELL_WIDE])
{
    size_t count = 0;
    for (size_t b = 0; b < all->count; b++) {
        float          asked[3][RAYS_OF_BLOCK];
        const uint32_t rays = m->set->place(all->blocks[b], last, all->at[count], asked);
        if (rays == 0)
            continue;
        for (int k = 0; k < 3; k++)
            memcpy(points[k] + count * RAYS_OF_BLOCK, asked[k], sizeof asked[k]);
        all->blocks[count++] = all->blocks[b];
        m->evaluations += rays;
    }
    all->count = count;
}

/* Stretches clearances in a cell whose distance changes less fast; that does not hold behind it. */
static void stretch_clearances(const Marching *all, float by)
{
    for (size_t b = 0; b < all->count && by != 1; b++)
        for (int i = 0; i < RAYS_OF_BLOCK; i++)
            all->blocks[b]->clearance[i] *= by;
}

/* Lists the rays that have hit since their states were these; returns how many. */
static size_t list_hits(const Marching *all, uint32_t before[CELL_BLOCKS][RAYS_OF_BLOCK],
                        RayHit hits[CELL_WIDE])
{
    size_t count = 0;
    for (size_t b = 0; b < all->count; b++)
        for (int i = 0; i < RAYS_OF_BLOCK; i++)
            if (all->blocks[b]->state[i] == RAY_HITS && before[b][i] != RAY_HITS)
                hits[count++] = (RayHit){all->blocks[b], i};
    return count;
}

/* Marches the rays of some blocks up to `last`. */
static void march_together(March *m, const CellTape *tape, Marching all, float last)
{
    const RayCell  cell   = {tape, m->work, LEAF_DEPTH + 1};
    const Marching before = all;
    RayHit         hits[CELL_WIDE];
    uint32_t       marched[CELL_BLOCKS][RAYS_OF_BLOCK];
    float          points[3][CELL_WIDE];
    for (size_t b = 0; b < before.count; b++)
        memcpy(marched[b], before.blocks[b]->state, sizeof marched[b]);
    stretch_clearances(&before, 1 / tape->slope);
    for (place_blocks(m, &all, last, points); all.count > 0; place_blocks(m, &all, last, points)) {
        const float *distances = ray_cell_run_wide(&cell, points, all.count);
        for (size_t b = 0; b < all.count; b++)
            m->set->take(all.blocks[b], m->rule, all.at[b], last, tape->cap, tape->slope,
                         distances + b * RAYS_OF_BLOCK);
    }
    stretch_clearances(&before, tape->slope);
    if (m->rule->normal_reach > 0)
        m->evaluations += ray_normals(&cell, m->rule, hits, list_hits(&before, marched, hits));
}

static void march_blocks(March *m, const CellTape *tape, const Bundle *bundle, float first,
                         float last)
{
    Marching all = {.count = 0};
    for (size_t b = bundle->first; b < bundle->first + bundle->count; b++) {
        if (m->set->has(&m->blocks[b], first, last))
            all.blocks[all.count++] = &m->blocks[b];
        if (all.count == CELL_BLOCKS) {
            march_together(m, tape, all, last);
            all.count = 0;
        }
    }
    march_together(m, tape, all, last);
}

/* Cells that are bounded at once. */
typedef struct Cells {
    const Bundle *bundle[CELL_LANES];
    float         first[CELL_LANES], last[CELL_LANES];
    float         radius[CELL_LANES], taps[CELL_LANES]; /* of the ball, and around it for normals */
    float         points[3][CELL_LANES];
    int           count;
} Cells;

/* Returns how far from a hit in the ball distances are asked for. */
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

static void march_cells(March *m, const CellTape *tape, uint32_t depth, Cells *cells, bool shorter);

/* Goes on within a cell that may have a surface. */
static void enter(March *m, const CellTape *tape, uint32_t depth, const Bundle *bundle, float first,
                  float last, bool shorter)
{
    Cells cells = {.count = 0};
    if (depth == LEAF_DEPTH || cell_cost(tape) < SHORT_TAPE) {
        march_blocks(m, tape, bundle, first, last);
        return;
    }
    const Bundle *parts = &m->bundles[depth + 1][QUARTERS * (bundle - m->bundles[depth])];
    for (int q = 0; q < QUARTERS; q++)
        for (int s = 0; s < PARTS && parts[q].count > 0; s++)
            add_cell(m, &cells, &parts[q], first + (last - first) * (float)s / PARTS,
                     s + 1 < PARTS ? first + (last - first) * (float)(s + 1) / PARTS : last);
    march_cells(m, tape, depth + 1, &cells, shorter);
}

/* The rays of the smallest cells ask few distances, and finding slopes takes as long as many of these.  So tapes that
   need that are shortened there only if those around them have become `shorter` by that. */
static bool is_worth_pruning(const CellTape *tape, uint32_t depth, bool shorter)
{
    return depth < LEAF_DEPTH || tape->steep || shorter;
}

/* Bounds the cells, which lie in a cell with this tape, and enters those in which there may be a surface, one after the
   other.  Those of one bundle follow each other, the nearest first. */
static void march_cells(March *m, const CellTape *tape, uint32_t depth, Cells *cells, bool shorter)
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
        if (!is_worth_pruning(tape, depth, shorter)) {
            enter(m, tape, depth, cells->bundle[i], first, last, shorter);
            continue;
        }
        const CellMark mark   = cell_mark(m->work);
        const CellTape pruned = cell_prune(tape, m->work, depth, (uint32_t)i,
                                           cells->radius[i] + cells->taps[i], m->field->margin);
        enter(m, &pruned, depth, cells->bundle[i], first, last,
              (float)cell_cost(&pruned) < SHORTER * (float)cell_cost(tape));
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
            measure_bundle(m, &m->bundles[depth][i]);
        }
}

void ray_begin_block(const RayRule *rule, RayBlock *block)
{
    for (int i = 0; i < RAYS_OF_BLOCK; i++) {
        block->t[i]   = block->start[i];
        block->end[i] = fminf(block->end[i], block->plane[i]);
        if (!rule->from_surfaces)
            block->side[i] = block->start[i] > 0 ? 1 : 0;
        block->clearance[i] = block->step[i] = 0;
        block->slope[i]                      = -1 / (1 - 0.3f);
        block->steps[i] = block->unresolved[i] = 0;
        if (block->state[i] != RAY_IS_ABSENT && !(block->start[i] <= block->end[i]))
            block->state[i] = block->state[i] == RAY_MARCHES ? RAY_MISSES : RAY_IS_ABSENT;
    }
}

/* Begins all rays, and finds where they are marched. */
static void begin(March *m, size_t count, float *first, float *last)
{
    *first = HUGE_VALF;
    *last  = 0;
    for (size_t b = 0; b < count; b++) {
        RayBlock *block = &m->blocks[b];
        ray_begin_block(m->rule, block);
        for (int i = 0; i < RAYS_OF_BLOCK; i++)
            if (is_there(block, i)) {
                *first = fminf(*first, block->start[i]);
                *last  = fmaxf(*last, block->end[i]);
            }
    }
}

/* Returns how far from their origin the rays of a tile are free, but no less than `least`. */
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
    return clear > 0 ? clear * (float)real_pow(last / clear, part)
                     : first + (last - first) * part * (even + (1 - even) * part);
}

uint64_t ray_end_block(const RayField *field, size_t part, const RayRule *rule, RayBlock *block)
{
    const RayCell planes = {&field->plane_distance.cells, field->plane_distance.works[part], 0};
    RayHit        meets[RAYS_OF_BLOCK];
    size_t        count = 0;
    for (int i = 0; i < RAYS_OF_BLOCK; i++) {
        const bool ends = block->state[i] == RAY_MARCHES || block->state[i] == RAY_REFINES;
        block->state[i] = ends ? (uint32_t)RAY_MISSES : block->state[i];
        if (block->state[i] == RAY_MISSES && !block->unresolved[i] && block->plane[i] < HUGE_VALF) {
            block->state[i] = RAY_HITS;
            block->t[i]     = block->plane[i];
            block->side[i]  = 1;
            meets[count++]  = (RayHit){block, i};
        }
    }
    return rule->normal_reach > 0 && field->planes ? ray_normals(&planes, rule, meets, count) : 0;
}

/* Marches rays in the slabs of a tile.  Those that begin with one tape are bounded at once. */
static void march_slabs(March *m, const Cells *slabs)
{
    Space *starts = &m->field->starts;
    for (int i = 0; i < slabs->count;) {
        Cells    same   = {.count = 0};
        uint32_t number = 0;
        for (; i < slabs->count; i++) {
            const float middle[3] = {slabs->points[0][i], slabs->points[1][i], slabs->points[2][i]};
            const uint32_t of     = has_rays(m, slabs->bundle[i], slabs->first[i], slabs->last[i])
                                        ? space_find_ball(starts, m->work, middle,
                                                          slabs->radius[i] + slabs->taps[i])
                                        : number;
            if (same.count > 0 && of != number)
                break;
            number = of;
            add_cell(m, &same, slabs->bundle[i], slabs->first[i], slabs->last[i]);
        }
        march_cells(m, &starts->cubes[number].tape, 0, &same, true);
    }
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
    march_slabs(m, &cells);
}

uint64_t ray_field_march(RayField *field, size_t part, RayBlock *blocks, size_t count,
                         const RayRule *rule)
{
    March m = {.field  = field,
               .work   = field->distance.works[part],
               .set    = field->set,
               .rule   = rule,
               .blocks = blocks};
    float first, last;
    begin(&m, count, &first, &last);
    march_tile(&m, &field->distance.cells, count, first, last);
    for (size_t b = 0; b < count; b++)
        m.evaluations += ray_end_block(field, part, rule, &blocks[b]);
    return m.evaluations;
}
