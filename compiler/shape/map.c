/*
 * map.c: maps of space: those that keep shapes, x -> scale * R * x + shift, and what all have in
 * common; moebius.c has those that invert.
 *
 * Scale, rows of R and shift are frame-time nodes, so a parameter can rotate or move a shape; for
 * constants the graph folds everything away.  R is orthonormal by construction, which is why
 * distances need no bound: they are multiplied by the scale.
 */
#include "compiler/shape/map.h"

#include <math.h>

static const double ZERO[3] = {0, 0, 0};

static Node unit_axis(Graph *graph, int axis)
{
    return graph_vec3(graph, axis == 0, axis == 1, axis == 2);
}

Map *map_new(ShapeBuilder *builder)
{
    Map *map   = arena_new(builder->arena, Map);
    map->scale = graph_number(builder->graph, 1);
    for (int i = 0; i < 3; i++)
        map->rows[i] = unit_axis(builder->graph, i);
    map->shift = graph_constant(builder->graph, TYPE_VEC3, ZERO);
    map->pole  = NODE_NONE;
    return map;
}

const Map *map_identity(ShapeBuilder *builder) { return map_new(builder); }

const Map *map_translation(ShapeBuilder *builder, Node shift)
{
    Map *map   = map_new(builder);
    map->shift = shift;
    return map;
}

const Map *map_scaling(ShapeBuilder *builder, Node scale)
{
    Map *map   = map_new(builder);
    map->scale = scale;
    return map;
}

/* Rodrigues: R = cos I + (1 - cos) a a^T + sin [a]x, row by row. */
static void rotation_rows(Graph *g, Node axis, Node cosine, Node sine, Node rows[3])
{
    Node one     = graph_number(g, 1);
    Node versine = graph_op2(g, OP_sub, one, cosine);
    for (int i = 0; i < 3; i++) {
        Node unit     = unit_axis(g, i);
        Node diagonal = graph_op2(g, OP_scale, unit, cosine);
        Node along    = graph_component(g, axis, (uint32_t)i);
        along         = graph_op2(g, OP_mul, along, versine);
        Node outer    = graph_op2(g, OP_scale, axis, along);
        /* Row i of [a]x is e_i x a, for (a x v)_i = e_i.(a x v) = (e_i x a).v */
        Node cross = graph_op2(g, OP_cross, unit, axis);
        cross      = graph_op2(g, OP_scale, cross, sine);
        Node sum   = graph_op2(g, OP_add, diagonal, outer);
        rows[i]    = graph_op2(g, OP_add, sum, cross);
    }
}

/* A quarter turn's cosine is 0, not what is left of the rounding of pi / 2. */
static Node snap(Graph *g, Node node)
{
    if (!graph_is_constant(g, node))
        return node;
    double number = g->items[node].number[0], nearest = round(number);
    return fabs(number - nearest) < 4e-16 ? graph_number(g, nearest) : node;
}

static void rotate(Graph *g, Node axis, Node angle, Node rows[3])
{
    Node unit   = graph_op1(g, OP_normalize, axis);
    Node cosine = snap(g, graph_op1(g, OP_cos, angle));
    Node sine   = snap(g, graph_op1(g, OP_sin, angle));
    rotation_rows(g, unit, cosine, sine, rows);
}

static bool is_known(const Graph *graph, Node node) { return graph->items[node].op == OP_CONSTANT; }

/* Finds rows that are known in a graph of their own: nothing needs what leads to them.  False: the
   axis or the angle depends on the frame. */
static bool rotate_known(ShapeBuilder *builder, Node axis, Node angle, Node rows[3])
{
    Graph *graph = builder->graph, *steps;
    if (!is_known(graph, axis) || !is_known(graph, angle))
        return false;
    steps = graph_new(builder->scratch);
    axis  = graph_copy_leaf(steps, &graph->items[axis]);
    angle = graph_copy_leaf(steps, &graph->items[angle]);
    rotate(steps, axis, angle, rows);
    if (!is_known(steps, rows[0]) || !is_known(steps, rows[1]) || !is_known(steps, rows[2]))
        return false; /* not finite */
    for (int i = 0; i < 3; i++)
        rows[i] = graph_copy_leaf(graph, &steps->items[rows[i]]);
    return true;
}

