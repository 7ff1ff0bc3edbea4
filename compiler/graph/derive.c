/*
 * derive.c: derivatives of expressions, as expressions.
 *
 * One loop over the needed nodes, operands first (forward mode): three derivatives a node.  The
 * rules of operations that work component by component are the columns da, db, dc of ops.def,
 * written there for ranges and read here as makers of nodes; the others have theirs below.
 */
#include "compiler/graph/derive.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "compiler/graph/build.h"
#include "compiler/graph/evaluate.h"

typedef struct Derivation {
    Graph      *graph;
    Smoothness  smoothness; /* the least of all so far */
    const bool *held;       /* nodes that are taken for constants, by number; or NULL */
    size_t      held_end;   /* none from this number on */
} Derivation;

/* ---- the functions of the columns da, db, dc, for nodes ---- */

/* A derivative that holds only where nothing jumps or breaks off. */
static Node between_jumps(Derivation *d, Node derivative)
{
    if (d->smoothness > DERIVED_BETWEEN)
        d->smoothness = DERIVED_BETWEEN;
    return derivative;
}

/* 1 where a < b, else 0, component by component. */
static Node is_less(Derivation *d, Node a, Node b)
{
    Graph *g        = d->graph;
    Node   not_less = graph_op2(g, OP_step, b, a);
    Node   one      = graph_number(g, 1);
    return between_jumps(d, sub(g, one, not_less));
}

/* -1/2 a^(-3/2), with r = a^(-1/2). */
static Node inversesqrt_slope(Derivation *d, Node r)
{
    Graph *g    = d->graph;
    Node   cube = mul(g, graph_op1(g, OP_square, r), r);
    return mul(g, graph_number(g, -0.5), cube);
}

/* 1 + sign * a^2 */
static Node one_and_square(Derivation *d, Node a, Op sign)
{
    Graph *g      = d->graph;
    Node   square = graph_op1(g, OP_square, a);
    return graph_op2(g, sign, graph_number(g, 1), square);
}

/* asin and acos take what is beyond 1 for 1: there they do not change. */
static Node asin_slope(Derivation *d, Node a)
{
    Graph *g      = d->graph;
    Node   rest   = one_and_square(d, a, OP_sub);
    Node   inside = is_less(d, graph_number(g, 0), rest);
    Node   safe   = graph_op2(g, OP_max, rest, graph_number(g, 1e-300));
    return mul(g, inside, graph_op1(g, OP_inversesqrt, safe));
}

static Node sech_square(Derivation *d, Node a)
{
    return one_and_square(d, graph_op1(d->graph, OP_tanh, a), OP_sub);
}

static Node pow_slope(Derivation *d, Node a, Node b)
{
    Graph *g    = d->graph;
    Node   less = sub(g, b, graph_number(g, 1));
    return mul(g, b, graph_power(g, a, less));
}

static Node atan2_slope(Derivation *d, Node a, Node b, Node numerator)
{
    Graph *g       = d->graph;
    Node   squares = add(g, graph_op1(g, OP_square, a), graph_op1(g, OP_square, b));
    return over(g, numerator, squares);
}

/* Of h^2 (3 - 2 h), h = (c - a) / (b - a) clamped: by c it is 6 h (1 - h) / (b - a), by the edges
   the same less what they contribute to h. */
static Node smoothstep_slope(Derivation *d, Node a, Node b, Node c, int operand)
{
    Graph *g    = d->graph;
    Node   zero = graph_number(g, 0), one = graph_number(g, 1);
    Node   width    = sub(g, b, a);
    Node   fraction = over(g, sub(g, c, a), width);
    Node   h        = graph_op3(g, OP_clamp, fraction, zero, one);
    Node   rest     = sub(g, one, h);
    Node   slope    = over(g, mul(g, mul(g, h, rest), graph_number(g, 6)), width);
    if (operand == 0)
        slope = neg(g, mul(g, slope, rest));
    else if (operand == 1)
        slope = neg(g, mul(g, slope, h));
    return between_jumps(d, slope);
}

