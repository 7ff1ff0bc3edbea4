/*
 * lane_instances.c: instance functions over lanes.
 *
 * Each lane visits its own instances, in the order in which a tape does (instance_walk.h).  All lanes take a step
 * at the same time: the body is run once for as many instances as there are lanes.  So results are those of
 * the tape, bit for bit, wherever points are.  A lane that is done takes its result with it, and the last
 * lane moves to its place.
 *
 * Of outlines the instance that is nearest to 0 decides, the first of several.  So lanes are pairs of a point and
 * an instance there: a few points fill all lanes.
 */
#include <math.h>
#include <string.h>

#include "compiler/graph/instance_walk.h"
#include "compiler/graph/lanes/lane_call.h"
#include "compiler/graph/op_values.h"

enum { STATE_NUMBERS = 4 * MAX_INSTANCE_STATES };

typedef struct LaneLoop {
    const Graph            *graph;
    const Instances        *groups;
    const InstanceFunction *function;
    const InstanceTable    *table;
    bool                    by_cells;
    size_t                  active;                /* lanes that are not done */
    uint32_t      instances[LANES], points[LANES]; /* of each lane: the number of its point */
    double        states[STATE_NUMBERS][LANES];
    InstanceWalk *walks[LANES];
} LaneLoop;

static size_t fill_up(size_t points) { return (points + LANE_BLOCK - 1) / LANE_BLOCK * LANE_BLOCK; }

/* ---- steps of bodies ---- */

static void read_column(const LaneLoop *loop, const NodeValue *values, uint32_t column, double *to,
                        size_t lanes)
{
    const InstanceTable *table   = loop->table;
    const Node          *nodes   = column_nodes(loop->groups, table, column);
    const double        *numbers = table->numbers + column;
    for (size_t i = 0; i < lanes; i++)
        to[i] = nodes ? values[nodes[loop->instances[i]]].v[0]
                      : numbers[(size_t)loop->instances[i] * table->columns];
}

void lane_instance_step(const LaneWork *work, const LaneCode *code, size_t points)
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
            to[i] = loop->instances[i];
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
    size_t        last    = --loop->active;
    InstanceWalk *done    = loop->walks[lane];
    loop->walks[lane]     = loop->walks[last];
    loop->walks[last]     = done;
    loop->points[lane]    = loop->points[last];
    loop->instances[lane] = loop->instances[last];
    for (uint32_t k = 0; k < LANE_INPUTS; k++)
        rows[k * LANES + lane] = rows[k * LANES + last];
    for (uint32_t k = 0; k < 4 * loop->function->state_count; k++)
        loop->states[k][lane] = loop->states[k][last];
}

/* Takes the next instance of a lane; false: it is done. */
static bool next_instance(LaneLoop *loop, size_t lane)
{
    uint32_t     distance = loop->function->distance != NO_DISTANCE ? loop->function->distance : 0;
    InstanceStep step;
    while ((step = instance_walk_next(loop->walks[lane], loop->states[4 * distance][lane],
                                      &loop->instances[lane])) == INSTANCE_AGAIN)
        begin_states(loop, lane);
    return step == INSTANCE_NEXT;
}

static void put_result(const LaneLoop *loop, const LaneCall *call, double *rows, size_t lane)
{
    NodeValue states[MAX_INSTANCE_STATES], result;
    for (uint32_t k = 0; k < loop->function->state_count; k++)
        for (uint32_t c = 0; c < 4; c++)
            states[k].v[c] = loop->states[4 * k + c][lane];
    result = instance_walk_result(loop->walks[lane], loop->graph, states);
    for (uint32_t c = 0; c < call->parts; c++)
        rows[(size_t)call->to[c] * LANES + loop->points[lane]] = result.v[c];
}

