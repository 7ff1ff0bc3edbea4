/*
 * parity.c: even and odd expressions.
 *
 * When a coordinate changes its sign, each component of a node stays (even), changes its sign
 * (odd), or does something else.  Sums need equal parities, products multiply them, and whatever
 * depends on even things only is even.
 */
#include "compiler/graph/parity.h"

#include "compiler/graph/evaluate.h"

enum { NEITHER = 0, EVEN = 1, ODD = 2, ZERO = 3 }; /* bits: 0 is both */

typedef struct Parity {
    uint8_t of[4];
} Parity;

static uint32_t size_of(const Expr *e) { return e->type <= TYPE_VEC4 ? e->type : 1; }

static uint8_t product(uint8_t a, uint8_t b)
{
    if (a == NEITHER || b == NEITHER)
        return NEITHER;
    if (a == ZERO || b == ZERO)
        return ZERO;
    return a == b ? EVEN : ODD;
}

/* abs, square and the like: what changes its sign does not show. */
static uint8_t unsign(uint8_t a) { return a == NEITHER ? NEITHER : EVEN; }

static bool all_even(const Expr *e, const Parity *const *operands, const Graph *graph)
{
    for (int i = 0; i < e->operand_count; i++)
        for (uint32_t k = 0; k < size_of(&graph->items[e->operands[i]]); k++)
            if (!(operands[i]->of[k] & EVEN))
                return false;
    return true;
}

/* The parity of a sum over components of a[k] * b[k]. */
static uint8_t sum_of_products(const Parity *a, const Parity *b, uint32_t size)
{
    uint8_t sum = ZERO;
    for (uint32_t k = 0; k < size; k++)
        sum &= product(a->of[k], b->of[k]);
    return sum;
}

static uint8_t component_parity(const Expr *e, const Parity *const *operands, uint32_t k)
{
    uint8_t a = operands[0]->of[k], b = e->operand_count > 1 ? operands[1]->of[k] : NEITHER;
    switch ((Op)e->op) {
    case OP_neg:
    case OP_sign:
    case OP_sin:
    case OP_tan:
    case OP_asin:
    case OP_atan:
    case OP_sinh:
    case OP_tanh: return a;
    case OP_abs:
    case OP_square:
    case OP_cos:
    case OP_cosh: return unsign(a);
    case OP_add:
    case OP_sub: return a & b;
    case OP_mul:
    case OP_div: return product(a, b);
    case OP_scale: return product(a, operands[1]->of[0]);
    default: return NEITHER;
    }
}

/* Constants, parameters and the point; whatever else is a leaf is not known. */
static Parity leaf_parity(const Expr *e, uint32_t axis)
{
    Parity parity = {{NEITHER, NEITHER, NEITHER, NEITHER}};
    for (uint32_t k = 0; k < size_of(e); k++) {
        if (e->op == OP_CONSTANT || e->op == OP_PARAMETER)
            parity.of[k] = e->op == OP_CONSTANT && e->number[k] == 0 ? ZERO : EVEN;
        else if (e->op == OP_POINT)
            parity.of[k] = k == axis ? ODD : EVEN;
    }
    return parity;
}

static Parity node_parity(const Graph *graph, const Expr *e, const Parity *const *operands,
                          uint32_t axis)
{
    Parity   parity = {{NEITHER, NEITHER, NEITHER, NEITHER}};
    uint32_t size   = size_of(e);
    if (e->operand_count == 0)
        return leaf_parity(e, axis);
    uint32_t first = size_of(&graph->items[e->operands[0]]);
    switch ((Op)e->op) {
    case OP_COMPONENT: parity.of[0] = operands[0]->of[e->index]; return parity;
    case OP_vec2:
    case OP_vec3:
    case OP_vec4:
        for (uint32_t k = 0; k < size; k++)
            parity.of[k] = operands[k]->of[0];
        return parity;
    case OP_splat2:
    case OP_splat3:
    case OP_splat4:
        for (uint32_t k = 0; k < size; k++)
            parity.of[k] = operands[0]->of[0];
        return parity;
    case OP_dot: parity.of[0] = sum_of_products(operands[0], operands[1], first); return parity;
    case OP_length:
        parity.of[0] = EVEN;
        for (uint32_t k = 0; k < first; k++)
            parity.of[0] &= unsign(operands[0]->of[k]);
        return parity;
    case OP_turn:
        for (uint32_t k = 0; k < 3; k++)
            parity.of[k] = sum_of_products(operands[k + 1], operands[0], 3);
        return parity;
    default: break;
    }
    bool even = all_even(e, operands, graph);
    for (uint32_t k = 0; k < size; k++)
        parity.of[k] = even ? EVEN : component_parity(e, operands, k);
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