#define ZERO                                     graph_number(d->graph, 0)
#define ONE                                      graph_number(d->graph, 1)
#define TWO                                      graph_number(d->graph, 2)
#define HALF                                     graph_number(d->graph, 0.5)
#define LN2                                      graph_number(d->graph, M_LN2)
#define MINUS_ONE                                graph_number(d->graph, -1)
#define ANYTHING                                 between_jumps(d, ZERO)
#define jumps(steps)                             between_jumps(d, ZERO)
#define unless_jumps(steps, derivative)          between_jumps(d, derivative)
#define range_sign(a)                            between_jumps(d, graph_op1(d->graph, OP_sign, a))
#define range_mul(a, b)                          mul(d->graph, a, b)
#define range_div(a, b)                          over(d->graph, a, b)
#define range_add(a, b)                          add(d->graph, a, b)
#define range_sub(a, b)                          sub(d->graph, a, b)
#define range_neg(a)                             neg(d->graph, a)
#define range_square(a)                          graph_op1(d->graph, OP_square, a)
#define range_sin(a)                             graph_op1(d->graph, OP_sin, a)
#define range_cos(a)                             graph_op1(d->graph, OP_cos, a)
#define range_sinh(a)                            graph_op1(d->graph, OP_sinh, a)
#define range_cosh(a)                            graph_op1(d->graph, OP_cosh, a)
#define range_floor(a)                           graph_op1(d->graph, OP_floor, a)
#define range_abs(a)                             graph_op1(d->graph, OP_abs, a)
#define range_sqrt(a)                            graph_op1(d->graph, OP_sqrt, a)
#define range_exp(a)                             graph_op1(d->graph, OP_exp, a)
#define range_exp2(a)                            graph_op1(d->graph, OP_exp2, a)
#define range_log(a)                             graph_op1(d->graph, OP_log, a)
#define range_log2(a)                            graph_op1(d->graph, OP_log2, a)
#define range_tan(a)                             graph_op1(d->graph, OP_tan, a)
#define range_atan(a)                            graph_op1(d->graph, OP_atan, a)
#define range_tanh(a)                            graph_op1(d->graph, OP_tanh, a)
#define range_min(a, b)                          graph_op2(d->graph, OP_min, a, b)
#define range_max(a, b)                          graph_op2(d->graph, OP_max, a, b)
#define range_above(a, least)                    (a)
#define range_inversesqrt_slope(a, r)            inversesqrt_slope(d, r)
#define range_tan_slope(r)                       one_and_square(d, r, OP_add)
#define range_asin_slope(a)                      asin_slope(d, a)
#define range_sech_square(a)                     sech_square(d, a)
#define range_pow_slope(a, b)                    pow_slope(d, a, b)
#define range_pow_slope_exponent(a, r)           mul(d->graph, r, graph_op1(d->graph, OP_log, a))
#define range_atan2_slope(a, b, numerator)       atan2_slope(d, a, b, numerator)
#define range_is_less(a, b)                      is_less(d, a, b)
#define range_smoothstep_slope(a, b, c, operand) smoothstep_slope(d, a, b, c, operand)

/* The derivative of a row by operand `which`; r is the row's own node. */
typedef Node Partial(Derivation *d, int which, Node a, Node b, Node c, Node r);
#define MAP(name, arity, glsl, value, range, da, db, dc, norm, meaning)                  \
    static Node partial_##name(Derivation *d, int which, Node a, Node b, Node c, Node r) \
    {                                                                                    \
        (void)a, (void)b, (void)c, (void)r;                                              \
        return which == 0 ? (da) : which == 1 ? (db) : (dc);                             \
    }
#include "compiler/graph/ops.def"

