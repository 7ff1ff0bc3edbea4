/*
 * lanes_loop.h: the functions of lanes.h, for the instruction set that this is compiled for.
 *
 * Loops have no branches, so the compiler turns them into vector instructions.
 */
#include <math.h>

#include "rays/lanes.h"

#ifndef __clang__
#pragma GCC optimize("no-tree-pre") /* it makes branches of choices */
#endif

#ifdef __clang__
#define EACH_RAY \
    _Pragma("clang loop vectorize(assume_safety)") for (size_t i = 0; i < RAYS_OF_BLOCK; i++)
#else
#define EACH_RAY \
    _Pragma("GCC ivdep") _Pragma("GCC unroll 1") for (size_t i = 0; i < RAYS_OF_BLOCK; i++)
#endif

/* These numbers are those of trace.comp, frame.glsl and march_step.glsl. */
static const float ROUNDING = 2.4e-7f, TOLERANCE = 0.05f, MAX_TOLERANCE = 0.0125f, LEARNING = 0.3f,
                   OVERSHOOT = 1.05f, SHALLOW = 0.25f, SEAM = 4;

static inline float lesser(float a, float b) { return b < a ? b : a; }
static inline float greater(float a, float b) { return b > a ? b : a; }

static uint32_t place(const RayBlock *block, float last, float at[RAYS_OF_BLOCK],
                      float points[3][RAYS_OF_BLOCK])
{
    uint32_t count = 0;
    EACH_RAY
    {
        const bool  marches = (block->state[i] == RAY_MARCHES) | (block->state[i] == RAY_REFINES);
        const float t = block->t[i], end = lesser(block->end[i], last);
        at[i] = lesser(t + block->step[i], greater(end, t));
        count += marches & (t < last);
    }
    for (int k = 0; k < 3; k++)
        EACH_RAY points[k][i] = block->origin[k][i] + at[i] * block->direction[k][i];
    return count;
}

static bool has(const RayBlock *block, float first, float last)
{
    uint32_t count = 0;
    EACH_RAY
    {
        const bool marches = (block->state[i] == RAY_MARCHES) | (block->state[i] == RAY_REFINES);
        count += marches & (block->t[i] < last) & (block->end[i] >= first);
    }
    return count > 0;
}

static void sum(const RayBlock *block, float sums[RAY_SUMS][RAYS_OF_BLOCK])
{
    for (int k = 0; k < 3; k++)
        EACH_RAY
        {
            const bool there = (block->state[i] == RAY_MARCHES) |
                               (block->state[i] == RAY_IS_BESIDE);
            const float origin = block->origin[k][i], direction = block->direction[k][i],
                        origins = sums[k][i], directions = sums[3 + k][i];
            sums[k][i]     = there ? origins + origin : origins;
            sums[3 + k][i] = there ? directions + direction : directions;
        }
    EACH_RAY
    {
        const bool  there = (block->state[i] == RAY_MARCHES) | (block->state[i] == RAY_IS_BESIDE);
        const float count = sums[6][i];
        sums[6][i]        = there ? count + 1 : count;
    }
}

/* Takes the greatest numbers of rows, of rays that are there. */
static inline void take_greatest(const RayBlock *block, const float *row, float *most)
{
    EACH_RAY
    {
        const bool  there  = (block->state[i] == RAY_MARCHES) | (block->state[i] == RAY_IS_BESIDE);
        const float before = most[i], now = row[i];
        most[i] = (there & (now > before)) ? now : before;
    }
}

static void spread(const RayBlock *block, const float origin[3], const float direction[3],
                   float most[RAY_SPREADS][RAYS_OF_BLOCK])
{
    float from[RAYS_OF_BLOCK] = {0}, aside[RAYS_OF_BLOCK] = {0};
    for (int k = 0; k < 3; k++)
        EACH_RAY
        {
            const float o = block->origin[k][i] - origin[k],
                        d = block->direction[k][i] - direction[k];
            from[i] += o * o;
            aside[i] += d * d;
        }
    take_greatest(block, from, most[0]);
    take_greatest(block, aside, most[1]);
    take_greatest(block, block->width, most[2]);
    take_greatest(block, block->spread, most[3]);
}

static void skip(RayBlock *block, float last)
{
    EACH_RAY
    {
        const bool marches = (block->state[i] == RAY_MARCHES) & (block->side[i] >= 0) &
                             (block->t[i] < last);
        block->t[i]         = marches ? last : block->t[i];
        block->side[i]      = marches ? 1 : block->side[i];
        block->clearance[i] = marches ? 0 : block->clearance[i];
        block->step[i]      = marches ? 0 : block->step[i];
        block->slope[i]     = marches ? -1 / (1 - LEARNING) : block->slope[i];
        block->state[i]     = (marches & (last > block->end[i])) ? (uint32_t)RAY_MISSES
                                                                 : block->state[i];
    }
}

