/*
 * space.c: an octree of cubes with tapes of their own.
 */
#include "rays/space.h"

#include <math.h>
#include <string.h>

#include "compiler/base/parallel.h"

/* There are no more cubes, with all of space. */
enum { CHILDREN = 8, DEEPEST = 5, MOST_CUBES = 1 + ((1 << 3 * (DEEPEST + 1)) - 1) / 7 };
/* Shorter tapes are not worth another. */
enum { SHORT_TAPE = 40 };
/* The room for all tapes of a space: as many steps as so many times the whole has, within limits.  Spaces of few
   threads have more, as all of them share MOST_SHARED.  Without room cubes stay undivided, which takes longer, and which
   ones do depends on the order of rays. */
enum {
    TIMES_WHOLE    = 2000,
    LEAST_STEPS    = 1 << 18,
    MOST_STEPS     = 1 << 22,
    MOST_SHARED    = 1 << 25,
    CALLS_OF_CUBES = 1 << 14,
    MOST_LISTED    = 1 << 20
};

/* Leaves the cubes that are there from the beginning. */
static void clear(Space *space, const CellTape *tape)
{
    const bool divides = space->side > 0;
    space->step_count = space->call_count = space->listed_count = 0;
    for (space->count = 0; space->count < (divides ? 2u : 1u); space->count++)
        space->cubes[space->count] = (SpaceCube){.tape = *tape, .leaf = !divides, .rays = -1};
}

void space_new(Space *space, const CellTape *tape, CellWork *work, const float low[3],
               const float high[3], float margin, Arena *arena)
{
    double       side   = 0;
    size_t       room   = (size_t)tape->count * TIMES_WHOLE;
    const size_t shared = MOST_SHARED / parallel_parts(),
                 most   = shared > MOST_STEPS ? shared : MOST_STEPS;
    for (int k = 0; k < 3; k++)
        side = fmax(side, (double)high[k] - (double)low[k]);
    room               = room < LEAST_STEPS ? LEAST_STEPS : room > most ? most : room;
    const bool divides = side > 0 && side < 1e30;
    *space             = (Space){.side        = divides ? (float)side : 0,
                                 .margin      = margin,
                                 .work        = work,
                                 .most        = divides ? MOST_CUBES : 1,
                                 .most_steps  = divides ? room : 0,
                                 .most_calls  = (size_t)tape->call_count * CALLS_OF_CUBES,
                                 .most_listed = tape->call_count ? MOST_LISTED : 0};
    space->cubes       = arena_new_array(arena, SpaceCube, space->most);
    space->steps       = arena_new_array(arena, CellStep, space->most_steps + 1);
    space->calls       = arena_new_array(arena, CellCall, space->most_calls + 1);
    space->listed      = arena_new_array(arena, uint32_t, space->most_listed + 1);
    for (int k = 0; k < 3; k++)
        space->low[k] = low[k];
    clear(space, tape);
}

void space_clear_full(Space *space)
{
    const CellTape whole = space->cubes[0].tape;
    if (space->full)
        clear(space, &whole);
    space->full = false;
}

/* Keeps the instances of calls; false: there is no room. */
static bool keep_instances(Space *space, CellCall *calls, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t *kept = space->listed + space->listed_count;
        if (!calls[i].instances)
            continue;
        if (calls[i].instance_count > space->most_listed - space->listed_count)
            return false;
        memcpy(kept, calls[i].instances, calls[i].instance_count * sizeof *kept);
        calls[i].instances = kept;
        space->listed_count += calls[i].instance_count;
    }
    return true;
}

/* Keeps a tape that was made for a cube; false: there is no room. */
static bool keep(Space *space, CellTape tape)
{
    CellStep *steps = space->steps + space->step_count;
    CellCall *calls = space->calls + space->call_count;
    if (tape.count > space->most_steps - space->step_count ||
        tape.call_count > space->most_calls - space->call_count)
        return false;
    memcpy(steps, tape.steps, tape.count * sizeof *steps);
    memcpy(calls, tape.calls, tape.call_count * sizeof *calls);
    if (!keep_instances(space, calls, tape.call_count))
        return false;
    space->step_count += tape.count;
    space->call_count += tape.call_count;
    tape.steps                   = steps;
    tape.calls                   = calls;
    space->cubes[space->count++] = (SpaceCube){
        .tape = tape, .leaf = cell_cost(&tape) < SHORT_TAPE, .rays = -1};
    return true;
}

/* Makes the children of a cube with this corner; false: there is no room. */
static bool divide(Space *space, uint32_t number, const float corner[3], float half)
{
    const CellTape tape   = space->cubes[number].tape;
    const uint32_t first  = space->count;
    const float    radius = 0.5f * sqrtf(3) * half * 1.0001f;
    bool           good   = first + CHILDREN <= space->most;
    float          middles[3][CELL_LANES];
    for (int i = 0; i < CELL_LANES; i++)
        for (int k = 0; k < 3; k++)
            middles[k][i] = corner[k] + half * ((i >> k & 1) ? 1.5f : 0.5f);
    if (good)
        cell_run(&tape, space->work, 0, (const float(*)[CELL_LANES])middles);
    for (uint32_t i = 0; i < CHILDREN && good; i++) {
        const CellMark mark = cell_mark(space->work);
        good = keep(space, cell_prune(&tape, space->work, 0, i, radius, space->margin));
        cell_release(space->work, mark);
    }
    if (good)
        space->cubes[number].first_child = first;
    else
        space->count = first;
    return good;
}

uint32_t space_find(Space *space, const float point[3])
{
    float    corner[3], half = 0.5f * space->side;
    uint32_t number = 1;
    bool     inside = space->side > 0;
    for (int k = 0; k < 3; k++) {
        corner[k] = space->low[k];
        inside    = inside && point[k] >= corner[k] && point[k] <= corner[k] + space->side;
    }
    if (!inside)
        return 0;
    for (int depth = 0; depth < DEEPEST && !space->cubes[number].leaf; depth++, half *= 0.5f) {
        uint32_t child = 0;
        if (!space->cubes[number].first_child && !divide(space, number, corner, half)) {
            space->cubes[number].leaf = space->full = true;
            break;
        }
        for (int k = 0; k < 3; k++)
            if (point[k] > corner[k] + half) {
                child |= 1u << k;
                corner[k] += half;
            }
        number = space->cubes[number].first_child + child;
    }
    return number;
}
