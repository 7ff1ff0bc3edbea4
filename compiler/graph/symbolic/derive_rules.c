/*
 * derive_rules.c: the rules by which operations are derived, but for blends.
 *
 * Those of operations that work component by component are the columns da, db, dc of ops.def,
 * written there for ranges and read here as makers of nodes; the others follow.
 */
#include "compiler/graph/symbolic/derive_rules.h"

#include <math.h>

#include "compiler/graph/build.h"

/* ---- the functions of the columns da, db, dc, for nodes ---- */

Node between_jumps(Derivation *d, Node derivative)
{
    d->breaks = true;
    return derivative;
}

/* Returns 1 where a < b, else 0, component by component. */
static Node is_less(Derivation *d, Node a, Node b)
{
    Graph *g        = d->graph;
    Node   not_less = graph_op2(g, OP_step, b, a);
    Node   one      = graph_number(g, 1);
    return between_jumps(d, sub(g, one, not_less));
}

/* Keeps an operand that is made, until the one before it is made, too. */
static void keep(Derivation *d, Node operand) { d->kept[d->kept_count++] = operand; }

static Node join(Derivation *d, Op op, Node operand)
{
    return graph_op2(d->graph, op, operand, d->kept[--d->kept_count]);
}

/* Returns -1/2 a^(-3/2), with r = a^(-1/2). */
static Node inversesqrt_slope(Derivation *d, Node r)
{
    Graph *g    = d->graph;
    Node   cube = mul(g, graph_op1(g, OP_square, r), r);
    return mul(g, graph_number(g, -0.5), cube);
}

/* Returns 1 + sign * a^2. */
static Node one_and_square(Derivation *d, Node a, Op sign)
{
    Graph *g      = d->graph;
    Node   square = graph_op1(g, OP_square, a);
    return graph_op2(g, sign, graph_number(g, 1), square);
}

/* Returns the derivative of asin, which like acos takes what is beyond 1 for 1: there they do not
   change. */
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
    Node   along   = graph_op1(g, OP_square, b);
    Node   squares = add(g, graph_op1(g, OP_square, a), along);
    return over(g, numerator, squares);
}

/* Derives h^2 (3 - 2 h), h = (c - a) / (b - a) clamped: by c it is 6 h (1 - h) / (b - a), by the edges the same
   less what they contribute to h. */
static Node smoothstep_slope(Derivation *d, Node a, Node b, Node c, int operand)
{
    Graph *g    = d->graph;
    Node   zero = graph_number(g, 0), one = graph_number(g, 1);
    Node   width    = sub(g, b, a);
    Node   fraction = over(g, sub(g, c, a), width);
    Node   h        = graph_op3(g, OP_clamp, fraction, zero, one);
    Node   rest     = sub(g, one, h);
    Node   six      = graph_number(g, 6);
    Node   slope    = over(g, mul(g, mul(g, h, rest), six), width);
    if (operand == 0)
        slope = neg(g, mul(g, slope, rest));
    else if (operand == 1)
        slope = neg(g, mul(g, slope, h));
    return between_jumps(d, slope);
}

#define ZERO                            graph_number(d->graph, 0)
#define ONE                             graph_number(d->graph, 1)
#define TWO                             graph_number(d->graph, 2)
#define HALF                            graph_number(d->graph, 0.5)
#define LN2                             graph_number(d->graph, M_LN2)
#define MINUS_ONE                       graph_number(d->graph, -1)
#define ANYTHING                        between_jumps(d, ZERO)
#define jumps(steps)                    between_jumps(d, ZERO)
#define unless_jumps(steps, derivative) between_jumps(d, derivative)
#define range_sign(a)                   between_jumps(d, graph_op1(d->graph, OP_sign, a))
/* C does not say which operand is made first, and the text of a scene shows it: the last one is. */
#define LAST_FIRST(op, a, b)                     (keep(d, b), join(d, op, a))
#define range_mul(a, b)                          LAST_FIRST(OP_mul, a, b)
#define range_div(a, b)                          LAST_FIRST(OP_div, a, b)
#define range_add(a, b)                          LAST_FIRST(OP_add, a, b)
#define range_sub(a, b)                          LAST_FIRST(OP_sub, a, b)
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
#define range_min(a, b)                          LAST_FIRST(OP_min, a, b)
#define range_max(a, b)                          LAST_FIRST(OP_max, a, b)
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
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning)          \
    static Node partial_##name(Derivation *d, int which, Node a, Node b, Node c, Node r) \
    {                                                                                    \
        (void)a, (void)b, (void)c, (void)r;                                              \
        return which == 0 ? (da) : which == 1 ? (db) : (dc);                             \
    }
#include "compiler/graph/ops.def"

static Partial *const partials[OP_COUNT] = {
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning) \
    [OP_##name] = partial_##name,
#include "compiler/graph/ops.def"
};

/* ---- rules ---- */

/* Refuses an operation without a formula. */
Node derive_none(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)d, (void)e, (void)node, (void)inner;
    return NODE_NONE;
}

