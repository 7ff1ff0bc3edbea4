/*
 * state_boxes.c: the boxes of components at the values of a state, and the floor below them.
 */
#include <math.h>

#include "krs/camera.h"
#include "compiler/scene/program.h"

const Box *state_find_boxes(KrsState *state)
{
    const KrsScene *scene = state->scene;
    if (scene->boxes.nodes.count == 0)
        return NULL;
    tape_run_frame(&scene->box_numbers, state->parameters, state->values);
    box_plan_find(&scene->boxes, roots_of(&scene->roots, ROOTS_BOX).items, state->values,
                  state->boxes);
    return state->boxes;
}

Box state_box(const KrsState *state, const Box *boxes, size_t component)
{
    const KrsComponent *all = &state->scene->components[component];
    Box                 box;
    if (component < state->scene->boxes.asked_for)
        return boxes[component];
    for (int k = 0; k < 3; k++)
        box.axis[k] = (Range){all->low[k], all->high[k]};
    return box;
}

Box state_outer_box(const KrsState *state, const Box *boxes)
{
    Box box = box_empty;
    for (size_t i = 0; i < state->scene->shown_count; i++) {
        const Box one = state_box(state, boxes, i);
        if (box_is_finite(one))
            box = box_hull(box, one);
    }
    return box;
}

static bool copy_corners(Box box, double low[3], double high[3])
{
    for (int k = 0; k < 3; k++) {
        low[k]  = box.axis[k].low;
        high[k] = box.axis[k].high;
    }
    return box_is_finite(box);
}

bool krs_state_component_box(KrsState *state, size_t component, double low[3], double high[3])
{
    return component < state->scene->shown_count &&
           copy_corners(state_box(state, state_find_boxes(state), component), low, high);
}

bool krs_state_box(KrsState *state, double low[3], double high[3])
{
    return copy_corners(state_outer_box(state, state_find_boxes(state)), low, high);
}

/* Returns the least height of all cameras. */
static double lowest_eye(const KrsState *state)
{
    const KrsScene *scene = state->scene;
    double          least = HUGE_VAL;
    for (size_t i = 0; i < scene->floor.eyes.count; i++)
        least = fmin(least, planned_range(&scene->floor.eyes.items[i], 1,
                                          roots_of(&scene->roots, ROOTS_BOX).items, state->values)
                                .low);
    return least;
}

void state_find_floor(KrsState *state, uint32_t changed)
{
    const KrsScene   *scene = state->scene;
    const StateFloor *floor = &scene->floor;
    if (floor->slot == 0 || !tape_depends_on(&scene->box_numbers, changed))
        return;
    const Box *boxes  = state_find_boxes(state);
    double     bottom = HUGE_VAL;
    for (size_t i = 0; i + 1 < scene->shown_count; i++) /* the last one is the floor */
        if (!box_is_empty(boxes[i]))
            bottom = fmin(bottom, boxes[i].axis[1].low);
    const bool seen                     = isfinite(bottom) && bottom < lowest_eye(state);
    state->parameters[floor->slot].v[0] = seen ? bottom : floor->otherwise;
}
