/*
 * frame_boxes.h: boxes of shapes at the values that parameters have in a frame.
 *
 * The box of a shape holds for all values and times.  A floor below it, or a camera that sees all of
 * it, is for what is there now.  What depends on the time keeps its box of all times, so that it does
 * not move from frame to frame; so do kinds without a rule, and what is in very large trees.
 */
#ifndef KRS_FRAME_BOXES_H
#define KRS_FRAME_BOXES_H

#include "compiler/graph/evaluate.h"
#include "compiler/shape/builder.h"

/* A number that is asked of frames, by its place among FrameBoxes.nodes; or one that is not: these
   ranges are those of all frames. */
typedef struct FrameNumber {
    Node   node; /* as rules know it */
    bool   asked;
    size_t place;
    Range  ranges[4];
} FrameNumber;

/* A shape whose box is found in each frame; without numbers and parts: `shape.box` is that of all. */
typedef struct FrameShape {
    Shape    shape; /* for the rule: of others it holds numbers only */
    size_t   first_number, first_part;
    uint32_t number_count, part_count;
} FrameShape;

typedef struct FrameBoxes {
    struct {
        Node  *items;
        size_t count, capacity;
    } nodes; /* what is asked of frames */
    struct {
        FrameNumber *items;
        size_t       count, capacity;
    } numbers;
    struct {
        FrameShape *items; /* first the shapes that are asked for; parts behind what they are of */
        size_t      count, capacity;
    } shapes;
    size_t asked_for; /* shapes; 0: none is planned */
} FrameBoxes;

/* Plans the boxes of some shapes, in the builder's arena.  No nodes, and no shapes: they are the same
   in all frames, or too many. */
void frame_boxes_plan(ShapeBuilder *builder, const Shape *const *shapes, size_t count,
                      FrameBoxes *plan);
/* Plans the box of a shape in each iteration of a loop (iteration_boxes.c): `leaf` is what its numbers depend on,
   and none of these on another parameter.  False: a box that depends on it is not known by a rule. */
bool frame_boxes_plan_iterations(ShapeBuilder *builder, const Shape *shape, Node leaf, Arena *arena,
                                 FrameBoxes *plan);
/* A number for frame_number_range, whose node is known to be of frame time. */
FrameNumber frame_number_plan(ShapeBuilder *builder, Node node, FrameBoxes *plan);
FrameBoxes  frame_boxes_copy(const FrameBoxes *plan, Arena *arena);
/* The boxes of all planned shapes; those that were asked for come first.  `nodes` are what the planned
   ones have become since, `values` those that the frame gives them; NULL: numbers are in their ranges. */
void  frame_boxes_find(const FrameBoxes *plan, const Node *nodes, const NodeValue *values,
                       Box *boxes);
Range frame_number_range(const FrameNumber *number, uint32_t component, const Node *nodes,
                         const NodeValue *values);
/* The same, for the defaults of the parameters, while shapes are made. */
void frame_boxes_default(ShapeBuilder *builder, const FrameBoxes *plan, Box *boxes);

#endif
