/*
 * lane_rows.h: lane tapes that are being made.
 */
#ifndef KRS_LANE_ROWS_H
#define KRS_LANE_ROWS_H

#include "compiler/graph/lanes/lanes.h"

typedef struct LaneSteps {
    Arena *arena;
    struct {
        LaneStep *items;
        size_t    count, capacity;
    } steps;
    struct {
        LaneCall *items;
        size_t    count, capacity;
    } calls;
    struct {
        LaneScalar *items;
        size_t      count, capacity;
    } sources;
    struct {
        uint32_t *items;
        size_t    count, capacity;
    } outputs;
} LaneSteps;

/* Adds a step; returns the number of its value. */
uint32_t lane_steps_add(LaneSteps *steps, LaneStep step);
/* Adds a scalar that is this number; returns the operand. */
uint32_t lane_steps_number(LaneSteps *steps, double number);
/* Finds how fast each node changes with the point at most, wherever that is; infinite: it may jump,
   or there is no bound. */
double *lane_steepest(const Graph *graph, Arena *arena);
/* Drops the steps that no output needs, and gives the others rows. */
LaneTape lane_steps_finish(LaneSteps *steps, const Tape *tape);

#endif