static Partial *const partials[OP_COUNT] = {
#define MAP(name, arity, glsl, value, range, da, db, dc, norm, meaning) \
    [OP_##name] = partial_##name,
#include "compiler/graph/ops.def"
};

/* ---- rules ---- */

static bool is_zero(const Graph *graph, Node node)
{
    const Expr *e    = &graph->items[node];
    bool        zero = e->op == OP_CONSTANT;
    for (uint32_t i = 0; zero && e->type <= TYPE_VEC4 && i < (uint32_t)e->type; i++)
        zero = e->number[i] == 0;
    return zero;
}

static Node zero_of(Graph *graph, GraphType type)
{
    static const double zeros[4] = {0};
    return graph_constant(graph, type, zeros);
}

/* What a length is divided by: below it, what is divided is 0. */
static Node not_zero(Derivation *d, Node length)
{
    Graph *g = d->graph;
    return graph_op2(g, OP_max, length, graph_number(g, 1e-30));
}

/* Sum over the operands of the row's derivative times the operand's own. */
static Node derive_by_partials(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    Graph *g = d->graph;
    Node   a = e->operands[0], b = e->operand_count > 1 ? e->operands[1] : a;
    Node   c   = e->operand_count > 2 ? e->operands[2] : a;
    Node   sum = zero_of(g, (GraphType)e->type);
    for (int i = 0; i < e->operand_count; i++) {
        if (is_zero(g, inner[i]))
            continue;
        Node factor = partials[e->op](d, i, a, b, c, node);
        if (is_zero(g, factor))
            continue;
        sum = plus(g, sum, mul(g, factor, inner[i]));
    }
    return sum;
}

/* min and max of numbers choose: 0 times the derivative of what is not chosen need not be 0.  Of two
   that are equal the one that changes is chosen: min(x, 0) joins the inside of a solid to its
   outside. */
static Node derive_choice(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    if (e->type != TYPE_FLOAT)
        return derive_by_partials(d, e, node, inner);
    bool least = e->op == OP_min;
    Op   op    = is_zero(d->graph, inner[1]) ? OP_less_equal : OP_less;
    Node less  = graph_op2(d->graph, op, e->operands[!least], e->operands[least]);
    return between_jumps(d, graph_op3(d->graph, OP_select, less, inner[0], inner[1]));
}

static Node derive_component(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)node;
    return graph_component(d->graph, inner[0], e->index);
}

static Node derive_vector(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)node;
    return graph_op(d->graph, (Op)e->op, inner);
}

/* op(da, b) + op(a, db): what is linear in both of its operands. */
static Node derive_bilinear(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)node;
    Graph *g   = d->graph;
    Op     op  = (Op)e->op;
    Node   sum = zero_of(g, e->type);
    if (!is_zero(g, inner[0]))
        sum = graph_op2(g, op, inner[0], e->operands[1]);
    if (!is_zero(g, inner[1])) {
        Node second = graph_op2(g, op, e->operands[0], inner[1]);
        sum         = plus(g, sum, second);
    }
    return sum;
}

static Node derive_length(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    Graph *g     = d->graph;
    Node   along = graph_op2(g, OP_dot, e->operands[0], inner[0]);
    return over(g, along, not_zero(d, node));
}

/* (a' - n (n.a')) / |a| */
static Node derive_normalize(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    Graph *g      = d->graph;
    Node   along  = graph_op2(g, OP_dot, node, inner[0]);
    Node   radial = graph_op2(g, OP_scale, node, along);
    Node   across = sub(g, inner[0], radial);
    Node   size   = graph_op1(g, OP_length, e->operands[0]);
    size          = not_zero(d, size);
    return graph_op2(g, OP_scale, across, over(g, graph_number(g, 1), size));
}

/* Where only some operands may depend on the point. */
static bool others_are_constant(const Graph *g, const Node *inner, int from, int count)
{
    for (int i = from; i < count; i++)
        if (!is_zero(g, inner[i]))
            return false;
    return true;
}

/* rows a' + rows' a */
static Node derive_turn(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)node;
    Graph *g   = d->graph;
    Node   sum = zero_of(g, TYPE_VEC3), components[3];
    if (!is_zero(g, inner[0]))
        sum = graph_op4(g, OP_turn, inner[0], e->operands[1], e->operands[2], e->operands[3]);
    if (others_are_constant(g, inner, 1, 4))
        return sum;
    for (int i = 0; i < 3; i++)
        components[i] = graph_op2(g, OP_dot, inner[i + 1], e->operands[0]);
    Node turning = graph_op(g, OP_vec3, components);
    return plus(g, sum, turning);
}

