/*
 * simplify.c: algebra that makes a graph smaller without changing values.
 *
 * Nodes are rebuilt in order into a new graph, each by the first rule of its operation that
 * fits, so that rules see operands that are simple already.  A second copy then leaves out what
 * no root needs any more.  Rules keep values exactly, but for the sign of zero and, where
 * constants are gathered, the last digit.
 */
#include "compiler/graph/rewrite/simplify.h"

#include <math.h>
#include <stdlib.h>

#include "compiler/graph/instance_table.h"
#include "compiler/graph/evaluate.h"

typedef struct Simplifier {
    const Graph *old;
    Graph       *graph;  /* what is built */
    Node        *nodes;  /* by node of old: the one of graph */
    bool        *finite; /* by node of old: never infinite or not a number, but by overflow */
} Simplifier;

/* A node about to be rebuilt: its operands in the new graph. */
typedef struct Rewrite {
    Graph    *graph;
    Op        op;
    GraphType type;
    uint32_t  index;
    Node      o[MAX_OPERANDS];
    bool      finite[MAX_OPERANDS]; /* of each operand */
} Rewrite;

/* ---- what rules ask about ---- */

static const Expr *expr(const Rewrite *s, Node node) { return &s->graph->items[node]; }
static bool        is(const Rewrite *s, Node node, Op op) { return expr(s, node)->op == op; }
static bool        constant(const Rewrite *s, Node node) { return is(s, node, OP_CONSTANT); }

/* Tells whether a node is the constant with all components equal to this number. */
static bool equals(const Rewrite *s, Node node, double number)
{
    const Expr *e = expr(s, node);
    for (uint32_t i = 0; e->op == OP_CONSTANT && i < components(e->type); i++)
        if (e->number[i] != number)
            return false;
    return e->op == OP_CONSTANT;
}

static Node operand(const Rewrite *s, Node node, int i) { return expr(s, node)->operands[i]; }

static Node zero(const Rewrite *s)
{
    static const double zeros[4] = {0};
    return graph_constant(s->graph, s->type, zeros);
}

static Node op2(const Rewrite *s, Op op, Node a, Node b) { return graph_op2(s->graph, op, a, b); }

/* Returns the constant that `op` makes of two, or NODE_NONE where it is not finite or the digits of
   a subnormal would be lost. */
static Node gathered(const Rewrite *s, Op op, Node a, Node b)
{
    Node node = op2(s, op, a, b);
    if (!constant(s, node))
        return NODE_NONE;
    for (uint32_t i = 0; i < components(s->type); i++)
        if (expr(s, node)->number[i] != 0 && !isnormal(expr(s, node)->number[i]))
            return NODE_NONE;
    return node;
}

/* Makes x `op` (c `join` d) of (x `op` c) ... d, where the constants gather. */
static Node gather(const Rewrite *s, Op op, Node x, Op join, Node c, Node d)
{
    Node both = gathered(s, join, c, d);
    return both == NODE_NONE ? NODE_NONE : op2(s, op, x, both);
}

/* ---- rules: each gives the node to use instead, or NODE_NONE ---- */

#define RULE(condition, result) \
    if (condition)              \
    return (result)

/* Orders operands of operations that may take them in either order: the older comes first, a constant last. */
static void order_operands(Rewrite *s)
{
    bool swap = constant(s, s->o[0]) ? !constant(s, s->o[1])
                                     : !constant(s, s->o[1]) && s->o[1] < s->o[0];
    if (swap) {
        Node first   = s->o[0];
        bool finite  = s->finite[0];
        s->o[0]      = s->o[1];
        s->finite[0] = s->finite[1];
        s->o[1]      = first;
        s->finite[1] = finite;
    }
}

static Node simplify_add(const Rewrite *s)
{
    Node a = s->o[0], b = s->o[1];
    RULE(equals(s, b, 0), a);
    RULE(is(s, b, OP_neg), op2(s, OP_sub, a, operand(s, b, 0)));
    RULE(is(s, a, OP_neg), op2(s, OP_sub, b, operand(s, a, 0)));
    bool chain = constant(s, b) && expr(s, a)->operand_count == 2;
    RULE(chain && is(s, a, OP_add) && constant(s, operand(s, a, 1)),
         gather(s, OP_add, operand(s, a, 0), OP_add, operand(s, a, 1), b));
    RULE(chain && is(s, a, OP_sub) && constant(s, operand(s, a, 1)),
         gather(s, OP_add, operand(s, a, 0), OP_sub, b, operand(s, a, 1)));
    return NODE_NONE;
}

