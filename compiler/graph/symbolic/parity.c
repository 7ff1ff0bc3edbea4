/*
 * parity.c: even and odd expressions.
 *
 * When a coordinate changes its sign, each component of a node stays (even), changes its sign
 * (odd), or does something else.  Sums need equal parities, products multiply them, and whatever
 * depends on even things only is even.
 */
#include "compiler/graph/symbolic/parity.h"

#include "compiler/graph/evaluate.h"

enum { NEITHER = 0, EVEN = 1, ODD = 2, ZERO = 3 }; /* bits: 0 is both */

typedef struct Parity {
    uint8_t of[4];
} Parity;

static uint32_t size_of(const Expr *e) { return components((GraphType)e->type); }

static uint8_t product(uint8_t a, uint8_t b)
{
    if (a == NEITHER || b == NEITHER)
        return NEITHER;
    if (a == ZERO || b == ZERO)
        return ZERO;
    return a == b ? EVEN : ODD;
}

/* Returns the parity of abs, square and the like, in which a change of sign does not show. */
static uint8_t unsign(uint8_t a) { return a == NEITHER ? NEITHER : EVEN; }

static bool all_even(const Expr *e, const Parity *const *operands, const Graph *graph)
{
    for (int i = 0; i < e->operand_count; i++)
        for (uint32_t k = 0; k < size_of(&graph->items[e->operands[i]]); k++)
            if (!(operands[i]->of[k] & EVEN))
                return false;
    return true;
}

/* Returns the parity of a sum over components of a[k] * b[k]. */
static uint8_t sum_of_products(const Parity *a, const Parity *b, uint32_t size)
{
    uint8_t sum = ZERO;
    for (uint32_t k = 0; k < size; k++)
        sum &= product(a->of[k], b->of[k]);
    return sum;
}

static const ParityRule rules[OP_COUNT] = {
#define RULES(name, cost, traits, simplify, derive, local, series, parity, rebase, target) \
    [OP_##name] = parity,
#include "compiler/graph/ops.def"
};

ParityRule op_parity(Op op) { return rules[op]; }

/* Constants, parameters and the point; whatever else is a leaf is not known. */
static Parity leaf_parity(const Expr *e, uint32_t axis)
{
    Parity parity = {{NEITHER, NEITHER, NEITHER, NEITHER}};
    for (uint32_t k = 0; k < size_of(e); k++) {
        if (e->op == OP_CONSTANT || e->op == OP_PARAMETERISED || e->op == OP_PARAMETER)
            parity.of[k] = e->op == OP_CONSTANT && e->number[k] == 0 ? ZERO : EVEN;
        else if (e->op == OP_POINT)
            parity.of[k] = k == axis ? ODD : EVEN;
    }
    return parity;
}

/* Tells whether all components of a vector are even, whatever their signs. */
static uint8_t length_parity(const Parity *vector, uint32_t size)
{
    uint8_t parity = EVEN;
    for (uint32_t k = 0; k < size; k++)
        parity &= unsign(vector->of[k]);
    return parity;
}

/* Returns the parity of component k of a node by its rule; o: its operands, the first of `first`
   components. */
static uint8_t component_parity(const Expr *e, const Parity *const *o, uint32_t first, uint32_t k)
{
    switch (op_parity((Op)e->op)) {
    case PARITY_NONE: return NEITHER;
    case PARITY_ODD: return o[0]->of[k];
    case PARITY_EVEN: return unsign(o[0]->of[k]);
    case PARITY_SUM: return o[0]->of[k] & o[1]->of[k];
    case PARITY_PRODUCT: return product(o[0]->of[k], o[1]->of[e->op == OP_scale ? 0 : k]);
    case PARITY_COMPONENT: return o[0]->of[e->index];
    case PARITY_VECTOR: return o[e->operand_count > 1 ? k : 0]->of[0];
    case PARITY_DOT: return sum_of_products(o[0], o[1], first);
    case PARITY_LENGTH: return length_parity(o[0], first);
    case PARITY_ROTATE: return sum_of_products(o[k + 1], o[0], 3);
    }
    return NEITHER;
}

/* Tells whether an operation makes other numbers of numbers, and does not only arrange or sum them
   up. */
static bool is_arithmetic(const Expr *e) { return op_parity((Op)e->op) <= PARITY_PRODUCT; }

static Parity node_parity(const Graph *graph, const Expr *e, const Parity *const *operands,
                          uint32_t axis)
{
    Parity parity = {{NEITHER, NEITHER, NEITHER, NEITHER}};
    if (e->operand_count == 0)
        return leaf_parity(e, axis);
    bool     even  = is_arithmetic(e) && all_even(e, operands, graph);
    uint32_t first = size_of(&graph->items[e->operands[0]]);
    for (uint32_t k = 0; k < size_of(e); k++)
        parity.of[k] = even ? EVEN : component_parity(e, operands, first, k);
    return parity;
}

bool graph_is_even(const Graph *graph, Node root, uint32_t axis, Arena *scratch)
{
    Tape    tape     = tape_new(graph, &root, 1, scratch);
    Parity *parities = arena_new_array(scratch, Parity, tape.count);
    for (size_t i = 0; i < tape.count; i++) {
        const Expr   *e = &graph->items[tape.nodes[i]];
        const Parity *operands[MAX_OPERANDS];
        for (int k = 0; k < e->operand_count; k++)
            operands[k] = &parities[tape_index(&tape, e->operands[k])];
        parities[i] = node_parity(graph, e, operands, axis);
    }
    return parities[tape_index(&tape, root)].of[0] & EVEN;
}
