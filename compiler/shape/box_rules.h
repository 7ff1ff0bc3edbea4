/*
 * box_rules.h: how the box of a shape follows from those of its parts and from its numbers.
 *
 * One rule for each kind (shapes.def), for three that ask: what makes a shape knows its numbers for all
 * values of the parameters, iteration_boxes.h knows them in each iteration of a loop, box_plan.h in a state.
 */
#ifndef KRS_BOX_RULES_H
#define KRS_BOX_RULES_H

#include "compiler/shape/cover.h"
#include "compiler/shape/shape.h"

/* The source of the ranges of numbers, which are nodes of frame time. */
typedef struct BoxNumbers {
    Range (*range)(const struct BoxNumbers *numbers, Node node, uint32_t component);
} BoxNumbers;

/* The arguments of a rule. */
typedef struct BoxInput {
    const BoxNumbers *numbers;
    const Shape      *shape;
    const Box        *parts; /* part i is parts[i * stride]; NULL: those that the parts have */
    size_t            stride;
} BoxInput;

/* Returns the shapes that a box depends on: the children, or what a declaration lies within. */
uint32_t     box_part_count(const Shape *shape);
const Shape *box_part(const Shape *shape, uint32_t index);
/* The numbers that the rule of a shape may ask for; and those of a similarity, behind others. */
enum { MAX_BOX_NODES = 12 };
uint32_t box_nodes(const Shape *shape, Node nodes[MAX_BOX_NODES]);
uint32_t map_box_nodes(const Map *map, Node *nodes, uint32_t count);
/* Tells whether there is a rule: else the box is found where the shape is made. */
bool has_box_rule(const Shape *shape);
Box  shape_box(const BoxInput *input);
/* These return a map without `first`; the box around the image of a box under a similarity. */
MapRange map_range_of(const BoxNumbers *numbers, const Map *map);
Box      map_box_of(const MapRange *range, Box box);

#endif
