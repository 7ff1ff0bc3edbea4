/*
 * lane_cell_bodies.c: instance functions in cell tapes: which instances count in a ball, and what these are in all lanes.
 *
 * In a ball lanes are near each other, so they visit the same instances together, in the order of the table.  One that does
 * not count at a point changes nothing there.
 */
#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "compiler/graph/instance_walk.h"
#include "compiler/graph/lanes/lane_cell_work.h"
#include "compiler/graph/op_values.h"

/* ---- bodies ---- */

static size_t rows_of(const CellTape *tape)
{
    return (size_t)tape->inputs + LANE_INPUTS + tape->count;
}

/* Finds the rows of numbers of the instance, and those of states. */
static void find_rows(CellBody *body, const Instances *groups, Arena *arena)
{
    const uint32_t first = body->tape.inputs + LANE_INPUTS;
    body->columns        = arena_new_array(arena, CellColumn, body->tape.count + 1);
    for (uint32_t i = 0; i < body->tape.count; i++) {
        const LaneStep *step = &body->lanes.steps[i];
        if (step->op == LANE_ROW)
            body->columns[body->column_count++] = (CellColumn){
                first + i, column_nodes(groups, body->table, step->operands[0]), step->operands[0]};
        else if (step->op == LANE_INSTANCE)
            body->columns[body->column_count++] = (CellColumn){first + i, NULL, NODE_NONE};
        else if (step->op == LANE_STATE)
            body->states[step->operands[0]] = first + i;
    }
}

/* Finds where the components of states are behind an instance. */
static void find_outputs(CellBody *body, const Expr *items, const Node *bodies, Arena *arena)
{
    uint32_t *rows = arena_new_array(arena, uint32_t, body->lanes.output_count + 1), at = 0;
    cell_outputs(&body->tape, rows);
    for (uint32_t k = 0; k < 4 * MAX_INSTANCE_STATES; k++)
        body->outputs[k] = NODE_NONE;
    for (uint32_t k = 0; k < body->function->state_count; k++)
        for (uint32_t c = 0; c < components((GraphType)items[bodies[k]].type); c++)
            body->outputs[4 * k + c] = rows[at++];
}

static bool is_sharp(const InstanceFunction *function, const Graph *graph)
{
    const Node body = graph->instances->bodies.items[function->first_body];
    return function->either || (function->state_count == 1 && is_lesser(graph->items[body].op));
}

static CellBody *new_body(const LaneBody *from, const Graph *graph, const NodeValue *values,
                          uint32_t first_row, Arena *arena)
{
    const Instances *groups = graph->instances;
    CellBody        *body   = arena_new(arena, CellBody);
    CellCall        *calls;
    body->lanes         = from->tape;
    body->function      = &groups->functions.items[from->function];
    body->table         = &groups->tables.items[from->table];
    body->sharp         = is_sharp(body->function, graph);
    body->first_row     = first_row;
    body->lanes.scalars = arena_new_array(arena, double, from->tape.scalar_count + 1);
    lane_tape_scalars(&from->tape, values, body->lanes.scalars);
    body->tape = cell_tape_alone(&body->lanes, &calls, arena);
    find_rows(body, groups, arena);
    find_outputs(body, graph->items, groups->bodies.items + body->function->first_body, arena);
    return body;
}

/* Tells whether it is known which instances count: of a distance by its slope, else by that of the nearest. */
static bool has_list(const LaneTape *tape, const LaneCall *call)
{
    const Instances *groups = tape->tape->graph->instances;
    if (!call->body || tape->tape->by_cells)
        return false;
    const InstanceFunction *function = &groups->functions.items[call->body->function];
    return distance_of_instances(tape, call) ||
           (function->distance != NO_DISTANCE && !function->sums &&
            (!function->joins || function->listed == NOT_LISTED));
}

void cell_bodies_new(const CellTape *tape, CellCall *calls, const NodeValue *values, Arena *arena)
{
    const Graph *graph  = tape->whole->tape->graph;
    size_t       end    = rows_of(tape) + cell_steps_of_bodies(tape, &(size_t){0});
    CellBody   **bodies = graph->instances ? arena_new_array(arena, CellBody *,
                                                             graph->instances->functions.count + 1)
                                           : NULL;
    for (uint32_t i = 0; i < tape->call_count && bodies; i++) {
        if (!has_list(tape->whole, calls[i].call))
            continue;
        CellBody **body = &bodies[calls[i].call->body->function];
        if (!*body) {
            *body = new_body(calls[i].call->body, graph, values, (uint32_t)end, arena);
            end += rows_of(&(*body)->tape);
        }
        calls[i].body = *body;
    }
}

size_t cell_row_count(const CellTape *tape)
{
    size_t end = rows_of(tape) + cell_steps_of_bodies(tape, &(size_t){0});
    for (uint32_t i = 0; i < tape->call_count; i++) {
        const CellBody *body = tape->calls[i].body;
        if (body && body->first_row + rows_of(&body->tape) > end)
            end = body->first_row + rows_of(&body->tape);
    }
    return end;
}

