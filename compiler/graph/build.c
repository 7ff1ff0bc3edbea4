/*
 * build.c: arithmetic that leaves out what is 0 or 1, and roots.
 */
#include "compiler/graph/build.h"

bool is_number(const Graph *g, Node node, double value)
{
    const Expr *e = &g->items[node];
    if (e->op != OP_CONSTANT || e->type > TYPE_VEC4 || (e->type != TYPE_FLOAT && value != 0))
        return false;
    for (uint32_t i = 0; i < (uint32_t)e->type; i++)
        if (e->number[i] != value)
            return false;
    return true;
}

Node plus(Graph *g, Node a, Node b)
{
    if (is_number(g, a, 0) || is_number(g, b, 0))
        return is_number(g, a, 0) ? b : a;
    return add(g, a, b);
}

Node times(Graph *g, Node a, Node b)
{
    if (is_number(g, a, 0) || is_number(g, b, 1))
        return a;
    if (is_number(g, b, 0) || is_number(g, a, 1))
        return b;
    return a == b ? graph_op1(g, OP_square, a) : mul(g, a, b);
}

Node stretch(Graph *g, Node vector, Node by)
{
    if (is_number(g, vector, 0) || is_number(g, by, 1))
        return vector;
    return is_number(g, by, 0) ? graph_vec3(g, 0, 0, 0) : graph_op2(g, OP_scale, vector, by);
}

Node at_least(Graph *g, Node node, double least)
{
    return graph_op2(g, OP_max, node, graph_number(g, least));
}

Node log_of_root(Graph *g, Node number, uint32_t k)
{
    Node log = graph_op1(g, OP_log2, at_least(g, number, 1e-37));
    return mul(g, log, graph_number(g, 1.0 / k));
}

Node root_of(Graph *g, Node number, uint32_t k)
{
    if (k == 1)
        return number;
    if (k % 2 == 0)
        return root_of(g, graph_op1(g, OP_sqrt, number), k / 2);
    return graph_op1(g, OP_exp2, log_of_root(g, number, k));
}