static void take_states(LaneLoop *loop, const LaneTape *body, const double *rows)
{
    const Expr *items  = body->tape->graph->items;
    const Node *bodies = loop->groups->bodies.items + loop->function->first_body;
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

/* Passes an operand of the call to inputs of the body. */
static void pass_operand(const LaneTape *tape, const double *rows, const uint32_t *from,
                         uint32_t size, double *inputs, size_t lanes)
{
    for (uint32_t c = 0; c < size; c++)
        for (size_t i = 0; i < lanes; i++)
            inputs[c * LANES + i] = from[c] & LANE_SCALAR ? tape->scalars[from[c] & ~LANE_SCALAR]
                                                          : rows[(size_t)from[c] * LANES + i];
}

static void begin_lanes(LaneLoop *loop, const LaneCall *call, InstanceWalk *walks,
                        const double *inputs, size_t points)
{
    loop->active = points;
    for (size_t i = 0; i < points; i++) {
        const double point[3] = {inputs[i], inputs[LANES + i], inputs[2 * LANES + i]};
        loop->walks[i]        = &walks[i];
        loop->points[i]       = (uint32_t)i;
        if (call->instances)
            instance_walk_along(&walks[i], loop->function, call->instances, call->instance_count);
        else
            instance_walk_begin(&walks[i], loop->function, loop->table, point, loop->by_cells);
    }
}

/* Gives each lane its next instance.  Lanes behind the last one do what that does. */
static void next_instances(LaneLoop *loop, const LaneCall *call, double *outer, double *inputs)
{
    for (size_t i = 0; i < loop->active;)
        if (next_instance(loop, i)) {
            i++;
        } else {
            put_result(loop, call, outer, i);
            close_lane(loop, inputs, i);
        }
    for (size_t i = loop->active; loop->active > 0 && i % LANE_BLOCK != 0; i++)
        loop->instances[i] = loop->instances[loop->active - 1];
}

static void run_lanes(LaneLoop *loop, const LaneCall *call, double *outer, const LaneTape *instance,
                      const LaneWork *work, LaneRun *run)
{
    double *inputs = work->rows;
    for (size_t i = 0; i < fill_up(loop->active); i++)
        begin_states(loop, i);
    for (next_instances(loop, call, outer, inputs); loop->active > 0;
         next_instances(loop, call, outer, inputs)) {
        run(instance, work, loop->active);
        take_states(loop, instance, inputs);
    }
}

/* ---- outlines ---- */

/* Points that are not done, and what is nearest to 0 there so far. */
typedef struct Pairs {
    LaneLoop *loop;
    double    points[3][LANES], found[LANES]; /* by the numbers of points */
    uint32_t  owners[LANES];                  /* of each lane: its point */
    size_t    lanes;
} Pairs;

/* Takes instances of a point, as many as there are lanes for it; false: it is done. */
static bool take_instances(Pairs *pairs, size_t at, size_t most)
{
    LaneLoop *loop  = pairs->loop;
    uint32_t  point = loop->points[at];
    size_t    first = pairs->lanes;
    do {
        while (pairs->lanes < first + most &&
               instance_walk_find(loop->walks[at], pairs->found[point],
                                  &loop->instances[pairs->lanes]))
            pairs->owners[pairs->lanes++] = point;
        if (pairs->lanes > first)
            return true;
        if (instance_walk_widen(loop->walks[at], pairs->found[point]) == INSTANCE_DONE)
            return false;
        pairs->found[point] = loop->function->states[0].first[0];
    } while (true);
}

/* Gives all lanes a point and an instance, as far as there are any. */
static void fill_pairs(Pairs *pairs, const LaneCall *call, double *outer)
{
    LaneLoop *loop = pairs->loop;
    size_t    most = LANES / (loop->active ? loop->active : 1);
    pairs->lanes   = 0;
    for (size_t i = 0; i < loop->active;) {
        if (take_instances(pairs, i, most)) {
            i++;
            continue;
        }
        uint32_t        point = loop->points[i];
        const NodeValue end   = {{pairs->found[point]}};
        outer[(size_t)call->to[0] * LANES + point] =
            instance_walk_result(loop->walks[i], loop->graph, &end).v[0];
        loop->walks[i]  = loop->walks[--loop->active];
        loop->points[i] = loop->points[loop->active];
    }
}

/* Runs pairs of points and instances.  Each lane begins with the first state: the result is that or
   the distance to the instance. */
static void run_pairs(Pairs *pairs, const LaneTape *instance, const LaneWork *work, LaneRun *run)
{
    LaneLoop *loop = pairs->loop;
    double   *rows = work->rows;
    for (size_t i = pairs->lanes; i % LANE_BLOCK != 0; i++) {
        loop->instances[i] = loop->instances[i - 1];
        pairs->owners[i]   = pairs->owners[i - 1];
    }
    for (int k = 0; k < 3; k++)
        for (size_t i = 0; i < fill_up(pairs->lanes); i++)
            rows[k * LANES + i] = pairs->points[k][pairs->owners[i]];
    for (size_t i = 0; i < fill_up(pairs->lanes); i++)
        begin_states(loop, i);
    run(instance, work, pairs->lanes);
    uint32_t from = instance->output_rows[0];
    for (size_t i = 0; i < pairs->lanes; i++) {
        double *found = &pairs->found[pairs->owners[i]];
        double  is    = from & LANE_SCALAR ? instance->scalars[from & ~LANE_SCALAR]
                                           : rows[(size_t)from * LANES + i];
        *found        = fabs(is) < fabs(*found) ? is : *found;
    }
}

static void run_outline(LaneLoop *loop, const LaneCall *call, double *outer,
                        const LaneTape *instance, const LaneWork *work, LaneRun *run)
{
    const double *inputs = work->rows;
    Pairs         pairs  = {.loop = loop};
    for (size_t i = 0; i < loop->active; i++) {
        for (int k = 0; k < 3; k++)
            pairs.points[k][i] = inputs[k * LANES + i];
        pairs.found[i] = loop->function->states[0].first[0];
    }
    for (fill_pairs(&pairs, call, outer); pairs.lanes > 0; fill_pairs(&pairs, call, outer))
        run_pairs(&pairs, instance, work, run);
}

/* ---- calls ---- */

static void pass_operands(const LaneTape *tape, const double *outer, const LaneCall *call,
                          double *inputs, size_t lanes)
{
    memset(inputs, 0, LANE_INPUTS * LANES * sizeof *inputs);
    pass_operand(tape, outer, call->from[1], 3, inputs, lanes);
    if (tape->tape->graph->items[call->node].operand_count > 2) {
        pass_operand(tape, outer, call->from[2], 3, inputs + LANE_NORMAL * LANES, lanes);
        pass_operand(tape, outer, call->from[3], 2, inputs + LANE_FOOTPRINT * LANES, lanes);
    }
    memcpy(inputs + LANE_VIEW * LANES, inputs + LANE_NORMAL * LANES, 3 * LANES * sizeof *inputs);
    for (size_t i = 0; i < lanes; i++)
        inputs[LANE_FRONT * LANES + i] = 1;
}

void lane_instance_call(const LaneTape *tape, const LaneWork *work, const LaneCall *call,
                        size_t points, LaneRun *run)
{
    InstanceWalk    walks[LANES];
    LaneLoop        loop;
    const LaneBody *body     = call->body;
    LaneTape        instance = body->tape;
    double         *outer = work->rows, *inputs = work->whole + (size_t)body->first_row * LANES;
    LaneWork        inner = {inputs, work->values, work->whole, &loop};
    loop.graph            = tape->tape->graph;
    loop.groups           = loop.graph->instances;
    loop.function         = &loop.groups->functions.items[body->function];
    loop.table            = &loop.groups->tables.items[body->table];
    loop.by_cells         = work->loop ? work->loop->by_cells : tape->tape->by_cells;
    instance.scalars      = inputs + (size_t)instance.rows * LANES;
    lane_tape_scalars(&instance, work->values, instance.scalars);
    pass_operands(tape, outer, call, inputs, fill_up(points));
    begin_lanes(&loop, call, walks, inputs, points);
    (loop.function->either ? run_outline : run_lanes)(&loop, call, outer, &instance, &inner, run);
    for (size_t i = points; i < fill_up(points); i++)
        for (uint32_t c = 0; c < call->parts; c++)
            outer[(size_t)call->to[c] * LANES + i] = 0;
}