size_t cell_cost(const CellTape *tape)
{
    enum { OF_POINTS = 1000 }; /* of all instances of a table, point by point */
    size_t cost = tape->count;
    for (uint32_t i = 0; i < tape->call_count; i++) {
        const CellCall *call = &tape->calls[i];
        if (call->body)
            cost += call->instances ? (size_t)call->instance_count * call->body->tape.count
                                    : OF_POINTS;
    }
    return cost;
}

/* ---- in all lanes ---- */

static void fill(float *row, float number)
{
    for (int i = 0; i < CELL_LANES; i++)
        row[i] = number;
}

static void read_instance(const CellBody *body, const NodeValue *values, uint32_t instance,
                          float *inner)
{
    const double *numbers = body->table->numbers + (size_t)instance * body->table->columns;
    for (uint32_t k = 0; k < body->column_count; k++) {
        const CellColumn *column = &body->columns[k];
        float            *row    = inner + (size_t)column->row * CELL_LANES;
        if (!column->nodes && column->column == NODE_NONE)
            fill(row, lane_bits(instance));
        else
            fill(row, (float)(column->nodes ? values[column->nodes[instance]].v[0]
                                            : numbers[column->column]) +
                          0.0f);
    }
}

/* Passes an operand of the call to inputs of the body. */
static void pass_operand(const CellCall *call, int operand, uint32_t size, const float *rows,
                         float *inputs)
{
    for (uint32_t c = 0; c < size; c++)
        memcpy(inputs + (size_t)c * CELL_LANES, rows + (size_t)call->from[operand][c] * CELL_LANES,
               CELL_LANES * sizeof *rows);
}

static void begin_visit(const CellCall *call, const float *rows, float *inner, CellStates states)
{
    const CellBody *body   = call->body;
    float          *inputs = inner + (size_t)body->tape.inputs * CELL_LANES;
    pass_operand(call, 1, 3, rows, inputs + LANE_POINT * CELL_LANES);
    if (call->from[2][0] != NODE_NONE) {
        pass_operand(call, 2, 3, rows, inputs + LANE_NORMAL * CELL_LANES);
        pass_operand(call, 2, 3, rows, inputs + LANE_VIEW * CELL_LANES);
        pass_operand(call, 3, 2, rows, inputs + LANE_FOOTPRINT * CELL_LANES);
    }
    fill(inputs + LANE_FRONT * CELL_LANES, 1);
    for (uint32_t k = 0; k < body->function->state_count; k++)
        for (uint32_t c = 0; c < 4; c++)
            fill(states[4 * k + c],
                 cell_number(body->function->states[k].type, body->function->states[k].first[c]));
}

/* Takes one more instance into the states. */
static void visit(const CellCall *call, NodeValue *values, uint32_t instance, float *inner,
                  CellStates states, LaneCellRun *run)
{
    const CellBody *body  = call->body;
    const uint32_t  count = 4 * body->function->state_count;
    const size_t    row   = CELL_LANES * sizeof *inner;
    read_instance(body, values, instance, inner);
    for (uint32_t k = 0; k < count; k++)
        if (body->states[k])
            memcpy(inner + (size_t)body->states[k] * CELL_LANES, states[k], row);
    run(&body->tape, values, inner);
    for (uint32_t k = 0; k < count; k++)
        if (body->outputs[k] != NODE_NONE)
            memcpy(states[k], inner + (size_t)body->outputs[k] * CELL_LANES, row);
}

/* Returns the box around the points of a call. */
static CellView find_box(const CellCall *call, const float *rows)
{
    CellView view = {.radius = 0};
    for (uint32_t c = 0; c < 3; c++) {
        const float *x  = rows + (size_t)call->from[1][c] * CELL_LANES;
        Range        at = range_of((double)x[0]);
        for (int i = 1; i < CELL_LANES; i++)
            at = (Range){min2(at.low, (double)x[i]), max2(at.high, (double)x[i])};
        view.at[c] = at;
    }
    return view;
}

/* Returns the distance below which an instance counts in some lane, with room for rounding. */
static double farthest_of(const float *state, double size)
{
    double farthest = 0;
    for (int i = 0; i < CELL_LANES; i++)
        farthest = max2(farthest, fabs((double)state[i]));
    return farthest + 1e-5 * (farthest + size);
}

/* Visits the nearest one first, and then those that may be nearer than what is found.  Points are near each other, more so
   than all of the ball. */
