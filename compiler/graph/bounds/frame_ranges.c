/*
 * frame_ranges.c: ranges of what does not depend on the point.
 *
 * Expressions grow from one another, and each is asked for.  So the graph keeps what is found of
 * those that depend on no parameter; ranges of parameters may change.  Nothing has a gradient
 * here, so the rules of facts are used for their values alone.
 */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "compiler/graph/bounds/facts.h"
#include "compiler/graph/bounds/rules.h"

/* Stands in place of the range of a node that depends on parameters. */
static Range varies;

/* Nodes whose ranges are not found yet. */
typedef struct NodeStack {
    Node  *items;
    size_t count, capacity;
} NodeStack;

/* ---- one node ---- */

static void leaf_range(const Graph *graph, const Expr *e, Range *result)
{
    const GraphParameter *p = e->op == OP_PARAMETER && e->index < graph->parameters.count
                                  ? &graph->parameters.items[e->index]
                                  : NULL;
    for (uint32_t i = 0; i < components(e->type); i++)
        result[i] = e->op != OP_PARAMETER ? range_of(e->number[i])
                    : p                   ? (Range){p->low[i], p->high[i]}
                                          : ANYTHING;
}

/* Finds the range of a MAP row, and of what vectors are made of; false: it is another one. */
static bool common_range(Op op, uint32_t index, uint32_t size, Range *const *o,
                         uint32_t operand_count, Range *result)
{
    const bool builds = op_has_traits(op, BUILDS), map = number_rows[op].map;
    if (op == OP_COMPONENT)
        result[0] = o[0][index];
    for (uint32_t i = 0; builds && i < size; i++)
        result[i] = o[operand_count > 1 ? i : 0][0];
    for (uint32_t i = 0; map && i < size; i++) {
        Range operands[MAX_OPERANDS] = {0};
        for (uint32_t k = 0; k < operand_count; k++)
            operands[k] = o[k][i];
        result[i] = number_rows[op].range(operands);
    }
    return op == OP_COMPONENT || builds || map;
}

/* Finds a range by the rule of the row, as if nothing depended on the point. */
static void range_by_rule(const Graph *graph, const Expr *e, Op op, Range *const *o, Range *result)
{
    GraphType types[MAX_OPERANDS];
    Fact      operands[MAX_OPERANDS] = {0};
    for (uint32_t k = 0; k < e->operand_count; k++) {
        types[k] = graph->items[e->operands[k]].type;
        memcpy(operands[k].value, o[k], components(types[k]) * sizeof **o);
    }
    const Fact fact = op_fact(op, e->type, e->index, types, operands, e->number);
    memcpy(result, fact.value, components(e->type) * sizeof *result);
}

/* Finds the range of a node whose operands have theirs. */
static void find_range(const Graph *graph, Node node, Range *result)
{
    const Expr *e = &graph->items[node];
    Range      *o[MAX_OPERANDS];
    if (e->operand_count == 0) {
        leaf_range(graph, e, result);
        return;
    }
    for (uint32_t k = 0; k < e->operand_count; k++)
        o[k] = graph->frame_ranges->items[e->operands[k]];
    /* Rules do not know that two operands are the same number; a square is not negative. */
    const bool     same = e->operand_count == 2 && e->operands[0] == e->operands[1];
    const Op       op   = same && e->op == OP_mul ? OP_square : (Op)e->op;
    const uint32_t size = components(e->type);
    if (op == OP_div && divides_by_zero(o[1], size))
        for (uint32_t i = 0; i < size; i++)
            result[i] = ANYTHING;
    else if (range_rule(op))
        range_rule(op)(size, o, result);
    else if (!common_range(op, e->index, size, o, e->operand_count, result))
        range_by_rule(graph, e, op, o, result);
    for (uint32_t i = 0; i < size; i++)
        if (!(result[i].low <= result[i].high))
            result[i] = ANYTHING;
    if (same && op == OP_dot)
        result[0] = range_intersect(result[0], (Range){0, HUGE_VAL});
}

/* ---- what the graph keeps ---- */

/* Tells whether an operand has no range, or one that is not this; it is put on the stack, if there is one. */
static bool push_operands(const Graph *graph, Node node, const Range *missing, NodeStack *rest,
                          Arena *scratch)
{
    const Expr *e     = &graph->items[node];
    bool        found = false;
    for (uint32_t k = 0; k < e->operand_count; k++)
        if (graph->frame_ranges->items[e->operands[k]] == missing) {
            found = true;
            array_push(scratch, rest, e->operands[k]);
        }
    return found;
}

static void keep_range(const Graph *graph, Node node)
{
    const Expr *e      = &graph->items[node];
    Range     **ranges = graph->frame_ranges->items;
    bool        fixed  = e->op != OP_PARAMETER;
    for (uint32_t k = 0; k < e->operand_count; k++)
        fixed = fixed && ranges[e->operands[k]] != &varies;
    if (graph->frame_ranges->used <= node)
        graph->frame_ranges->used = node + 1;
    Range *range = fixed ? arena_new_array(graph->arena, Range, components(e->type)) : &varies;
    if (fixed)
        find_range(graph, node, range);
    ranges[node] = range;
}

static void keep_ranges(const Graph *graph, Node node, Arena *scratch)
{
    FrameRanges *found = graph->frame_ranges;
    NodeStack    rest  = {0};
    while (found->count <= node)
        found->items = arena_grow(graph->arena, found->items, found->count, &found->count,
                                  sizeof *found->items);
    if (found->items[node])
        return;
    if (!push_operands(graph, node, NULL, &rest, scratch)) {
        keep_range(graph, node);
        return;
    }
    while (rest.count > 0) {
        const Node next = rest.items[rest.count - 1];
        if (!found->items[next] && push_operands(graph, next, NULL, &rest, scratch))
            continue;
        if (!found->items[next])
            keep_range(graph, next);
        rest.count--;
    }
    keep_range(graph, node);
}

/* Returns the range of a node that depends on parameters.  Those of all such nodes that it needs
   stand in the table meanwhile. */
static Range range_of_varying(const Graph *graph, Node node, uint32_t component, Arena *scratch)
{
    Range   **ranges = graph->frame_ranges->items;
    NodeStack rest = {0}, done = {0};
    array_push(scratch, &rest, node);
    while (rest.count > 0) {
        const Node next = rest.items[rest.count - 1];
        if (ranges[next] == &varies) {
            if (push_operands(graph, next, &varies, &rest, scratch))
                continue;
            Range *range = arena_new_array(scratch, Range, 4);
            find_range(graph, next, range);
            ranges[next] = range;
            array_push(scratch, &done, next);
        }
        rest.count--;
    }
    const Range result = ranges[node][component];
    for (size_t i = 0; i < done.count; i++)
        ranges[done.items[i]] = &varies;
    return result;
}

Range graph_frame_range(const Graph *graph, Node node, uint32_t component, Arena *scratch)
{
    assert(graph->items[node].time != TIME_POINT);
    double number; /* most are known, and need no place in the table */
    if (graph_known_component(graph, node, component, &number) && isfinite(number))
        return range_of(number);
    keep_ranges(graph, node, scratch);
    const Range *kept = graph->frame_ranges->items[node];
    return kept != &varies ? kept[component] : range_of_varying(graph, node, component, scratch);
}
