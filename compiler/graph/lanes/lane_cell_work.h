/*
 * lane_cell_work.h: what cell tapes are made and shortened with.
 */
#ifndef KRS_LANE_CELL_WORK_H
#define KRS_LANE_CELL_WORK_H

#include "compiler/graph/bounds/numbers.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/lanes/lane_cells.h"

/* The instances of a call whose bodies a tape may have, and their steps. */
enum { MAX_CELL_INSTANCES = 8, MAX_BODY_STEPS = 4096 };
/* Longer tapes are run block by block: their rows would need much memory. */
enum { MAX_WIDE_STEPS = 1024 };
/* Longer lists of instances are not kept, nor are those of more calls. */
enum { MAX_LISTED = 256, MAX_LISTS = 256 };

/* A row of a body that is a number of the instance. */
typedef struct CellColumn {
    uint32_t    row;
    const Node *nodes;  /* by instance, of the frame; NULL: numbers that are known, */
    uint32_t    column; /* in this column; NODE_NONE: the number of the instance itself */
} CellColumn;

/* An instance function in single precision.  Its rows are behind those of the tape that calls it. */
typedef struct CellBody {
    LaneTape                lanes;
    CellTape                tape;
    const InstanceFunction *function;
    const InstanceTable    *table;
    bool        sharp; /* only the nearest instance counts; else what reaches as far as that */
    uint32_t    first_row;
    CellColumn *columns;
    uint32_t    column_count;
    uint32_t states[4 * MAX_INSTANCE_STATES];  /* rows of what states are before; 0: nobody asks */
    uint32_t outputs[4 * MAX_INSTANCE_STATES]; /* and behind an instance; NODE_NONE: none */
} CellBody;

typedef float CellStates[4 * MAX_INSTANCE_STATES][CELL_LANES];

/* Instances of a call that may count in a ball. */
typedef struct CellList {
    const uint32_t *instances; /* NULL: any may */
    uint32_t        count;
    bool            expands; /* their bodies become steps */
} CellList;

struct CellWork {
    NodeValue *values;
    float    **rows;                 /* of each depth */
    float *constants, *wide, *found; /* of all scalars; rows, and distances, of CELL_WIDE numbers */
    /* The state of rows while a tape is made: whether one is needed, and then between a floor and a
       cap; the row that stands for it; and where that is in the tape that is made. */
    bool     *needed;
    float    *caps, *floors;
    uint32_t *same, *now;
    CellStep *steps;  /* a stack */
    CellCall *calls;  /* a stack, too */
    uint32_t *listed; /* and one of instances */
    size_t    step_count, call_count, listed_count, max_listed;
    /* The slopes in the ball, by step of the tape that is shortened, 0: not known; and the ranges
       then. */
    float    *steepest;
    Range    *ranges;
    CellList *lists;                    /* by its calls */
    uint32_t *body_rows, *body_scalars; /* of a body whose steps are added */
};

/* Returns a scalar of a lane tape as rows hold it. */
float cell_constant(const LaneTape *tape, size_t i);

/* ---- operations ---- */

static inline bool is_lesser(uint16_t op) { return op == OP_min || op == LANE_LESSER; }
static inline bool is_greater(uint16_t op) { return op == OP_max || op == LANE_GREATER; }

/* Returns the row of ops.def for an operation. */
static inline const NumberRow *row_of_op(uint16_t op)
{
    return &number_rows[is_lesser(op)    ? OP_min
                        : is_greater(op) ? OP_max
                        : op < OP_COUNT  ? op
                                         : OP_CONSTANT];
}

/* ---- balls ---- */

/* The ball of a lane. */
typedef struct Ball {
    const CellTape *tape;
    const float    *rows; /* values in its middle: those of the lane */
    float           radius, margin;
    /* The slopes and ranges by step, as CellWork has them.  NULL: as steps have them, and none. */
    const float *steepest;
    const Range *ranges;
} Ball;

static inline bool is_constant(const CellTape *tape, uint32_t row) { return row < tape->inputs; }

/* Returns the operands of a step that are constants, as bits. */
static inline unsigned scalars_of(const CellStep *step, uint32_t inputs)
{
    unsigned scalars = 0;
    for (uint32_t k = 0; k < step->operand_count; k++)
        scalars |= (unsigned)(step->from[k] < inputs) << k;
    return scalars & ((1u << MAX_OPERANDS) - 1);
}

static inline const CellStep *step_of(const CellTape *tape, uint32_t row)
{
    const uint32_t first = tape->inputs + LANE_INPUTS;
    return row < first ? NULL : &tape->steps[row - first];
}

static inline float value_of(const Ball *ball, uint32_t row)
{
    return ball->rows[(size_t)row * CELL_LANES];
}

/* lane_cell_slopes.c: how fast a row changes in the ball at most; infinite: that is not known. */
float cell_steepest(const Ball *ball, uint32_t row);
/* Returns how much a row may differ from its value in the middle; infinite: there is no bound. */
float reach_of(const Ball *ball, uint32_t row);
Range cell_range(const Ball *ball, uint32_t row);
/* Finds how fast steps change in a ball of which nothing is known everywhere, or at least their ranges. */
void cell_find_slopes(const Ball *ball, float *steepest, Range *ranges);

/* ---- instance groups ---- */

/* Returns the function of a call that is a distance with a slope; NULL: it is none. */
const InstanceFunction *distance_of_instances(const LaneTape *tape, const LaneCall *call);
/* Returns the function of a call that takes the least distance of its instances, one after the
   other. */
const InstanceFunction *min_of_instances(const LaneTape *tape, const LaneCall *call);

/* Returns how far the point of a call moves at most if its components move so far. */
double cell_call_moves(const CellCall *call, const double by[3], double point);

/* Tells whether all steps have slopes. */
bool cell_all_steep(const CellStep *steps, uint32_t count);
/* Returns the cell tape of output 0 without bodies of instance functions. */
CellTape cell_tape_alone(const LaneTape *tape, CellCall **calls, Arena *arena);
/* Returns the steps that bodies of instances may add to all tapes that are made of one, and the
   steps of the longest body. */
size_t cell_steps_of_bodies(const CellTape *tape, size_t *longest);
/* Makes the bodies of a tape for all of space. */
void cell_bodies_new(const CellTape *tape, CellCall *calls, const NodeValue *values, Arena *arena);
/* Returns the number of rows of a tape and its bodies. */
size_t cell_row_count(const CellTape *tape);
/* Computes what all instances of the list make of the states. */
void cell_visit(const CellCall *call, NodeValue *values, float *rows, CellStates states,
                LaneCellRun *run);

/* Reads numbers of a table; false: some lane has no instance. */
bool cell_read_rows(const Graph *graph, const Expr *row, const NodeValue *values,
                    const float *instances, float *to);
/* Computes what the operation behind the bodies makes of the states, point by point. */
void cell_join(const CellCall *call, const Graph *graph, CellStates states, float *to);

/* The points of a call in a ball, and the distance there. */
typedef struct CellView {
    Range  at[3], value;
    double radius; /* of the ball that the point is in */
} CellView;
/* Lists the instances that may count: up to `most` of those that may in the ball around; false: there are more, or
   nothing is known. */
bool cell_find_instances(const CellCall *call, const CellView *view, uint32_t *instances,
                         uint32_t most, uint32_t *count);

/* Steps that its body becomes for an instance at most: numbers of rows are steps, too. */
static inline size_t steps_of_instance(const LaneBody *body)
{
    return body->tape.count + body->tape.scalar_count;
}

#endif
