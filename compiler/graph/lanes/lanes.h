/*
 * lanes.h: expressions in many points at once, and over boxes.
 *
 * A lane tape is made of a tape (evaluate.h).  Its steps are scalar: vectors are taken apart, in the
 * order of op_values.c, so that in double precision every result is equal to that of the tape, bit for
 * bit (one that is not a number is not a number).  A step works on rows of LANES numbers, one for
 * each point.  Rows are reused.  Operands that are the same in all points are scalars.
 *
 * The same steps are run over boxes, in intervals.  They tell which operand of a minimum, a choice or a
 * blend decides all over a box.  The lane tape without the others is shorter, and in that box its
 * outputs are the same, bit for bit.
 *
 * A lane tape is never changed once it is made: threads share it, and each has its own work space.
 */
#ifndef KRS_LANES_H
#define KRS_LANES_H

#include "compiler/graph/evaluate.h"
#include "compiler/graph/range.h"

/* Points in a row; rows are filled in blocks, so that few points cost less than many. */
enum { LANES = 32, LANE_BLOCK = 8 };

/* Steps that are no operation of ops.def. */
enum {
    LANE_CALL = OP_COUNT, /* an operation that is evaluated point by point: calls[operands[0]] */
    LANE_PART,            /* a further component of the call right before */
    LANE_LESSER,          /* b where b < a, else a */
    LANE_GREATER,         /* b where b > a, else a */
    LANE_INSTANCE,        /* in bodies of instance functions: the number of the instance */
    LANE_ROW,             /* its number in the column operands[0] of the table */
    LANE_STATE,           /* component operands[0] of the states, which have four each */
    LANE_NUMBER /* in cell tapes alone: a number, whose bits are in the place of the first operand */
};

/* An operand is the number of a value, or this bit and the number of a scalar.  Values are the
   inputs, then the results of the steps. */
#define LANE_SCALAR 0x80000000u
enum {
    LANE_POINT     = 0,
    LANE_NORMAL    = 3,
    LANE_FOOTPRINT = 6,
    LANE_THRESHOLD = 7,
    LANE_VIEW      = 8, /* where nobody looks, the normal */
    LANE_FRONT     = 11,
    LANE_INPUTS    = 12
};

/* An operation of ops.def works on numbers here: OP_length on the components of a vector, OP_normalize
   on one component and the length, OP_cell on one component of each operand. */
typedef struct LaneStep {
    uint16_t op;
    uint16_t operand_count;
    uint32_t operands[MAX_OPERANDS];
    float
        steepest; /* it changes no faster than that with the point, and jumps nowhere; 0: not known */
    uint32_t
        origin; /* the same for steps that have the same value in all tapes of a scene; 0: not known */
    bool component; /* of `least`: no surface of the component is nearer than its value */
    uint32_t
        kin; /* the same for steps that are one step of the tape, or of a body, at different instances */
    uint32_t instance; /* 1 and the instance; 0: it is of no body */
} LaneStep;

/* The operation of a step on rows and, where the bit of the operand is set, scalars. */
typedef struct LaneCode {
    uint16_t op;
    uint8_t  operand_count, scalars;
    uint32_t to, from[MAX_OPERANDS];
} LaneCode;

/* An operation that is evaluated point by point; an instance function is not where it has a body. */
typedef struct LaneCall {
    Node                   node;
    const struct LaneBody *body; /* in double precision; or NULL */
    const uint32_t *instances;   /* of a pruned tape: the only ones that may count; NULL: any may */
    uint32_t        instance_count;
    float
        steepest; /* of an instance function: its point changes no faster than that; 0: not known */
    uint32_t parts; /* components of the result, each a step */
    uint32_t operands[MAX_OPERANDS][4];
    uint32_t from[MAX_OPERANDS][4], to[4]; /* rows */
} LaneCall;

/* The source of a scalar: a component of a node of the frame, or, with NODE_NONE, a number. */
typedef struct LaneScalar {
    Node     node;
    uint32_t component;
    double   number;
} LaneScalar;

typedef struct LaneTape {
    const Tape *tape;
    LaneStep   *steps;
    LaneCode   *code;
    size_t      count;
    LaneCall   *calls;
    size_t      call_count;
    bool        reads_tables; /* some call reads tables or textures */
    LaneScalar *sources;
    size_t      scalar_count;
    double     *scalars; /* their values; NULL: not known yet */
    uint32_t   *outputs; /* operands as of steps */
    uint32_t   *output_rows;
    size_t      output_count;
    uint32_t    rows;       /* those of inputs are the first */
    uint32_t    bodies_end; /* behind the rows of all bodies; 0: there are none */
} LaneTape;

