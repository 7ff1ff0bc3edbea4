/*
 * csg_nodes.c: the tree of CSG nodes of a distance, and what is left of it.
 */
#include "compiler/graph/rewrite/csg_nodes.h"

#include "compiler/base/elementary.h"
#include "compiler/base/far.h"
#include "compiler/graph/evaluate.h"
#include "compiler/graph/rewrite/csg_needs.h"

/* A larger tree would take longer to look at than what is saved. */
enum { MAX_NODES = 4000 };

typedef struct Making {
    CsgTree  *tree;
    Tape      tape;
    uint32_t *part_of; /* by place on the tape: the part + 1, or 0 */
} Making;

static const Expr *expr_of(const Making *m, Node node) { return &m->tree->graph->items[node]; }

static bool is_number(const Making *m, Node node)
{
    const Expr *e = expr_of(m, node);
    return e->op == OP_CONSTANT && e->type == TYPE_FLOAT;
}

static bool is_zero(const Making *m, Node node)
{
    const Expr *e = expr_of(m, node);
    for (int k = 0; k < 3; k++)
        if (e->op != OP_CONSTANT || e->number[k] != 0)
            return false;
    return true;
}

/* ---- corners ---- */

/* Returns the operand of an operation beside 0; NODE_NONE: it is no such operation. */
static Node beside_zero(const Making *m, Node node, Op op)
{
    const Expr *e = expr_of(m, node);
    if (e->op != op || e->operand_count != 2)
        return NODE_NONE;
    return is_zero(m, e->operands[1])   ? e->operands[0]
           : is_zero(m, e->operands[0]) ? e->operands[1]
                                        : NODE_NONE;
}

/* Tells whether a node is a maximum of exactly these nodes. */
static bool is_greatest(const Making *m, Node node, const Node *sides, uint32_t count)
{
    Node     open[2 * MAX_SIDES] = {node};
    uint32_t waiting = 1, found = 0, leaves = 0;
    while (waiting > 0 && leaves <= count) {
        const Node  next  = open[--waiting];
        const Expr *e     = expr_of(m, next);
        uint32_t    which = 0;
        while (which < count && sides[which] != next)
            which++;
        if (which < count)
            found |= 1u << which;
        else if (e->op != OP_max || waiting + 2 > 2 * MAX_SIDES)
            return false;
        else
            for (int k = 0; k < 2; k++)
                open[waiting++] = e->operands[k];
        leaves += which < count;
    }
    return leaves == count && found == (1u << count) - 1;
}

/* Returns the sides of length(max(sides, 0)), which may be one vector; 0: it is something else. */
static uint32_t sides_of_length(const Making *m, Node node, Node sides[MAX_SIDES])
{
    const Expr *e = expr_of(m, node);
    if (e->op != OP_length)
        return 0;
    const Expr *outside = expr_of(m, e->operands[0]);
    uint32_t    count   = outside->operand_count;
    Node        whole   = beside_zero(m, e->operands[0], OP_max);
    if (whole != NODE_NONE) {
        count = expr_of(m, whole)->type;
        for (uint32_t k = 0; k < count && k < MAX_SIDES; k++)
            sides[k] = graph_component(m->tree->graph, whole, k);
        return count <= MAX_SIDES ? count : 0;
    }
    if (outside->op != OP_vec2 && outside->op != OP_vec3)
        return 0;
    for (uint32_t k = 0; k < count; k++) {
        sides[k] = beside_zero(m, outside->operands[k], OP_max);
        if (sides[k] == NODE_NONE)
            return 0;
    }
    return count;
}

/* Finds the sides of length(max(sides, 0)) + min(greatest of sides, 0). */
static uint32_t sides_of_corner(const Making *m, Node node, Node sides[MAX_SIDES])
{
    const Expr e = *expr_of(m, node);
    for (int k = 0; e.op == OP_add && k < 2; k++) {
        uint32_t count    = sides_of_length(m, e.operands[k], sides);
        Node     greatest = count ? beside_zero(m, e.operands[1 - k], OP_min) : NODE_NONE;
        if (greatest != NODE_NONE && is_greatest(m, greatest, sides, count))
            return count;
    }
    return 0;
}