/* Folds mirror directions as they mirror points: b the unit normal. */
static Node derive_fold(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)node;
    if (!others_are_constant(d->graph, inner, 1, 3))
        return NODE_NONE;
    Graph *g        = d->graph;
    Node   front    = graph_op3(g, OP_front, e->operands[0], e->operands[1], e->operands[2]);
    Node   along    = graph_op2(g, OP_dot, e->operands[1], inner[0]);
    Node   twice    = mul(g, along, graph_number(g, 2));
    Node   mirrored = sub(g, inner[0], graph_op2(g, OP_scale, e->operands[1], twice));
    return between_jumps(d, graph_op3(g, OP_select, front, mirrored, inner[0]));
}

/* A turn about y by an angle that stays the same within its sector; its sine and cosine are told by
   what it has made of the point. */
static Node derive_cell_polar(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    if (!is_zero(d->graph, inner[1]))
        return NODE_NONE;
    Graph *g = d->graph;
    Node   p[3], r[3], v[3];
    for (uint32_t i = 0; i < 3; i++) {
        p[i] = graph_component(g, e->operands[0], i);
        r[i] = graph_component(g, node, i);
        v[i] = graph_component(g, inner[0], i);
    }
    Node xx = mul(g, p[0], r[0]), zz = mul(g, p[2], r[2]);
    Node zx = mul(g, p[2], r[0]), xz = mul(g, p[0], r[2]);
    Node square = graph_op1(g, OP_square, p[0]), other = graph_op1(g, OP_square, p[2]);
    square      = not_zero(d, add(g, square, other));
    Node cosine = over(g, add(g, xx, zz), square);
    Node sine   = over(g, sub(g, zx, xz), square);
    Node cx = mul(g, cosine, v[0]), sz = mul(g, sine, v[2]);
    Node cz = mul(g, cosine, v[2]), sx = mul(g, sine, v[0]);
    Node x = add(g, cx, sz), z = sub(g, cz, sx);
    return between_jumps(d, graph_op3(g, OP_vec3, x, v[1], z));
}

/* A cell stays the same between its walls. */
static Node derive_cell(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)e, (void)node;
    return others_are_constant(d->graph, inner, 1, 4) ? between_jumps(d, inner[0]) : NODE_NONE;
}

static Node derive_select(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)node;
    return between_jumps(d, graph_op3(d->graph, OP_select, e->operands[0], inner[1], inner[2]));
}

static Node derive_guard(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)node;
    Graph *g         = d->graph;
    Node   limit     = graph_op2(g, OP_min, e->operands[1], e->operands[3]);
    Node   out       = graph_op2(g, OP_less_equal, limit, e->operands[0]);
    Node   least_far = graph_op2(g, OP_min, e->operands[3], graph_number(g, 0));
    least_far        = graph_op2(g, OP_less, least_far, e->operands[0]);
    out              = graph_op2(g, OP_and, out, least_far);
    Node least       = graph_op2(g, OP_less, e->operands[0], e->operands[1]);
    least            = graph_op3(g, OP_select, least, inner[0], inner[1]);
    return between_jumps(d, graph_op3(g, OP_select, out, least, inner[2]));
}

/* ---- blends: weight[0] da + weight[1] db ---- */

/* Of a sharp minimum. */
static void sharp_weights(Derivation *d, Node a, Node b, Node weight[2])
{
    Graph *g    = d->graph;
    Node   less = graph_op2(g, OP_less, a, b), one = graph_number(g, 1), zero = graph_number(g, 0);
    weight[0] = graph_op3(g, OP_select, less, one, zero);
    weight[1] = graph_op3(g, OP_select, less, zero, one);
}

/* Of a blend whose width is above 0; `node` is the blend.  `weight` comes as that of a sharp minimum. */
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

#define BLEND(name)                                                                            \
    static Node derive_smin_##name(Derivation *d, const Expr *e, Node node, const Node *inner) \
    {                                                                                          \
        return derive_blend(d, e, node, inner, name##_weights);                                \
    }
BLEND(quadratic)
BLEND(cubic)
BLEND(exponential)
BLEND(circular)
BLEND(chamfer)
BLEND(stairs)
#undef BLEND

/* clamp(1/2 + (b - a) / 2k, 0, 1) */
static Node derive_blend_weight(Derivation *d, const Expr *e, Node node, const Node *inner)
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

/* ---- any node ---- */

/* There is no formula. */
static Node derive_none(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)d, (void)e, (void)node, (void)inner;
    return NODE_NONE;
}

