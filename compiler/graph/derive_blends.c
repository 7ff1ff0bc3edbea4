/*
 * derive_blends.c: derivatives of smooth minima of a and b over a width, weight[0] da + weight[1] db,
 * and of the weight of each.
 */
#include "compiler/graph/derive_rules.h"

#include <math.h>
#include <string.h>

#include "compiler/graph/build.h"

/* The weights of a sharp minimum, */
static void sharp_weights(Derivation *d, Node a, Node b, Node weight[2])
{
    Graph *g    = d->graph;
    Node   less = graph_op2(g, OP_less, a, b), one = graph_number(g, 1), zero = graph_number(g, 0);
    weight[0] = graph_op3(g, OP_select, less, one, zero);
    weight[1] = graph_op3(g, OP_select, less, zero, one);
}

/* and of a blend whose width is above 0; `node` is the blend.  `weight` comes as that of a sharp
   minimum. */
typedef void Weights(Derivation *d, Node node, Node a, Node b, Node width, Node weight[2]);

/* How far apart a and b are, in widths. */
static Node widths_apart(Derivation *d, Node a, Node b, Node width)
{
    Graph *g          = d->graph;
    Node   difference = graph_op1(g, OP_abs, sub(g, a, b));
    return over(g, difference, not_zero(d, width));
}

/* By the weight of the farther one: 1/2 at most, the less the farther it is. */
static void weights_by_farther(Derivation *d, Node a, Node b, Node far, Node weight[2])
{
    Graph *g    = d->graph;
    Node   less = graph_op2(g, OP_less, a, b), near = sub(g, graph_number(g, 1), far);
    weight[0] = graph_op3(g, OP_select, less, near, far);
    weight[1] = graph_op3(g, OP_select, less, far, near);
}

/* max(1 - |a - b| / k, 0) */
static Node nearness(Derivation *d, Node a, Node b, Node width)
{
    Graph *g    = d->graph;
    Node   near = sub(g, graph_number(g, 1), widths_apart(d, a, b, width));
    return graph_op2(g, OP_max, near, graph_number(g, 0));
}

static void quadratic_weights(Derivation *d, Node node, Node a, Node b, Node width, Node weight[2])
{
    Graph *g = d->graph;
    (void)node;
    Node far = nearness(d, a, b, width);
    weights_by_farther(d, a, b, mul(g, far, graph_number(g, 0.5)), weight);
}

static void cubic_weights(Derivation *d, Node node, Node a, Node b, Node width, Node weight[2])
{
    Graph *g = d->graph;
    (void)node;
    Node far = graph_op1(g, OP_square, nearness(d, a, b, width));
    weights_by_farther(d, a, b, mul(g, far, graph_number(g, 0.5)), weight);
}

static void exponential_weights(Derivation *d, Node node, Node a, Node b, Node width,
                                Node weight[2])
{
    (void)node;
    Graph *g   = d->graph;
    Node   far = graph_op1(g, OP_exp, neg(g, widths_apart(d, a, b, width)));
    far        = over(g, far, add(g, graph_number(g, 1), far));
    weights_by_farther(d, a, b, far, weight);
}

/* max(k, min(a, b)) - length(max(k - a, 0), max(k - b, 0)) */
static void circular_weights(Derivation *d, Node node, Node a, Node b, Node width, Node weight[2])
{
    (void)node;
    Graph *g    = d->graph;
    Node   zero = graph_number(g, 0), depth[2];
    for (int i = 0; i < 2; i++)
        depth[i] = graph_op2(g, OP_max, sub(g, width, i ? b : a), zero);
    Node both = not_zero(d, graph_op1(g, OP_length, graph_op(g, OP_vec2, depth)));
    Node out  = graph_op2(g, OP_less, width, graph_op2(g, OP_min, a, b));
    for (int i = 0; i < 2; i++)
        weight[i] = graph_op3(g, OP_select, out, weight[i], over(g, depth[i], both));
}

