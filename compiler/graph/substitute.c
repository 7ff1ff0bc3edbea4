/*
 * substitute.c: copies of expressions with other leaves.
 */
#include "compiler/graph/evaluate.h"
#include "compiler/graph/graph.h"

Substitution substitute_point(Node point)
{
    return (Substitution){point, NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE};
}

static Node substitute_leaf(const Expr *e, Node node, Substitution with)
{
    Node other = e->op == OP_POINT      ? with.point
                 : e->op == OP_INSTANCE ? with.instance
                 : e->op == OP_LEVEL    ? with.level
                 : e->op == OP_UV       ? with.uv
                 : e->op == OP_TRAP     ? with.trap
                 : e->op == OP_NORMAL   ? with.normal
                                        : NODE_NONE;
    return other == NODE_NONE ? node : other;
}

/* The graph grows meanwhile, so the expression is handed over as a copy. */
static Node substitute_operands(Graph *graph, Expr e, Node node, const Tape *tape,
                                const Node *copies)
{
    bool changed = false;
    for (int i = 0; i < e.operand_count; i++) {
        Node copy     = copies[tape_index(tape, e.operands[i])];
        changed       = changed || copy != e.operands[i];
        e.operands[i] = copy;
    }
    if (!changed)
        return node;
    graph->here = e.span;
    return e.op == OP_COMPONENT ? graph_component(graph, e.operands[0], e.index)
                                : graph_op(graph, e.op, e.operands);
}

/* Copies what a tape has; copies of leaves are given. */
static void copy_operations(Graph *graph, const Tape *tape, Node *copies)
{
    Span here = graph->here;
    for (size_t i = 0; i < tape->count; i++) {
        Expr e = graph->items[tape->nodes[i]];
        if (e.operand_count)
            copies[i] = substitute_operands(graph, e, tape->nodes[i], tape, copies);
    }
    graph->here = here;
}

Node graph_substitute(Graph *graph, Node root, Substitution with, Arena *scratch)
{
    Tape  tape   = tape_new(graph, &root, 1, scratch);
    Node *copies = arena_new_array(scratch, Node, tape.count);
    for (size_t i = 0; i < tape.count; i++)
        if (graph->items[tape.nodes[i]].operand_count == 0)
            copies[i] = substitute_leaf(&graph->items[tape.nodes[i]], tape.nodes[i], with);
    copy_operations(graph, &tape, copies);
    return copies[tape_index(&tape, root)];
}

Node graph_replace_nodes(Graph *graph, Node root, const Tape *tape, const Node *by, Arena *scratch)
{
    Span  here   = graph->here;
    Node *copies = arena_new_array(scratch, Node, tape->count);
    for (size_t i = 0; i < tape->count; i++) {
        Expr e = graph->items[tape->nodes[i]];
        if (by[i])
            copies[i] = by[i] - 1;
        else if (e.operand_count)
            copies[i] = substitute_operands(graph, e, tape->nodes[i], tape, copies);
        else
            copies[i] = tape->nodes[i];
    }
    graph->here = here;
    return copies[tape_index(tape, root)];
}

Node graph_replace_leaf(Graph *graph, Node root, Node leaf, Node by, Arena *scratch)
{
    Tape  tape   = tape_new(graph, &root, 1, scratch);
    Node *copies = arena_new_array(scratch, Node, tape.count);
    for (size_t i = 0; i < tape.count; i++)
        copies[i] = tape.nodes[i] == leaf ? by : tape.nodes[i];
    copy_operations(graph, &tape, copies);
    return copies[tape_index(&tape, root)];
}
