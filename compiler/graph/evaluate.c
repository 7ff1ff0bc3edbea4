/*
 * evaluate.c: the graph in double precision: lists of nodes, and how they are run.
 *
 * What each operation is stands in op_values.c.
 */
#include "compiler/graph/evaluate.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/graph/fractal.h"
#include "compiler/graph/op_values.h"
#include "compiler/graph/regions.h"

/* The nodes found so far, in a hash table; its size is a power of 2, at most half is full. */
typedef struct NodeSet {
    Node  *slots; /* node + 1; 0 is free */
    size_t size;
    Node  *nodes; /* in the order in which they were found */
    size_t count, capacity;
} NodeSet;

/* Whether the node is new; then it takes its slot. */
static bool set_take(NodeSet *set, Node node)
{
    size_t i = node * (size_t)0x9E3779B97F4A7C15u >> 20 & (set->size - 1);
    for (; set->slots[i]; i = (i + 1) & (set->size - 1))
        if (set->slots[i] == node + 1)
            return false;
    set->slots[i] = node + 1;
    return true;
}

static void set_add(NodeSet *set, Node node, Arena *arena)
{
    if (2 * (set->count + 1) > set->size) {
        set->size  = set->size ? 2 * set->size : 64;
        set->slots = arena_new_array(arena, Node, set->size);
        for (size_t i = 0; i < set->count; i++)
            set_take(set, set->nodes[i]);
    }
    if (!set_take(set, node))
        return;
    if (set->count == set->capacity)
        set->nodes = arena_grow(arena, set->nodes, set->count, &set->capacity, sizeof *set->nodes);
    set->nodes[set->count++] = node;
}

static int compare_nodes(const void *a, const void *b)
{
    return (*(const Node *)a > *(const Node *)b) - (*(const Node *)a < *(const Node *)b);
}

/* The work grows with what the roots need, not with the graph: most expressions are small and
   the graph of many of them is large.  Nothing of frame time needs anything of point time, so
   it can all go first. */
Tape tape_new(const Graph *graph, const Node *roots, size_t root_count, Arena *arena)
{
    NodeSet set = {0};
    for (size_t i = 0; i < root_count; i++)
        set_add(&set, roots[i], arena);
    for (size_t i = 0; i < set.count; i++) {
        const Expr *e = &graph->items[set.nodes[i]];
        for (int k = 0; k < e->operand_count; k++)
            set_add(&set, e->operands[k], arena);
    }
    if (set.count)
        qsort(set.nodes, set.count, sizeof *set.nodes, compare_nodes);
    Tape  tape  = {.graph = graph, .count = set.count};
    Node *nodes = arena_new_array(arena, Node, set.count + 1);
    for (int frame = 1; frame >= 0; frame--)
        for (size_t i = 0, at = frame ? 0 : tape.frame_count; i < set.count; i++)
            if ((graph->items[set.nodes[i]].time != TIME_POINT) == frame) {
                nodes[at++] = set.nodes[i];
                tape.frame_count += (size_t)frame;
            }
    tape.nodes = nodes;
    return tape;
}

/* A tape on which each region follows its guard. */
typedef struct Layout {
    const Regions *regions;
    Node          *nodes;
    uint32_t      *skips;
    size_t         count;
} Layout;

static void lay_out(Layout *layout, uint32_t region)
{
    const Regions *regions = layout->regions;
    for (Node node = regions->list.items[region].first; node != NODE_NONE;
         node      = regions->next[node]) {
        if (regions->body[node] != NO_REGION) {
            size_t test                    = layout->count;
            layout->nodes[layout->count++] = node;
            lay_out(layout, regions->body[node]);
            layout->skips[test] = (uint32_t)(layout->count - test);
        }
        layout->nodes[layout->count++] = node;
    }
}

Tape tape_new_guarded(const Graph *graph, const Node *roots, size_t root_count, Arena *arena)
{
    Tape    tape    = tape_new(graph, roots, root_count, arena);
    Regions regions = {0};
    graph_regions(&regions, graph, roots, root_count, arena);
    size_t most   = tape.count + regions.list.count;
    Layout layout = {&regions, arena_new_array(arena, Node, most + 1),
                     arena_new_array(arena, uint32_t, most + 1), tape.frame_count};
    memcpy(layout.nodes, tape.nodes, tape.frame_count * sizeof *layout.nodes);
    lay_out(&layout, REGION_ALWAYS);
    tape.nodes = layout.nodes;
    tape.skips = layout.skips;
    tape.count = layout.count;
    return tape;
}