static Node simplify_sub(const Rewrite *s)
{
    Node a = s->o[0], b = s->o[1];
    RULE(equals(s, b, 0), a);
    RULE(equals(s, a, 0), graph_op1(s->graph, OP_neg, b));
    RULE(a == b && s->finite[0], zero(s));
    RULE(is(s, b, OP_neg), op2(s, OP_add, a, operand(s, b, 0)));
    bool chain = constant(s, b) && expr(s, a)->operand_count == 2;
    RULE(chain && is(s, a, OP_add) && constant(s, operand(s, a, 1)),
         gather(s, OP_sub, operand(s, a, 0), OP_sub, b, operand(s, a, 1)));
    RULE(chain && is(s, a, OP_sub) && constant(s, operand(s, a, 1)),
         gather(s, OP_sub, operand(s, a, 0), OP_add, operand(s, a, 1), b));
    return NODE_NONE;
}

static Node simplify_mul(const Rewrite *s)
{
    Node a = s->o[0], b = s->o[1];
    RULE(equals(s, b, 1), a);
    RULE(equals(s, b, -1), graph_op1(s->graph, OP_neg, a));
    RULE(equals(s, b, 0) && s->finite[0] && s->finite[1], zero(s));
    RULE(a == b, graph_op1(s->graph, OP_square, a));
    RULE(is(s, a, OP_neg) && is(s, b, OP_neg), op2(s, OP_mul, operand(s, a, 0), operand(s, b, 0)));
    RULE(constant(s, b) && is(s, a, OP_mul) && constant(s, operand(s, a, 1)),
         gather(s, OP_mul, operand(s, a, 0), OP_mul, operand(s, a, 1), b));
    return NODE_NONE;
}

/* Divisions cost more than products, and no driver may make one of the other. */
static Node simplify_div(const Rewrite *s)
{
    Node a = s->o[0], b = s->o[1];
    RULE(equals(s, b, 1), a);
    if (!constant(s, b) || equals(s, b, 0))
        return NODE_NONE;
    Node reciprocal = gathered(s, OP_div, graph_number(s->graph, 1), b);
    return reciprocal == NODE_NONE ? NODE_NONE : op2(s, OP_mul, a, reciprocal);
}

static Node simplify_neg(const Rewrite *s)
{
    Node a = s->o[0];
    RULE(is(s, a, OP_neg), operand(s, a, 0));
    RULE(is(s, a, OP_sub), op2(s, OP_sub, operand(s, a, 1), operand(s, a, 0)));
    return NODE_NONE;
}

static Node simplify_abs(const Rewrite *s)
{
    Node a = s->o[0];
    RULE(is(s, a, OP_abs) || is(s, a, OP_square) || is(s, a, OP_length), a);
    RULE(is(s, a, OP_neg), graph_op1(s->graph, OP_abs, operand(s, a, 0)));
    return NODE_NONE;
}

static Node simplify_square(const Rewrite *s)
{
    Node a = s->o[0];
    RULE(is(s, a, OP_abs) || is(s, a, OP_neg), graph_op1(s->graph, OP_square, operand(s, a, 0)));
    return NODE_NONE;
}

/* Tells whether a sum has only squares as terms, at most 4; what is squared goes to `roots`, the oldest
   first, as they are when they are the components of one vector. */
static bool sum_of_squares(const Rewrite *s, Node sum, Node *roots, uint32_t *count)
{
    if (is(s, sum, OP_add))
        return sum_of_squares(s, operand(s, sum, 0), roots, count) &&
               sum_of_squares(s, operand(s, sum, 1), roots, count);
    if (!is(s, sum, OP_square) || *count == 4)
        return false;
    Node     root = operand(s, sum, 0);
    uint32_t i    = (*count)++;
    for (; i > 0 && roots[i - 1] > root; i--)
        roots[i] = roots[i - 1];
    roots[i] = root;
    return true;
}

/* The slope of a root of squares is unbounded to whoever does not see that it is a length. */
static Node simplify_sqrt(const Rewrite *s)
{
    static const Op vectors[] = {OP_vec2, OP_vec3, OP_vec4};
    Node            a         = s->o[0], roots[4];
    uint32_t        count     = 0;
    RULE(is(s, a, OP_square), graph_op1(s->graph, OP_abs, operand(s, a, 0)));
    RULE(is(s, a, OP_dot) && operand(s, a, 0) == operand(s, a, 1),
         graph_op1(s->graph, OP_length, operand(s, a, 0)));
    if (s->type != TYPE_FLOAT || !sum_of_squares(s, a, roots, &count) || count < 2)
        return NODE_NONE;
    Node vector = graph_op(s->graph, vectors[count - 2], roots);
    return graph_op1(s->graph, OP_length, vector);
}

