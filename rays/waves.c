/*
 * waves.c: rays that go anywhere, those of hits and of mirrors, in cubes of space.
 *
 * All rays of a wave take a step.  They are sorted by the cubes that they are in then, and those in a cube ask
 * its tape together.
 */
#include "rays/waves.h"

#include <math.h>
#include <string.h>

#include "rays/march.h"
#include "rays/ray_field.h"

/* Clips a blocked ray.  Rays of hits meet planes at once, and else only what is in the box. */
static void clip_blocked(const RayField *field, RayBlock *block, int i)
{
    float first = 0, last = fminf(block->end[i], block->plane[i]);
    for (int k = 0; k < 3; k++) {
        const float along = block->direction[k][i], safe = fabsf(along) < 1e-18f ? 1e-18f : along;
        const float a = (field->low[k] - block->origin[k][i]) / safe,
                    b = (field->high[k] - block->origin[k][i]) / safe;
        first         = fmaxf(first, fminf(a, b));
        last          = fminf(last, fmaxf(a, b));
    }
    if (first > last)
        block->state[i] = RAY_MISSES;
    if (first > 0) {
        block->t[i]     = first;
        block->slope[i] = -1;
        block->ratio[i] = 1;
        block->steps[i] = 1;
    }
    block->end[i] = last;
}

/* Cones that may meet a plane are not empty: at the far end of their axis it must be farther away than they are
   wide. */
static void block_cones(const Wave *wave, RayBlock *block)
{
    const RayField *field = wave->field;
    const float     far   = 1e4f * (1 + field->space.side);
    float           points[3][RAYS_OF_BLOCK];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < RAYS_OF_BLOCK; i++)
            points[k][i] = block->origin[k][i] + far * block->direction[k][i];
    const float *distances = cell_run(&field->plane_distance.cells,
                                      field->plane_distance.works[wave->part], 0,
                                      (const float(*)[CELL_LANES])points);
    for (int i = 0; i < RAYS_OF_BLOCK; i++)
        if (block->state[i] == RAY_MARCHES && distances[i] < far * (1.01f * block->cone[i] + 1e-6f))
            block->state[i] = RAY_HITS;
}

/* Begins the rays of hits. */
static void begin_blocked(const Wave *wave, RayBlock *block, float ends[RAYS_OF_BLOCK])
{
    memcpy(ends, block->end, sizeof block->end);
    ray_field_meet_planes(wave->field, wave->part, 1e30f, block);
    for (int i = 0; i < RAYS_OF_BLOCK; i++) {
        block->t[i] = block->clearance[i] = block->step[i] = 0;
        block->slope[i]                                    = block->facing[i];
        block->ratio[i]                                    = 0;
        block->took_least[i]                               = 1;
        block->steps[i] = block->unresolved[i] = 0;
        if (!wave->rule->cones && block->state[i] == RAY_MARCHES)
            clip_blocked(wave->field, block, i);
    }
    if (wave->rule->cones && wave->field->planes)
        block_cones(wave, block);
}

/* Ends rays that nothing else blocks at the plane that blocks them. */
static void end_blocked(const Wave *wave, RayBlock *block, const bool marched[RAYS_OF_BLOCK],
                        const float ends[RAYS_OF_BLOCK])
{
    for (int i = 0; i < RAYS_OF_BLOCK; i++) {
        if (block->state[i] == RAY_MARCHES)
            block->state[i] = RAY_MISSES;
        if (!wave->rule->cones && marched[i] && block->state[i] == RAY_MISSES &&
            !block->unresolved[i] && block->plane[i] < ends[i]) {
            block->state[i] = RAY_HITS;
            block->t[i]     = block->plane[i];
        }
    }
}

/* Returns how far a point is from the box around all that is marched, at least. */
static float distance_to_box(const RayField *field, const float point[3])
{
    float square = 0;
    for (int k = 0; k < 3; k++) {
        const float off = fmaxf(fmaxf(field->low[k] - point[k], point[k] - field->high[k]), 0);
        square += off * off;
    }
    return 0.9999f * sqrtf(square);
}