const Map *map_rotation(ShapeBuilder *builder, Node axis, Node angle)
{
    Map *map = map_new(builder);
    if (!rotate_known(builder, axis, angle, map->rows))
        rotate(builder->graph, axis, angle, map->rows);
    return map;
}

/* Returns the reflection x - 2 (u.x - w) u. */
const Map *map_reflection(ShapeBuilder *builder, Node normal, Node offset)
{
    Graph *g   = builder->graph;
    Map   *map = map_new(builder);
    Node   two = graph_number(g, 2);
    for (int i = 0; i < 3; i++) {
        Node entry   = graph_component(g, normal, (uint32_t)i);
        Node factor  = graph_op2(g, OP_mul, entry, two);
        Node outer   = graph_op2(g, OP_scale, normal, factor);
        Node unit    = unit_axis(g, i);
        map->rows[i] = graph_op2(g, OP_sub, unit, outer);
    }
    Node twice = graph_op2(g, OP_mul, offset, two);
    map->shift = graph_op2(g, OP_scale, normal, twice);
    return map;
}

/*
 * Returns the rotation that takes one direction to another, by two reflections: first in the plane
 * between from and from+to, which maps from to -to, then in the plane perpendicular to `to`.
 * Opposite directions leave the first plane undefined: then any perpendicular axis serves.
 */
const Map *map_alignment(ShapeBuilder *builder, Node from, Node to)
{
    Graph *g    = builder->graph;
    Node   a    = graph_op1(g, OP_normalize, from);
    Node   b    = graph_op1(g, OP_normalize, to);
    Node   sum  = graph_op2(g, OP_add, a, b);
    Node   size = graph_op1(g, OP_length, sum);
    /* Perpendicular to a: a x (the axis in which a is least). */
    Node ax = graph_component(g, a, 0), small = graph_number(g, 0.8);
    ax           = graph_op1(g, OP_abs, ax);
    Node along_x = graph_op2(g, OP_less, ax, small);
    Node other = unit_axis(g, 0), third = unit_axis(g, 1);
    other              = graph_op3(g, OP_select, along_x, other, third);
    Node perpendicular = graph_op2(g, OP_cross, a, other);
    Node tiny          = graph_number(g, 1e-9);
    Node opposite      = graph_op2(g, OP_less, size, tiny);
    Node bisector      = graph_op3(g, OP_select, opposite, perpendicular, sum);
    bisector           = graph_op1(g, OP_normalize, bisector);
    Node       zero    = graph_number(g, 0);
    const Map *first   = map_reflection(builder, bisector, zero);
    /* The first takes a to -b; when they are opposite it leaves a, which is -b, where it is. */
    Node rotated         = map_rotate(builder, first, a);
    Node difference      = graph_op2(g, OP_sub, rotated, b);
    Node difference_size = graph_op1(g, OP_length, difference);
    Node coincide        = graph_op2(g, OP_less, difference_size, tiny);
    Node mirror          = graph_op3(g, OP_select, coincide, bisector, difference);
    mirror               = graph_op1(g, OP_normalize, mirror);
    const Map *second    = map_reflection(builder, mirror, zero);
    return map_product(builder, second, first);
}

Node map_rotate(ShapeBuilder *builder, const Map *f, Node vector)
{
    return graph_op4(builder->graph, OP_rotate, vector, f->rows[0], f->rows[1], f->rows[2]);
}

Node map_apply(ShapeBuilder *builder, const Map *f, Node point)
{
    Graph *g     = builder->graph;
    Node   scale = f->scale;
    if (f->pole != NODE_NONE) {
        point       = graph_op2(g, OP_sub, point, f->pole);
        Node square = graph_op2(g, OP_dot, point, point);
        scale       = graph_op2(g, OP_div, scale, square);
    }
    Node rotated = map_rotate(builder, f, point);
    rotated      = graph_op2(g, OP_scale, rotated, scale);
    return graph_op2(g, OP_add, rotated, f->shift);
}

/* ---- products and inverses ---- */

/* Returns row i of a product A B: the sum over j of A_ij times row j of B. */
static Node product_row(Graph *g, Node row, const Node rows[3])
{
    Node sum = NODE_NONE;
    for (uint32_t j = 0; j < 3; j++) {
        Node entry = graph_component(g, row, j);
        Node term  = graph_op2(g, OP_scale, rows[j], entry);
        sum        = j == 0 ? term : graph_op2(g, OP_add, sum, term);
    }
    return sum;
}