static Node simplify_pow(const Rewrite *s)
{
    Node power = graph_power(s->graph, s->o[0], s->o[1]);
    return is(s, power, OP_pow) ? NODE_NONE : power;
}

static Node simplify_extremum(const Rewrite *s)
{
    RULE(s->o[0] == s->o[1], s->o[0]);
    return NODE_NONE;
}

/* Simplifies a ramp: from constant to constant by k x + b it is a constant times x and another. */
static Node simplify_ramp(const Rewrite *s)
{
    Node from = s->o[0], x = s->o[2];
    Node span = op2(s, OP_sub, s->o[1], from), steep = span;
    if (is(s, x, OP_add) && constant(s, operand(s, x, 1))) {
        from = op2(s, OP_add, from, op2(s, OP_mul, span, operand(s, x, 1)));
        x    = operand(s, x, 0);
    }
    if (is(s, x, OP_mul) && constant(s, operand(s, x, 1))) {
        steep = gathered(s, OP_mul, span, operand(s, x, 1));
        x     = operand(s, x, 0);
    }
    if (steep == NODE_NONE || !constant(s, from))
        return NODE_NONE;
    return op2(s, OP_add, op2(s, OP_mul, x, steep), from);
}

static Node simplify_mix(const Rewrite *s)
{
    RULE(equals(s, s->o[2], 0) && s->finite[1], s->o[0]);
    RULE(equals(s, s->o[2], 1) && s->finite[0], s->o[1]);
    if (s->type == TYPE_FLOAT && constant(s, s->o[0]) && constant(s, s->o[1]) && s->finite[0] &&
        s->finite[1])
        return simplify_ramp(s);
    return NODE_NONE;
}

static Node simplify_scale(const Rewrite *s)
{
    RULE(equals(s, s->o[1], 1), s->o[0]);
    RULE(equals(s, s->o[1], -1), graph_op1(s->graph, OP_neg, s->o[0]));
    RULE(equals(s, s->o[1], 0) && s->finite[0], zero(s));
    return NODE_NONE;
}

static Node simplify_component(const Rewrite *s)
{
    Node a = s->o[0];
    if (!op_has_traits(expr(s, a)->op, BUILDS))
        return NODE_NONE;
    return operand(s, a, expr(s, a)->operand_count > 1 ? (int)s->index : 0);
}

/* Simplifies a vector: [v.x, v.y, v.z] is v, and [x, x, x] a splat. */
static Node simplify_vector(const Rewrite *s)
{
    static const Op splats[] = {OP_splat2, OP_splat3, OP_splat4};
    uint32_t        size     = s->type;
    Node            first    = s->o[0];
    bool            equal = true, whole = is(s, first, OP_COMPONENT);
    for (uint32_t i = 0; i < size; i++) {
        equal = equal && s->o[i] == first;
        whole = whole && is(s, s->o[i], OP_COMPONENT) && expr(s, s->o[i])->index == i &&
                operand(s, s->o[i], 0) == operand(s, first, 0);
    }
    RULE(whole && expr(s, operand(s, first, 0))->type == s->type, operand(s, first, 0));
    RULE(equal, graph_op1(s->graph, splats[size - 2], first));
    return NODE_NONE;
}

static Node simplify_logic(const Rewrite *s)
{
    Node a = s->o[0], b = s->o[1];
    RULE(a == b, a);
    RULE(constant(s, b), (expr(s, b)->number[0] != 0) == (s->op == OP_and) ? a : b);
    return NODE_NONE;
}

static Node simplify_not(const Rewrite *s)
{
    RULE(is(s, s->o[0], OP_not), operand(s, s->o[0], 0));
    return NODE_NONE;
}

static Node simplify_select(const Rewrite *s)
{
    Node condition = s->o[0], yes = s->o[1], no = s->o[2];
    RULE(yes == no, yes);
    RULE(constant(s, condition), expr(s, condition)->number[0] != 0 ? yes : no);
    RULE(is(s, condition, OP_not),
         graph_op3(s->graph, OP_select, operand(s, condition, 0), no, yes));
    return NODE_NONE;
}

static Node simplify_rotate(const Rewrite *s)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const Expr *row = expr(s, s->o[i + 1]);
            if (row->op != OP_CONSTANT || row->number[j] != (i == j))
                return NODE_NONE;
        }
    return s->o[0];
}

static Node simplify_cell(const Rewrite *s)
{
    RULE(equals(s, s->o[1], 0), s->o[0]);
    return NODE_NONE;
}

