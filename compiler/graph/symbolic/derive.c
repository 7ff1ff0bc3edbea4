/*
 * derive.c: derivatives of expressions, as expressions.
 *
 * One loop over the needed nodes, operands first (forward mode): three derivatives a node.  The
 * rules are in derive_rules.c and derive_blends.c.
 */
#include "compiler/graph/symbolic/derive.h"

#include <assert.h>

#include "compiler/graph/evaluate.h"
#include "compiler/graph/symbolic/derive_rules.h"

static DeriveRule *const rules[OP_COUNT] = {
#define RULES(name, cost, traits, simplify, derive, ...) [OP_##name] = derive,
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

/* Returns the derivatives along one axis of all nodes on the tape; NODE_NONE: reached one without. */
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
        else if (e.op == OP_POINT || (d->partly && e.op == OP_INSTANCE_POINT))
            made[i] = graph_vec3(g, axis == 0, axis == 1, axis == 2);
        else if (e.time != TIME_POINT)
            made[i] = zero_of(g, e.type);
        else {
            for (int k = 0; k < e.operand_count; k++)
                inner[k] = made[tape_index(tape, e.operands[k])];
            made[i] = e.operand_count ? derive_node(d, node, inner) : NODE_NONE;
        }
        if (made[i] == NODE_NONE && d->partly)
            made[i] = zero_of(g, e.type);
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
    return d->breaks ? DERIVED_BETWEEN : DERIVED_SMOOTH;
}

Smoothness graph_derive(Graph *graph, Node root, Node partial[3], Node *blame, Arena *scratch)
{
    Derivation d = {.graph = graph};
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
    Derivation d     = {.graph = graph, .held = marks, .held_end = graph->count};
    for (size_t i = 0; i < held_count; i++)
        marks[held[i]] = true;
    Smoothness smoothness = derive(&d, root, partial, blame, scratch);
    if (smoothness != DERIVED_NOT)
        *gradient = graph_op(graph, OP_vec3, partial);
    return smoothness;
}

Node graph_known_gradient(Graph *graph, Node root, Arena *scratch)
{
    Node       partial[3];
    Derivation d = {.graph = graph, .partly = true};
    derive(&d, root, partial, NULL, scratch);
    return graph_op(graph, OP_vec3, partial);
}
