/*
 * box_plan.h: boxes of shapes that are found anew for each state, or iteration of a loop.
 *
 * The box of a shape holds for all values of parameters and times.  A floor below it, or a camera that sees all of
 * it, is for what is there now.  What depends on the time keeps its box of all times, so that it does
 * not move from frame to frame; so do kinds without a rule, and what is in very large trees.
 */
#ifndef KRS_BOX_PLAN_H
#define KRS_BOX_PLAN_H

#include "compiler/graph/evaluate.h"
#include "compiler/shape/builder.h"

/* A number that is asked of states, by its place among BoxPlan.nodes; or one that is not: these
   ranges are those of all states. */
typedef struct PlannedNumber {
    Node   node; /* as rules know it */
    bool   asked;
    size_t place;
    Range  ranges[4];
} PlannedNumber;

/* A shape whose box is found in each state; without numbers and parts: `shape.box` is that of all. */
typedef struct PlannedShape {
    Shape    shape; /* for the rule: of others it holds numbers only */
    size_t   first_number, first_part;
    uint32_t number_count, part_count;
} PlannedShape;

typedef struct BoxPlan {
    struct {
        Node  *items;
        size_t count, capacity;
    } nodes; /* what is asked of states */
    struct {
        PlannedNumber *items;
        size_t         count, capacity;
    } numbers;
    struct {
        PlannedShape *items;
        size_t        count, capacity;
    } shapes;         /* first those that are asked for; parts stand behind what they are of */
    size_t asked_for; /* shapes; 0: none is planned */
} BoxPlan;

/* Plans the boxes of some shapes, in the builder's arena.  No nodes, and no shapes: they are the same
   in all states, or too many. */
void box_plan_states(ShapeBuilder *builder, const Shape *const *shapes, size_t count,
                     BoxPlan *plan);
/* Plans the box of a shape in each iteration of a loop (iteration_boxes.c): `leaf` is what its numbers depend on,
   and none of these on another parameter.  False: a box that depends on it is not known by a rule. */
bool box_plan_iterations(ShapeBuilder *builder, const Shape *shape, Node leaf, Arena *arena,
                         BoxPlan *plan);
/* Returns a number for planned_range, whose node is known to be of frame time. */
PlannedNumber box_plan_number(ShapeBuilder *builder, Node node, BoxPlan *plan);
BoxPlan       box_plan_copy(const BoxPlan *plan, Arena *arena);
/* These find the boxes of all planned shapes; those that were asked for come first.  `nodes` are
   what the planned ones have become since, `values` those that the state gives them; NULL: numbers
   are in their ranges. */
void  box_plan_find(const BoxPlan *plan, const Node *nodes, const NodeValue *values, Box *boxes);
Range planned_range(const PlannedNumber *number, uint32_t component, const Node *nodes,
                    const NodeValue *values);
/* Does the same, for the defaults of the parameters, while shapes are made. */
void box_plan_default(ShapeBuilder *builder, const BoxPlan *plan, Box *boxes);

#endif
