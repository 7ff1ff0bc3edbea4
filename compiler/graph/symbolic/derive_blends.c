/*
 * derive_blends.c: derivatives of smooth minima of a and b over a width: those of a and b, weighted;
 * and of the weight of each.
 */
#include "compiler/graph/symbolic/derive_rules.h"

#include <math.h>

#include "compiler/graph/build.h"

/* A smooth minimum that is derived: its operands, and the weights that a sharp one would have. */
typedef struct Blending {
    Derivation *derivation;
    Graph      *graph;
    Node        node, a, b, width, steps;
    Node        sharp[2];
} Blending;

/* The factors of the derivatives of a and b. */
typedef struct Weights {
    Node of_a, of_b;
} Weights;

/* ---- numbers of which the column `weights` of blends.def is made ---- */

static Node width_above_zero(Blending *x) { return not_zero(x->derivation, x->width); }

/* Returns |a - b| / k. */
static Node widths_between(Blending *x)
{
    Graph *g          = x->graph;
    Node   difference = graph_op1(g, OP_abs, sub(g, x->a, x->b));
    return over(g, difference, width_above_zero(x));
}

/* Returns max(1 - |a - b| / k, 0). */
static Node nearness(Blending *x)
{
    Graph *g     = x->graph;
    Node   apart = widths_between(x);
    Node   near  = sub(g, graph_number(g, 1), apart);
    return graph_op2(g, OP_max, near, graph_number(g, 0));
}

static Node half(Blending *x, Node number)
{
    return mul(x->graph, number, graph_number(x->graph, 0.5));
}

static Node power(Blending *x, Node number, uint32_t exponent)
{
    if (exponent == 1)
        return number;
    if (exponent % 2 == 0)
        return graph_op1(x->graph, OP_square, power(x, number, exponent / 2));
    return mul(x->graph, power(x, number, exponent - 1), number);
}

/* Returns 1 / (1 + e^t) = e^-t / (1 + e^-t), which never overflows where t is at least 0. */
static Node logistic(Blending *x, Node t)
{
    Graph *g       = x->graph;
    Node   inverse = graph_op1(g, OP_exp, neg(g, t));
    return over(g, inverse, add(g, graph_number(g, 1), inverse));
}

/* ---- the column `weights` ---- */

/* Returns both weights by that of the farther one: 1/2 at most, the less the farther it is. */
static Weights by_farther(Blending *x, Node far)
{
    Graph  *g    = x->graph;
    Node    less = graph_op2(g, OP_less, x->a, x->b), near = sub(g, graph_number(g, 1), far);
    Weights weights;
    weights.of_a = graph_op3(g, OP_select, less, near, far);
    weights.of_b = graph_op3(g, OP_select, less, far, near);
    return weights;
}

/* Weights max(k, min(a, b)) - length(max(k - a, 0), max(k - b, 0)): along the arc, as deep as each
   is. */
static Weights by_arc(Blending *x)
{
    Graph *g    = x->graph;
    Node   zero = graph_number(g, 0), depth[2], weight[2];
    for (int i = 0; i < 2; i++)
        depth[i] = graph_op2(g, OP_max, sub(g, x->width, i ? x->b : x->a), zero);
    Node both = graph_op1(g, OP_length, graph_op(g, OP_vec2, depth));
    both      = not_zero(x->derivation, both);
    Node out  = graph_op2(g, OP_less, x->width, graph_op2(g, OP_min, x->a, x->b));
    for (int i = 0; i < 2; i++)
        weight[i] = graph_op3(g, OP_select, out, x->sharp[i], over(g, depth[i], both));
    return (Weights){weight[0], weight[1]};
}

/* Weights min(a, b, (a + b - k) / sqrt(2)). */
static Weights by_cut(Blending *x)
{
    Graph *g     = x->graph;
    Node   root  = graph_number(g, M_SQRT1_2), weight[2];
    Node   cut   = sub(g, add(g, x->a, x->b), x->width);
    Node   least = graph_op2(g, OP_min, x->a, x->b);
    Node   cuts  = graph_op2(g, OP_less, mul(g, cut, root), least);
    for (int i = 0; i < 2; i++)
        weight[i] = graph_op3(g, OP_select, cuts, root, x->sharp[i]);
    return (Weights){weight[0], weight[1]};
}

/* Weights min(a, b, (b - k + a + |mod(b - k - a + s, 2 s) - s|) / 2), s the width of a step. */
static Weights by_steps(Blending *x)
{
    Graph *g       = x->graph;
    Node   width   = width_above_zero(x);
    Node   steps   = graph_op2(g, OP_max, x->steps, graph_number(g, 1));
    Node   step    = over(g, width, steps);
    Node   level   = sub(g, x->b, width);
    level          = sub(g, level, x->a);
    level          = add(g, level, step);
    Node    within = graph_op2(g, OP_mod, level, add(g, step, step));
    Node    rises  = graph_op2(g, OP_less, step, within);
    Node    stairs = graph_op2(g, OP_less, x->node, graph_op2(g, OP_min, x->a, x->b));
    Node    zero = graph_number(g, 0), one = graph_number(g, 1);
    Node    by_b = graph_op3(g, OP_select, rises, one, zero);
    Node    by_a = graph_op3(g, OP_select, rises, zero, one);
    Weights weights;
    weights.of_a = graph_op3(g, OP_select, stairs, by_a, x->sharp[0]);
    weights.of_b = graph_op3(g, OP_select, stairs, by_b, x->sharp[1]);
    return weights;
}

