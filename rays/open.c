/*
 * open.c: makes what rays ask, and frees it.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rays/ray_field.h"
#include "rays/waves.h"

/* Finds the box that has cubes: around the scene or, where that is endless, around what is not,
   with room beside it. */
static void bound_space(const RayField *field, float low[3], float high[3])
{
    const Box box = state_outer_box(field->state, state_find_boxes(field->state));
    for (int k = 0; k < 3; k++) {
        const bool   endless = field->high[k] - field->low[k] >= 1e30f && !box_is_empty(box);
        const double size    = box.axis[k].high - box.axis[k].low;
        low[k]               = endless ? (float)(box.axis[k].low - size) : field->low[k];
        high[k]              = endless ? (float)(box.axis[k].high + size) : field->high[k];
    }
}

/* Shorter tapes are not worth another.  The room is in steps, which take memory when they are used. */
enum {
    SHORT_OF_CUBES  = 40,
    SHORT_OF_STARTS = 300,
    MAX_OF_CUBES    = 1 << 25,
    MAX_OF_STARTS   = 1 << 23
};

static void fill(RayField *field)
{
    state_refresh_points(field->state);
    ray_field_make_distance(field, false, &field->distance, LEAF_DEPTH + 1);
    if (field->planes) {
        ray_field_make_plane_t(field, &field->plane_t);
        ray_field_make_distance(field, true, &field->plane_distance, 0);
    }
    const KrsProgram *program = &field->state->scene->program;
    field->margin             = ray_margin(program);
    for (int k = 0; k < 3; k++) {
        const double low   = field->planes ? program->rest_low[k] : program->low[k],
                     high  = field->planes ? program->rest_high[k] : program->high[k];
        const double slack = 1e-4 * (high - low) + (double)field->margin;
        field->low[k]      = (float)fmax(low - slack, -1e30);
        field->high[k]     = (float)fmin(high + slack, 1e30);
    }
    float low[3], high[3];
    bound_space(field, low, high);
    const SpaceRule cubes  = {.stretch    = 1,
                              .margin     = field->margin,
                              .deepest    = 5,
                              .short_tape = SHORT_OF_CUBES,
                              .max_steps  = MAX_OF_CUBES},
                    starts = {.stretch    = 2,
                              .margin     = field->margin,
                              .deepest    = 4,
                              .short_tape = SHORT_OF_STARTS,
                              .max_steps  = MAX_OF_STARTS};
    space_new(&field->space, &field->distance.cells, low, high, &cubes, &field->arena);
    space_new(&field->starts, &field->distance.cells, low, high, &starts, &field->arena);
    for (size_t i = 0; i < parallel_parts(); i++) {
        Wave *wave       = arena_new(&field->arena, Wave);
        field->waves[i]  = wave;
        wave->first_rays = arena_new_array(&field->arena, int32_t, field->space.most);
        for (uint32_t k = 0; k < field->space.most; k++)
            wave->first_rays[k] = -1;
    }
}

RayField *ray_field_new(KrsState *state, bool planes)
{
    const Memory *from  = &state->scene->memory;
    RayField     *field = from->allocate ? from->allocate(from->user, sizeof *field)
                                         : malloc(sizeof *field);
    jmp_buf       exhausted;
    if (!field)
        return NULL;
    *field = (RayField){
        .memory = {.allocate = from->allocate, .release = from->release, .user = from->user},
        .state  = state,
        .set    = ray_set_of_lanes(),
        .planes = planes && state->scene->program.planes};
    field->arena.memory     = &field->memory;
    field->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0) {
        ray_field_free(field);
        return NULL;
    }
    fill(field);
    field->memory.exhausted = NULL;
    return field;
}

void ray_field_begin(RayField *field)
{
    space_clear_full(&field->space);
    space_clear_full(&field->starts);
}

void ray_field_free(RayField *field)
{
    if (!field)
        return;
    const Memory memory = field->memory;
    space_free(&field->space);
    space_free(&field->starts);
    arena_free(&field->arena);
    if (memory.allocate)
        memory.release(memory.user, field);
    else
        free(field);
}
