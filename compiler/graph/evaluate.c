/*
 * evaluate.c: the graph in double precision.
 *
 * The first half says what each operation of ops.def is; every definition is total, or not a
 * number exactly where mathematics has no answer.  The second half runs lists of nodes.
 */
#include "compiler/graph/evaluate.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/graph/fractal.h"
#include "compiler/graph/regions.h"

/* ---- the `value` column of MAP rows ---- */

static double value_sign(double a) { return (a > 0) - (a < 0); }
static double value_unit(double a) { return fmin(fmax(a, -1), 1); }

/* Exact, unlike a - b * floor(a / b), so that it never leaves [0, b). */
static double value_mod(double a, double b)
{
    double rest = fmod(a, b);
    return rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest;
}

/* The sign of a zero means nothing here. */
static double value_pow(double a, double b) { return pow(a + 0.0, b); }
static double value_atan2(double a, double b) { return atan2(a + 0.0, b + 0.0); }

static double value_smoothstep(double a, double b, double c)
{
    double t = a == b ? !(c < a) : fmin(fmax((c - a) / (b - a), 0), 1);
    return t * t * (3 - 2 * t);
}

/* ---- the `evaluate` column of OP rows: `size` is the number of components that matter ---- */

static NodeValue number(double a) { return (NodeValue){{a}}; }
static NodeValue vector3(double x, double y, double z) { return (NodeValue){{x, y, z}}; }

static NodeValue evaluate_splat(const NodeValue *o, uint32_t size)
{
    NodeValue result = {0};
    for (uint32_t i = 0; i < size; i++)
        result.v[i] = o[0].v[0];
    return result;
}

static NodeValue evaluate_vector(const NodeValue *o, uint32_t size)
{
    NodeValue result = {0};
    for (uint32_t i = 0; i < size; i++)
        result.v[i] = o[i].v[0];
    return result;
}

static double dot(const NodeValue *a, const NodeValue *b, uint32_t size)
{
    double sum = 0;
    for (uint32_t i = 0; i < size; i++)
        sum += a->v[i] * b->v[i];
    return sum;
}

static NodeValue evaluate_dot(const NodeValue *o, uint32_t size)
{
    return number(dot(&o[0], &o[1], size));
}

