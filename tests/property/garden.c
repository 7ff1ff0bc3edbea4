/*
 * garden.c: graphs made at random from every operation there is, and a plain recursive evaluator
 * that everything is held against.
 */
#include "tests/property/garden.h"

#include <math.h>
#include <string.h>

/* ---- the evaluator ---- */

NodeValue evaluate_plainly(const Graph *graph, Node node, const Place *place)
{
    const Expr *e     = &graph->items[node];
    NodeValue   value = {{0}}, operands[MAX_OPERANDS] = {0};
    GraphType   types[MAX_OPERANDS] = {0};
    switch ((Op)e->op) {
    case OP_CONSTANT: memcpy(value.v, e->number, sizeof value.v); return value;
    case OP_PARAMETER: return place->parameters[e->index];
    case OP_POINT: memcpy(value.v, place->point, sizeof place->point); return value;
    case OP_INSTANCE: return (NodeValue){{1}};
    case OP_LEVEL:
    case OP_UV:
    case OP_NORMAL:
    case OP_FOOTPRINT: return value;
    default:
        for (int i = 0; i < e->operand_count; i++) {
            types[i]    = graph->items[e->operands[i]].type;
            operands[i] = evaluate_plainly(graph, e->operands[i], place);
        }
        return op_evaluate(e->op, e->type, e->index, types, operands);
    }
}

Place random_place(Bench *b)
{
    double first = random_between(&b->random, 0, 10), second = random_between(&b->random, -2, 2);
    Place  place = {.parameters = {{{first}}, {{second}}}};
    for (int i = 0; i < 3; i++)
        place.point[i] = random_between(&b->random, -2, 2);
    return place;
}

/* ---- graphs at random ---- */

/* Returns a node of this type among those made so far, or a new constant. */
static Node pick(Bench *b, const Garden *garden, GraphType type)
{
    static const double numbers[] = {0, 1, -1, 2, 0.5, 3, -2.5, 0.1};
    for (int attempt = 0; attempt < 12; attempt++) {
        Node node = garden->nodes[random_below(&b->random, garden->count)];
        if (b->graph->items[node].type == type)
            return node;
    }
    double values[4];
    bool   counts = type == TYPE_BOOL || type == TYPE_UINT;
    for (int i = 0; i < 4; i++)
        values[i] = numbers[random_below(&b->random, counts ? 2 : 8)];
    if (random_below(&b->random, 2))
        values[1] = values[2] = values[3] = values[0];
    return graph_constant(b->graph, type, values);
}

static GraphType random_type(Bench *b) { return (GraphType)(1 + random_below(&b->random, 6)); }

/* Returns a random operation on random operands that it is defined for; there are no tables to
   read. */
static Node grow(Bench *b, const Garden *garden)
{
    for (;;) {
        Op        op = (Op)(OP_COMPONENT + random_below(&b->random, OP_COUNT - OP_COMPONENT));
        GraphType types[MAX_OPERANDS];
        Node      operands[MAX_OPERANDS];
        GraphType usual = random_type(b);
        if (op_has_traits(op, READS_TABLES) || op_has_traits(op, OF_HOST))
            continue;
        for (uint32_t count = 1; count <= MAX_OPERANDS; count++) {
            for (uint32_t i = 0; i < count; i++)
                types[i] = random_below(&b->random, 3) ? usual : random_type(b);
            if (!graph_op_type(op, types, count))
                continue;
            for (uint32_t i = 0; i < count; i++)
                operands[i] = pick(b, garden, types[i]);
            if (op == OP_COMPONENT)
                return graph_component(b->graph, operands[0], random_below(&b->random, types[0]));
            return graph_op(b->graph, op, operands);
        }
    }
}

Garden random_garden(Bench *b, uint32_t count)
{
    Garden garden                = {0};
    Node   point                 = graph_leaf(b->graph, OP_POINT);
    garden.nodes[garden.count++] = point;
    for (uint32_t i = 0; i < 3; i++)
        garden.nodes[garden.count++] = graph_component(b->graph, point, i);
    garden.nodes[garden.count++] = graph_parameter(b->graph, 0, TYPE_FLOAT);
    garden.nodes[garden.count++] = graph_parameter(b->graph, 1, TYPE_FLOAT);
    garden.nodes[garden.count++] = graph_leaf(b->graph, OP_INSTANCE);
    while (garden.count < count)
        garden.nodes[garden.count++] = grow(b, &garden);
    return garden;
}

/* ---- comparing values ---- */

double value_apart(GraphType type, const NodeValue *a, const NodeValue *b)
{
    double apart = 0;
    for (uint32_t i = 0; i < components(type); i++)
        apart = fmax(apart, fabs(a->v[i] - b->v[i]));
    return apart;
}

double value_magnitude(GraphType type, const NodeValue *a)
{
    double size = 0;
    for (uint32_t i = 0; i < components(type); i++)
        size = isfinite(a->v[i]) ? fmax(size, fabs(a->v[i])) : HUGE_VAL;
    return size;
}

bool values_same(GraphType type, const NodeValue *a, const NodeValue *b)
{
    for (uint32_t i = 0; i < components(type); i++)
        if (a->v[i] != b->v[i] && !(isnan(a->v[i]) && isnan(b->v[i])))
            return false;
    return true;
}
