/*
 * lane_cells.h: short tapes for cells of space, for rays.
 *
 * Rays ask for many distances in small parts of space.  A *cell* is a ball.  In it most shapes are farther
 * away than the nearest one, and a *cell tape* without them is short.  It works in single precision on
 * CELL_LANES points at once.
 *
 * As many cells are bounded at once, a lane each: in a ball no value of a step differs by more than its
 * slope times the radius from that in the middle.  A minimum needs no operand that is above another one in
 * all of the ball, nor above the *cap*: the most that the distance is there, or the diameter of the ball if
 * that is less.  Beyond the cap a cell tape may be wrong, but is no less than the cap.  Whoever steps by
 * the distance leaves the ball by such a step.
 *
 * A step has a row of numbers for itself, so all values are there when cells are bounded.
 *
 * Of an instance function the bodies of few near instances become steps.  Else its call keeps a list of those that may
 * count in the ball, and all lanes visit these together.
 */
#ifndef KRS_LANE_CELLS_H
#define KRS_LANE_CELLS_H

#include "compiler/graph/lanes/lane_math.h"
#include "compiler/graph/lanes/lanes.h"

enum { CELL_LANES = 16, CELL_BLOCKS = 8, CELL_WIDE = CELL_BLOCKS * CELL_LANES };

/* A step works on rows: those of constants are the first, then inputs, then a row for each step, in
   their order.  Of operands that are constants the bits of `scalars` are set. */
typedef struct CellStep {
    uint16_t op;
    uint8_t  operand_count;
    unsigned scalars : MAX_OPERANDS, component : 1; /* the latter as of LaneStep */
    uint32_t from[MAX_OPERANDS]; /* 0 behind the last; of LANE_CALL the number of the call */
    float    steepest;           /* as of LaneStep */
} CellStep;

typedef struct CellCall {
    const LaneCall        *call;
    const struct CellBody *body;      /* of an instance function, in single precision; or NULL */
    const uint32_t        *instances; /* the only ones that may count in the ball; NULL: any may */
    uint32_t               instance_count;
    uint32_t               from[MAX_OPERANDS][4]; /* rows; NODE_NONE behind the last */
} CellCall;

typedef struct CellTape {
    const LaneTape *whole;
    const CellStep *steps;
    const CellCall *calls;
    uint32_t        count, call_count;
    uint32_t        inputs; /* the row of the first input: the number of constants */
    uint32_t        output; /* the row of the distance, which is output 0 */
    bool            steep;  /* all steps have slopes */
    float           cap;    /* infinite: it is right all over the ball */
    float           slope;  /* how fast the distance changes in the ball, at most; no more than 1 */
} CellTape;

/* Returns a number as a row of a type holds it; cell_value is the inverse.  Rows of integers, as numbers of
   copies are, hold their bits, since a float is exact up to 2^24 alone. */
static inline float cell_number(GraphType type, double number)
{
    return type == TYPE_UINT ? lane_bits((uint32_t)number) : (float)number + 0.0f;
}
static inline double cell_value(GraphType type, float number)
{
    return type == TYPE_UINT ? (double)lane_bits_of(number) : (double)number;
}

/* The work of one thread; cell_work_new makes it. */
typedef struct CellWork CellWork;

/* Returns the cell tape of output 0 for all of space; the lane tape lives as long, and its scalars
   are known.  Values are those of the frame. */
CellTape cell_tape_new(const LaneTape *tape, const NodeValue *values, Arena *arena);

/* Makes what one thread needs for cells within cells: `depth` of them, each within the one before.
   Values are those of the frame, its own if the tape reads tables. */
CellWork *cell_work_new(const CellTape *tape, uint32_t depth, NodeValue *values, Arena *arena);

/* Runs it at CELL_LANES points: x, y and z of all, by rows of this depth.  Returns the row of the distance. */
const float *cell_run(const CellTape *tape, CellWork *work, uint32_t depth,
                      const float points[3][CELL_LANES]);

/* Returns the same at up to CELL_BLOCKS times as many points at once, which takes less time for
   each.  Returns all distances. */
const float *cell_run_wide(const CellTape *tape, CellWork *work, uint32_t depth,
                           const float points[3][CELL_WIDE], size_t blocks);

/* Returns the same on rays of these directions, by the rows of depth 0. */
const float *cell_run_seen(const CellTape *tape, CellWork *work, const float points[3][CELL_LANES],
                           const float directions[3][CELL_LANES]);

/* Finds the rows of outputs of the whole tape, as many as it has. */
void cell_outputs(const CellTape *tape, uint32_t *rows);

/* Points on surfaces, where they are seen from: all inputs of a tape. */
typedef struct CellPoints {
    float point[3][CELL_LANES], normal[3][CELL_LANES], footprint[CELL_LANES], view[3][CELL_LANES];
} CellPoints;
/* Runs it there.  Returns all rows, of CELL_LANES numbers each. */
const float *cell_run_surfaces(const CellTape *tape, CellWork *work, uint32_t depth,
                               const CellPoints *points);

/* Returns how much a row differs in a ball from its value in the middle, at most. */
float cell_row_reach(const CellTape *tape, uint32_t row, float radius, float margin);

/* Returns the steps that all lanes take by it, those for instances of lists included. */
size_t cell_cost(const CellTape *tape);

/* These shorten a tape, after a run in the middles of balls, to what is left in the ball of a lane.
   `margin` is what rounding may make of coordinates.  The new tape lives until its mark, which was
   taken before, is released.  As many may live as the work has depth. */
typedef struct CellMark {
    size_t steps, calls, listed;
} CellMark;
CellMark cell_mark(const CellWork *work);
void     cell_release(CellWork *work, CellMark mark);
CellTape cell_prune(const CellTape *tape, CellWork *work, uint32_t depth, uint32_t lane,
                    float radius, float margin);
/* Returns the same, but of several rows, all of which are right in all of the ball.  They get the
   numbers of the rows that stand for them. */
CellTape cell_prune_rows(const CellTape *tape, CellWork *work, uint32_t depth, uint32_t lane,
                         float radius, float margin, uint32_t *rows, size_t count);

#endif