static Node simplify_smin(const Rewrite *s)
{
    RULE(equals(s, s->o[2], 0), op2(s, OP_min, s->o[0], s->o[1]));
    return NODE_NONE;
}

/* Simplifies a footprint to 0: when materials have been lowered, the rest is of distances. */
static Node simplify_footprint(const Rewrite *s) { return zero(s); }

/* Keeps a node without a rule. */
static Node simplify_none(const Rewrite *s)
{
    (void)s;
    return NODE_NONE;
}

static Node (*const rules[OP_COUNT])(const Rewrite *s) = {
#define RULES(name, cost, traits, simplify, ...) [OP_##name] = simplify,
#include "compiler/graph/ops.def"
};

static Node simplify_by_rule(Rewrite *s)
{
    if (op_has_traits(s->op, COMMUTES))
        order_operands(s);
    return rules[s->op](s);
}

/* ---- the pass ---- */

static bool node_stays_finite(const Simplifier *simplifier, const Expr *e)
{
    bool finite = e->operand_count == 0 || op_has_traits(e->op, STAYS_FINITE);
    for (int i = 0; i < 4 && e->op == OP_CONSTANT; i++)
        finite = finite && isfinite(e->number[i]);
    for (int i = 0; i < e->operand_count; i++)
        finite = finite && simplifier->finite[e->operands[i]];
    return finite;
}

static Node rebuild(Simplifier *simplifier, const Expr *e, bool with_rules)
{
    Graph *graph = simplifier->graph;
    graph->here  = e->span;
    if (e->operand_count == 0)
        return graph_copy_leaf(graph, e);
    Rewrite step = {.graph = graph, .op = e->op, .type = e->type, .index = e->index};
    for (int i = 0; i < e->operand_count; i++) {
        step.o[i]      = simplifier->nodes[e->operands[i]];
        step.finite[i] = simplifier->finite[e->operands[i]];
    }
    Node node = with_rules ? simplify_by_rule(&step) : NODE_NONE;
    return node != NODE_NONE ? node : graph_like(graph, e, step.o);
}

/* Copies what the roots need of `old`, by the rules or as it is, into a new graph. */
static Graph *rebuild_all(const Graph *old, Node *roots, size_t root_count, bool with_rules,
                          Arena *arena)
{
    Tape       tape       = tape_new(old, roots, root_count, arena);
    Simplifier simplifier = {.old = old, .graph = graph_new(arena)};
    bool      *needed     = arena_new_array(arena, bool, old->count + 1);
    simplifier.nodes      = arena_new_array(arena, Node, old->count + 1);
    simplifier.finite     = arena_new_array(arena, bool, old->count + 1);
    for (size_t i = 0; i < tape.count; i++)
        needed[tape.nodes[i]] = true;
    for (Node node = 0; node < old->count; node++)
        if (needed[node]) {
            const Expr *e           = &old->items[node];
            simplifier.finite[node] = node_stays_finite(&simplifier, e);
            simplifier.nodes[node]  = rebuild(&simplifier, e, with_rules);
        }
    for (size_t i = 0; i < root_count; i++)
        roots[i] = simplifier.nodes[roots[i]];
    simplifier.graph->parameters.count = 0;
    for (size_t i = 0; i < old->parameters.count; i++)
        array_push(arena, &simplifier.graph->parameters, old->parameters.items[i]);
    simplifier.graph->here = (Span){0};
    return simplifier.graph;
}

/* Tells whether the roots need so little of a graph that arrays of its size would cost more than a copy
   of what they need. */
static bool is_small_part(const Graph *graph, const Node *roots, size_t root_count, Arena *arena)
{
    return tape_new(graph, roots, root_count, arena).count < graph->count / 8;
}

/* Simplifies again while it helps: what one rule makes may fit another. */
static Graph *simplify_all(const Graph *graph, Node *roots, size_t root_count, Arena *arena)
{
    if (is_small_part(graph, roots, root_count, arena))
        graph = graph_extract(graph, roots, root_count, arena);
    for (size_t before = SIZE_MAX;;) {
        Graph *simple = rebuild_all(graph, roots, root_count, true, arena);
        Graph *copy   = rebuild_all(simple, roots, root_count, false, arena);
        if (copy->count >= before)
            return copy;
        before = copy->count;
        graph  = copy;
    }
}

Graph *graph_simplify(const Graph *graph, Node *roots, size_t root_count, Arena *arena)
{
    size_t all_count;
    Node  *all    = roots_with_bodies(graph, roots, root_count, &all_count, arena);
    Graph *simple = simplify_all(graph, all, all_count, arena);
    hand_on_instances(simple, graph, all, roots, root_count);
    return simple;
}
