/*
 * rebase.c: the graph of points that are relative to an origin near them.
 *
 * Every value that is the point, or made of it by moving, rotating, scaling or mirroring, has two
 * summands: a base, which is what happens to the origin, and what is relative to it, which happens
 * to the offset from there.  Mirrors cost as much as before: behind one with dot(u, p) <= w the
 * latter, r, is
 *     r - 2 (max(dot(u, r), w') - k) u,   w' = w - dot(u, base),  k = 0 or w'
 * (0 if it mirrors the base), where nothing large is added and taken away again.  Rounding and
 * limits keep both, too, so that repetition does.  Everything else gets the sum: near a surface
 * of a shader it is no larger than the shader.
 */
#include "compiler/graph/rewrite/rebase.h"

#include "compiler/graph/instance_table.h"
#include "compiler/graph/evaluate.h"

/* base + relative; base NODE_NONE: the latter is all. */
typedef struct SplitValue {
    Node base, relative;
} SplitValue;

static SplitValue whole(Node node) { return (SplitValue){NODE_NONE, node}; }

static Node precise(Graph *g, Node node)
{
    return g->items[node].time == TIME_COMPILE ? node : graph_op1(g, OP_precise, node);
}

static Node sum_of(Graph *g, SplitValue value)
{
    if (value.base == NODE_NONE)
        return value.relative;
    Node base = precise(g, value.base);
    return graph_op2(g, OP_add, base, value.relative);
}

static bool is_held_constant(const Graph *g, SplitValue value)
{
    return value.base == NODE_NONE && g->items[value.relative].time != TIME_POINT;
}

static Node zero_like(Graph *g, Node node)
{
    static const double zeros[4] = {0};
    return graph_constant(g, (GraphType)g->items[node].type, zeros);
}

/* Splits a + b and a - b: what does not depend on the point joins the base. */
static SplitValue add_values(Graph *g, Op op, SplitValue a, SplitValue b)
{
    SplitValue sum  = {NODE_NONE, NODE_NONE};
    Node       zero = NODE_NONE;
    if (is_held_constant(g, a))
        a = (SplitValue){a.relative, zero = zero_like(g, a.relative)};
    if (is_held_constant(g, b))
        b = (SplitValue){b.relative, zero = zero_like(g, b.relative)};
    if (a.base == NODE_NONE || b.base == NODE_NONE) {
        bool first = a.base != NODE_NONE;
        sum.base = first || op == OP_add ? (first ? a.base : b.base) : graph_op1(g, OP_neg, b.base);
    } else
        sum.base = graph_op2(g, op, a.base, b.base);
    sum.relative = graph_op2(g, op, a.relative, b.relative);
    return sum;
}

/* Returns the same linear operation on both; other operands stand still. */
static SplitValue map_value(Graph *g, const Expr *e, SplitValue a, int index)
{
    Node operands[MAX_OPERANDS];
    for (int i = 0; i < e->operand_count; i++)
        operands[i] = e->operands[i];
    operands[index]   = a.base;
    SplitValue mapped = {graph_op(g, e->op, operands), NODE_NONE};
    operands[index]   = a.relative;
    mapped.relative   = graph_op(g, e->op, operands);
    return mapped;
}

static SplitValue make_vector(Graph *g, const Expr *e, const SplitValue *components)
{
    Node bases[MAX_OPERANDS], rests[MAX_OPERANDS];
    for (int i = 0; i < e->operand_count; i++) {
        bool held = is_held_constant(g, components[i]);
        Node zero = graph_number(g, 0);
        bases[i]  = held                              ? components[i].relative
                    : components[i].base == NODE_NONE ? zero
                                                      : components[i].base;
        rests[i]  = held ? zero : components[i].relative;
    }
    return (SplitValue){graph_op(g, e->op, bases), graph_op(g, e->op, rests)};
}

