/*
 * evaluate.c: the graph in double precision: how tapes are run.
 *
 * What each operation is stands in op_values.c.
 */
#include "compiler/graph/evaluate.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/graph/instance_walk.h"
#include "compiler/graph/op_values.h"
#include "compiler/graph/texture.h"

/* The sources of the values of leaves. */
typedef struct Inputs {
    const NodeValue *parameters;
    const double    *point, *normal;
    const double    *view; /* of the ray that sees the surface; NULL: nobody looks */
    double           footprint;
    bool             by_cells;
    uint64_t        *ran;
    /* The operands of the call, in bodies of instance functions. */
    double           threshold;
    uint32_t         instance;
    const NodeValue *states;
} Inputs;

/* Returns four numbers, in which zero has no sign (op_evaluate). */
static NodeValue all_of(const double v[4])
{
    return (NodeValue){{v[0] + 0.0, v[1] + 0.0, v[2] + 0.0, v[3] + 0.0}};
}
static NodeValue vector_of(const double v[3])
{
    return vector3(v[0] + 0.0, v[1] + 0.0, v[2] + 0.0);
}

static double sees_front(const Inputs *in)
{
    return in->view && dot3(in->view, in->normal) > 0 ? 0 : 1;
}

#define LEAF(name, text, type, low, high, value, meaning)                  \
    static NodeValue leaf_value_of_##name(const Expr *e, const Inputs *in) \
    {                                                                      \
        (void)e, (void)in;                                                 \
        return value;                                                      \
    }
#include "compiler/graph/ops.def"

static NodeValue (*const leaf_values[OP_COUNT])(const Expr *e, const Inputs *in) = {
#define LEAF(name, ...) [OP_##name] = leaf_value_of_##name,
#include "compiler/graph/ops.def"
};

NodeValue leaf_unseen(const Expr *leaf) { return leaf_values[leaf->op](leaf, &(Inputs){0}); }

/* Computes an operation straight from operands to result, without copies, if it is a row of
   numbers. */
static inline void run_row(const Expr *e, const NodeValue *values, NodeValue *result,
                           const Expr *nodes)
{
    if (e->op == OP_COMPONENT) {
        *result = number(values[e->operands[0]].v[e->index]);
        return;
    }
    if (map_values[e->op]) {
        map_values[e->op](values[e->operands[0]].v, values[e->operands[1]].v,
                          values[e->operands[2]].v, components(e->type), result->v);
        return;
    }
    NodeValue operands[MAX_OPERANDS];
    GraphType types[MAX_OPERANDS];
    for (int i = 0; i < e->operand_count; i++) {
        types[i]    = nodes[e->operands[i]].type;
        operands[i] = values[e->operands[i]];
    }
    *result = op_evaluate(e->op, e->type, e->index, types, operands);
}

static void tape_run_node(const Graph *graph, Node node, NodeValue *values)
{
    run_row(&graph->items[node], values, &values[node], graph->items);
}

/* Returns the guard at `i`: how many elements it leaves out. */
static size_t run_guard(const Tape *tape, size_t i, NodeValue *values)
{
    const Expr *e     = &tape->graph->items[tape->nodes[i]];
    double      bound = values[e->operands[0]].v[0], least = values[e->operands[1]].v[0];
    if (!guard_decides(bound, least, values[e->operands[3]].v[0])) {
        values[tape->nodes[i]] = values[e->operands[2]];
        return 0;
    }
    values[tape->nodes[i]] = number(fmin(bound, least));
    return tape->skips ? tape->skips[i] : 0;
}

void tape_run_frame(const Tape *tape, const NodeValue *parameters, NodeValue *values)
{
    Inputs inputs = {.parameters = parameters};
    for (size_t i = 0; i < tape->frame_count; i++) {
        Node        node = tape->nodes[i];
        const Expr *e    = &tape->graph->items[node];
        if (e->operand_count == 0)
            values[node] = leaf_values[e->op](e, &inputs);
        else
            tape_run_node(tape->graph, node, values);
    }
}

bool node_value_is_finite(const Graph *graph, Node node, const NodeValue *values)
{
    const Expr *e = &graph->items[node];
    for (uint32_t k = 0; e->type <= TYPE_VEC4 && k < (uint32_t)e->type; k++)
        if (!isfinite(values[node].v[k]))
            return false;
    return true;
}

/* Finds a number of the frame that OP_row may read and that is not finite. */
static Node column_infinite(const Graph *graph, const Expr *row, const NodeValue *values)
{
    uint32_t    count;
    const Node *nodes = row_nodes(graph, row, &count);
    for (uint32_t i = 0; i < count; i++)
        if (!node_value_is_finite(graph, nodes[i], values))
            return nodes[i];
    return NODE_NONE;
}

static Node functions_frame_infinite(const Tape *tape, const NodeValue *values)
{
    Node found = NODE_NONE;
    for (uint32_t id = 0; id < tape->function_count && found == NODE_NONE; id++)
        found = tape_frame_infinite(&tape->functions[id], values);
    return found;
}

Node tape_frame_infinite(const Tape *tape, const NodeValue *values)
{
    for (size_t i = tape->frame_count; i < tape->count; i++) {
        const Expr *e = &tape->graph->items[tape->nodes[i]];
        for (int k = 0; k < e->operand_count; k++)
            if (tape->graph->items[e->operands[k]].time != TIME_POINT &&
                !node_value_is_finite(tape->graph, e->operands[k], values))
                return e->operands[k];
        Node found = e->op == OP_row ? column_infinite(tape->graph, e, values) : NODE_NONE;
        if (found != NODE_NONE)
            return found;
    }
    return functions_frame_infinite(tape, values);
}

/* ---- at points ---- */

