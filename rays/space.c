/*
 * space.c: an octree of cubes with tapes of their own.
 */
#include "rays/space.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { CHILDREN = 8, DEEPEST = 5, MAX_CUBES = 1 + ((1 << 3 * (DEEPEST + 1)) - 1) / 7 };
/* The room for all tapes of a space: as many steps as so many times the whole has, within limits.  Without room cubes stay
   undivided, which takes longer, and which ones do depends on the order of rays. */
enum {
    TIMES_WHOLE      = 2000,
    MIN_STEPS        = 1 << 18,
    CALLS_OF_CUBES   = 1 << 14,
    MAX_SPACE_LISTED = 1 << 20
};

/* Leaves the cubes that are there from the beginning. */
static void clear(Space *space, const CellTape *tape)
{
    const bool divides = space->side > 0;
    space->step_count = space->call_count = space->listed_count = 0;
    for (space->count = 0; space->count < (divides ? 2u : 1u); space->count++) {
        SpaceCube *cube = &space->cubes[space->count];
        cube->tape      = *tape;
        atomic_store(&cube->first_child, 0);
        atomic_store(&cube->leaf, !divides);
        atomic_store(&cube->made, true);
    }
    for (uint32_t i = 0; i < space->cells * space->cells * space->cells; i++)
        atomic_store_explicit(&space->leaf_of[i], 0, memory_order_relaxed);
    atomic_store(&space->full, false);
}

void space_new(Space *space, const CellTape *tape, const float low[3], const float high[3],
               const SpaceRule *rule, Arena *arena)
{
    double side = 0;
    size_t room = (size_t)tape->count * TIMES_WHOLE;
    for (int k = 0; k < 3; k++)
        side = fmax(side, (double)high[k] - (double)low[k]);
    room               = room < MIN_STEPS ? MIN_STEPS : room;
    room               = room > rule->max_steps || tape->call_count > 0 ? rule->max_steps : room;
    const bool divides = side > 0 && side < 1e30;
    *space             = (Space){.side       = divides ? (float)side : 0,
                                 .stretch    = rule->stretch,
                                 .margin     = rule->margin,
                                 .deepest    = divides ? rule->deepest : 0,
                                 .cells      = divides ? 1u << rule->deepest : 0,
                                 .short_tape = rule->short_tape,
                                 .most       = divides ? MAX_CUBES : 1,
                                 .max_steps  = divides ? room : 0,
                                 .max_calls  = (size_t)tape->call_count * CALLS_OF_CUBES,
                                 .max_listed = tape->call_count ? MAX_SPACE_LISTED : 0};
    assert(rule->deepest <= DEEPEST);
    space->leaf_of = arena_new_array(arena, atomic_uint,
                                     space->cells * space->cells * space->cells + 1);
    space->cubes   = arena_new_array(arena, SpaceCube, space->most);
    space->steps   = arena_new_array(arena, CellStep, space->max_steps + 1);
    space->calls   = arena_new_array(arena, CellCall, space->max_calls + 1);
    space->listed  = arena_new_array(arena, uint32_t, space->max_listed + 1);
    for (int k = 0; k < 3; k++)
        space->low[k] = low[k];
    pthread_mutex_init(&space->room, NULL);
    for (int i = 0; i < SPACE_GATES; i++)
        pthread_mutex_init(&space->gates[i], NULL);
    clear(space, tape);
}

void space_free(Space *space)
{
    if (!space->cubes)
        return;
    pthread_mutex_destroy(&space->room);
    for (int i = 0; i < SPACE_GATES; i++)
        pthread_mutex_destroy(&space->gates[i]);
}

void space_clear_full(Space *space)
{
    const CellTape whole = space->cubes[0].tape;
    if (atomic_load(&space->full))
        clear(space, &whole);
}

/* ---- cubes ---- */

static size_t instances_of(const CellTape *tape)
{
    size_t count = 0;
    for (uint32_t i = 0; i < tape->call_count; i++)
        count += tape->calls[i].instances ? tape->calls[i].instance_count : 0;
    return count;
}

