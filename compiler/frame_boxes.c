/*
 * frame_boxes.c: the boxes of components at the values of a frame, and the floor below them.
 */
#include <math.h>

#include "compiler/program.h"

const Box *frame_find_boxes(KrsFrame *frame)
{
    const KrsScene *scene = frame->scene;
    if (scene->boxes.nodes.count == 0)
        return NULL;
    tape_run_frame(&scene->box_numbers, frame->parameters, frame->values);
    frame_boxes_find(&scene->boxes, roots_of(&scene->roots, ROOTS_BOX).items, frame->values,
                     frame->boxes);
    return frame->boxes;
}

/* The least height of all cameras. */
static double lowest_eye(const KrsFrame *frame)
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

void frame_find_floor(KrsFrame *frame, uint32_t changed)
{
    const KrsScene   *scene = frame->scene;
    const FrameFloor *floor = &scene->floor;
    if (floor->slot == 0 || !tape_depends_on(&scene->box_numbers, changed))
        return;
    const Box *boxes  = frame_find_boxes(frame);
    double     bottom = HUGE_VAL;
    for (size_t i = 0; i + 1 < scene->shown_count; i++)
        if (!box_is_empty(boxes[i]))
            bottom = fmin(bottom, boxes[i].axis[1].low);
    const bool seen                     = isfinite(bottom) && bottom < lowest_eye(frame);
    frame->parameters[floor->slot].v[0] = seen ? bottom : floor->otherwise;
}