static void take(RayBlock *block, const RayRule *rule, const float ats[RAYS_OF_BLOCK], float last,
                 float cap, float steepest, const float distances[RAYS_OF_BLOCK])
{
    const float    longer    = 1 / steepest;
    const float    in_pixels = lesser(TOLERANCE * rule->error, MAX_TOLERANCE), error = rule->error;
    const uint32_t max_steps = rule->max_steps;
    EACH_RAY
    {
        const uint32_t state    = block->state[i];
        const float    old_step = block->step[i], old_slope = block->slope[i],
                    old_side     = block->side[i];
        const uint32_t old_steps = block->steps[i], old_unresolved = block->unresolved[i];
        const float    end = block->end[i];
        const float    at = ats[i], t = block->t[i], step = at - t, before = block->clearance[i];
        const bool     refines = state == RAY_REFINES;
        const bool     marches = ((state == RAY_MARCHES) | refines) & (t < last);
        const float    x = fabsf(block->origin[0][i]), y = fabsf(block->origin[1][i]),
                    z         = fabsf(block->origin[2][i]);
        const float rounded   = ROUNDING * (greater(greater(x, y), z) + at);
        const float pixel     = block->width[i] + block->spread[i] * at;
        const float distance  = longer * lesser(distances[i], cap);
        const float side      = old_side != 0 ? old_side : distance < 0 ? -1.0f : 1.0f;
        const float clearance = side * distance + (side < 0 ? SEAM * rounded : 0);
        const float tolerance = in_pixels * pixel + rounded, permitted = error * pixel;
        const float unverified = step - before;
        const bool  found    = ((clearance <= 0) & (unverified <= permitted + tolerance)) | refines;
        const bool  verified = !found & (clearance > 0) &
                              (step - before <= clearance + 1.01f * tolerance);
        const bool accurate = (unverified <= 2 * tolerance) | refines |
                              (-clearance <= SHALLOW * before);
        const float    along    = before > clearance ? lesser(before / (before - clearance), 2) : 0;
        const float    crossing = greater(step * along, before);
        const float    last_slope = step > 0 ? (clearance - before) / step : 0;
        const float    slope      = (1 - LEARNING) * old_slope + LEARNING * last_slope;
        const float    shorter    = greater(0.4f * (step + before - greater(clearance, 0)),
                                            before + tolerance);
        const bool     crosses    = OVERSHOOT * clearance <= -last_slope * (clearance + permitted);
        const float    factor = crosses ? OVERSHOOT / -last_slope : 2 / (1 - lesser(slope, 0.98f));
        const float    next   = greater(clearance, factor * clearance) + tolerance;
        const bool     hits   = found & accurate;
        const bool     misses = verified & (at + clearance >= end);
        const uint32_t after  = found    ? (accurate ? RAY_HITS : RAY_REFINES)
                                : misses ? RAY_MISSES
                                         : RAY_MARCHES;
        const uint32_t steps  = old_steps + 1;
        const bool     ends   = !hits & !misses & (steps >= max_steps);
        const float    new_t  = verified ? at : t + (hits ? crossing : 0);
        const float    new_step = verified ? next : found ? crossing : shorter;
        block->t[i]             = marches ? new_t : t;
        block->step[i]          = marches ? new_step : old_step;
        block->clearance[i]     = (marches & verified) ? clearance : before;
        block->slope[i]         = !marches ? old_slope : verified ? slope : -1;
        block->side[i]          = marches ? side : old_side;
        block->steps[i]         = marches ? steps : old_steps;
        block->unresolved[i]    = (marches & ends) ? 1 : old_unresolved;
        block->state[i]         = !marches ? state : ends ? (uint32_t)RAY_MISSES : after;
    }
}

/* These numbers are those of secondary.comp. */
static const float SAFETY = 0.6f, BLOCK_LEARNING = 0.5f, STEEPEST = 0.9f, NEAR_START = 8,
                   MIN_OF_LENGTH = 0.25f;
/* A cone that takes longer proves nothing: rays are sent. */
enum { MAX_BLOCK_STEPS = 1024, MAX_CONE_STEPS = 64 };

