/*
 * surface.c: what is known of the surface at a hit where two shapes are joined: that of one shape,
 * or a mixture where they blend.
 */
#include "compiler/lower/surface.h"

/* Tells whether two values are the same costly operation, or vectors with such parts.  Then it is better to
   choose between operands: each branch of a tree would have an arc of its own, and all would be computed. */
static bool have_same_structure(const Graph *g, Node a, Node b)
{
    const Expr *x = &g->items[a], *y = &g->items[b];
    if (x->op != y->op || x->type != y->type)
        return false;
    if (x->op != OP_vec2)
        return x->op == OP_atan2 || x->op == OP_join_id;
    return have_same_structure(g, x->operands[0], y->operands[0]) ||
           have_same_structure(g, x->operands[1], y->operands[1]);
}

static Node choose(Graph *g, Node condition, Node a, Node b)
{
    if (a == NODE_NONE || b == NODE_NONE || a == b)
        return a == NODE_NONE ? b : a;
    if (!have_same_structure(g, a, b))
        return graph_op3(g, OP_select, condition, a, b);
    const Expr x = g->items[a], y = g->items[b];
    Node       first  = choose(g, condition, x.operands[0], y.operands[0]);
    Node       second = choose(g, condition, x.operands[1], y.operands[1]);
    return graph_op2(g, (Op)x.op, first, second);
}

Surface choose_surface(Graph *g, Node condition, Surface a, Surface b)
{
    Surface chosen;
#define KRS_INNER(name, blends) chosen.name = choose(g, condition, a.name, b.name);

#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    KRS_INNER(name, blends)
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) KRS_INNER(name, blends)
#include "krs/surface.def"
    return chosen;
}

/* Returns the weighted mean of a and b; weight 1 gives a. */
static Node mix_nodes(Graph *g, Node a, Node b, Node weight)
{
    if (a == NODE_NONE || b == NODE_NONE || a == b)
        return a == NODE_NONE ? b : a;
    return graph_op3(g, OP_mix, b, a, weight);
}

/* Mixes materials where shapes blend.  Levels, instances and coordinates cannot be mixed. */
Surface mix_surface(Graph *g, Node nearer, Node weight, Surface a, Surface b)
{
    Surface mixed;
#define MIXED(name)             mix_nodes(g, a.name, b.name, weight)
#define NEARER(name)            choose(g, nearer, a.name, b.name)
#define KRS_INNER(name, blends) mixed.name = blends(name);

#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    KRS_INNER(name, blends)
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) KRS_INNER(name, blends)
#include "krs/surface.def"
    return mixed;
}