void rotate_product(ShapeBuilder *builder, const Node a[3], const Node b[3], Node product[3])
{
    for (int i = 0; i < 3; i++)
        product[i] = product_row(builder->graph, a[i], b);
}

static const Map *similarity_product(ShapeBuilder *builder, const Map *f, const Map *g)
{
    Map *map   = map_new(builder);
    map->scale = graph_op2(builder->graph, OP_mul, f->scale, g->scale);
    rotate_product(builder, f->rows, g->rows, map->rows);
    map->shift = map_apply(builder, f, g->shift);
    return map;
}

static bool is_identity(ShapeBuilder *builder, const Map *map)
{
    bool identity = map->pole == NODE_NONE && map->scale == graph_number(builder->graph, 1) &&
                    map->shift == graph_constant(builder->graph, TYPE_VEC3, ZERO);
    for (int i = 0; i < 3; i++)
        identity = identity && map->rows[i] == unit_axis(builder->graph, i);
    return identity;
}

/* Returns f(g(x)), f without maps before it: what can be one map becomes one. */
static const Map *prepend(ShapeBuilder *builder, const Map *f, const Map *g)
{
    if (is_identity(builder, f))
        return g;
    bool       plain  = f->pole == NODE_NONE && g->pole == NODE_NONE;
    const Map *joined = plain ? similarity_product(builder, f, g) : moebius_product(builder, f, g);
    if (joined)
        return g->first ? prepend(builder, joined, g->first) : joined;
    Map *chain   = arena_new(builder->arena, Map);
    *chain       = *f;
    chain->first = g;
    return chain;
}

const Map *map_product(ShapeBuilder *builder, const Map *f, const Map *g)
{
    return prepend(builder, f, f->first ? map_product(builder, f->first, g) : g);
}

static bool is_unit_axis(const Graph *graph, Node row, int axis)
{
    const double *entries = graph->items[row].number;
    return is_known(graph, row) && entries[0] == (axis == 0) && entries[1] == (axis == 1) &&
           entries[2] == (axis == 2);
}

static bool rotates_nothing(const Graph *graph, const Node rows[3])
{
    return is_unit_axis(graph, rows[0], 0) && is_unit_axis(graph, rows[1], 1) &&
           is_unit_axis(graph, rows[2], 2);
}

void transpose_rows(Graph *graph, const Node rows[3], Node transposed[3])
{
    if (rotates_nothing(graph, rows)) {
        for (int i = 0; i < 3; i++)
            transposed[i] = rows[i];
        return;
    }
    for (uint32_t i = 0; i < 3; i++) {
        Node x        = graph_component(graph, rows[0], i);
        Node y        = graph_component(graph, rows[1], i);
        Node z        = graph_component(graph, rows[2], i);
        transposed[i] = graph_op3(graph, OP_vec3, x, y, z);
    }
}

static const Map *similarity_inverse(ShapeBuilder *builder, const Map *f)
{
    Graph *g   = builder->graph;
    Map   *map = map_new(builder);
    Node   one = graph_number(g, 1);
    map->scale = graph_op2(g, OP_div, one, f->scale);
    transpose_rows(g, f->rows, map->rows);
    Node back   = map_rotate(builder, map, f->shift);
    Node factor = graph_op1(g, OP_neg, map->scale);
    map->shift  = graph_op2(g, OP_scale, back, factor);
    return map;
}

const Map *map_inverse(ShapeBuilder *builder, const Map *f)
{
    const Map *back = f->pole == NODE_NONE ? similarity_inverse(builder, f)
                                           : inversion_inverse(builder, f);
    return f->first ? map_product(builder, map_inverse(builder, f->first), back) : back;
}

/* ---- boxes ---- */

MapRange map_range(ShapeBuilder *builder, const Map *f)
{
    const BuilderNumbers all = builder_numbers(builder);
    return map_range_of(&all.numbers, f);
}

Box map_box(ShapeBuilder *builder, const Map *f, Box box)
{
    const MapRange range = map_range(builder, f);
    return map_box_of(&range, box);
}