/* min(a, b, (a + b - k) / sqrt(2)) */
static void chamfer_weights(Derivation *d, Node node, Node a, Node b, Node width, Node weight[2])
{
    (void)node;
    Graph *g     = d->graph;
    Node   half  = graph_number(g, M_SQRT1_2);
    Node   cut   = sub(g, add(g, a, b), width);
    Node   least = graph_op2(g, OP_min, a, b);
    Node   cuts  = graph_op2(g, OP_less, mul(g, cut, half), least);
    for (int i = 0; i < 2; i++)
        weight[i] = graph_op3(g, OP_select, cuts, half, weight[i]);
}

/* min(a, b, (b - k + a + |mod(b - k - a + s, 2 s) - s|) / 2), s the width of a step */
static void stairs_weights(Derivation *d, Node node, Node a, Node b, Node width, Node weight[2])
{
    Graph *g    = d->graph;
    Expr   e    = g->items[node];
    width       = not_zero(d, width);
    Node steps  = graph_op2(g, OP_max, e.operands[3], graph_number(g, 1));
    Node step   = over(g, width, steps);
    Node level  = sub(g, b, width);
    level       = sub(g, level, a);
    level       = add(g, level, step);
    Node within = graph_op2(g, OP_mod, level, add(g, step, step));
    Node rises  = graph_op2(g, OP_less, step, within);
    Node stairs = graph_op2(g, OP_less, node, graph_op2(g, OP_min, a, b));
    Node zero = graph_number(g, 0), one = graph_number(g, 1);
    Node by_b = graph_op3(g, OP_select, rises, one, zero);
    Node by_a = graph_op3(g, OP_select, rises, zero, one);
    weight[0] = graph_op3(g, OP_select, stairs, by_a, weight[0]);
    weight[1] = graph_op3(g, OP_select, stairs, by_b, weight[1]);
}

static Node derive_blend(Derivation *d, const Expr *e, Node node, const Node *inner,
                         Weights *weights)
{
    Graph *g = d->graph;
    if (!others_are_constant(g, inner, 2, e->operand_count))
        return NODE_NONE;
    Node a = e->operands[0], b = e->operands[1], width = e->operands[2];
    Node sharp[2], weight[2];
    sharp_weights(d, a, b, sharp);
    memcpy(weight, sharp, sizeof weight);
    weights(d, node, a, b, width, weight);
    Node blends = graph_op2(g, OP_less, graph_number(g, 0), width), sum[2];
    for (int i = 0; i < 2; i++) {
        weight[i] = graph_op3(g, OP_select, blends, weight[i], sharp[i]);
        sum[i]    = mul(g, weight[i], inner[i]);
    }
    return between_jumps(d, add(g, sum[0], sum[1]));
}

#define BLEND(name)                                                                     \
    Node derive_smin_##name(Derivation *d, const Expr *e, Node node, const Node *inner) \
    {                                                                                   \
        return derive_blend(d, e, node, inner, name##_weights);                         \
    }
BLEND(quadratic)
BLEND(cubic)
BLEND(exponential)
BLEND(circular)
BLEND(chamfer)
BLEND(stairs)
#undef BLEND

/* clamp(1/2 + (b - a) / 2k, 0, 1) */
Node derive_blend_weight(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)node;
    if (!is_zero(d->graph, inner[2]))
        return NODE_NONE;
    Graph *g          = d->graph;
    Node   difference = graph_op1(g, OP_abs, sub(g, e->operands[1], e->operands[0]));
    Node   blends     = graph_op2(g, OP_less, difference, e->operands[2]);
    Node   width      = not_zero(d, e->operands[2]);
    Node   slope      = over(g, graph_number(g, 0.5), width);
    Node   change     = mul(g, sub(g, inner[1], inner[0]), slope);
    return between_jumps(d, graph_op3(g, OP_select, blends, change, graph_number(g, 0)));
}
