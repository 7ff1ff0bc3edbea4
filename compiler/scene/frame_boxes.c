/*
 * frame_boxes.c: the boxes of components at the values of a frame, and the floor below them.
 */
#include <math.h>

#include "krs/camera.h"
#include "compiler/scene/program.h"

const Box *frame_find_boxes(KrsState *frame)
{
    const KrsScene *scene = frame->scene;
    if (scene->boxes.nodes.count == 0)
        return NULL;
    tape_run_frame(&scene->box_numbers, frame->parameters, frame->values);
    frame_boxes_find(&scene->boxes, roots_of(&scene->roots, ROOTS_BOX).items, frame->values,
                     frame->boxes);
    return frame->boxes;
}

Box frame_box(const KrsState *frame, const Box *boxes, size_t component)
{
    const KrsComponent *all = &frame->scene->components[component];
    Box                 box;
    if (component < frame->scene->boxes.asked_for)
        return boxes[component];
    for (int k = 0; k < 3; k++)
        box.axis[k] = (Range){all->low[k], all->high[k]};
    return box;
}

Box frame_outer_box(const KrsState *frame, const Box *boxes)
{
    Box box = box_empty;
    for (size_t i = 0; i < frame->scene->shown_count; i++) {
        const Box one = frame_box(frame, boxes, i);
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

bool krs_state_component_box(KrsState *frame, size_t component, double low[3], double high[3])
{
    return component < frame->scene->shown_count &&
           copy_corners(frame_box(frame, frame_find_boxes(frame), component), low, high);
}

bool krs_state_box(KrsState *frame, double low[3], double high[3])
{
    return copy_corners(frame_outer_box(frame, frame_find_boxes(frame)), low, high);
}

/* The least height of all cameras. */
static double lowest_eye(const KrsState *frame)
{
    const KrsScene *scene = frame->scene;
    double          least = HUGE_VAL;
    for (size_t i = 0; i < scene->floor.eyes.count; i++)
        least = fmin(least,
                     frame_number_range(&scene->floor.eyes.items[i], 1,
                                        roots_of(&scene->roots, ROOTS_BOX).items, frame->values)
                         .low);
    return least;
}

void frame_find_floor(KrsState *frame, uint32_t changed)
{
    const KrsScene   *scene = frame->scene;
    const FrameFloor *floor = &scene->floor;
    if (floor->slot == 0 || !tape_depends_on(&scene->box_numbers, changed))
        return;
    const Box *boxes  = frame_find_boxes(frame);
    double     bottom = HUGE_VAL;
    for (size_t i = 0; i + 1 < scene->shown_count; i++) /* the last one is the floor */
        if (!box_is_empty(boxes[i]))
            bottom = fmin(bottom, boxes[i].axis[1].low);
    const bool seen                     = isfinite(bottom) && bottom < lowest_eye(frame);
    frame->parameters[floor->slot].v[0] = seen ? bottom : floor->otherwise;
}
