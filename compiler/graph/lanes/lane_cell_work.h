/*
 * lane_cell_work.h: what cell tapes are made and shortened with.
 */
#ifndef KRS_LANE_CELL_WORK_H
#define KRS_LANE_CELL_WORK_H

#include "compiler/graph/bounds/numbers.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/lanes/lane_cells.h"

/* At most so many instances of a call have their bodies in a tape, and these so many steps. */
enum { MAX_CELL_INSTANCES = 64, MAX_BODY_STEPS = 4096 };

struct CellWork {
    NodeValue *values;
    float    **rows; /* of each depth */
    /* What is known of rows while a tape is made: whether one is needed, and then between a floor
       and a cap; the row that stands for it; and where that is in the tape that is made. */
    bool     *needed;
    float    *caps, *floors;
    uint32_t *same, *now;
    CellStep *steps; /* a stack */
    CellCall *calls; /* a stack, too */
    size_t    step_count, call_count;
    /* The instances that may count in the ball, of each call of the tape that is shortened; none:
       it stays a call. */
    uint32_t (*instances)[MAX_CELL_INSTANCES];
    uint32_t *instance_counts;
    uint32_t *body_rows, *body_scalars; /* of a body whose steps are added */
};

/* ---- operations ---- */

static inline bool is_lesser(uint16_t op) { return op == OP_min || op == LANE_LESSER; }
static inline bool is_greater(uint16_t op) { return op == OP_max || op == LANE_GREATER; }

/* What ops.def says of an operation. */
static inline const NumberRow *row_of_op(uint16_t op)
{
    return &number_rows[is_lesser(op)    ? OP_min
                        : is_greater(op) ? OP_max
                        : op < OP_COUNT  ? op
                                         : OP_CONSTANT];
}

/* ---- instance groups ---- */

/* The function of a call that takes the least distance of its instances, one after the other; NULL: it is none. */
const InstanceFunction *least_of_instances(const LaneTape *tape, const LaneCall *call);

/* Steps that its body becomes for an instance at most: numbers of rows are steps, too. */
static inline size_t steps_of_instance(const LaneBody *body)
{
    return body->tape.count + body->tape.scalar_count;
}

#endif