/* Cones go on outside of the box.  Where that is farther away than they are wide, it is asked in place of all that is in
   it. */
static bool is_beside(const Wave *wave, const RayBlock *block, uint32_t i, const float point[3],
                      float t, float *distance)
{
    if (wave->march || !wave->rule->cones || !(wave->space->side > 0))
        return false;
    *distance = distance_to_box(wave->field, point);
    return *distance > 2 * (block->cone[i] * t + block->margin[i]);
}

/* Lists a ray among those that ask in a cube. */
static void list_ray(Wave *wave, uint32_t number, uint32_t ray)
{
    if (wave->first_rays[number] < 0)
        wave->cubes[wave->cube_count++] = number;
    wave->next[ray]          = wave->first_rays[number];
    wave->first_rays[number] = (int32_t)ray;
}

/* Lists the rays of a block by cubes; false: none marches. */
static bool sort_rays(Wave *wave, uint32_t b)
{
    const RayBlock *block = &wave->blocks[b];
    const uint32_t  rays  = wave->field->set->place(block, HUGE_VALF, wave->at[b], wave->points[b]);
    for (uint32_t i = 0; i < RAYS_OF_BLOCK && rays > 0; i++) {
        if (block->state[i] != RAY_MARCHES && block->state[i] != RAY_REFINES)
            continue;
        const float point[3] = {wave->points[b][0][i], wave->points[b][1][i],
                                wave->points[b][2][i]};
        if (is_beside(wave, block, i, point, wave->at[b][i], &wave->distances[b][i]))
            continue;
        list_ray(wave, space_find(wave->space, wave->work, point), b * RAYS_OF_BLOCK + i);
    }
    wave->evaluations += rays;
    return rays > 0;
}

/* Evaluates the distances of all rays in a cube. */
static void ask_cube(Wave *wave, uint32_t number)
{
    const CellTape *tape     = &wave->space->cubes[number].tape;
    int32_t         next     = wave->first_rays[number];
    wave->first_rays[number] = -1;
    while (next >= 0) {
        float   points[3][CELL_WIDE];
        int32_t rays[CELL_WIDE];
        int     count = 0;
        for (; count < CELL_WIDE && next >= 0; count++) {
            rays[count] = next;
            next        = wave->next[next];
        }
        const int blocks = (count + RAYS_OF_BLOCK - 1) / RAYS_OF_BLOCK;
        for (int i = 0; i < blocks * RAYS_OF_BLOCK; i++) {
            const int32_t ray = rays[i < count ? i : 0];
            for (int k = 0; k < 3; k++)
                points[k][i] = wave->points[ray / RAYS_OF_BLOCK][k][ray % RAYS_OF_BLOCK];
        }
        const float *distances = cell_run_wide(tape, wave->work, 1,
                                               (const float(*)[CELL_WIDE])points, (size_t)blocks);
        for (int i = 0; i < count; i++)
            wave->distances[rays[i] / RAYS_OF_BLOCK][rays[i] % RAYS_OF_BLOCK] = fminf(distances[i],
                                                                                      tape->cap);
    }
}

/* The clearances of a ray that looks for surfaces are true ones, as its next distance may be in another cube. */
static void take_block(const Wave *wave, uint32_t b)
{
    const RaySet *set = wave->field->set;
    if (wave->march)
        set->take(&wave->blocks[b], wave->march, wave->at[b], HUGE_VALF, HUGE_VALF, 1,
                  wave->distances[b]);
    else
        set->take_blocked(&wave->blocks[b], wave->rule, wave->at[b], wave->distances[b]);
}

static void march_wave(Wave *wave, size_t count)
{
    wave->live_count = (uint32_t)count;
    for (uint32_t b = 0; b < count; b++)
        wave->live[b] = b;
    while (wave->live_count > 0) {
        uint32_t live    = 0;
        wave->cube_count = 0;
        for (uint32_t i = 0; i < wave->live_count; i++)
            if (sort_rays(wave, wave->live[i]))
                wave->live[live++] = wave->live[i];
        wave->live_count = live;
        for (uint32_t i = 0; i < wave->cube_count; i++)
            ask_cube(wave, wave->cubes[i]);
        for (uint32_t i = 0; i < live; i++)
            take_block(wave, wave->live[i]);
    }
}