static NodeValue evaluate_cross(const NodeValue *o, uint32_t size)
{
    (void)size;
    const double *a = o[0].v, *b = o[1].v;
    return vector3(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}

/* Where the sum of squares overflows or loses what is small, hypot goes on. */
static double length(const NodeValue *a, uint32_t size)
{
    double sum = 0, whole = fabs(a->v[0]);
    for (uint32_t i = 0; i < size; i++)
        sum += a->v[i] * a->v[i];
    if (sum > 1e-200 && sum < 1e200)
        return sqrt(sum);
    for (uint32_t i = 1; i < size; i++)
        whole = hypot(whole, a->v[i]);
    return whole;
}

static NodeValue evaluate_length(const NodeValue *o, uint32_t size)
{
    return number(length(&o[0], size));
}

static NodeValue evaluate_normalize(const NodeValue *o, uint32_t size)
{
    NodeValue result = {0};
    double    whole  = length(&o[0], size);
    for (uint32_t i = 0; i < size && whole != 0; i++)
        result.v[i] = o[0].v[i] / whole;
    return result;
}

static NodeValue evaluate_scale(const NodeValue *o, uint32_t size)
{
    NodeValue result = {0};
    for (uint32_t i = 0; i < size; i++)
        result.v[i] = o[0].v[i] * o[1].v[0];
    return result;
}

#define TRUTH(name, condition)                                          \
    static NodeValue evaluate_##name(const NodeValue *o, uint32_t size) \
    {                                                                   \
        (void)size;                                                     \
        return number(condition);                                       \
    }
TRUTH(less, o[0].v[0] < o[1].v[0])
TRUTH(less_equal, o[0].v[0] <= o[1].v[0])
TRUTH(equal, o[0].v[0] == o[1].v[0])
TRUTH(not_equal, o[0].v[0] != o[1].v[0])
TRUTH(and, o[0].v[0] != 0 && o[1].v[0] != 0)
TRUTH(or, o[0].v[0] != 0 || o[1].v[0] != 0)
TRUTH(not, o[0].v[0] == 0)
TRUTH(front, dot(&o[1], &o[0], 3) > o[2].v[0])
#undef TRUTH

static NodeValue evaluate_select(const NodeValue *o, uint32_t size)
{
    (void)size;
    return o[0].v[0] != 0 ? o[1] : o[2];
}

/* What is at 0 may be anywhere inside: there, inside of something else, only the rest can tell how
   deep. */
static bool guard_decides(double bound, double least, double far)
{
    return bound >= fmin(least, far) && bound > fmin(far, 0);
}

static NodeValue evaluate_guard(const NodeValue *o, uint32_t size)
{
    (void)size;
    double bound = o[0].v[0], least = o[1].v[0];
    return guard_decides(bound, least, o[3].v[0]) ? number(fmin(bound, least)) : o[2];
}

static NodeValue evaluate_turn(const NodeValue *o, uint32_t size)
{
    (void)size;
    return vector3(dot(&o[1], &o[0], 3), dot(&o[2], &o[0], 3), dot(&o[3], &o[0], 3));
}

static NodeValue evaluate_fold(const NodeValue *o, uint32_t size)
{
    NodeValue result = o[0];
    double    depth  = fmax(dot(&o[1], &o[0], 3) - o[2].v[0], 0);
    for (uint32_t i = 0; i < size; i++)
        result.v[i] -= 2 * depth * o[1].v[i];
    return result;
}

static NodeValue evaluate_cell(const NodeValue *o, uint32_t size)
{
    NodeValue result = o[0];
    for (uint32_t i = 0; i < size; i++) {
        double period = o[1].v[i];
        if (period > 0) {
            double cell = floor(o[0].v[i] / period + 0.5);
            result.v[i] -= period * fmin(fmax(cell, o[2].v[i]), o[3].v[i]);
        }
    }
    return result;
}

static NodeValue evaluate_cell_polar(const NodeValue *o, uint32_t size)
{
    (void)size;
    const double *p = o[0].v, count = o[1].v[0];
    if (!(count >= 1))
        return o[0];
    double sector = 2 * acos(-1) / count;
    double angle  = sector * floor(value_atan2(p[2], p[0]) / sector + 0.5);
    double c = cos(angle), s = sin(angle);
    return vector3(c * p[0] + s * p[2], p[1], c * p[2] - s * p[0]);
}

/* The same integer arithmetic as in print/glsl/identity.glsl; every input gives another output. */
static uint32_t scramble(uint32_t x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

/*
 * Gradient noise (Perlin, "Improving noise", 2002): at each point of the lattice of whole numbers
 * stands a linear function, 0 there, in one of twelve directions (eight in the plane); between
 * them it is faded by 6 t^5 - 15 t^4 + 10 t^3.  Divided by the largest value there can be; the
 * bounds are proven in tests/property/noise.c.  Beyond 2^30 it goes on as it is there.
 */
static const double NOISE_END = 1073741824, NOISE_UNIT_2 = 0.99, NOISE_UNIT_3 = 0.96;

static double lattice_fraction(double p, uint32_t *cell)
{
    double clamped = fmin(fmax(p, -NOISE_END), NOISE_END), whole = floor(clamped);
    *cell = (uint32_t)(int32_t)whole;
    return clamped - whole;
}

static double fade(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

/* The direction of a lattice point, from what was scrambled of its other coordinates. */
static uint32_t lattice_bits(uint32_t row, uint32_t cell) { return scramble(row + cell) >> 28; }

static double slope_of_2(uint32_t h, double x, double y)
{
    double straight = (h & 2 ? y : x) * sqrt(2), diagonal = h & 2 ? x - y : x + y;
    double along = h & 4 ? straight : diagonal;
    return h & 1 ? -along : along;
}

static double slope_of_3(uint32_t h, double x, double y, double z)
{
    double u = h < 8 ? x : y, v = h < 4 ? y : h == 12 || h == 14 ? x : z;
    return (h & 1 ? -u : u) + (h & 2 ? -v : v);
}

static double interpolate(double a, double b, double t) { return a + (b - a) * t; }

static NodeValue evaluate_noise2(const NodeValue *o, uint32_t size)
{
    uint32_t cell[2];
    double   f[2], rows[2];
    for (uint32_t i = 0; i < size; i++) {
        if (isnan(o[0].v[i]))
            return number(o[0].v[i]);
        f[i] = lattice_fraction(o[0].v[i], &cell[i]);
    }
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t column = scramble(cell[0] + i);
        double   x      = f[0] - i;
        double   low    = slope_of_2(lattice_bits(column, cell[1]), x, f[1]);
        double   high   = slope_of_2(lattice_bits(column, cell[1] + 1), x, f[1] - 1);
        rows[i]         = interpolate(low, high, fade(f[1]));
    }
    return number(NOISE_UNIT_2 * interpolate(rows[0], rows[1], fade(f[0])));
}

static NodeValue evaluate_noise3(const NodeValue *o, uint32_t size)
{
    uint32_t cell[3];
    double   f[3], planes[2], rows[2];
    for (uint32_t i = 0; i < size; i++) {
        if (isnan(o[0].v[i]))
            return number(o[0].v[i]);
        f[i] = lattice_fraction(o[0].v[i], &cell[i]);
    }
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t plane = scramble(cell[0] + i);
        for (uint32_t k = 0; k < 2; k++) {
            uint32_t row = scramble(plane + cell[1] + k);
            double   x = f[0] - i, y = f[1] - k;
            double   low  = slope_of_3(lattice_bits(row, cell[2]), x, y, f[2]);
            double   high = slope_of_3(lattice_bits(row, cell[2] + 1), x, y, f[2] - 1);
            rows[k]       = interpolate(low, high, fade(f[2]));
        }
        planes[i] = interpolate(rows[0], rows[1], fade(f[1]));
    }
    return number(NOISE_UNIT_3 * interpolate(planes[0], planes[1], fade(f[0])));
}

static NodeValue evaluate_push_id(const NodeValue *o, uint32_t size)
{
    (void)size;
    return number((uint32_t)o[0].v[0] * 2u + (o[1].v[0] != 0));
}

static NodeValue evaluate_hash_id(const NodeValue *o, uint32_t size)
{
    (void)size;
    return number(scramble((uint32_t)o[0].v[0] + (o[1].v[0] != 0 ? 0x9e3779b9u : 0x7f4a7c15u)));
}

static NodeValue evaluate_join_id(const NodeValue *o, uint32_t size)
{
    (void)size;
    return number(scramble(scramble((uint32_t)o[0].v[0]) + (uint32_t)o[1].v[0]));
}

static NodeValue evaluate_id_unit(const NodeValue *o, uint32_t size)
{
    (void)size;
    return number((scramble((uint32_t)o[0].v[0]) >> 8) / 16777216.0);
}

/* ---- smooth minima (math.md, section 4); a width of 0 leaves min(a, b) ---- */

/* Infinite distances are as near as equal ones. */
static double widths_apart(double a, double b, double width)
{
    return a == b ? 0 : fabs(a - b) / width;
}

#define SMIN(name, glsl, value, facts, meaning)                         \
    static NodeValue evaluate_##name(const NodeValue *o, uint32_t size) \
    {                                                                   \
        (void)size;                                                     \
        double a = o[0].v[0], b = o[1].v[0], k = o[2].v[0];             \
        if (!(k > 0))                                                   \
            return number(fmin(a, b));                                  \
        double t = widths_apart(a, b, k), h = fmax(1 - t, 0);           \
        (void)h;                                                        \
        return number(value);                                           \
    }
#include "compiler/graph/ops.def"

/* hg_sdf's fOpUnionStairs: a triangle wave turns the line a + b = k into steps along which
   either a or b alone decides; that is why its slope is that of the steeper of them. */
static NodeValue evaluate_smin_stairs(const NodeValue *o, uint32_t size)
{
    (void)size;
    double a = o[0].v[0], b = o[1].v[0], k = o[2].v[0];
    if (!(k > 0) || isinf(a) || isinf(b))
        return number(fmin(a, b));
    double s = k / fmax(o[3].v[0], 1), u = b - k;
    double wave = fabs(value_mod(u - a + s, 2 * s) - s);
    return number(fmin(fmin(a, b), 0.5 * (u + a + wave)));
}

static NodeValue evaluate_blend_weight(const NodeValue *o, uint32_t size)
{
    (void)size;
    double a = o[0].v[0], b = o[1].v[0], k = o[2].v[0];
    if (!(k > 0))
        return number(b >= a);
    return number(a == b ? 0.5 : fmin(fmax(0.5 + 0.5 * (b - a) / k, 0), 1));
}

/* ---- one operation ---- */

static uint32_t components(GraphType type) { return type <= TYPE_VEC4 ? (uint32_t)type : 1; }

static NodeValue value_of_row(Op op, GraphType type, uint32_t index, const GraphType *types,
                              const NodeValue *operands)
{
    NodeValue result = {0};
    uint32_t  size   = components(type);
    switch (op) {
    case OP_COMPONENT: return number(operands[0].v[index]);
#define MAP(name, arity, glsl, value, range, da, db, dc, norm, meaning)                \
    case OP_##name:                                                                    \
        for (uint32_t i = 0; i < size; i++) {                                          \
            double a = operands[0].v[i], b = arity > 1 ? operands[arity > 1].v[i] : 0; \
            double c = arity > 2 ? operands[arity > 2 ? 2 : 0].v[i] : 0;               \
            (void)b, (void)c;                                                          \
            result.v[i] = (value);                                                     \
        }                                                                              \
        return result;
#define OP(name, signature, glsl, evaluate, facts, meaning) \
    case OP_##name:                                         \
        return evaluate(operands, components(types[0]) > size ? components(types[0]) : size);
#include "compiler/graph/ops.def"
#define LEAF(name, ...) case OP_##name:
#include "compiler/graph/ops.def"
    case OP_COUNT: break;
    }
    assert(!"a leaf has no value by itself");
    return result;
}

/* Zero has no sign: -0 becomes 0, so that 1 / (-1 * 0) does not depend on who multiplied. */
NodeValue op_evaluate(Op op, GraphType type, uint32_t index, const GraphType *types,
                      const NodeValue *operands)
{
    NodeValue value = value_of_row(op, type, index, types, operands);
    for (int i = 0; i < 4; i++)
        value.v[i] += 0.0;
    return value;
}

/* ---- tapes ---- */

/* The nodes found so far, in a hash table; its size is a power of 2, at most half is full. */
typedef struct NodeSet {
    Node  *slots; /* node + 1; 0 is free */
    size_t size;
    Node  *nodes; /* in the order in which they were found */
    size_t count, capacity;
} NodeSet;

/* Whether the node is new; then it takes its slot. */
static bool set_take(NodeSet *set, Node node)
{
    size_t i = node * (size_t)0x9E3779B97F4A7C15u >> 20 & (set->size - 1);
    for (; set->slots[i]; i = (i + 1) & (set->size - 1))
        if (set->slots[i] == node + 1)
            return false;
    set->slots[i] = node + 1;
    return true;
}

static void set_add(NodeSet *set, Node node, Arena *arena)
{
    if (2 * (set->count + 1) > set->size) {
        set->size  = set->size ? 2 * set->size : 64;
        set->slots = arena_new_array(arena, Node, set->size);
        for (size_t i = 0; i < set->count; i++)
            set_take(set, set->nodes[i]);
    }
    if (!set_take(set, node))
        return;
    if (set->count == set->capacity)
        set->nodes = arena_grow(arena, set->nodes, set->count, &set->capacity, sizeof *set->nodes);
    set->nodes[set->count++] = node;
}

static int compare_nodes(const void *a, const void *b)
{
    return (*(const Node *)a > *(const Node *)b) - (*(const Node *)a < *(const Node *)b);
}

/* The work grows with what the roots need, not with the graph: most expressions are small and
   the graph of many of them is large.  Nothing of frame time needs anything of point time, so
   it can all go first. */
Tape tape_new(const Graph *graph, const Node *roots, size_t root_count, Arena *arena)
{
    NodeSet set = {0};
    for (size_t i = 0; i < root_count; i++)
        set_add(&set, roots[i], arena);
    for (size_t i = 0; i < set.count; i++) {
        const Expr *e = &graph->items[set.nodes[i]];
        for (int k = 0; k < e->operand_count; k++)
            set_add(&set, e->operands[k], arena);
    }
    if (set.count)
        qsort(set.nodes, set.count, sizeof *set.nodes, compare_nodes);
    Tape  tape  = {.graph = graph, .count = set.count};
    Node *nodes = arena_new_array(arena, Node, set.count + 1);
    for (int frame = 1; frame >= 0; frame--)
        for (size_t i = 0, at = frame ? 0 : tape.frame_count; i < set.count; i++)
            if ((graph->items[set.nodes[i]].time != TIME_POINT) == frame) {
                nodes[at++] = set.nodes[i];
                tape.frame_count += (size_t)frame;
            }
    tape.nodes = nodes;
    return tape;
}

/* A tape on which each region follows its guard. */
typedef struct Layout {
    const Regions *regions;
    Node          *nodes;
    uint32_t      *skips;
    size_t         count;
} Layout;

static void lay_out(Layout *layout, uint32_t region)
{
    const Regions *regions = layout->regions;
    for (Node node = regions->list.items[region].first; node != NODE_NONE;
         node      = regions->next[node]) {
        if (regions->body[node] != NO_REGION) {
            size_t test                    = layout->count;
            layout->nodes[layout->count++] = node;
            lay_out(layout, regions->body[node]);
            layout->skips[test] = (uint32_t)(layout->count - test);
        }
        layout->nodes[layout->count++] = node;
    }
}

Tape tape_new_guarded(const Graph *graph, const Node *roots, size_t root_count, Arena *arena)
{
    Tape    tape    = tape_new(graph, roots, root_count, arena);
    Regions regions = {0};
    graph_regions(&regions, graph, roots, root_count, arena);
    size_t most   = tape.count + regions.list.count;
    Layout layout = {&regions, arena_new_array(arena, Node, most + 1),
                     arena_new_array(arena, uint32_t, most + 1), tape.frame_count};
    memcpy(layout.nodes, tape.nodes, tape.frame_count * sizeof *layout.nodes);
    lay_out(&layout, REGION_ALWAYS);
    tape.nodes = layout.nodes;
    tape.skips = layout.skips;
    tape.count = layout.count;
    return tape;
}

double tape_flops(const Tape *tape)
{
    const Expr *items = tape->graph->items;
    double      flops = 0;
    for (size_t i = tape->frame_count; i < tape->count; i++) {
        const Expr *expr = &items[tape->nodes[i]];
        GraphType   types[MAX_OPERANDS];
        for (uint32_t k = 0; k < expr->operand_count; k++)
            types[k] = items[expr->operands[k]].type;
        if (expr->operand_count)
            flops += op_cost((Op)expr->op, expr->type, types);
    }
    return flops;
}

uint32_t tape_loops(const Tape *tape)
{
    const Expr *items = tape->graph->items;
    uint32_t    loops = 0;
    for (size_t i = tape->frame_count; i < tape->count; i++) {
        const Expr *expr  = &items[tape->nodes[i]];
        uint32_t    range = expr->op == OP_julia ? 2 : expr->op == OP_mandelbulb ? 1 : 0;
        if (range > 0) /* always a constant (fractal.c) */
            loops += fractal_loops((Op)expr->op, items[expr->operands[range]].number[1]);
    }
    return loops;
}

size_t tape_index(const Tape *tape, Node node)
{
    bool   point = tape->graph->items[node].time == TIME_POINT;
    size_t low = point ? tape->frame_count : 0, high = point ? tape->count : tape->frame_count;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (tape->nodes[middle] <= node)
            low = middle;
        else
            high = middle;
    }
    assert(low < tape->count && tape->nodes[low] == node);
    return low;
}