/* The derivative of a node from those of its operands, `inner`; NODE_NONE: there is none. */
static Node (*const rules[OP_COUNT])(Derivation *d, const Expr *e, Node node, const Node *inner) = {
#define RULES(name, cost, promises, simplify, derive, ...) [OP_##name] = derive,
#include "compiler/graph/ops.def"
};

/* A truth value may change where no number does. */
static bool has_condition(const Graph *g, const Expr *e)
{
    for (int i = 0; i < e->operand_count; i++)
        if (g->items[e->operands[i]].type == TYPE_BOOL)
            return true;
    return false;
}

static Node derive_node(Derivation *d, Node node, const Node *inner)
{
    Expr e = d->graph->items[node];
    if (others_are_constant(d->graph, inner, 0, e.operand_count) && !has_condition(d->graph, &e))
        return zero_of(d->graph, (GraphType)e.type);
    return rules[e.op](d, &e, node, inner);
}

/* The derivatives along one axis of all nodes on the tape; NODE_NONE: reached one without. */
static Node derive_along(Derivation *d, const Tape *tape, int axis, Node *made, Node *blame)
{
    Graph *g = d->graph;
    for (size_t i = 0; i < tape->count; i++) {
        Node node = tape->nodes[i];
        Expr e    = g->items[node];
        Node inner[MAX_OPERANDS];
        g->here = e.span;
        if (e.type > TYPE_VEC4)
            made[i] = zero_of(g, TYPE_FLOAT); /* conditions: between them nothing changes */
        else if (d->held && node < d->held_end && d->held[node])
            made[i] = zero_of(g, e.type);
        else if (e.op == OP_POINT)
            made[i] = graph_vec3(g, axis == 0, axis == 1, axis == 2);
        else if (e.time != TIME_POINT)
            made[i] = zero_of(g, e.type);
        else {
            for (int k = 0; k < e.operand_count; k++)
                inner[k] = made[tape_index(tape, e.operands[k])];
            made[i] = e.operand_count ? derive_node(d, node, inner) : NODE_NONE;
        }
        if (made[i] == NODE_NONE) {
            *blame = node;
            return NODE_NONE;
        }
    }
    return made[tape->count - 1];
}

static Smoothness derive(Derivation *d, Node root, Node partial[3], Node *blame, Arena *scratch)
{
    Graph *graph   = d->graph;
    Span   here    = graph->here;
    Node   culprit = NODE_NONE;
    Tape   tape    = tape_new(graph, &root, 1, scratch);
    assert(graph->items[root].type <= TYPE_VEC4);
    /* The root's place: frame-time nodes come first on a tape, so it need not be the last. */
    size_t index = tape_index(&tape, root);
    Node  *made  = arena_new_array(scratch, Node, tape.count);
    for (int axis = 0; axis < 3; axis++) {
        if (derive_along(d, &tape, axis, made, &culprit) == NODE_NONE) {
            graph->here = here;
            if (blame)
                *blame = culprit;
            return DERIVED_NOT;
        }
        partial[axis] = made[index];
    }
    graph->here = here;
    return d->smoothness;
}

Smoothness graph_derive(Graph *graph, Node root, Node partial[3], Node *blame, Arena *scratch)
{
    Derivation d = {.graph = graph, .smoothness = DERIVED_SMOOTH};
    return derive(&d, root, partial, blame, scratch);
}

Smoothness graph_gradient(Graph *graph, Node root, Node *gradient, Node *blame, Arena *scratch)
{
    return graph_gradient_of(graph, root, NULL, 0, gradient, blame, scratch);
}

Smoothness graph_gradient_of(Graph *graph, Node root, const Node *held, size_t held_count,
                             Node *gradient, Node *blame, Arena *scratch)
{
    Node       partial[3];
    bool      *marks = held_count ? arena_new_array(scratch, bool, graph->count) : NULL;
    Derivation d     = {graph, DERIVED_SMOOTH, marks, graph->count};
    for (size_t i = 0; i < held_count; i++)
        marks[held[i]] = true;
    Smoothness smoothness = derive(&d, root, partial, blame, scratch);
    if (smoothness != DERIVED_NOT)
        *gradient = graph_op(graph, OP_vec3, partial);
    return smoothness;
}