/* Returns w - dot(u, base): the offset of a mirror as the rest sees it. */
static Node offset_seen(Graph *g, const Expr *e, SplitValue a)
{
    Node depth = graph_op2(g, OP_dot, e->operands[1], a.base);
    return graph_op2(g, OP_sub, e->operands[2], depth);
}

static SplitValue fold_value(Graph *g, const Expr *e, SplitValue a)
{
    Node seen = offset_seen(g, e, a), zero = graph_number(g, 0);
    Node before       = graph_op3(g, OP_front, a.base, e->operands[1], e->operands[2]);
    Node retained     = graph_op3(g, OP_select, before, zero, seen);
    Node depth        = graph_op2(g, OP_dot, e->operands[1], a.relative);
    Node excess       = graph_op2(g, OP_max, depth, precise(g, seen));
    excess            = graph_op2(g, OP_sub, excess, precise(g, retained));
    Node       twice  = graph_op2(g, OP_mul, excess, graph_number(g, 2));
    Node       offset = graph_op2(g, OP_scale, e->operands[1], twice);
    SplitValue folded = {graph_op3(g, OP_fold, a.base, e->operands[1], e->operands[2]), NODE_NONE};
    folded.relative   = graph_op2(g, OP_sub, a.relative, offset);
    return folded;
}

/* Splits round, floor and ceil: that of the base, and that of what is relative and the base's
   excess. */
static SplitValue round_value(Graph *g, const Expr *e, SplitValue a)
{
    SplitValue rounded  = {graph_op1(g, e->op, a.base), NODE_NONE};
    Node       excess   = graph_op2(g, OP_sub, a.base, rounded.base);
    Node       relative = graph_op2(g, OP_add, precise(g, excess), a.relative);
    rounded.relative    = graph_op1(g, e->op, relative);
    return rounded;
}

/* Splits min, max and clamp by limits that stand still. */
static SplitValue limit_value(Graph *g, const Expr *e, SplitValue a)
{
    Node operands[MAX_OPERANDS] = {a.relative};
    for (int i = 1; i < e->operand_count; i++) {
        Node limit  = graph_op2(g, OP_sub, e->operands[i], a.base);
        operands[i] = precise(g, limit);
    }
    return (SplitValue){a.base, graph_op(g, e->op, operands)};
}

/* Compares a < b as rest a - rest b < base b - base a. */
static Node compare_values(Graph *g, const Expr *e, SplitValue a, SplitValue b)
{
    SplitValue difference = add_values(g, OP_sub, a, b);
    if (difference.base == NODE_NONE) {
        Node second = sum_of(g, b);
        return graph_op2(g, e->op, sum_of(g, a), second);
    }
    Node limit = graph_op1(g, OP_neg, difference.base);
    return graph_op2(g, e->op, difference.relative, precise(g, limit));
}

/* Tells whether all operands but one stand still. */
static bool others_are_held_constant(const Graph *g, const Expr *e, const SplitValue *values,
                                     int but)
{
    for (int i = 0; i < e->operand_count; i++)
        if (i != but && !is_held_constant(g, values[i]))
            return false;
    return true;
}

/* Returns an operation of which nothing is known but its value. */
static SplitValue plain_value(Graph *g, const Expr *e, const SplitValue *values)
{
    Node operands[MAX_OPERANDS];
    for (int i = 0; i < e->operand_count; i++)
        operands[i] = sum_of(g, values[i]);
    return whole(graph_like(g, e, operands));
}

static bool any_base(const Expr *e, const SplitValue *values)
{
    for (int i = 0; i < e->operand_count; i++)
        if (values[i].base != NODE_NONE)
            return true;
    return false;
}

/* ---- rules; one operand at least has a base ---- */

static SplitValue rebase_none(Graph *g, const Expr *e, const SplitValue *p)
{
    return plain_value(g, e, p);
}

static SplitValue rebase_sum(Graph *g, const Expr *e, const SplitValue *p)
{
    return add_values(g, (Op)e->op, p[0], p[1]);
}