/* Room that a tape is copied to. */
typedef struct Room {
    CellStep *steps;
    CellCall *calls;
    uint32_t *listed;
} Room;

static bool take_room(Space *space, const CellTape *tape, Room *room)
{
    const size_t listed = instances_of(tape);
    pthread_mutex_lock(&space->room);
    const bool good = tape->count <= space->max_steps - space->step_count &&
                      tape->call_count <= space->max_calls - space->call_count &&
                      listed <= space->max_listed - space->listed_count;
    *room = (Room){space->steps + space->step_count, space->calls + space->call_count,
                   space->listed + space->listed_count};
    space->step_count += good ? tape->count : 0;
    space->call_count += good ? tape->call_count : 0;
    space->listed_count += good ? listed : 0;
    pthread_mutex_unlock(&space->room);
    return good;
}

/* Takes numbers for the children of a cube; 0: there are no more. */
static uint32_t take_numbers(Space *space)
{
    pthread_mutex_lock(&space->room);
    const bool     good  = CHILDREN <= space->most - space->count;
    const uint32_t first = good ? space->count : 0;
    for (uint32_t i = 0; i < CHILDREN && good; i++) {
        SpaceCube *cube = &space->cubes[space->count++];
        atomic_store(&cube->first_child, 0);
        atomic_store(&cube->made, false);
    }
    pthread_mutex_unlock(&space->room);
    return first;
}

/* Keeps a tape that was made for a cube; false: there is no room. */
static bool keep(Space *space, CellTape tape, SpaceCube *cube)
{
    Room room;
    if (!take_room(space, &tape, &room))
        return false;
    memcpy(room.steps, tape.steps, tape.count * sizeof *room.steps);
    memcpy(room.calls, tape.calls, tape.call_count * sizeof *room.calls);
    for (uint32_t i = 0; i < tape.call_count; i++) {
        CellCall *call = &room.calls[i];
        if (!call->instances)
            continue;
        memcpy(room.listed, call->instances, call->instance_count * sizeof *room.listed);
        call->instances = room.listed;
        room.listed += call->instance_count;
    }
    tape.steps = room.steps;
    tape.calls = room.calls;
    cube->tape = tape;
    return true;
}

/* Returns the radius of the ball in which the tape of a cube of this side is right. */
static float ball_of_cube(const Space *space, float side)
{
    return space->stretch * 0.5f * sqrtf(3) * side;
}

/* Makes a cube with this corner within another one.  Without room it has the tape of that. */
static void make(Space *space, CellWork *work, const SpaceCube *around, const float corner[3],
                 float side, SpaceCube *cube)
{
    const float    radius = 1.0001f * ball_of_cube(space, side);
    const CellMark mark   = cell_mark(work);
    float          middles[3][CELL_LANES];
    for (int i = 0; i < CELL_LANES; i++)
        for (int k = 0; k < 3; k++)
            middles[k][i] = corner[k] + 0.5f * side;
    cell_run(&around->tape, work, 0, (const float(*)[CELL_LANES])middles);
    const bool kept = keep(space, cell_prune(&around->tape, work, 0, 0, radius, space->margin),
                           cube);
    cell_release(work, mark);
    if (!kept) {
        cube->tape = around->tape;
        atomic_store(&space->full, true);
    }
    atomic_store(&cube->leaf, !kept || cell_cost(&cube->tape) < space->short_tape);
    atomic_store_explicit(&cube->made, true, memory_order_release);
}

/* Returns the first child of a cube; 0: it is a leaf. */
static uint32_t first_child_of(Space *space, uint32_t number)
{
    SpaceCube *cube  = &space->cubes[number];
    uint32_t   first = atomic_load_explicit(&cube->first_child, memory_order_acquire);
    if (first > 0 || atomic_load(&cube->leaf))
        return first;
    pthread_mutex_t *gate = &space->gates[number % SPACE_GATES];
    pthread_mutex_lock(gate);
    first = atomic_load(&cube->first_child);
    if (first == 0 && !atomic_load(&cube->leaf)) {
        first = take_numbers(space);
        atomic_store(&cube->leaf, first == 0);
        if (first == 0)
            atomic_store(&space->full, true);
        atomic_store_explicit(&cube->first_child, first, memory_order_release);
    }
    pthread_mutex_unlock(gate);
    return first;
}

