/*
 * graph.c: making nodes.
 *
 * What is constant is computed on the spot.  Tables about operations are made from ops.def here.
 */
#include "compiler/graph/graph.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- what is known of operations ---- */

typedef struct OpInfo {
    const char *name, *glsl;
    const char *signature; /* NULL for leaves and componentwise rows */
    uint8_t     arity;     /* of componentwise rows */
    uint8_t     operands;  /* of rows with a signature */
    GraphType   type;      /* of leaves; ANY_TYPE: each has its own */
} OpInfo;

#define ANY_TYPE 0

static const OpInfo op_info[OP_COUNT] = {
#define LEAF(name_, text, type_, low, high, value, meaning) \
    [OP_##name_] = {.name = text, .type = type_},
#define INDEXED(name_, text) [OP_##name_] = {.name = text},
#define MAP(name_, arity_, called, glsl_, value, range, da, db, dc, norm, meaning) \
    [OP_##name_] = {.name = #name_, .glsl = glsl_, .arity = arity_},
#define OP(name_, signature_, glsl_, evaluate, facts, meaning) \
    [OP_##name_] = {.name      = #name_,                       \
                    .glsl      = glsl_,                        \
                    .signature = signature_,                   \
                    .operands  = sizeof signature_ - sizeof ">t"},
#include "compiler/graph/ops.def"
};

/* Every operation has one RULES row: as many as there are, and no array has an element twice. */
enum {
    ROW_COUNT = 0
#define LEAF(...)  +1
#define RULES(...) +1
#include "compiler/graph/ops.def"
};
_Static_assert(ROW_COUNT == (int)OP_COUNT, "an operation has no row of rules");

static const OpTraits traits_of[OP_COUNT] = {
#define RULES(name, cost, traits, simplify, derive, local, series, parity, rebase, target) \
    [OP_##name] = traits,
#include "compiler/graph/ops.def"
};

bool op_has_traits(Op op, OpTraits traits) { return (traits_of[op] & traits) == traits; }

bool op_has_setting(Op op, int operand)
{
    return op_has_traits(op, (OpTraits)(FIRST_SETTING << operand));
}

const char *graph_op_name(Op op) { return op_info[op].name; }
const char *op_glsl(Op op) { return op_info[op].glsl; }

/* Cost of one component; of OP rows, of the whole. */
#define RULES(name, cost, ...) \
    static double cost_of_##name(double n) { return (void)n, (cost); }
#include "compiler/graph/ops.def"

static double (*const costs[OP_COUNT])(double n) = {
#define RULES(name, ...) [OP_##name] = cost_of_##name,
#include "compiler/graph/ops.def"
};

double op_cost(Op op, GraphType type, const GraphType *operands)
{
    uint32_t size = components(type), first;
    if (!costs[op])
        return 0; /* a leaf */
    if (op_info[op].arity)
        return costs[op](1) * size;
    first = op_info[op].signature ? components(operands[0]) : 1;
    return costs[op](first > size ? first : size);
}

/* ---- types ---- */

/* The operands are FLOATs and vectors of one size; FLOATs will be spread. */
static GraphType map_type(const GraphType *operands, uint32_t count)
{
    GraphType type = TYPE_FLOAT;
    for (uint32_t i = 0; i < count; i++) {
        if (operands[i] < TYPE_FLOAT || operands[i] > TYPE_VEC4)
            return 0;
        if (operands[i] != TYPE_FLOAT && type != TYPE_FLOAT && operands[i] != type)
            return 0;
        if (operands[i] != TYPE_FLOAT)
            type = operands[i];
    }
    return type;
}

/* Tells whether a type fits the letter of a signature; `vector` and `any` are 0 until one is met. */
static bool letter_fits(char letter, GraphType type, GraphType *vector, GraphType *any)
{
    switch (letter) {
    case 'f': return type == TYPE_FLOAT;
    case 'b': return type == TYPE_BOOL;
    case 'u': return type == TYPE_UINT;
    case 'v':
        if (!*vector && type >= TYPE_VEC2 && type <= TYPE_VEC4)
            *vector = type;
        return *vector && type == *vector;
    case 't':
        if (!*any)
            *any = type;
        return type == *any;
    default: return type == (GraphType)(letter - '0');
    }
}

static GraphType signature_type(const char *signature, const GraphType *operands, uint32_t count)
{
    GraphType vector = 0, any = 0;
    uint32_t  i = 0;
    for (; signature[i] != '>'; i++)
        if (i >= count || !letter_fits(signature[i], operands[i], &vector, &any))
            return 0;
    char result = signature[i + 1];
    if (i != count)
        return 0;
    for (GraphType type = TYPE_FLOAT; type <= TYPE_UINT; type++)
        if (letter_fits(result, type, &vector, &any))
            return type;
    return 0;
}

GraphType graph_op_type(Op op, const GraphType *operands, uint32_t count)
{
    if (op_info[op].signature)
        return signature_type(op_info[op].signature, operands, count);
    if (op == OP_COMPONENT)
        return count == 1 && operands[0] >= TYPE_VEC2 && operands[0] <= TYPE_VEC4 ? TYPE_FLOAT : 0;
    return op_info[op].arity && op_info[op].arity == count ? map_type(operands, count) : 0;
}

static uint32_t op_arity(Op op)
{
    if (op == OP_COMPONENT)
        return 1;
    return op_info[op].signature ? op_info[op].operands : op_info[op].arity;
}

/* ---- leaves ---- */

Graph *graph_new(Arena *arena)
{
    Graph *graph        = arena_new(arena, Graph);
    graph->arena        = arena;
    graph->frame_ranges = arena_new(arena, FrameRanges);
    GraphParameter time = {{-HUGE_VAL}, {HUGE_VAL}};
    array_push(arena, &graph->parameters, time);
    return graph;
}

Node graph_constant(Graph *graph, GraphType type, const double *numbers)
{
    Expr e = {.op = OP_CONSTANT, .type = (uint8_t)type};
    memcpy(e.number, numbers, components(type) * sizeof *numbers);
    return node_intern(graph, e);
}

Node graph_number(Graph *graph, double number)
{
    return graph_constant(graph, TYPE_FLOAT, &number);
}

Node graph_vec3(Graph *graph, double x, double y, double z)
{
    double numbers[3] = {x, y, z};
    return graph_constant(graph, TYPE_VEC3, numbers);
}

Node graph_bool(Graph *graph, bool value)
{
    double number = value;
    return graph_constant(graph, TYPE_BOOL, &number);
}

Node graph_uint(Graph *graph, uint32_t value)
{
    double number = value;
    return graph_constant(graph, TYPE_UINT, &number);
}

Node graph_parameter(Graph *graph, uint32_t slot, GraphType type)
{
    Expr e = {.op = OP_PARAMETER, .type = (uint8_t)type, .time = TIME_FRAME, .index = slot};
    return node_intern(graph, e);
}

Node graph_parameterised(Graph *graph, GraphType type, const double *numbers, uint32_t index)
{
    Expr e = {.op = OP_PARAMETERISED, .type = (uint8_t)type, .time = TIME_FRAME, .index = index};
    memcpy(e.number, numbers, components(type) * sizeof *numbers);
    return node_intern(graph, e);
}

Node graph_leaf(Graph *graph, Op op) { return graph_leaf_of(graph, op, 0); }

Node graph_leaf_of(Graph *graph, Op op, uint32_t index)
{
    assert(op_info[op].type != ANY_TYPE);
    return graph_indexed_leaf(graph, op, op_info[op].type, index);
}

Node graph_indexed_leaf(Graph *graph, Op op, GraphType type, uint32_t index)
{
    Expr e = {.op = (uint8_t)op, .type = (uint8_t)type, .time = TIME_POINT, .index = index};
    return node_intern(graph, e);
}

Node graph_copy_leaf(Graph *graph, const Expr *e)
{
    if (e->op == OP_CONSTANT)
        return graph_constant(graph, e->type, e->number);
    if (e->op == OP_PARAMETERISED)
        return graph_parameterised(graph, e->type, e->number, e->index);
    return e->op == OP_PARAMETER ? graph_parameter(graph, e->index, e->type)
                                 : graph_indexed_leaf(graph, e->op, e->type, e->index);
}

bool graph_is_constant(const Graph *graph, Node node)
{
    return graph->items[node].op == OP_CONSTANT || graph->items[node].op == OP_PARAMETERISED;
}

bool graph_known_component(const Graph *graph, Node node, uint32_t component, double *number)
{
    if (op_has_traits((Op)graph->items[node].op, BUILDS)) {
        const Expr *e = &graph->items[node];
        node          = e->operands[e->operand_count > 1 ? component : 0];
        component     = 0;
    }
    if (!graph_is_constant(graph, node))
        return false;
    *number = graph->items[node].number[component];
    return true;
}

bool graph_known_components(const Graph *graph, Node node, uint32_t count, double *numbers)
{
    bool known = true;
    for (uint32_t i = 0; i < count; i++)
        known = known && graph_known_component(graph, node, i, &numbers[i]);
    return known;
}

bool graph_known_finite(const Graph *graph, Node node)
{
    double number;
    bool   finite = true;
    for (uint32_t k = 0; finite && k < components(graph->items[node].type); k++)
        finite = graph_known_component(graph, node, k, &number) && isfinite(number);
    return finite;
}

/* ---- operations ---- */

/* Returns the constant that e is when all its operands are; NODE_NONE when it is not a finite one. */
static Node fold_constant(Graph *graph, const Expr *e)
{
    for (int i = 0; i < e->operand_count; i++)
        if (graph->items[e->operands[i]].op != OP_CONSTANT)
            return NODE_NONE;
    if (op_has_traits(e->op, READS_TABLES))
        return NODE_NONE;
    GraphType types[MAX_OPERANDS]    = {0};
    NodeValue operands[MAX_OPERANDS] = {0};
    for (int i = 0; i < e->operand_count; i++) {
        const Expr *operand = &graph->items[e->operands[i]];
        types[i]            = operand->type;
        memcpy(operands[i].v, operand->number, sizeof operands[i].v);
    }
    NodeValue value = op_evaluate(e->op, e->type, e->index, types, operands);
    for (uint32_t i = 0; i < components(e->type); i++)
        if (!isfinite(value.v[i]))
            return NODE_NONE;
    return graph_constant(graph, e->type, value.v);
}

/* Returns the earliest that the value of an operation is known, but for constants. */
static uint8_t earliest_time(Op op)
{
    return op_has_traits(op, READS_TABLES) ? TIME_POINT : TIME_FRAME;
}

/* Returns the node of e, whose operands are in place; its binding time is the latest of theirs, or
   the frame's for what is constant and not finite: shaders have no literal for it. */
static Node operation(Graph *graph, Expr e)
{
    Node folded = fold_constant(graph, &e);
    if (folded != NODE_NONE)
        return folded;
    for (int i = 0; i < e.operand_count; i++)
        if (graph->items[e.operands[i]].time > e.time)
            e.time = graph->items[e.operands[i]].time;
    if (e.time < earliest_time(e.op))
        e.time = earliest_time(e.op);
    return node_intern(graph, e);
}

static Node spread(Graph *graph, Node number, GraphType type)
{
    static const Op splats[] = {OP_splat2, OP_splat3, OP_splat4};
    return graph_op(graph, splats[type - TYPE_VEC2], &number);
}

Node graph_op(Graph *graph, Op op, const Node *operands)
{
    Expr      e                   = {.op = (uint8_t)op, .operand_count = (uint8_t)op_arity(op)};
    GraphType types[MAX_OPERANDS] = {0};
    assert(e.operand_count > 0);
    for (int i = 0; i < e.operand_count; i++) {
        assert(operands[i] < graph->count);
        types[i]      = graph->items[operands[i]].type;
        e.operands[i] = operands[i];
    }
    GraphType type = graph_op_type(op, types, e.operand_count);
    assert(type != 0);
    e.type = (uint8_t)type;
    for (int i = 0; op_info[op].arity && i < e.operand_count; i++)
        if (types[i] == TYPE_FLOAT && type != TYPE_FLOAT)
            e.operands[i] = spread(graph, operands[i], type);
    return operation(graph, e);
}

Node graph_op1(Graph *graph, Op op, Node a) { return graph_op(graph, op, &a); }

Node graph_op2(Graph *graph, Op op, Node a, Node b)
{
    Node operands[] = {a, b};
    return graph_op(graph, op, operands);
}

Node graph_op3(Graph *graph, Op op, Node a, Node b, Node c)
{
    Node operands[] = {a, b, c};
    return graph_op(graph, op, operands);
}

Node graph_op4(Graph *graph, Op op, Node a, Node b, Node c, Node d)
{
    Node operands[] = {a, b, c, d};
    return graph_op(graph, op, operands);
}

Node graph_component(Graph *graph, Node vector, uint32_t index)
{
    GraphType type = graph->items[vector].type;
    assert(type <= TYPE_VEC4 && index < components(type));
    if (type == TYPE_FLOAT)
        return vector;
    return operation(graph, (Expr){.op            = OP_COMPONENT,
                                   .type          = TYPE_FLOAT,
                                   .index         = index,
                                   .operand_count = 1,
                                   .operands      = {vector}});
}

Node graph_like(Graph *graph, const Expr *e, const Node *operands)
{
    return e->op == OP_COMPONENT ? graph_component(graph, operands[0], e->index)
                                 : graph_op(graph, (Op)e->op, operands);
}

/* ---- powers ---- */

/* Returns base ^ n for n >= 1, bit by bit from the highest. */
static Node power_positive(Graph *graph, Node base, uint32_t n)
{
    uint32_t bit = 1;
    while (bit <= n / 2)
        bit *= 2;
    Node power = base;
    for (bit /= 2; bit; bit /= 2) {
        power = graph_op1(graph, OP_square, power);
        if (n & bit)
            power = graph_op2(graph, OP_mul, power, base);
    }
    return power;
}

Node graph_power(Graph *graph, Node base, Node exponent)
{
    const Expr *e       = &graph->items[exponent];
    double      n       = e->number[0];
    bool        uniform = e->op == OP_CONSTANT;
    for (uint32_t i = 1; i < components(e->type); i++)
        uniform = uniform && e->number[i] == n;
    bool same_type = e->type == TYPE_FLOAT || e->type == graph->items[base].type;
    bool integer   = n == floor(n) && fabs(n) <= 64;
    if (uniform && same_type && n == 0) {
        static const double ones[4] = {1, 1, 1, 1};
        return graph_constant(graph, graph->items[base].type, ones);
    }
    if (!uniform || !same_type || !(integer || fabs(n) == 0.5))
        return graph_op2(graph, OP_pow, base, exponent);
    if (!integer)
        return graph_op1(graph, n > 0 ? OP_sqrt : OP_inversesqrt, base);
    Node power = power_positive(graph, base, (uint32_t)fabs(n));
    if (n > 0)
        return power;
    Node one = graph_number(graph, 1);
    return graph_op2(graph, OP_div, one, power);
}

/* ---- validation ---- */

static const char *node_mistake(const Graph *graph, Node node)
{
    const Expr *e                   = &graph->items[node];
    GraphType   types[MAX_OPERANDS] = {0};
    uint8_t     latest              = e->op == OP_CONSTANT        ? TIME_COMPILE
                                      : e->op == OP_PARAMETER     ? TIME_FRAME
                                      : e->op == OP_PARAMETERISED ? TIME_FRAME
                                      : e->operand_count == 0     ? TIME_POINT
                                                                  : earliest_time(e->op);
    if (e->op >= OP_COUNT || e->operand_count != op_arity(e->op))
        return "wrong number of operands";
    for (int i = 0; i < e->operand_count; i++) {
        if (e->operands[i] >= node)
            return "an operand does not come first";
        const Expr *operand = &graph->items[e->operands[i]];
        types[i]            = operand->type;
        latest              = operand->time > latest ? operand->time : latest;
        if (op_info[e->op].arity && operand->type != e->type)
            return "an operand that was not spread";
    }
    if (e->operand_count && graph_op_type(e->op, types, e->operand_count) != e->type)
        return "wrong type";
    if (e->op == OP_COMPONENT && e->index >= components(types[0]))
        return "no such component";
    return e->time == latest ? NULL : "wrong binding time";
}

void graph_validate(const Graph *graph, const char *pass)
{
    for (Node node = 0; node < graph->count; node++) {
        const char *mistake = node_mistake(graph, node);
        if (mistake) {
            fprintf(stderr, "after %s: node %u (%s): %s\n", pass, (unsigned)node,
                    graph_op_name(graph->items[node].op), mistake);
            assert(!"an invalid graph");
        }
    }
}