/* Splits what is linear in the first operand. */
static SplitValue rebase_linear(Graph *g, const Expr *e, const SplitValue *p)
{
    return others_are_held_constant(g, e, p, 0) ? map_value(g, e, p[0], 0) : plain_value(g, e, p);
}

/* Splits what is linear in each operand. */
static SplitValue rebase_product(Graph *g, const Expr *e, const SplitValue *p)
{
    int first = p[0].base != NODE_NONE ? 0 : 1;
    return others_are_held_constant(g, e, p, first) ? map_value(g, e, p[first], first)
                                                    : plain_value(g, e, p);
}

static SplitValue rebase_component(Graph *g, const Expr *e, const SplitValue *p)
{
    return (SplitValue){graph_component(g, p[0].base, e->index),
                        graph_component(g, p[0].relative, e->index)};
}

static SplitValue rebase_vector(Graph *g, const Expr *e, const SplitValue *p)
{
    return make_vector(g, e, p);
}

static SplitValue rebase_fold(Graph *g, const Expr *e, const SplitValue *p)
{
    return others_are_held_constant(g, e, p, 0) ? fold_value(g, e, p[0]) : plain_value(g, e, p);
}

static SplitValue rebase_front(Graph *g, const Expr *e, const SplitValue *p)
{
    if (!others_are_held_constant(g, e, p, 0))
        return plain_value(g, e, p);
    return whole(
        graph_op3(g, OP_front, p[0].relative, e->operands[1], precise(g, offset_seen(g, e, p[0]))));
}

static SplitValue rebase_round(Graph *g, const Expr *e, const SplitValue *p)
{
    return round_value(g, e, p[0]);
}

static SplitValue rebase_limit(Graph *g, const Expr *e, const SplitValue *p)
{
    return others_are_held_constant(g, e, p, 0) ? limit_value(g, e, p[0]) : plain_value(g, e, p);
}

static SplitValue rebase_compare(Graph *g, const Expr *e, const SplitValue *p)
{
    return whole(compare_values(g, e, p[0], p[1]));
}