/* What leaves get their values from. */
typedef struct Inputs {
    const NodeValue *parameters;
    const double    *point, *normal;
    double           footprint;
} Inputs;

static NodeValue all_of(const double v[4]) { return (NodeValue){{v[0], v[1], v[2], v[3]}}; }
static NodeValue vector_of(const double v[3]) { return vector3(v[0], v[1], v[2]); }

static inline NodeValue leaf_value(const Expr *e, const Inputs *in)
{
    switch ((Op)e->op) {
#define LEAF(name, text, type, low, high, value, meaning) \
    case OP_##name:                                       \
        return (value);
#include "compiler/graph/ops.def"
#define RULES(name, ...) case OP_##name:
#include "compiler/graph/ops.def"
    case OP_COUNT: break;
    }
    assert(!"no leaf");
    return number(0);
}

/* The rows once more, for tapes: straight from operands to result, without copies. */
static inline void run_row(const Expr *e, const NodeValue *values, NodeValue *result,
                           const Expr *nodes)
{
    const NodeValue *x = &values[e->operands[0]], *y = &values[e->operands[1]];
    const NodeValue *z    = &values[e->operands[2]];
    uint32_t         size = components(e->type);
    switch ((Op)e->op) {
    case OP_COMPONENT: *result = number(x->v[e->index]); return;
#define MAP(name, arity, glsl, value, range, da, db, dc, norm, meaning)                   \
    case OP_##name:                                                                       \
        for (uint32_t i = 0; i < size; i++) {                                             \
            double a = x->v[i], b = arity > 1 ? y->v[i] : 0, c = arity > 2 ? z->v[i] : 0; \
            (void)b, (void)c;                                                             \
            result->v[i] = (value) + 0.0;                                                 \
        }                                                                                 \
        return;
#include "compiler/graph/ops.def"
#define LEAF(name, ...) case OP_##name:
#define OP(name, ...)   case OP_##name:
#include "compiler/graph/ops.def"
    case OP_COUNT: break;
    }
    NodeValue operands[MAX_OPERANDS];
    GraphType types[MAX_OPERANDS];
    for (int i = 0; i < e->operand_count; i++) {
        types[i]    = nodes[e->operands[i]].type;
        operands[i] = values[e->operands[i]];
    }
    *result = op_evaluate(e->op, e->type, e->index, types, operands);
}