static void visit_nearest(const CellCall *call, NodeValue *values, const CellView *view,
                          float *inner, CellStates states, LaneCellRun *run)
{
    const InstanceTable *table     = call->body->table;
    const double         middle[2] = {0.5 * (view->at[0].low + view->at[0].high),
                                      0.5 * (view->at[1].low + view->at[1].high)};
    const double         radius    = real_hypot(0.5 * (view->at[0].high - view->at[0].low),
                                                0.5 * (view->at[1].high - view->at[1].low));
    const double         size      = fabs(middle[0]) + fabs(middle[1]) + radius;
    double               least[MAX_LISTED];
    uint32_t             first = 0;
    for (uint32_t i = 0; i < call->instance_count; i++) {
        const uint32_t instance = call->instances[i];
        least[i]                = table->arcs
                                      ? instance_arc_min_distance(&table->arcs[instance], middle) - radius
                                      : distance_of_boxes(&table->bounds[instance], view->at) / table->stretch;
        first                   = least[i] < least[first] ? i : first;
    }
    visit(call, values, call->instances[first], inner, states, run);
    double farthest = farthest_of(states[0], size);
    for (uint32_t i = 0; i < call->instance_count; i++)
        if (i != first && !(least[i] > farthest)) {
            visit(call, values, call->instances[i], inner, states, run);
            farthest = farthest_of(states[0], size);
        }
}

void cell_visit(const CellCall *call, NodeValue *values, float *rows, CellStates states,
                LaneCellRun *run)
{
    enum { FEW = 3 };
    const CellBody *body  = call->body;
    float          *inner = rows + (size_t)body->first_row * CELL_LANES;
    begin_visit(call, rows, inner, states);
    if (body->sharp && call->instance_count > FEW && (body->table->arcs || body->table->bounds)) {
        const CellView view = find_box(call, rows);
        visit_nearest(call, values, &view, inner, states, run);
        return;
    }
    for (uint32_t i = 0; i < call->instance_count; i++)
        visit(call, values, call->instances[i], inner, states, run);
}

bool cell_read_rows(const Graph *graph, const Expr *row, const NodeValue *values,
                    const float *instances, float *to)
{
    const uint32_t       id     = (uint32_t)graph->items[row->operands[0]].number[0];
    const InstanceTable *table  = &graph->instances->tables.items[row_table(id)];
    const uint32_t       column = row_column(id);
    const Node          *nodes  = column_nodes(graph->instances, table, column);
    for (int i = 0; i < CELL_LANES; i++)
        if (lane_bits_of(instances[i]) >= table->rows)
            return false;
    for (int i = 0; i < CELL_LANES; i++) {
        const size_t instance = lane_bits_of(instances[i]);
        to[i]                 = (float)(nodes ? values[nodes[instance]].v[0]
                                              : table->numbers[instance * table->columns + column]);
    }
    return true;
}

void cell_join(const CellCall *call, const Graph *graph, CellStates states, float *to)
{
    InstanceWalk walk;
    instance_walk_along(&walk, call->body->function, NULL, 0);
    for (int i = 0; i < CELL_LANES; i++) {
        NodeValue all[MAX_INSTANCE_STATES];
        for (uint32_t k = 0; k < call->body->function->state_count; k++)
            for (uint32_t c = 0; c < 4; c++)
                all[k].v[c] = cell_value(call->body->function->states[k].type,
                                         states[4 * k + c][i]);
        to[i] = (float)instance_walk_result(&walk, graph, all).v[0];
    }
}

/* ---- which count ---- */

double cell_call_moves(const CellCall *call, const double by[3], double point)
{
    const bool   plane = call->body && call->body->table->arcs;
    const double moves = plane ? real_hypot(by[0], by[1])
                               : sqrt(by[0] * by[0] + by[1] * by[1] + by[2] * by[2]);
    return call->call->steepest > 0 && !(moves < call->call->steepest * point)
               ? call->call->steepest * point
               : moves;
}

bool cell_find_instances(const CellCall *call, const CellView *view, uint32_t *instances,
                         uint32_t most, uint32_t *count)
{
    const CellBody      *body  = call->body;
    const InstanceTable *table = body->table;
    const Box     *boxes     = table->bounds ? table->bounds : table->places ? NULL : table->boxes;
    const uint32_t all       = call->instances ? call->instance_count : table->rows;
    const double   middle[2] = {0.5 * (view->at[0].low + view->at[0].high),
                                0.5 * (view->at[1].low + view->at[1].high)};
    /* The nearest curve of an outline anywhere in the ball is no farther from its middle.  A blend
       is less than the nearest of its parts, by less than they reach. */
    const double farthest = range_largest(view->value) + view->radius;
    const double reach    = body->sharp ? max2(view->value.high, 0) * table->stretch
                                        : (max2(view->value.high, 0) + table->reach) * table->stretch +
                                           table->reach;
    *count                = 0;
    if (!isfinite(farthest) || (!table->arcs && !boxes))
        return false;
    for (uint32_t i = 0; i < all; i++) {
        const uint32_t instance = call->instances ? call->instances[i] : i;
        if (table->arcs ? instance_arc_min_distance(&table->arcs[instance], middle) > farthest
                        : distance_of_boxes(&boxes[instance], view->at) > reach)
            continue;
        if (*count == most)
            return false;
        instances[(*count)++] = instance;
    }
    return *count > 0;
}
