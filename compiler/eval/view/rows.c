/*
 * rows.c: kinds of properties that cameras and lights share.
 */
#include "compiler/eval/view/view.h"

Node ask_number(const Asked *a, const char *name, const double otherwise[4])
{
    return number_property(a->e, a->env, a->block, name, otherwise[0]);
}

Node ask_place(const Asked *a, const char *name, const double otherwise[4])
{
    return position_property(a->e, a->env, a->block, name, otherwise);
}

Node ask_axis(const Asked *a, const char *name, const double otherwise[4])
{
    return vector_property(a->e, a->env, a->block, name, otherwise);
}

Node ask_pair(const Asked *a, const char *name, const double otherwise[4])
{
    Elaboration  *e      = a->e;
    const Syntax *syntax = find_property(a->block, name);
    Node          node   = NODE_NONE;
    if (syntax)
        node = to_pair(e, evaluate(e, a->env, syntax), syntax, diag_text(e->diags, "`%s`", name));
    return node == NODE_NONE ? graph_constant(e->graph, TYPE_VEC2, otherwise) : node;
}