#define BLEND(name, signature, slope, bulge, most, reach, acts, fades, cost, facts, glsl, value, \
              weights, meaning)                                                                  \
    static Weights weights_of_##name(Blending *x) { return weights; }
#include "compiler/graph/blends.def"

/* Finds the weights of blends whose width is above 0. */
static Weights (*const weights_of[OP_COUNT])(Blending *x) = {
#define BLEND(name, ...) [OP_smin_##name] = weights_of_##name,
#include "compiler/graph/blends.def"
};

/* ---- rules ---- */

static void find_sharp_weights(Blending *x)
{
    Graph *g    = x->graph;
    Node   less = graph_op2(g, OP_less, x->a, x->b), one = graph_number(g, 1);
    Node   zero = graph_number(g, 0);
    x->sharp[0] = graph_op3(g, OP_select, less, one, zero);
    x->sharp[1] = graph_op3(g, OP_select, less, zero, one);
}

Node derive_smin(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    Graph *g = d->graph;
    if (!others_are_constant(g, inner, 2, e->operand_count))
        return NODE_NONE;
    const Node *o = e->operands;
    Blending    x = {d, g, node, o[0], o[1], o[2], e->operand_count > 3 ? o[3] : NODE_NONE, {0}};
    find_sharp_weights(&x);
    Weights smooth    = weights_of[e->op](&x);
    Node    weight[2] = {smooth.of_a, smooth.of_b}, sum[2];
    Node    blends    = graph_op2(g, OP_less, graph_number(g, 0), x.width);
    for (int i = 0; i < 2; i++) {
        weight[i] = graph_op3(g, OP_select, blends, weight[i], x.sharp[i]);
        sum[i]    = mul(g, weight[i], inner[i]);
    }
    return between_jumps(d, add(g, sum[0], sum[1]));
}

/* ---- of several numbers that share the result ---- */

/* The columns `share`, of how far components are below the threshold, in widths from 0 to 1. */
typedef struct Sharing {
    Graph *graph;
    Node   below;
} Sharing;

static Node share_linear(const Sharing *x) { return x->below; }

/* Returns 2 v^2, or 1 - 2 (1 - v)^2 above a half: 1/2 + 2 u - 2 u |u| with u = v - 1/2. */
static Node share_curved(const Sharing *x)
{
    Graph *g      = x->graph;
    Node   middle = sub(g, x->below, graph_number(g, 0.5)), two = graph_number(g, 2);
    Node   bend  = mul(g, middle, graph_op1(g, OP_abs, middle));
    Node   share = mul(g, sub(g, middle, bend), two);
    return add(g, share, graph_number(g, 0.5));
}

#define BLEND_SHARES(name, sharers, share, ...) \
    static Node share_of_##name(const Sharing *x) { return share; }
#include "compiler/graph/blends.def"

static const struct {
    Op threshold;
    Node (*share)(const Sharing *x);
} sharing_of[OP_COUNT] = {
#define BLEND_SHARES(name, ...)                                  \
    [OP_smin4_##name] = {OP_threshold4_##name, share_of_##name}, \
    [OP_smin8_##name] = {OP_threshold8_##name, share_of_##name},
#include "compiler/graph/blends.def"
};

/* Derives shares.  Without a width the least operand, which is at the threshold, has all. */
Node derive_shares(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)node;
    Graph    *g       = d->graph;
    const int vectors = e->operand_count - 1;
    if (!is_zero(g, inner[vectors]))
        return NODE_NONE;
    Node width     = not_zero(d, e->operands[vectors]);
    Node threshold = graph_op(g, sharing_of[e->op].threshold, e->operands);
    Node sum = zero_of(g, TYPE_FLOAT), zero = graph_number(g, 0), one = graph_number(g, 1);
    Node blends = graph_op2(g, OP_less, zero, e->operands[vectors]);
    Node sharp  = graph_op3(g, OP_select, blends, zero, one);
    for (int k = 0; k < vectors; k++) {
        if (is_zero(g, inner[k]))
            continue;
        Node    below = add(g, over(g, sub(g, threshold, e->operands[k]), width), sharp);
        Sharing x     = {g, graph_op3(g, OP_clamp, below, zero, one)};
        sum           = plus(g, sum, graph_op2(g, OP_dot, sharing_of[e->op].share(&x), inner[k]));
    }
    return between_jumps(d, sum);
}

/* Derives clamp(1/2 + (b - a) / 2k, 0, 1). */
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