static void tape_run_node(const Graph *graph, Node node, NodeValue *values)
{
    run_row(&graph->items[node], values, &values[node], graph->items);
}

/* The guard at `i`: how many elements it leaves out. */
static size_t run_guard(const Tape *tape, size_t i, NodeValue *values)
{
    const Expr *e     = &tape->graph->items[tape->nodes[i]];
    double      bound = values[e->operands[0]].v[0], least = values[e->operands[1]].v[0];
    if (!guard_decides(bound, least, values[e->operands[3]].v[0])) {
        values[tape->nodes[i]] = values[e->operands[2]];
        return 0;
    }
    values[tape->nodes[i]] = number(fmin(bound, least));
    return tape->skips ? tape->skips[i] : 0;
}

void tape_run_frame(const Tape *tape, const NodeValue *parameters, NodeValue *values)
{
    Inputs inputs = {.parameters = parameters};
    for (size_t i = 0; i < tape->frame_count; i++) {
        Node        node = tape->nodes[i];
        const Expr *e    = &tape->graph->items[node];
        if (e->operand_count == 0)
            values[node] = leaf_value(e, &inputs);
        else
            tape_run_node(tape->graph, node, values);
    }
}

bool node_value_is_finite(const Graph *graph, Node node, const NodeValue *values)
{
    const Expr *e = &graph->items[node];
    for (uint32_t k = 0; e->type <= TYPE_VEC4 && k < (uint32_t)e->type; k++)
        if (!isfinite(values[node].v[k]))
            return false;
    return true;
}

Node tape_frame_infinite(const Tape *tape, const NodeValue *values)
{
    for (size_t i = tape->frame_count; i < tape->count; i++) {
        const Expr *e = &tape->graph->items[tape->nodes[i]];
        for (int k = 0; k < e->operand_count; k++)
            if (tape->graph->items[e->operands[k]].time != TIME_POINT &&
                !node_value_is_finite(tape->graph, e->operands[k], values))
                return e->operands[k];
    }
    return NODE_NONE;
}

void tape_run_point(const Tape *tape, const double point[3], NodeValue *values)
{
    tape_run_surface(tape, point, (double[3]){0, 0, 0}, 0, values);
}

void tape_run_surface(const Tape *tape, const double point[3], const double normal[3],
                      double footprint, NodeValue *values)
{
    Inputs inputs = {.point = point, .normal = normal, .footprint = footprint};
    for (size_t i = tape->frame_count; i < tape->count; i++) {
        Node        node = tape->nodes[i];
        const Expr *e    = &tape->graph->items[node];
        if (e->operand_count == 0)
            values[node] = leaf_value(e, &inputs);
        else if (e->op == OP_guard)
            i += run_guard(tape, i, values);
        else
            tape_run_node(tape->graph, node, values);
    }
}
