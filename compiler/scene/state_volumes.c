/*
 * state_volumes.c: media that scatter light in a state: where they are, and how dense they are at most and at
 * least in the cells of their boxes.
 *
 * Paths choose where light is scattered by the most that a density can be.  Were it denser anywhere, light
 * would be wrong and nobody would know.  So bounds are not looked for by points: they are proven, by
 * interval arithmetic over each cell.
 */
#include <float.h>
#include <math.h>

#include "compiler/graph/bounds/facts.h"
#include "compiler/scene/program.h"

/* How far cells reach beyond their walls, in parts of their sides: shaders find by rounded numbers in
   which a point is.  And the part by which rounded densities may be beyond exact ones. */
#define BEYOND  1e-3
#define ROUNDED 1e-4

/* Returns the box of a medium, with sides that are not 0. */
static Box box_of(const KrsScene *scene, size_t volume)
{
    const Box box = scene->volumes[volume].box;
    return box_grow(box, 1e-4 * box_diagonal(box) + 1e-9);
}

KrsVolume krs_scene_volume(const KrsScene *scene, size_t volume)
{
    const Box box    = box_of(scene, volume);
    KrsVolume result = {.before = scene->volumes[volume].before};
    double    side   = 0;
    for (int k = 0; k < 3; k++) {
        result.low[k]  = box.axis[k].low;
        result.high[k] = box.axis[k].high;
        side           = fmax(side, result.high[k] - result.low[k]);
    }
    /* Cells are about cubes, as small as there is room for. */
    for (double count = HUGE_VAL, cell = side / 64; count > KRS_MAX_VOLUME_CELLS; cell *= 1.05) {
        count = 1;
        for (int k = 0; k < 3; k++) {
            result.cells[k] = (uint32_t)ceil((result.high[k] - result.low[k]) / cell);
            count *= result.cells[k];
        }
    }
    return result;
}

/* Returns a cell, and a little more. */
static Box cell_of(const KrsVolume *volume, const uint32_t at[3])
{
    Box cell;
    for (int k = 0; k < 3; k++) {
        const double side = (volume->high[k] - volume->low[k]) / volume->cells[k];
        cell.axis[k].low  = volume->low[k] + (at[k] - BEYOND) * side;
        cell.axis[k].high = volume->low[k] + (at[k] + 1 + BEYOND) * side;
    }
    return cell;
}

/* Finds the bounds of all cells; false with the cell in `at` where there is none. */
static bool find_bounds(const KrsState *state, size_t number, const KrsVolume *volume,
                        float (*bounds)[2], uint32_t at[3], Arena *arena)
{
    const KrsScene *scene   = state->scene;
    const Node      density = volume_roots(&scene->roots, number)->density;
    const RangeTask task    = range_task(scene->graph, &density, 1, arena);
    range_task_set(&task, (const double(*)[4])state->parameters);
    for (at[2] = 0; at[2] < volume->cells[2]; at[2]++)
        for (at[1] = 0; at[1] < volume->cells[1]; at[1]++)
            for (at[0] = 0; at[0] < volume->cells[0]; at[0]++, bounds++) {
                range_task_run(&task, cell_of(volume, at));
                const Range range = range_task_value(&task, density);
                if (!(range.high < FLT_MAX))
                    return false;
                (*bounds)[0] = (float)fmax(range.low * (1 - ROUNDED), 0);
                (*bounds)[1] = (float)fmax(range.high * (1 + ROUNDED), 0);
            }
    return true;
}

/* Does the same; where memory runs out, longjmp returns here. */
static KrsStatus find_guarded(const KrsState *state, size_t number, const KrsVolume *volume,
                              float (*bounds)[2], uint32_t at[3], Arena *arena)
{
    jmp_buf exhausted;
    arena->memory->exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return KRS_OUT_OF_MEMORY;
    return find_bounds(state, number, volume, bounds, at, arena) ? KRS_OK : KRS_BAD_SCENE;
}

KrsStatus state_volume(KrsState *state, size_t number, const KrsVolume *volume, float (*bounds)[2],
                       uint32_t at[3])
{
    const Memory *from = &state->scene->memory;
    Memory memory      = {.allocate = from->allocate, .release = from->release, .user = from->user};
    Arena  arena       = {.memory = &memory};
    const KrsStatus status = find_guarded(state, number, volume, bounds, at, &arena);
    arena_free(&arena);
    return status;
}

KrsStatus krs_state_volume(KrsState *state, size_t number, float (*bounds)[2])
{
    const KrsVolume volume = krs_scene_volume(state->scene, number);
    uint32_t        at[3];
    return state_volume(state, number, &volume, bounds, at);
}

double krs_state_density(KrsState *state, size_t volume, const double point[3])
{
    state_refresh_points(state);
    tape_run_point(&state->scene->volumes_tape, point, state->values);
    return state->values[volume_roots(&state->scene->roots, volume)->density].v[0];
}