bool is_zero(const Graph *graph, Node node)
{
    const Expr *e    = &graph->items[node];
    bool        zero = e->op == OP_CONSTANT;
    for (uint32_t i = 0; zero && e->type <= TYPE_VEC4 && i < (uint32_t)e->type; i++)
        zero = e->number[i] == 0;
    return zero;
}

Node zero_of(Graph *graph, GraphType type)
{
    static const double zeros[4] = {0};
    return graph_constant(graph, type, zeros);
}

Node not_zero(Derivation *d, Node length)
{
    Graph *g = d->graph;
    return graph_op2(g, OP_max, length, graph_number(g, 1e-30));
}

/* Derives by the sum over the operands of the row's derivative times the operand's own. */
Node derive_by_partials(Derivation *d, const Expr *e, Node node, const Node *inner)
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

/* Derives min and max of numbers, which choose: 0 times the derivative of what is not chosen need
   not be 0.  Of two that are equal the one that changes is chosen: min(x, 0) joins the inside of a
   solid to its outside. */
Node derive_choice(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    if (e->type != TYPE_FLOAT)
        return derive_by_partials(d, e, node, inner);
    bool least = e->op == OP_min;
    Op   op    = is_zero(d->graph, inner[1]) ? OP_less_equal : OP_less;
    Node less  = graph_op2(d->graph, op, e->operands[!least], e->operands[least]);
    return between_jumps(d, graph_op3(d->graph, OP_select, less, inner[0], inner[1]));
}

Node derive_component(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)node;
    return graph_component(d->graph, inner[0], e->index);
}

Node derive_vector(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)node;
    return graph_op(d->graph, (Op)e->op, inner);
}

/* Derives what is linear in both of its operands: op(da, b) + op(a, db). */
Node derive_bilinear(Derivation *d, const Expr *e, Node node, const Node *inner)
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

Node derive_length(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    Graph *g     = d->graph;
    Node   along = graph_op2(g, OP_dot, e->operands[0], inner[0]);
    return over(g, along, not_zero(d, node));
}

/* Derives normalize: (a' - n (n.a')) / |a|. */
Node derive_normalize(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    Graph *g      = d->graph;
    Node   along  = graph_op2(g, OP_dot, node, inner[0]);
    Node   radial = graph_op2(g, OP_scale, node, along);
    Node   across = sub(g, inner[0], radial);
    Node   size   = graph_op1(g, OP_length, e->operands[0]);
    size          = not_zero(d, size);
    return graph_op2(g, OP_scale, across, over(g, graph_number(g, 1), size));
}

bool others_are_constant(const Graph *g, const Node *inner, int from, int count)
{
    for (int i = from; i < count; i++)
        if (!is_zero(g, inner[i]))
            return false;
    return true;
}

/* Derives a rotation: rows a' + rows' a. */
Node derive_rotate(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)node;
    Graph *g   = d->graph;
    Node   sum = zero_of(g, TYPE_VEC3), components[3];
    if (!is_zero(g, inner[0]))
        sum = graph_op4(g, OP_rotate, inner[0], e->operands[1], e->operands[2], e->operands[3]);
    if (others_are_constant(g, inner, 1, 4))
        return sum;
    for (int i = 0; i < 3; i++)
        components[i] = graph_op2(g, OP_dot, inner[i + 1], e->operands[0]);
    Node turning = graph_op(g, OP_vec3, components);
    return plus(g, sum, turning);
}

/* Folds mirror directions as they mirror points: b the unit normal. */
Node derive_fold(Derivation *d, const Expr *e, Node node, const Node *inner)
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

/* Returns a rotation about y by an angle that stays the same within its sector; its sine and cosine
   are told by what it has made of the point. */
Node derive_cell_polar(Derivation *d, const Expr *e, Node node, const Node *inner)
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
Node derive_cell(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)e, (void)node;
    return others_are_constant(d->graph, inner, 1, 4) ? between_jumps(d, inner[0]) : NODE_NONE;
}

Node derive_select(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)node;
    return between_jumps(d, graph_op3(d->graph, OP_select, e->operands[0], inner[1], inner[2]));
}

Node derive_guard(Derivation *d, const Expr *e, Node node, const Node *inner)
{
    (void)node;
    Graph *g       = d->graph;
    Node   limit   = graph_op2(g, OP_min, e->operands[1], e->operands[3]);
    Node   out     = graph_op2(g, OP_less_equal, limit, e->operands[0]);
    Node   min_far = graph_op2(g, OP_min, e->operands[3], graph_number(g, 0));
    min_far        = graph_op2(g, OP_less, min_far, e->operands[0]);
    out            = graph_op2(g, OP_and, out, min_far);
    Node least     = graph_op2(g, OP_less, e->operands[0], e->operands[1]);
    least          = graph_op3(g, OP_select, least, inner[0], inner[1]);
    return between_jumps(d, graph_op3(g, OP_select, out, least, inner[2]));
}
