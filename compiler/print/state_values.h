/*
 * state_values.h: where the host puts what depends on the state alone.
 *
 * Shaders that computed it would do so in every lane.  The host finds it once, in double precision,
 * and packs it into slots of the parameter block.
 */
#ifndef KRS_STATE_VALUES_H
#define KRS_STATE_VALUES_H

#include "compiler/graph/evaluate.h"

/* A value and the places of its components: numbers of the block, four to a slot.  Truth values are 0
   or 1, a UINT has its bits there.  What is the same in all states has no place: shaders save
   operations where they know a constant. */
typedef struct StateValue {
    Node     node;
    uint32_t width;
    uint32_t at[4]; /* or NO_PLACE: */
    double   constant[4];
} StateValue;
#define NO_PLACE UINT32_MAX

typedef struct StateValues {
    StateValue *items;
    size_t      count;
    uint32_t    first_slot, slots; /* the first, and how many */
    Tape        tape;              /* of all of them */
} StateValues;

/* Tells whether shaders read it where it is already: a parameter, or a component of one. */
bool state_value_is_given(const Graph *graph, Node node);
/* Tells whether it only arranges its operands: shaders do that. */
bool state_value_is_arranged(const Graph *graph, Node node);
/* Finds places for `wanted`, or for what those arrange. */
void state_values_assign(StateValues *values, const Graph *graph, const Node *wanted, size_t count,
                         Arena *arena, Arena *scratch);
/* Finds all these values; `block` has room for `slots`. */
void state_values_find(const StateValues *values, const NodeValue *parameters, NodeValue *room,
                       float (*block)[4]);

#endif