double tape_flops(const Tape *tape)
{
    const Expr *items = tape->graph->items;
    double      flops = 0;
    for (size_t i = tape->frame_count; i < tape->count; i++) {
        const Expr *expr = &items[tape->nodes[i]];
        GraphType   types[MAX_OPERANDS];
        for (uint32_t k = 0; k < expr->operand_count; k++)
            types[k] = items[expr->operands[k]].type;
        if (expr->operand_count)
            flops += op_cost((Op)expr->op, expr->type, types);
    }
    return flops;
}

uint32_t tape_loops(const Tape *tape)
{
    const Expr *items = tape->graph->items;
    uint32_t    loops = 0;
    for (size_t i = tape->frame_count; i < tape->count; i++) {
        const Expr *expr  = &items[tape->nodes[i]];
        uint32_t    range = expr->op == OP_julia ? 2 : expr->op == OP_mandelbulb ? 1 : 0;
        if (range > 0) /* always a constant (fractal.c) */
            loops += fractal_loops((Op)expr->op, items[expr->operands[range]].number[1]);
    }
    return loops;
}

size_t tape_index(const Tape *tape, Node node)
{
    bool   point = tape->graph->items[node].time == TIME_POINT;
    size_t low = point ? tape->frame_count : 0, high = point ? tape->count : tape->frame_count;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (tape->nodes[middle] <= node)
            low = middle;
        else
            high = middle;
    }
    assert(low < tape->count && tape->nodes[low] == node);
    return low;
}

/* What leaves get their values from. */
typedef struct Inputs {
    const NodeValue *parameters;
    const double    *point, *normal;
    double           footprint;
} Inputs;

static NodeValue all_of(const double v[4]) { return (NodeValue){{v[0], v[1], v[2], v[3]}}; }
static NodeValue vector_of(const double v[3]) { return vector3(v[0], v[1], v[2]); }

static inline NodeValue leaf_value(const Expr *e, const Inputs *in)
{
    switch ((Op)e->op) {
#define LEAF(name, text, type, low, high, value, meaning) \
    case OP_##name:                                       \
        return (value);
#include "compiler/graph/ops.def"
#define RULES(name, ...) case OP_##name:
#include "compiler/graph/ops.def"
    case OP_COUNT: break;
    }
    assert(!"no leaf");
    return number(0);
}

/* The rows once more, for tapes: straight from operands to result, without copies. */
static inline void run_row(const Expr *e, const NodeValue *values, NodeValue *result,
                           const Expr *nodes)
{
    const NodeValue *x = &values[e->operands[0]], *y = &values[e->operands[1]];
    const NodeValue *z    = &values[e->operands[2]];
    uint32_t         size = components(e->type);
    switch ((Op)e->op) {
    case OP_COMPONENT: *result = number(x->v[e->index]); return;
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning)           \
    case OP_##name:                                                                       \
        for (uint32_t i = 0; i < size; i++) {                                             \
            double a = x->v[i], b = arity > 1 ? y->v[i] : 0, c = arity > 2 ? z->v[i] : 0; \
            (void)b, (void)c;                                                             \
            result->v[i] = (value) + 0.0;                                                 \
        }                                                                                 \
        return;
#include "compiler/graph/ops.def"
#define LEAF(name, ...) case OP_##name:
#define OP(name, ...)   case OP_##name:
#include "compiler/graph/ops.def"
    case OP_COUNT: break;
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

/* The guard at `i`: how many elements it leaves out. */
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
            values[node] = leaf_value(e, &inputs);
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

Node tape_frame_infinite(const Tape *tape, const NodeValue *values)
{
    for (size_t i = tape->frame_count; i < tape->count; i++) {
        const Expr *e = &tape->graph->items[tape->nodes[i]];
        for (int k = 0; k < e->operand_count; k++)
            if (tape->graph->items[e->operands[k]].time != TIME_POINT &&
                !node_value_is_finite(tape->graph, e->operands[k], values))
                return e->operands[k];
    }
    return NODE_NONE;
}

void tape_run_point(const Tape *tape, const double point[3], NodeValue *values)
{
    tape_run_surface(tape, point, (double[3]){0, 0, 0}, 0, values);
}

void tape_run_surface(const Tape *tape, const double point[3], const double normal[3],
                      double footprint, NodeValue *values)
{
    Inputs inputs = {.point = point, .normal = normal, .footprint = footprint};
    for (size_t i = tape->frame_count; i < tape->count; i++) {
        Node        node = tape->nodes[i];
        const Expr *e    = &tape->graph->items[node];
        if (e->operand_count == 0)
            values[node] = leaf_value(e, &inputs);
        else if (e->op == OP_guard)
            i += run_guard(tape, i, values);
        else
            tape_run_node(tape->graph, node, values);
    }
}