/* Finds the normals of hits in a cube. */
static void find_normals_in_cube(Wave *wave, uint32_t number)
{
    const RayCell cell       = {&wave->space->cubes[number].tape, wave->work, 1};
    int32_t       next       = wave->first_rays[number];
    wave->first_rays[number] = -1;
    while (next >= 0) {
        RayHit hits[CELL_WIDE];
        size_t count = 0;
        for (; count < CELL_WIDE && next >= 0; next = wave->next[next])
            hits[count++] = (RayHit){&wave->blocks[next / RAYS_OF_BLOCK], next % RAYS_OF_BLOCK};
        wave->evaluations += ray_normals(&cell, wave->march, hits, count);
    }
}

/* Returns the smallest cube whose tape is right where the normal of a hit is found. */
static uint32_t find_cube_of_hit(const Wave *wave, const RayBlock *block, uint32_t i)
{
    const float t = block->t[i];
    float       point[3], largest = 0;
    for (int k = 0; k < 3; k++) {
        point[k] = block->origin[k][i] + t * block->direction[k][i];
        largest  = fmaxf(largest, fmaxf(fabsf(point[k]), fabsf(block->origin[k][i])));
    }
    const float reach = ray_normal_reach(wave->march, block->width[i] + block->spread[i] * t, t,
                                         largest);
    return space_find_ball(wave->space, wave->work, point, TAPS_REACH * reach);
}

static void find_normals_of_wave(Wave *wave, size_t count)
{
    wave->cube_count = 0;
    for (uint32_t b = 0; b < count; b++)
        for (uint32_t i = 0; i < RAYS_OF_BLOCK; i++)
            if (wave->blocks[b].state[i] == RAY_HITS)
                list_ray(wave, find_cube_of_hit(wave, &wave->blocks[b], i), b * RAYS_OF_BLOCK + i);
    for (uint32_t i = 0; i < wave->cube_count; i++)
        find_normals_in_cube(wave, wave->cubes[i]);
}

static Wave *begin_wave(RayField *field, size_t part, RayBlock *blocks)
{
    Wave *wave        = field->waves[part];
    wave->field       = field;
    wave->part        = part;
    wave->space       = &field->space;
    wave->work        = field->distance.works[part];
    wave->rule        = NULL;
    wave->march       = NULL;
    wave->blocks      = blocks;
    wave->evaluations = 0;
    return wave;
}

uint64_t ray_field_follow(RayField *field, size_t part, RayBlock *blocks, size_t count,
                          const RayRule *rule)
{
    Wave *wave  = begin_wave(field, part, blocks);
    wave->march = rule;
    for (size_t b = 0; b < count; b++)
        ray_begin_block(rule, &blocks[b]);
    march_wave(wave, count);
    if (rule->normal_reach > 0)
        find_normals_of_wave(wave, count);
    for (size_t b = 0; b < count; b++)
        wave->evaluations += ray_end_block(field, part, rule, &blocks[b]);
    return wave->evaluations;
}

uint64_t ray_field_block(RayField *field, size_t part, RayBlock *blocks, size_t count,
                         const BlockRule *rule)
{
    Wave *wave = begin_wave(field, part, blocks);
    wave->rule = rule;
    for (size_t b = 0; b < count; b++) {
        for (int i = 0; i < RAYS_OF_BLOCK; i++)
            wave->marched[b][i] = blocks[b].state[i] == RAY_MARCHES;
        begin_blocked(wave, &blocks[b], wave->ends[b]);
    }
    march_wave(wave, count);
    for (size_t b = 0; b < count; b++)
        end_blocked(wave, &blocks[b], wave->marched[b], wave->ends[b]);
    return wave->evaluations;
}