/* The kind is known when this is compiled: a choice that is the same in all lanes is no vector instruction. */
static inline __attribute__((always_inline)) void
take_of_kind(RayBlock *block, const BlockRule *rule, const bool cones, const bool over_hemisphere,
             const float ats[RAYS_OF_BLOCK], const float distances[RAYS_OF_BLOCK])
{
    const float    growth = rule->growth, far = rule->far;
    const uint32_t most = cones ? MAX_CONE_STEPS : MAX_BLOCK_STEPS;
    EACH_RAY
    {
        const float old_step = block->step[i], old_slope = block->slope[i],
                    old_ratio    = block->ratio[i];
        const uint32_t old_steps = block->steps[i], old_unresolved = block->unresolved[i],
                       old_state = block->state[i];
        const float old_took     = block->took_least[i];
        const float lift = block->lift[i], width = block->width[i], rounding = block->rounding[i];
        const float at = ats[i], t = block->t[i], step = at - t, before = block->clearance[i];
        const bool  marches  = old_state == RAY_MARCHES;
        const float distance = block->side[i] * distances[i];
        const float cone = block->cone[i], margin = block->margin[i], facing = block->facing[i];
        const float end = block->end[i], least = block->least[i];
        const uint32_t steps   = old_steps + 1;
        const float    first   = lesser(greater(distance / lift, 0.0625f), 1);
        const float    ratio   = steps == 1 ? first : old_ratio;
        const float    needed  = cone * at + lesser(margin, 0.5f * facing * at);
        const float    part    = lesser(at / (NEAR_START * width), 1);
        const float    near    = ratio + (1 - ratio) * part;
        const bool     inside  = distance < (cones ? needed : near * rounding);
        const float    per_gap = 1 / greater(step, 1e-30f);
        const float    behind = 0.5f * (step + (distance - before) * (distance + before) * per_gap);
        const float    lateral   = greater(distance * distance - behind * behind, 0);
        const float    there     = at - behind,
                    needed_there = cone * there + lesser(margin, 0.5f * facing * there);
        const bool narrow        = (behind > 0) & (behind < step) &
                            (lateral < needed_there * needed_there);
        const bool overstepped = (old_took < 0.5f) & (step > before) &
                                 (narrow | (step > before + distance));
        const bool  back  = overstepped & !(inside & !cones);
        const float risen = (1 - BLOCK_LEARNING) * old_slope +
                            BLOCK_LEARNING * (distance - before) * per_gap;
        const float begun      = ((steps == 1) & (distance > 2 * lift)) ? -1.0f : old_slope;
        const float slope      = back ? -1.0f : step > 0 ? risen : begun;
        const bool  blocked    = inside & !back;
        const bool  arrives    = at + greater(distance, least) >= end;
        const bool  took_least = !back & (distance < least);
        const float chord      = step * distance / greater(before - distance, 1e-30f);
        const float crossing   = old_slope > 0 ? distance : chord;
        const float around     = sqrtf(greater(distance * distance - needed * needed, 0));
        const float relaxed    = greater(
               2 * SAFETY / (1 - lesser(greater(slope, -1), STEEPEST)) * around, distance);
        const float    wanted   = took_least ? least : greater(relaxed, least);
        const float    hurried  = (over_hemisphere & (step > 0) & (distance > before))
                                      ? (at > far ? 1 : MIN_OF_LENGTH) * at
                                      : 0;
        const float    next     = lesser(greater(wanted, hurried), greater(end - at, 0));
        const bool     too_many = steps >= most;
        const bool     misses = !back & arrives, gives_up = too_many & !blocked & !misses;
        const uint32_t after = blocked ? RAY_HITS : (misses | gives_up) ? RAY_MISSES : RAY_MARCHES;
        const float    moved = (blocked & !cones) ? at + lesser(crossing, 0) : at;
        block->t[i]          = (marches & !back) ? moved : t;
        block->step[i]       = marches ? (back ? before : next) : old_step;
        block->clearance[i]  = (marches & !back) ? distance : before;
        block->slope[i]      = marches ? slope : old_slope;
        block->ratio[i]      = marches ? ratio : old_ratio;
        block->least[i]      = marches ? least * growth : least;
        const float took     = distance < least ? 1.0f : hurried > wanted ? 1.0f : 0.0f;
        block->took_least[i] = !marches ? old_took : back ? 0 : took;
        block->steps[i]      = marches ? steps : old_steps;
        block->unresolved[i] = !marches ? old_unresolved : gives_up ? 1u : old_unresolved;
        block->state[i]      = marches ? after : old_state;
    }
}

static void take_blocked(RayBlock *block, const BlockRule *rule, const float at[RAYS_OF_BLOCK],
                         const float distances[RAYS_OF_BLOCK])
{
    if (rule->cones)
        take_of_kind(block, rule, true, false, at, distances);
    else if (rule->over_hemisphere)
        take_of_kind(block, rule, false, true, at, distances);
    else
        take_of_kind(block, rule, false, false, at, distances);
}

const RaySet RAY_SET = {RAY_SET_NAME, place, take, skip, take_blocked, sum, spread, has};