static SplitValue (*const rules[OP_COUNT])(Graph *g, const Expr *e, const SplitValue *p) = {
#define RULES(name, cost, traits, simplify, derive, local, series, parity, rebase, target) \
    [OP_##name] = rebase,
#include "compiler/graph/ops.def"
};

static SplitValue rebase_node(Graph *g, const Expr *e, const SplitValue *p)
{
    return any_base(e, p) ? rules[e->op](g, e, p) : plain_value(g, e, p);
}

/* ---- instance groups ---- */

/* The columns of a table that are relative, and the points of its calls.  So rows and grids are
   small numbers near the camera, which the host finds. */
typedef struct Relocated {
    Node base; /* of the points; NODE_NONE: they are as they are */
    bool stays;
} Relocated;

static const InstanceTable *table_at(const Graph *g, uint32_t table)
{
    return &g->instances->tables.items[table];
}

static uint32_t table_of_call(const Graph *g, const Expr *call)
{
    return g->instances->functions.items[called_function(g, call)].table_number;
}

/* Notes which tables stay as they are: also those that instances of others call. */
static Relocated *new_relocated(const Graph *g, Arena *scratch)
{
    const Instances *instances = g->instances;
    Relocated       *tables    = arena_new_array(scratch, Relocated,
                                                 (instances ? instances->tables.count : 0) + 1);
    for (size_t t = 0; instances && t < instances->tables.count; t++)
        tables[t] = (Relocated){NODE_NONE, !instances->tables.items[t].relocates};
    if (!instances)
        return tables;
    const Tape bodies = tape_new(g, instances->bodies.items, instances->bodies.count, scratch);
    for (size_t i = 0; i < bodies.count; i++) {
        const Expr *e = &g->items[bodies.nodes[i]];
        if (is_call((Op)e->op))
            tables[table_of_call(g, e)].stays = true;
    }
    return tables;
}

/* Notes the base of a call.  All calls of a table have the same base, or it stays. */
static void note_call(const Graph *g, const Expr *call, Node base, Relocated *tables)
{
    Relocated *table = &tables[table_of_call(g, call)];
    table->stays     = table->stays || base == NODE_NONE ||
                   (table->base != NODE_NONE && table->base != base);
    table->base = base;
}

/* The frame has the bases of those that do not stay. */
static void keep_bases(Graph *g, Relocated *tables)
{
    Instances *instances = g->instances;
    for (size_t t = 0; instances && t < instances->tables.count; t++) {
        if (tables[t].stays)
            tables[t].base = NODE_NONE;
        if (tables[t].base == NODE_NONE)
            continue;
        array_push(instances->arena, &instances->frame_numbers, tables[t].base);
        instances->tables.items[t].origin = (uint32_t)instances->frame_numbers.count;
    }
}

/* Returns what a call has in the place of its point: along axes without a column all of it. */
static SplitValue point_of_call(Graph *g, const InstanceTable *table, SplitValue point)
{
    Node parts[MAX_OPERANDS], zero = graph_number(g, 0);
    bool all = true;
    for (int k = 0; k < 3; k++) {
        const bool relative = relocates_along(table, k);
        parts[k]            = relative ? zero : graph_component(g, point.base, (uint32_t)k);
        all                 = all && relative;
    }
    return whole(all ? point.relative
                     : sum_of(g, (SplitValue){graph_op(g, OP_vec3, parts), point.relative}));
}

/* Returns a number of a row, which is relative to the base of its table. */
static SplitValue row_value(Graph *g, const Expr *row, const SplitValue *operands,
                            const Relocated *tables)
{
    const uint32_t id    = (uint32_t)g->items[row->operands[0]].number[0];
    const Node     base  = tables[row_table(id)].base;
    const uint8_t  axis  = table_at(g, row_table(id))->axes[row_column(id)];
    SplitValue     value = plain_value(g, row, operands);
    if (base != NODE_NONE && axis > 0)
        value.base = graph_component(g, base, axis - 1u);
    return value;
}

/* ---- all ---- */

/* Rebases a tape: first without the bases of tables, which are found, then with them. */
static void rebase_tape(Graph *g, const Tape *tape, Node rebase_origin, Relocated *tables,
                        bool finds, SplitValue *values)
{
    for (size_t i = 0; i < tape->count; i++) {
        Node       node = tape->nodes[i];
        Expr       e    = g->items[node];
        SplitValue operands[MAX_OPERANDS];
        g->here = e.span;
        if (e.op == OP_POINT) {
            values[i] = (SplitValue){rebase_origin, node};
            continue;
        }
        if (e.time != TIME_POINT || e.operand_count == 0) {
            values[i] = whole(node);
            continue;
        }
        for (int k = 0; k < e.operand_count; k++)
            operands[k] = values[tape_index(tape, e.operands[k])];
        if (is_call((Op)e.op) && finds)
            note_call(g, &e, operands[1].base, tables);
        else if (is_call((Op)e.op) && tables[table_of_call(g, &e)].base != NODE_NONE)
            operands[1] = point_of_call(g, table_at(g, table_of_call(g, &e)), operands[1]);
        values[i] = e.op == OP_row && !finds ? row_value(g, &e, operands, tables)
                                             : rebase_node(g, &e, operands);
    }
}

void graph_rebase(Graph *graph, Node *roots, size_t count, Node rebase_origin, Arena *scratch)
{
    Span        here   = graph->here;
    Tape        tape   = tape_new(graph, roots, count, scratch);
    SplitValue *values = arena_new_array(scratch, SplitValue, tape.count);
    Relocated  *tables = new_relocated(graph, scratch);
    if (graph->instances)
        rebase_tape(graph, &tape, rebase_origin, tables, true, values);
    keep_bases(graph, tables);
    rebase_tape(graph, &tape, rebase_origin, tables, false, values);
    for (size_t i = 0; i < count; i++)
        roots[i] = sum_of(graph, values[tape_index(&tape, roots[i])]);
    graph->here = here;
}
