/*
 * nearest.c: distances of two operands and of many, joined as a blend does (blends.def).
 */
#include "compiler/lower/nearest.h"

#include "compiler/base/far.h"
#include "compiler/graph/blend_shares.h"

Node join_distances(Graph *g, Blend blend, Node a, Node b)
{
    if (blend.width == NODE_NONE)
        return graph_op2(g, OP_min, a, b);
    Node operands[MAX_OPERANDS] = {a, b, blend.width, blend.steps};
    return graph_op(g, blend_info[blend.kind].op, operands);
}

/* ---- of many ---- */

static Node nowhere(Graph *g) { return graph_number(g, NOWHERE); }

Nearest nearest_none(Graph *g, bool pairs)
{
    Node none = nowhere(g);
    if (!pairs)
        none = graph_op1(g, OP_splat4, none);
    return (Nearest){pairs, none, none};
}

static bool is_nowhere(const Graph *g, Node node)
{
    const Expr *e = &g->items[node];
    return e->op == OP_CONSTANT && e->number[0] == NOWHERE;
}

/* Returns the four least of four in ascending order and one more. */
static Node insert(Graph *g, Node four, Node distance)
{
    Node parts[4];
    parts[0] = graph_number(g, -NOWHERE);
    for (uint32_t k = 1; k < 4; k++)
        parts[k] = graph_component(g, four, k - 1);
    Node behind = graph_op(g, OP_vec4, parts);
    Node least  = graph_op2(g, OP_min, four, graph_op1(g, OP_splat4, distance));
    return graph_op2(g, OP_max, behind, least);
}

Nearest nearest_add(Graph *g, Nearest nearest, Node distance)
{
    Node first = distance, more;
    if (!nearest.pairs) {
        more  = graph_op2(g, OP_max, graph_component(g, nearest.near, 3), distance);
        more  = insert(g, nearest.more, more);
        first = insert(g, nearest.near, distance);
    } else if (is_nowhere(g, nearest.near)) {
        more = nearest.more;
    } else {
        more  = graph_op2(g, OP_max, nearest.near, distance);
        more  = is_nowhere(g, nearest.more) ? more : graph_op2(g, OP_min, nearest.more, more);
        first = graph_op2(g, OP_min, nearest.near, distance);
    }
    return (Nearest){nearest.pairs, first, more};
}

Nearest nearest_merge(Graph *g, Nearest nearest, Nearest others)
{
    if (others.pairs)
        return nearest_add(g, nearest_add(g, nearest, others.near), others.more);
    for (uint32_t k = 0; k < MAX_SHARERS; k++)
        nearest = nearest_add(g, nearest,
                              graph_component(g, k < 4 ? others.near : others.more, k % 4));
    return nearest;
}

Node nearest_end(Graph *g, Blend blend, Nearest nearest)
{
    if (nearest.pairs)
        return join_distances(g, blend, nearest.near, nearest.more);
    return graph_op3(g, blend_many(blend.kind).of_eight, nearest.near, nearest.more, blend.width);
}

Node nearest_threshold(Graph *g, Blend blend, Nearest nearest)
{
    return graph_op3(g, OP_threshold8_quadratic, nearest.near, nearest.more, blend.width);
}

/* Returns the share of an operand.  Without a width the nearest ones, which are at the threshold,
   have all. */
Node share_below(Graph *g, Blend blend, Node threshold, Node distance)
{
    Node zero = graph_number(g, 0), one = graph_number(g, 1);
    Node width  = graph_op2(g, OP_max, blend.width, graph_number(g, 1e-30));
    Node blends = graph_op2(g, OP_less, zero, blend.width);
    Node below  = graph_op2(g, OP_div, graph_op2(g, OP_sub, threshold, distance), width);
    below       = graph_op2(g, OP_add, below, graph_op3(g, OP_select, blends, zero, one));
    return graph_op3(g, OP_clamp, below, zero, one);
}

/* Returns up to four numbers in a vector. */
static Node four_of(Graph *g, const Node *distances, uint32_t count)
{
    Node parts[4];
    for (uint32_t k = 0; k < 4; k++)
        parts[k] = k < count ? distances[k] : nowhere(g);
    return graph_op(g, OP_vec4, parts);
}

static Nearest nearest_of(Graph *g, bool pairs, const Node *distances, uint32_t count)
{
    Nearest nearest = nearest_none(g, pairs);
    if (!pairs && count <= MAX_SHARERS) { /* they need no order */
        nearest.near = four_of(g, distances, count);
        if (count > 4)
            nearest.more = four_of(g, distances + 4, count - 4);
        return nearest;
    }
    for (uint32_t i = 0; i < count; i++)
        nearest = nearest_add(g, nearest, distances[i]);
    return nearest;
}

/* Joins distances two and two, so that the graph stays shallow. */
static Node join_in_pairs(Graph *g, Blend blend, const Node *distances, uint32_t count)
{
    if (count == 1)
        return distances[0];
    Node left  = join_in_pairs(g, blend, distances, count / 2);
    Node right = join_in_pairs(g, blend, distances + count / 2, count - count / 2);
    return join_distances(g, blend, left, right);
}

Node blend_distances(Graph *g, Blend blend, const Node *distances, uint32_t count)
{
    const BlendMany many = blend_many(blend.kind);
    if (count <= 2 || many.way == MANY_IN_ROW)
        return join_in_pairs(g, blend, distances, count);
    if (many.way == MANY_SHARE && count <= 4)
        return graph_op2(g, many.of_four, four_of(g, distances, count), blend.width);
    return nearest_end(g, blend, nearest_of(g, many.way == MANY_PAIRS, distances, count));
}

Node blend_threshold(Graph *g, Blend blend, const Node *distances, uint32_t count)
{
    if (count <= 4)
        return graph_op2(g, OP_threshold4_quadratic, four_of(g, distances, count), blend.width);
    return nearest_threshold(g, blend, nearest_of(g, false, distances, count));
}