/* The tape of an instance function at an instance: its outputs are the components of its states. */
typedef struct LaneBody {
    LaneTape tape;
    uint32_t function, table; /* their numbers */
    uint32_t first_row;       /* of its rows in the work space; its scalars lie behind them */
} LaneBody;

/* Makes a lane tape.  Outputs are the components of the roots, one root after the other; the tape
   has these roots, no guards that skip, and lives as long.  With `least`, output 0 is the least of
   all roots but the last `cuts`, which are numbers, cut by those: as far as the greatest of them is
   greater. */
LaneTape lane_tape_new(const Tape *tape, const Node *roots, size_t root_count, bool least,
                       size_t cuts, Arena *arena);
/* Returns the same, and steps know how fast they change at most. */
LaneTape lane_tape_new_steep(const Tape *tape, const Node *roots, size_t root_count, bool least,
                             size_t cuts, Arena *arena);

/* Returns the step that an operand is the result of; NULL: none. */
static inline const LaneStep *lane_step_of(const LaneTape *tape, uint32_t operand)
{
    bool step = !(operand & LANE_SCALAR) && operand >= LANE_INPUTS;
    return step ? &tape->steps[operand - LANE_INPUTS] : NULL;
}

/* Computes the values of its scalars: `values` is as tape_run_frame fills it; `scalars` has room
   for scalar_count. */
void lane_tape_scalars(const LaneTape *tape, const NodeValue *values, double *scalars);

/* ---- points ---- */

typedef enum LanePrecision { LANE_DOUBLE, LANE_SINGLE, LANE_PRECISIONS } LanePrecision;

/* The memory of one thread for a lane tape, and all that it is pruned to. */
typedef struct LaneWork {
    void *rows; /* aligned to 64 bytes */
    NodeValue *
        values; /* those of the frame, for calls that read tables, which change others; else NULL */
    double                *whole; /* rows of the work space, where bodies have theirs */
    const struct LaneLoop *loop;  /* while a body is run */
} LaneWork;

/* A call may become that many steps when it is pruned, which work on as many rows; or one to an instance function the
   steps of its body for some instances; or it keeps a list of instances, which takes that many bytes. */
enum {
    LANE_STEPS_OF_CALL      = 6,
    MAX_LANE_INSTANCES      = 32,
    MAX_STEPS_OF_INSTANCES  = 640,
    LANE_BYTES_OF_INSTANCES = 4 * MAX_LANE_INSTANCES + 16
};
static inline size_t lane_steps_of_calls(const LaneTape *tape)
{
    size_t steps = LANE_STEPS_OF_CALL * tape->call_count;
    for (size_t i = 0; i < tape->call_count; i++)
        if (tape->calls[i].body)
            steps += MAX_STEPS_OF_INSTANCES;
    return steps;
}
/* Returns the most steps of a lane tape and of all that it is pruned to, and the most rows. */
static inline size_t lane_max_steps(const LaneTape *tape)
{
    return tape->count + lane_steps_of_calls(tape);
}
static inline size_t lane_max_rows(const LaneTape *tape)
{
    return tape->rows + lane_steps_of_calls(tape);
}

/* These return the bytes of rows, and the rows within a block of memory of that size. */
size_t   lane_work_bytes(const LaneTape *tape);
LaneWork lane_work_in(void *memory, NodeValue *values);

/* Points on surfaces with these normals, seen by pixels of these radii; NULL: 0. */
typedef struct LanePoints {
    const double (*points)[3], (*normals)[3];
    const double *footprints;
    size_t        count;
} LanePoints;

/* Computes outputs `first` to first + outputs - 1 in all points: that of point i goes to results[i
   * outputs]. */
void lane_run(const LaneTape *tape, const LaneWork *work, LanePrecision precision,
              LanePoints points, size_t first, size_t outputs, double *results);

/* Runs a block of rows whose inputs are filled, by an instruction set. */
typedef void LaneRun(const LaneTape *tape, const LaneWork *work, size_t points);
/* A lane tape runs cell tapes (lane_cells.h) on all lanes. */
struct CellTape;
typedef void LaneCellRun(const struct CellTape *tape, NodeValue *values, float *rows);
/* The same on so many blocks of lanes, for a tape without calls: rows are as wide as all of them, and those of inputs
   are the first. */
