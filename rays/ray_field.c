/*
 * ray_field.c: distances of a state of a scene for rays.
 */
#include "rays/ray_field.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static_assert((int)RAYS_OF_BLOCK == (int)CELL_LANES, "a block is run at once");

const char *ray_field_refuses(const KrsScene *scene)
{
    const KrsProgram *program = &scene->program;
    if (scene->component_count == 0)
        return "the scene shows nothing";
    if (program->along || program->open_surfaces)
        return "rays go from root to root of what the scene shows";
    return NULL;
}

/* ---- tapes ---- */

NodeValue *ray_copy_values(const KrsState *state, Arena *arena)
{
    const size_t count  = state->scene->graph->count;
    NodeValue   *values = arena_new_array(arena, NodeValue, count + 1);
    memcpy(values, state->values, count * sizeof *values);
    return values;
}

/* The coordinates that count of what has no end: pixels are much wider than rounding, farther
   away. */
static const double ENDLESS = 1e4;

float ray_margin(const KrsProgram *program)
{
    double most = 1;
    for (int k = 0; k < 3; k++) {
        const double side = fmax(fabs(program->rest_low[k]), fabs(program->rest_high[k]));
        most              = fmax(most, side < 1e30 ? side : ENDLESS);
    }
    return 2e-6f * (float)most;
}

/* Completes a tape whose lanes are made; `values` are those of the frame. */
static void finish_tape(RayField *field, RayTape *tape, const NodeValue *values, uint32_t depth)
{
    LaneTape *lanes = &tape->lanes;
    lanes->scalars  = arena_new_array(&field->arena, double, lanes->scalar_count + 1);
    lane_tape_scalars(lanes, values, lanes->scalars);
    tape->cells = cell_tape_new(lanes, values, &field->arena);
    for (size_t i = 0; i < parallel_parts(); i++)
        tape->works[i] = cell_work_new(
            &tape->cells, depth,
            lanes->reads_tables ? ray_copy_values(field->state, &field->arena) : NULL,
            &field->arena);
}

/* Makes the least distance of the components that are planes, or of all others, cut by zones. */
void ray_field_make_distance(RayField *field, bool planes, RayTape *tape, uint32_t depth)
{
    const KrsScene *scene    = field->state->scene;
    const bool     *is_plane = field->planes ? scene->module.is_plane : NULL;
    const Node      zone     = zone_root(scene);
    Node           *roots    = arena_new_array(&field->arena, Node, scene->component_count + 1);
    size_t          count    = 0;
    for (size_t i = 0; i < scene->component_count; i++)
        if ((is_plane && is_plane[i]) == planes)
            roots[count++] = distance_root(&scene->roots, i);
    /* A tape needs a root also if there are planes alone and nothing is marched. */
    if (count == 0)
        roots[count++] = distance_root(&scene->roots, 0);
    if (zone != NODE_NONE)
        roots[count++] = zone;
    tape->lanes = lane_tape_new_steep(&field->state->tapes.distance, roots, count, true,
                                      zone != NODE_NONE, &field->arena);
    finish_tape(field, tape, field->state->values, depth);
}

/* Makes the tape of the length to the nearest plane along a ray. */
void ray_field_make_plane_t(RayField *field, RayTape *tape)
{
    const KrsScene *scene  = field->state->scene;
    const Node      root   = plane_roots(&scene->roots)->step;
    Tape           *of     = arena_new(&field->arena, Tape);
    NodeValue      *values = ray_copy_values(field->state, &field->arena);
    *of                    = tape_new(scene->graph, &root, 1, &field->arena);
    tape_run_frame(of, field->state->parameters, values);
    tape->lanes = lane_tape_new(of, &root, 1, false, 0, &field->arena);
    finish_tape(field, tape, values, 0);
}

void ray_field_meet_planes(RayField *field, size_t part, float farthest, RayBlock *block)
{
    if (!field->planes) {
        for (int i = 0; i < RAYS_OF_BLOCK; i++)
            block->plane[i] = HUGE_VALF;
        return;
    }
    const float *found = cell_run_seen(&field->plane_t.cells, field->plane_t.works[part],
                                       (const float(*)[CELL_LANES])block->origin,
                                       (const float(*)[CELL_LANES])block->direction);
    for (int i = 0; i < RAYS_OF_BLOCK; i++)
        block->plane[i] = found[i] > farthest ? HUGE_VALF : fmaxf(found[i], 0);
}
