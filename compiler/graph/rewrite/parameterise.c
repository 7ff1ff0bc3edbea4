/*
 * parameterise.c: constants that change with the numbers of a scene leave the text of its shaders.
 *
 * Numbers that the author wrote are OP_PARAMETERISED from the beginning, so that no rule looks at them.
 * What the compiler derives from them, such as the corners of boxes, is found here: it is a
 * constant like those of formulas.  The latter are mostly 0, 1, 2 and one half, which stay, since
 * literals cost nothing.
 */
#include "compiler/graph/rewrite/parameterise.h"

#include <math.h>

#include "compiler/base/far.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/evaluate.h"

static bool is_of_formulas(double number)
{
    double size = fabs(number);
    return size == 0 || size == 0.5 || size == 1 || size == 2 || size >= FAR_SIDE;
}

/* Operands, as bits, that decide how something is computed: exponents, and how often loops run. */
static const uint8_t structure_of[OP_COUNT] = {
    [OP_pow] = 1 << 0 | 1 << 1,    [OP_mandelbulb] = 1 << 1, [OP_julia] = 1 << 2,
    [OP_mandelbulb_trap] = 1 << 1, [OP_julia_trap] = 1 << 2,
};

/* Constants of what is found at points. */
static bool parameterises(const Expr *user, const Expr *operand)
{
    return operand->op == OP_CONSTANT && operand->type <= TYPE_VEC4 && user->time == TIME_POINT &&
           !(operand->type == TYPE_FLOAT && is_of_formulas(operand->number[0]));
}

typedef struct Parameterise {
    const Graph *old;
    Graph       *graph;
    Node        *nodes; /* of the copy, by those of the original */
    uint32_t     next;
} Parameterise;

static Node copy_operation(Parameterise *h, const Expr *e)
{
    Node operands[MAX_OPERANDS];
    for (int i = 0; i < e->operand_count; i++) {
        const Expr *operand = &h->old->items[e->operands[i]];
        operands[i]         = parameterises(e, operand) && !(structure_of[e->op] >> i & 1)
                                  ? graph_parameterised(h->graph, operand->type, operand->number, h->next++)
                                  : h->nodes[e->operands[i]];
    }
    return graph_like(h->graph, e, operands);
}

static Graph *parameterise_all(const Graph *old, Node *roots, size_t root_count, uint32_t first,
                               Arena *arena)
{
    Tape         tape = tape_new(old, roots, root_count, arena);
    Parameterise h = {old, graph_new(arena), arena_new_array(arena, Node, old->count + 1), first};
    for (size_t i = 0; i < tape.count; i++) {
        Node        node = tape.nodes[i];
        const Expr *e    = &old->items[node];
        h.graph->here    = e->span;
        h.nodes[node]    = e->operand_count ? copy_operation(&h, e) : graph_copy_leaf(h.graph, e);
    }
    for (size_t i = 0; i < root_count; i++)
        roots[i] = h.nodes[roots[i]];
    h.graph->parameters.count = 0;
    for (size_t i = 0; i < old->parameters.count; i++)
        array_push(arena, &h.graph->parameters, old->parameters.items[i]);
    h.graph->here = (Span){0};
    return h.graph;
}

Graph *graph_parameterise(const Graph *old, Node *roots, size_t root_count, uint32_t first,
                          Arena *arena)
{
    size_t all_count;
    Node  *all   = roots_with_bodies(old, roots, root_count, &all_count, arena);
    Graph *graph = parameterise_all(old, all, all_count, first, arena);
    hand_on_instances(graph, old, all, roots, root_count);
    return graph;
}