typedef void LaneWideRun(const struct CellTape *tape, const float *constants, float *rows,
                         size_t blocks);
typedef struct LaneSet {
    const char  *name;
    LaneRun     *run[LANE_PRECISIONS];
    LaneCellRun *run_cells;
    LaneWideRun *run_wide;
} LaneSet;

/* Returns the sets that this processor has, best first; the last is plain C. */
size_t lane_sets(const LaneSet **sets);
/* Makes all threads use this set only, for tests; NULL: the best. */
void lane_use_set(const LaneSet *set);
/* Returns the one that is used. */
const LaneSet *lane_used_set(void);

/* ---- boxes ---- */

/* The ranges of values over a box, by one thread.  `sure`: it is a number in every point of the box. */
typedef struct LaneRanges {
    Range *ranges;
    bool  *sure;
    NodeValue *
        values; /* those of the frame, as of LaneWork: then instance groups have ranges; NULL: not */
    Range *middle; /* those in the middle of the box: for lane_ranges_run_closer */
    bool
        unroll; /* pruning makes steps of calls of instance groups of which few instances are near */
    double
           stretch; /* 1, or above: ranges hold as well if the length of each pair is longer by up to this factor, */
    double longest; /* what is made of several lengths by up to this one */
    double chords;  /* 0, or above: and if curves of outlines are so far away from where they are */
} LaneRanges;

/* Makes room for the ranges of a lane tape, and of all that it is pruned to. */
LaneRanges lane_ranges_new(const LaneTape *tape, Arena *arena);
/* Returns that of output 0; it holds where the value is a number.  Normals and footprints may be
   anything. */
Range lane_ranges_run(const LaneTape *tape, const LaneRanges *ranges, Box box);
/* Returns the same, but narrower where steps know how fast they change.  Rotated boxes grow, so
   ranges of a chain of rotations are wide; balls do not.  It takes twice the time. */
Range lane_ranges_run_closer(const LaneTape *tape, const LaneRanges *ranges, Box box);
/* Returns the range of an output, after a run. */
Range lane_ranges_output(const LaneTape *tape, const LaneRanges *ranges, size_t output);

/* Returns the range of an operand, which may be a scalar, after a run. */
static inline Range lane_range_at(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand)
{
    if (operand & LANE_SCALAR)
        return range_of(tape->scalars[operand & ~LANE_SCALAR]);
    return ranges->ranges[operand];
}

/* Ranges of the derivatives of a value by x, y and z. */
typedef struct LaneSlope {
    Range by[3];
} LaneSlope;

/* Makes room for the slopes of a lane tape, and of all that it is pruned to; for one thread. */
LaneSlope *lane_slopes_new(const LaneTape *tape, Arena *arena);
/* Finds, after a run over a box, the slopes of output 0 in it.  They are of its pieces if it
   chooses between some.  False: it may not be a number, or there is no bound. */
bool lane_slopes_run(const LaneTape *tape, const LaneRanges *ranges, LaneSlope *slopes,
                     LaneSlope *slope);

/* Tells, after a run over a box, whether it is clear at once that lane_slopes_run finds no bound
   for an operand, which then need not be asked.  So it is behind a sign, or behind a root of what
   may be 0. */
bool lane_is_boundless(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand);

/* Ranges of the second derivatives of a value: by xx, yy, zz, yz, xz and xy. */
typedef struct LaneHessian {
    Range by[6];
    bool  known, flat; /* whether there are bounds; all are 0 */
} LaneHessian;

/* Makes room for the Hessians of a lane tape, and of all that it is pruned to; for one thread. */
LaneHessian *lane_hessians_new(const LaneTape *tape, Arena *arena);
/* Finds, after a run of slopes over a box, the second derivatives of output 0 in it, whose first
   derivatives do not jump there.  False: they may, or there is no bound. */
bool lane_hessians_run(const LaneTape *tape, const LaneRanges *ranges, const LaneSlope *slopes,
                       LaneHessian *hessians, LaneHessian *hessian);

/* Tells, after a run over a box, whether output 0 is one of several numbers there and it is not
   known which.  Then it has no second derivatives, and need not be asked for them. */
bool lane_is_undecided(const LaneTape *tape, const LaneRanges *ranges);

/* Makes, after a run over a box, a tape of the first `outputs` outputs without what has no
   influence in it. */
LaneTape lane_prune(const LaneTape *tape, const LaneRanges *ranges, size_t outputs, Arena *arena);

#endif
