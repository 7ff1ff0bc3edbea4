/*
 * lane_crowds.c: crowd functions over lanes.
 *
 * Each lane visits its own members, in the order in which a tape does (crowd_walk.h).  All lanes take a step
 * at the same time: the body is run once for as many members as there are lanes.  So results are those of
 * the tape, bit for bit, wherever points are.  A lane that is done takes its result with it, and the last
 * lane moves to its place.
 */
#include <string.h>

#include "compiler/graph/crowd_walk.h"
#include "compiler/graph/lane_call.h"
#include "compiler/graph/op_values.h"

enum { STATE_NUMBERS = 4 * MOST_CROWD_STATES };

typedef struct LaneLoop {
    const LaneBody      *body;
    const Crowds        *crowds;
    const CrowdFunction *function;
    const Crowd         *table;
    bool                 by_cells;
    size_t               active;                        /* lanes that are not done */
    uint32_t             members[LANES], points[LANES]; /* of each lane: the number of its point */
    double               states[STATE_NUMBERS][LANES];
    CrowdWalk           *walks[LANES];
} LaneLoop;

static size_t fill_up(size_t points) { return (points + LANE_BLOCK - 1) / LANE_BLOCK * LANE_BLOCK; }

/* ---- steps of bodies ---- */

static void read_column(const LaneLoop *loop, const NodeValue *values, uint32_t column, double *to,
                        size_t lanes)
{
    const Crowd  *table   = loop->table;
    const Node   *nodes   = column_nodes(loop->crowds, table, column);
    const double *numbers = table->numbers + column;
    for (size_t i = 0; i < lanes; i++)
        to[i] = nodes ? values[nodes[loop->members[i]]].v[0]
                      : numbers[(size_t)loop->members[i] * table->columns];
}

void lane_member_step(const LaneWork *work, const LaneCode *code, size_t points)
{
    const LaneLoop *loop  = work->loop;
    double         *to    = (double *)work->rows + (size_t)code->to * LANES;
    size_t          lanes = fill_up(points);
    if (code->op == LANE_ROW)
        read_column(loop, work->values, code->from[0], to, lanes);
    else if (code->op == LANE_STATE)
        memcpy(to, loop->states[code->from[0]], lanes * sizeof *to);
    else
        for (size_t i = 0; i < lanes; i++)
            to[i] = loop->members[i];
}

/* ---- lanes ---- */

static void begin_states(LaneLoop *loop, size_t lane)
{
    for (uint32_t k = 0; k < loop->function->state_count; k++)
        for (uint32_t c = 0; c < 4; c++)
            loop->states[4 * k + c][lane] = loop->function->states[k].first[c] + 0.0;
}

/* The last lane that is active takes the place of one that is done. */
static void close_lane(LaneLoop *loop, double *rows, size_t lane)
{
    size_t     last     = --loop->active;
    CrowdWalk *done     = loop->walks[lane];
    loop->walks[lane]   = loop->walks[last];
    loop->walks[last]   = done;
    loop->points[lane]  = loop->points[last];
    loop->members[lane] = loop->members[last];
    for (uint32_t k = 0; k < LANE_INPUTS; k++)
        rows[k * LANES + lane] = rows[k * LANES + last];
    for (uint32_t k = 0; k < 4 * loop->function->state_count; k++)
        loop->states[k][lane] = loop->states[k][last];
}

/* The next member of a lane; false: it is done. */
static bool next_member(LaneLoop *loop, size_t lane)
{
    uint32_t  distance = loop->function->distance != NO_DISTANCE ? loop->function->distance : 0;
    CrowdStep step;
    while ((step = crowd_walk_next(loop->walks[lane], loop->states[4 * distance][lane],
                                   &loop->members[lane])) == CROWD_AGAIN)
        begin_states(loop, lane);
    return step == CROWD_MEMBER;
}

/* The first state is the result. */
static void put_result(const LaneLoop *loop, const LaneCall *call, double *rows, size_t lane)
{
    for (uint32_t c = 0; c < call->parts; c++)
        rows[(size_t)call->to[c] * LANES + loop->points[lane]] = loop->states[c][lane];
    const double ends[] = {loop->states[0][lane], loop->states[4][lane], loop->states[8][lane]};
    rows[(size_t)call->to[0] * LANES + loop->points[lane]] = crowd_walk_result(loop->walks[lane],
                                                                               ends);
}