static uint32_t whole(const NodeValue *value) { return (uint32_t)value->v[0]; }

/* Evaluates OP_row. */
static NodeValue read_table(const Graph *graph, const Expr *e, const NodeValue *values)
{
    uint32_t column = whole(&values[e->operands[0]]), instance = whole(&values[e->operands[1]]);
    const InstanceTable *table = &graph->instances->tables.items[row_table(column)];
    const Node          *nodes = column_nodes(graph->instances, table, row_column(column));
    assert(instance < table->rows);
    if (nodes)
        return values[nodes[instance]];
    return number(table->numbers[(size_t)instance * table->columns + row_column(column)]);
}

static NodeValue read_texture(const Graph *graph, const Expr *e, const NodeValue *values)
{
    return texture_mean(texture_of(graph, e), values[e->operands[0]].v, values[e->operands[1]].v);
}

static void run_points(const Tape *tape, const Inputs *in, NodeValue *values);

/* The loop of an instance function, which has a tape for what it does at each instance. */
typedef struct Loop {
    const InstanceFunction *function;
    const InstanceTable    *table;
    const Tape             *body;
    const Node             *bodies;
    NodeValue              *values;
    NodeValue               states[MAX_INSTANCE_STATES];
    Inputs                  in;
} Loop;

static void begin_loop(Loop *loop)
{
    for (uint32_t k = 0; k < loop->function->state_count; k++)
        loop->states[k] = all_of(loop->function->states[k].first);
    loop->in.states = loop->states;
}

static void loop_over(Loop *loop, uint32_t instance)
{
    loop->in.instance = instance;
    run_points(loop->body, &loop->in, loop->values);
    for (uint32_t k = 0; k < loop->function->state_count; k++)
        loop->states[k] = loop->values[loop->bodies[k]];
}

static NodeValue run_loop(Loop *loop)
{
    InstanceWalk  walk;
    InstanceStep  step;
    uint32_t      instance, distance = loop->function->distance;
    const double *found = loop->states[distance != NO_DISTANCE ? distance : 0].v;
    instance_walk_begin(&walk, loop->function, loop->table, loop->in.point, loop->in.by_cells);
    begin_loop(loop);
    while ((step = instance_walk_next(&walk, *found, &instance)) != INSTANCE_DONE)
        if (step == INSTANCE_NEXT)
            loop_over(loop, instance);
        else
            begin_loop(loop);
    return instance_walk_result(&walk, loop->body->graph, loop->states);
}

static NodeValue run_call(const Tape *tape, const Expr *e, const Inputs *outer, NodeValue *values)
{
    const Instances *instances = tape->graph->instances;
    uint32_t         id        = whole(&values[e->operands[0]]);
    double           point[3], normal[3] = {0, 0, 0}, pixel[2] = {0, 0};
    memcpy(point, values[e->operands[1]].v, sizeof point);
    if (e->operand_count > 2) {
        memcpy(normal, values[e->operands[2]].v, sizeof normal);
        memcpy(pixel, values[e->operands[3]].v, sizeof pixel);
    }
    const InstanceFunction *function = &instances->functions.items[id];

    Loop loop = {.function = function,
                 .table    = &instances->tables.items[function->table_number],
                 .body     = &tape->functions[id],
                 .bodies   = instances->bodies.items + function->first_body,
                 .values   = values,
                 .in       = {.point     = point,
                              .normal    = normal,
                              .footprint = pixel[0],
                              .threshold = pixel[1],
                              .by_cells  = outer->by_cells,
                              .ran       = outer->ran}};
    return run_loop(&loop);
}

static void run_reader(const Tape *tape, Node node, const Inputs *in, NodeValue *values)
{
    const Expr *e = &tape->graph->items[node];
    values[node]  = e->op == OP_row         ? read_table(tape->graph, e, values)
                    : is_texture((Op)e->op) ? read_texture(tape->graph, e, values)
                                            : run_call(tape, e, in, values);
}

NodeValue tape_run_reader(const Tape *tape, Node node, const NodeValue *operands, NodeValue *values)
{
    const Expr  *e  = &tape->graph->items[node];
    const Inputs in = {.by_cells = tape->by_cells};
    for (uint32_t k = 0; k < e->operand_count; k++)
        values[e->operands[k]] = operands[k];
    run_reader(tape, node, &in, values);
    return values[node];
}

static void run_points(const Tape *tape, const Inputs *in, NodeValue *values)
{
    uint64_t ran = 0;
    for (size_t i = tape->frame_count; i < tape->count; i++) {
        Node        node = tape->nodes[i];
        const Expr *e    = &tape->graph->items[node];
        if (e->operand_count == 0)
            values[node] = leaf_values[e->op](e, in);
        else if (e->op == OP_guard)
            i += run_guard(tape, i, values);
        else if (op_has_traits((Op)e->op, READS_TABLES))
            run_reader(tape, node, in, values);
        else
            tape_run_node(tape->graph, node, values);
        ran++;
    }
    if (in->ran)
        *in->ran += ran;
}

void tape_run_point(const Tape *tape, const double point[3], NodeValue *values)
{
    tape_run_surface(tape, point, (double[3]){0, 0, 0}, 0, values);
}

void tape_run_surface(const Tape *tape, const double point[3], const double normal[3],
                      double footprint, NodeValue *values)
{
    Inputs in = {.point     = point,
                 .normal    = normal,
                 .footprint = footprint,
                 .by_cells  = tape->by_cells,
                 .ran       = tape->ran};
    run_points(tape, &in, values);
}

void tape_run_seen(const Tape *tape, const double point[3], const double normal[3],
                   const double view[3], NodeValue *values)
{
    Inputs in = {.point = point, .normal = normal, .view = view, .by_cells = tape->by_cells};
    run_points(tape, &in, values);
}
