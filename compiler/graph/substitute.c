/*
 * substitute.c: copies of expressions with other leaves.
 */
#include <string.h>

#include "compiler/graph/evaluate.h"
#include "compiler/graph/graph.h"

Substitution substitute_point(Node point)
{
    return (Substitution){point, NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE};
}

static Node substitute_leaf(const Expr *e, Node node, Substitution with)
{
    Node other = e->op == OP_POINT      ? with.point
                 : e->op == OP_INSTANCE ? with.instance
                 : e->op == OP_LEVEL    ? with.level
                 : e->op == OP_UV       ? with.uv
                 : e->op == OP_TRAP     ? with.trap
                 : e->op == OP_NORMAL   ? with.normal
                 : e->op == OP_FRONT    ? with.front
                                        : NODE_NONE;
    return other == NODE_NONE ? node : other;
}

/* Returns the node of an operation whose operands were replaced. */
static Node with_operands(Graph *graph, const Expr *e)
{
    graph->here = e->span;
    return graph_like(graph, e, e->operands);
}

static Node substitute_operands(Graph *graph, Expr e, Node node, const Tape *tape,
                                const Node *copies)
{
    bool changed = false;
    for (int i = 0; i < e.operand_count; i++) {
        Node copy     = copies[tape_index(tape, e.operands[i])];
        changed       = changed || copy != e.operands[i];
        e.operands[i] = copy;
    }
    return changed ? with_operands(graph, &e) : node;
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

/*
 * Most expressions are small, and their nodes were made one after the other: what they need is found
 * among the last nodes up to the root, but for a few that many share, such as the coordinates.  What
 * does not depend on the point stays as it is.
 */
enum { WINDOW = 256, WORD = 64, MAX_EARLIER = 16 };

typedef struct Window {
    Node     first; /* the root is among the WINDOW nodes from this one on */
    uint64_t needed[WINDOW / WORD];
    Node     copies[WINDOW];
    Node     earlier[MAX_EARLIER], earlier_copies[MAX_EARLIER]; /* before the window, ascending */
    uint32_t earlier_count;
} Window;

static bool is_needed(const Window *window, uint32_t at)
{
    return window->needed[at / WORD] >> at % WORD & 1;
}

/* Finds where an earlier node is, or belongs. */
static uint32_t earlier_place(const Window *window, Node node)
{
    uint32_t at = 0;
    while (at < window->earlier_count && window->earlier[at] < node)
        at++;
    return at;
}

static bool note_earlier(Window *window, Node node)
{
    const uint32_t at = earlier_place(window, node), count = window->earlier_count;
    if (at < count && window->earlier[at] == node)
        return true;
    if (count == MAX_EARLIER)
        return false;
    memmove(&window->earlier[at + 1], &window->earlier[at], (count - at) * sizeof(Node));
    window->earlier[at] = node;
    window->earlier_count++;
    return true;
}

/* Notes an operation that depends on the point; false: there are too many before the window. */
static bool note_operation(Window *window, const Graph *graph, Node node)
{
    const Expr *e = &graph->items[node];
    if (e->time != TIME_POINT || e->operand_count == 0)
        return true;
    if (node < window->first)
        return note_earlier(window, node);
    window->needed[(node - window->first) / WORD] |= (uint64_t)1 << (node - window->first) % WORD;
    return true;
}

/* Notes the operands of a node; false also where more is needed than operands. */
static bool note_operands(Window *window, const Graph *graph, Node node)
{
    const Expr *e    = &graph->items[node];
    bool        good = e->op != OP_row;
    for (int k = 0; good && k < e->operand_count; k++)
        good = note_operation(window, graph, e->operands[k]);
    return good;
}

/* Finds the operations that the root needs; false: it is no such expression. */
static bool find_operations(Window *window, const Graph *graph, Node root)
{
    bool good = note_operation(window, graph, root);
    for (uint32_t at = root - window->first + 1; good && at-- > 0;)
        if (is_needed(window, at))
            good = note_operands(window, graph, window->first + at);
    /* Operands stand before: what they add is at the same place or at one that is yet to come. */
    for (uint32_t left = window->earlier_count; good && left > 0;) {
        const uint32_t before = window->earlier_count;
        good                  = note_operands(window, graph, window->earlier[left - 1]);
        left += window->earlier_count - before - 1;
    }
    return good;
}

static Node window_copy(const Window *window, const Graph *graph, Node node, Substitution with)
{
    const Expr *e = &graph->items[node];
    if (e->time != TIME_POINT)
        return node;
    if (e->operand_count == 0)
        return substitute_leaf(e, node, with);
    return node < window->first ? window->earlier_copies[earlier_place(window, node)]
                                : window->copies[node - window->first];
}

static Node substitute_operation(Graph *graph, const Window *window, Node node, Substitution with)
{
    Expr e       = graph->items[node];
    bool changed = false;
    for (int k = 0; k < e.operand_count; k++) {
        Node copy     = window_copy(window, graph, e.operands[k], with);
        changed       = changed || copy != e.operands[k];
        e.operands[k] = copy;
    }
    return changed ? with_operands(graph, &e) : node;
}

static Node substitute_in_window(Graph *graph, Window *window, Node root, Substitution with)
{
    Span here = graph->here;
    for (uint32_t i = 0; i < window->earlier_count; i++)
        window->earlier_copies[i] = substitute_operation(graph, window, window->earlier[i], with);
    for (uint32_t at = 0; at <= root - window->first; at++)
        if (is_needed(window, at))
            window->copies[at] = substitute_operation(graph, window, window->first + at, with);
    graph->here = here;
    return window_copy(window, graph, root, with);
}

Node graph_substitute(Graph *graph, Node root, Substitution with, Arena *scratch)
{
    Window window;
    window.first = root < WINDOW ? 0 : root - (WINDOW - 1);
    memset(window.needed, 0, sizeof window.needed);
    window.earlier_count = 0;
    if (find_operations(&window, graph, root))
        return substitute_in_window(graph, &window, root, with);
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