/* Returns the child with this corner, which the first thread that asks for it makes; 0: the cube is
   a leaf. */
static uint32_t child_of(Space *space, CellWork *work, uint32_t number, uint32_t child,
                         const float corner[3], float side)
{
    const uint32_t first = first_child_of(space, number);
    SpaceCube     *cube  = &space->cubes[first + child];
    if (first == 0 || atomic_load_explicit(&cube->made, memory_order_acquire))
        return first == 0 ? 0 : first + child;
    pthread_mutex_t *gate = &space->gates[(first + child) % SPACE_GATES];
    pthread_mutex_lock(gate);
    if (!atomic_load(&cube->made))
        make(space, work, &space->cubes[number], corner, side, cube);
    pthread_mutex_unlock(gate);
    return first + child;
}

/* ---- who asks ---- */

/* Returns the child in whose octant a point is; the corner becomes that of the child. */
static uint32_t enter_child(const float point[3], float corner[3], float half)
{
    uint32_t child = 0;
    for (int k = 0; k < 3; k++)
        if (point[k] > corner[k] + half) {
            child |= 1u << k;
            corner[k] += half;
        }
    return child;
}

/* Returns the cube that has a cell of the deepest level. */
static uint32_t find_leaf(Space *space, CellWork *work, const uint32_t cell[3])
{
    float    corner[3] = {space->low[0], space->low[1], space->low[2]}, half = 0.5f * space->side;
    uint32_t number = 1;
    for (uint32_t level = space->deepest; level-- > 0; half *= 0.5f) {
        uint32_t child = 0;
        for (int k = 0; k < 3; k++) {
            child |= (cell[k] >> level & 1) << k;
            corner[k] += (cell[k] >> level & 1) ? half : 0;
        }
        const uint32_t next = child_of(space, work, number, child, corner, half);
        if (next == 0)
            break;
        number = next;
    }
    return number;
}

uint32_t space_find(Space *space, CellWork *work, const float point[3])
{
    const float cells = (float)space->cells;
    uint32_t    cell[3];
    for (int k = 0; k < 3; k++) {
        const float at = (point[k] - space->low[k]) * (cells / space->side);
        if (!(at >= 0 && at <= cells) || !(space->side > 0))
            return 0;
        cell[k] = at < cells ? (uint32_t)at : space->cells - 1;
    }
    atomic_uint *leaf =
        &space->leaf_of[(cell[2] * space->cells + cell[1]) * space->cells + cell[0]];
    uint32_t number = atomic_load_explicit(leaf, memory_order_acquire);
    if (number == 0) {
        number = find_leaf(space, work, cell);
        atomic_store_explicit(leaf, number, memory_order_release);
    }
    return number;
}

uint32_t space_find_ball(Space *space, CellWork *work, const float middle[3], float radius)
{
    float    corner[3], half = 0.5f * space->side;
    uint32_t number = 1;
    if (!(space->side > 0))
        return 0;
    memcpy(corner, space->low, sizeof corner);
    for (uint32_t depth = 0; depth < space->deepest; depth++, half *= 0.5f) {
        float inner[3], square = 0;
        memcpy(inner, corner, sizeof inner);
        const uint32_t child = enter_child(middle, inner, half);
        for (int k = 0; k < 3; k++) {
            const float off = middle[k] - (inner[k] + 0.5f * half);
            square += off * off;
        }
        if (!(sqrtf(square) + radius <= ball_of_cube(space, half)))
            break;
        const uint32_t next = child_of(space, work, number, child, inner, half);
        if (next == 0)
            break;
        memcpy(corner, inner, sizeof corner);
        number = next;
    }
    return number;
}