/* ---- the tree ---- */

/* Tells whether it is a minimum where its operands differ by its width or more, and as steep as
   they are.  Not stairs, whose number is a fourth operand. */
static bool is_narrow_blend(Op op)
{
    const double n = 2;
    (void)n;
#define BLEND(name, signature, slope, bulge, most, reach, acts, ...) \
    if (op == OP_smin_##name)                                        \
        return (slope) == 1 && (acts) <= 1 && sizeof(signature) == sizeof "fff>f";
#include "compiler/graph/blends.def"
    return false;
}

static bool has_two(CsgKind kind)
{
    return kind == CSG_MIN || kind == CSG_MAX || kind == CSG_BLEND;
}

static uint32_t add_part(const Making *m, Node node);

static uint32_t new_part(const Making *m, CsgPart part)
{
    m->tree->parts[m->tree->count] = part;
    return m->tree->count++;
}

static CsgPart part_of_number(const Making *m, CsgKind kind, Node node, Node other, double number)
{
    return (CsgPart){.kind = kind, .node = node, .a = add_part(m, other), .number = number};
}

static CsgPart part_of_two(const Making *m, CsgKind kind, Node node)
{
    const Expr e = *expr_of(m, node);
    uint32_t   a = add_part(m, e.operands[0]), b = add_part(m, e.operands[1]);
    return (CsgPart){.kind = kind, .node = node, .a = a, .b = b};
}

static CsgPart part_of_corner(const Making *m, Node node, const Node *sides, uint32_t count)
{
    CsgPart part = {.kind = CSG_CORNER, .node = node, .side_count = count};
    for (uint32_t k = 0; k < count; k++)
        part.sides[k] = new_part(m, (CsgPart){.kind = CSG_LEAF, .node = sides[k]});
    return part;
}

/* Returns the numbers that a blend of several is of, without those that are nowhere; 0: it is none
   of known width, or of other vectors than of numbers. */
static uint32_t operands_of_shares(const Making *m, const Expr *e, Node operands[MAX_SHARERS])
{
    uint32_t count = 0, vectors = e->operand_count - 1u;
    if (!sharing_op((Op)e->op).find || !is_number(m, e->operands[vectors]) ||
        !(expr_of(m, e->operands[vectors])->number[0] > 0))
        return 0;
    for (uint32_t k = 0; k < vectors; k++) {
        const Expr *vector = expr_of(m, e->operands[k]);
        const bool  same   = vector->op == OP_CONSTANT && vector->number[0] >= NOWHERE;
        if (!same && vector->op != OP_vec4)
            return 0;
        for (uint32_t c = 0; c < 4 && !same; c++) {
            const Node operand = vector->operands[c];
            if (!is_number(m, operand) || expr_of(m, operand)->number[0] < NOWHERE)
                operands[count++] = operand;
        }
    }
    return count;
}

static CsgPart part_of_shares(const Making *m, Node node, const Node *operands, uint32_t count)
{
    const Expr e    = *expr_of(m, node);
    CsgPart    part = {.kind = CSG_SHARES, .node = node, .sharer_count = count};
    for (uint32_t k = 0; k < count; k++)
        part.sharers[k] = add_part(m, operands[k]);
    part.number = expr_of(m, e.operands[e.operand_count - 1])->number[0];
    return part;
}

static CsgPart make_part(const Making *m, Node node)
{
    const Expr e = *expr_of(m, node);
    Node       sides[MAX_SIDES];
    uint32_t   count = sides_of_corner(m, node, sides);
    if (count)
        return part_of_corner(m, node, sides, count);
    const Node   first = e.operands[0], second = e.operands[1];
    const bool   has_number = e.operand_count == 2 && is_number(m, second);
    const double number     = has_number ? expr_of(m, second)->number[0] : 0;
    if (e.op == OP_neg)
        return part_of_number(m, CSG_NEGATIVE, node, first, 0);
    if (e.op == OP_add && has_number)
        return part_of_number(m, CSG_ADD, node, first, number);
    if (e.op == OP_sub && has_number)
        return part_of_number(m, CSG_ADD, node, first, -number);
    if (e.op == OP_mul && has_number && number > 0)
        return part_of_number(m, CSG_SCALE, node, first, number);
    if (e.op == OP_min || e.op == OP_max)
        return part_of_two(m, e.op == OP_min ? CSG_MIN : CSG_MAX, node);
    if (is_narrow_blend((Op)e.op) && is_number(m, e.operands[2]) &&
        expr_of(m, e.operands[2])->number[0] > 0) {
        CsgPart part = part_of_two(m, CSG_BLEND, node);
        part.number  = expr_of(m, e.operands[2])->number[0];
        return part;
    }
    Node operands[MAX_SHARERS];
    count = operands_of_shares(m, &e, operands);
    return count ? part_of_shares(m, node, operands, count)
                 : (CsgPart){.kind = CSG_LEAF, .node = node};
}

static uint32_t add_part(const Making *m, Node node)
{
    uint32_t *known = &m->part_of[tape_index(&m->tape, node)];
    if (!*known)
        *known = new_part(m, make_part(m, node)) + 1;
    return *known - 1;
}

/* Finds in which ways the whole depends on its parts. */
static void find_signs(CsgTree *tree)
{
    tree->parts[tree->count - 1].upwards = true;
    for (uint32_t i = tree->count; i-- > 0;) {
        const CsgPart  part   = tree->parts[i];
        const bool     shares = part.kind == CSG_SHARES;
        const uint32_t two[] = {part.a, part.b}, *of = shares ? part.sharers : two;
        const bool     negates = part.kind == CSG_NEGATIVE;
        const uint32_t others  = part.kind == CSG_LEAF || part.kind == CSG_CORNER ? 0
                                 : shares             ? part.sharer_count
                                 : has_two(part.kind) ? 2
                                                      : 1;
        for (uint32_t k = 0; k < others; k++) {
            tree->parts[of[k]].upwards |= negates ? part.downwards : part.upwards;
            tree->parts[of[k]].downwards |= negates ? part.upwards : part.downwards;
        }
    }
}

/* ---- what is left ---- */

static Node greatest_of(Graph *g, const Node *sides, uint32_t count)
{
    Node greatest = sides[0];
    for (uint32_t k = 1; k < count; k++)
        greatest = graph_op2(g, OP_max, greatest, sides[k]);
    return greatest;
}

/* Makes the distance to the corner of two sides. */
static Node corner_of(Graph *g, const Node *sides)
{
    Node zero = graph_number(g, 0), outside[2];
    for (int k = 0; k < 2; k++)
        outside[k] = graph_op2(g, OP_max, sides[k], zero);
    Node distance = graph_op1(g, OP_length, graph_op(g, OP_vec2, outside));
    Node depth    = graph_op2(g, OP_min, greatest_of(g, sides, 2), zero);
    return graph_op2(g, OP_add, distance, depth);
}

static Node rest_of_corner(Graph *g, const CsgPart *part, const Node *rests)
{
    Node     sides[MAX_SIDES] = {0};
    uint32_t count            = 0;
    for (uint32_t k = 0; k < part->side_count; k++)
        if (part->needed >> k & 1)
            sides[count++] = rests[part->sides[k]];
    if (!part->is_round || count == 1)
        return greatest_of(g, sides, count);
    return count == part->side_count ? part->node : corner_of(g, sides);
}

/* Returns those that share with operand k, or with one that does, as bits. */
static uint32_t who_share_with(const CsgPart *part, uint32_t k)
{
    uint32_t all = 1u << k, before = 0;
    while (all != before) {
        before = all;
        for (uint32_t i = 0; i < part->sharer_count; i++)
            if (before >> i & 1)
                all |= part->shares[i];
    }
    return all;
}

static Node blend_of(Graph *g, Op op, Node width, const Node *operands, uint32_t count)
{
    const SharingOp sharing = sharing_op(op);
    Node            four[8], vectors[2];
    if (count <= 2)
        return count == 1 ? operands[0]
                          : graph_op3(g, sharing.of_two, operands[0], operands[1], width);
    for (uint32_t k = 0; k < 8; k++)
        four[k] = k < count ? operands[k] : graph_number(g, NOWHERE);
    for (uint32_t k = 0; k < 2; k++)
        vectors[k] = graph_op(g, OP_vec4, four + 4 * k);
    return count <= 4 ? graph_op2(g, sharing.of_four, vectors[0], width)
                      : graph_op3(g, sharing.of_eight, vectors[0], vectors[1], width);
}

/* Returns the least of what those make that share. */
static Node rest_of_shares(Graph *g, const CsgPart *part, const Node *rests)
{
    const Expr e     = g->items[part->node];
    Node       least = NODE_NONE;
    uint32_t   done  = 0;
    for (uint32_t k = 0; k < part->sharer_count; k++) {
        Node     operands[MAX_SHARERS];
        uint32_t count = 0, together = who_share_with(part, k);
        if (done >> k & 1)
            continue;
        done |= together;
        for (uint32_t i = 0; i < part->sharer_count; i++)
            if (together >> i & 1)
                operands[count++] = rests[part->sharers[i]];
        Node blended = blend_of(g, (Op)e.op, e.operands[e.operand_count - 1], operands, count);
        least        = least == NODE_NONE ? blended : graph_op2(g, OP_min, least, blended);
    }
    return least;
}

static Node rest_of_part(Graph *g, const CsgPart *part, const Node *rests)
{
    const Expr e = g->items[part->node];
    g->here      = e.span;
    switch (part->kind) {
    case CSG_LEAF: return part->node;
    case CSG_CORNER: return rest_of_corner(g, part, rests);
    case CSG_SHARES: return rest_of_shares(g, part, rests);
    case CSG_NEGATIVE: return graph_op1(g, OP_neg, rests[part->a]);
    case CSG_ADD:
    case CSG_SCALE: return graph_op2(g, (Op)e.op, rests[part->a], e.operands[1]);
    case CSG_BLEND:
        if (part->blends)
            return graph_op3(g, (Op)e.op, rests[part->a], rests[part->b], e.operands[2]);
        return graph_op2(g, OP_min, rests[part->a], rests[part->b]);
    default: return graph_op2(g, (Op)e.op, rests[part->a], rests[part->b]);
    }
}

static Node rest_of(const CsgTree *tree, Arena *scratch)
{
    Span  here  = tree->graph->here;
    Node *rests = arena_new_array(scratch, Node, tree->count);
    for (uint32_t i = 0; i < tree->count; i++)
        rests[i] = rest_of_part(tree->graph, &tree->parts[i], rests);
    tree->graph->here = here;
    return rests[tree->count - 1];
}

/* Tells whether a part depends on the frame: parts are left out by points alone. */
static bool depends_on_frame(const Graph *graph, const Tape *tape)
{
    for (size_t i = 0; i < tape->count; i++)
        if (graph->items[tape->nodes[i]].time == TIME_FRAME ||
            op_has_traits((Op)graph->items[tape->nodes[i]].op, READS_TABLES))
            return true;
    return false;
}

/* Tells whether there is anything to be left out. */
static bool has_candidates(const CsgTree *tree)
{
    for (uint32_t i = 0; i < tree->count; i++)
        if (csg_node_is_candidate(&tree->parts[i]))
            return true;
    return false;
}

Node csg_nodes_prune(Graph *graph, Node root, Box box, Arena *scratch)
{
    CsgTree tree = {.graph = graph};
    Making  m    = {.tree = &tree, .tape = tape_new(graph, &root, 1, scratch)};
    if (m.tape.count > MAX_NODES || depends_on_frame(graph, &m.tape))
        return root;
    m.part_of  = arena_new_array(scratch, uint32_t, m.tape.count);
    tree.parts = arena_new_array(scratch, CsgPart, (1 + MAX_SIDES) * m.tape.count);
    add_part(&m, root);
    find_signs(&tree);
    if (!has_candidates(&tree) || !csg_nodes_find_needs(&tree, box, scratch))
        return root;
    return rest_of(&tree, scratch);
}