static void take_states(LaneLoop *loop, const LaneTape *body, const double *rows)
{
    const Expr *items  = body->tape->graph->items;
    const Node *bodies = loop->crowds->bodies.items + loop->function->first_body;
    size_t      output = 0;
    for (uint32_t k = 0; k < loop->function->state_count; k++)
        for (uint32_t c = 0; c < components((GraphType)items[bodies[k]].type); c++) {
            uint32_t from  = body->output_rows[output++];
            double  *state = loop->states[4 * k + c];
            if (from & LANE_SCALAR)
                for (size_t i = 0; i < loop->active; i++)
                    state[i] = body->scalars[from & ~LANE_SCALAR];
            else
                memcpy(state, rows + (size_t)from * LANES, loop->active * sizeof *state);
        }
}

/* ---- calls ---- */

/* An operand of the call becomes inputs of the body. */
static void pass_operand(const LaneTape *tape, const double *rows, const uint32_t *from,
                         uint32_t size, double *inputs, size_t lanes)
{
    for (uint32_t c = 0; c < size; c++)
        for (size_t i = 0; i < lanes; i++)
            inputs[c * LANES + i] = from[c] & LANE_SCALAR ? tape->scalars[from[c] & ~LANE_SCALAR]
                                                          : rows[(size_t)from[c] * LANES + i];
}

static void begin_lanes(LaneLoop *loop, CrowdWalk *walks, const double *inputs, size_t points)
{
    loop->active = points;
    for (size_t i = 0; i < fill_up(points); i++)
        begin_states(loop, i);
    for (size_t i = 0; i < points; i++) {
        const double point[3] = {inputs[i], inputs[LANES + i], inputs[2 * LANES + i]};
        loop->walks[i]        = &walks[i];
        loop->points[i]       = (uint32_t)i;
        crowd_walk_begin(loop->walks[i], loop->function, loop->table, point, loop->by_cells);
    }
}

/* Gives each lane its next member.  Lanes behind the last one do what that does. */
static void next_members(LaneLoop *loop, const LaneCall *call, double *outer, double *inputs)
{
    for (size_t i = 0; i < loop->active;)
        if (next_member(loop, i)) {
            i++;
        } else {
            put_result(loop, call, outer, i);
            close_lane(loop, inputs, i);
        }
    for (size_t i = loop->active; loop->active > 0 && i % LANE_BLOCK != 0; i++)
        loop->members[i] = loop->members[loop->active - 1];
}

void lane_crowd_call(const LaneTape *tape, const LaneWork *work, const LaneCall *call,
                     size_t points, LaneKernel *run)
{
    CrowdWalk       walks[LANES];
    const LaneBody *body   = call->body;
    LaneTape        member = body->tape;
    double         *outer = work->rows, *inputs = work->whole + (size_t)body->first_row * LANES;
    const Crowds   *crowds = tape->tape->graph->crowds;
    LaneLoop        loop   = {.body     = body,
                              .crowds   = crowds,
                              .function = &crowds->functions.items[body->function],
                              .table    = &crowds->tables.items[body->table],
                              .by_cells = work->loop ? work->loop->by_cells : tape->tape->by_cells};
    LaneWork        inner  = {inputs, work->values, work->whole, &loop};
    member.scalars         = inputs + (size_t)member.rows * LANES;
    lane_tape_scalars(&member, work->values, member.scalars);
    memset(inputs, 0, LANE_INPUTS * LANES * sizeof *inputs);
    pass_operand(tape, outer, call->from[1], 3, inputs, fill_up(points));
    if (call->from[2][0] != NODE_NONE && tape->tape->graph->items[call->node].operand_count > 2) {
        pass_operand(tape, outer, call->from[2], 3, inputs + LANE_NORMAL * LANES, fill_up(points));
        pass_operand(tape, outer, call->from[3], 1, inputs + LANE_FOOTPRINT * LANES,
                     fill_up(points));
    }
    begin_lanes(&loop, walks, inputs, points);
    for (next_members(&loop, call, outer, inputs); loop.active > 0;
         next_members(&loop, call, outer, inputs)) {
        run(&member, &inner, loop.active);
        take_states(&loop, &member, inputs);
    }
    for (size_t i = points; i < fill_up(points); i++)
        for (uint32_t c = 0; c < call->parts; c++)
            outer[(size_t)call->to[c] * LANES + i] = 0;
}
