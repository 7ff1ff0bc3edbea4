/*
 * similarity.c: maps that keep shapes: x -> scale * R * x + shift.
 *
 * Scale, rows of R and shift are frame-time nodes, so a parameter can turn or move a shape; for
 * constants the graph folds everything away.  R is orthonormal by construction, which is why
 * distances need no bound: they are multiplied by the scale.
 */
#include "compiler/geometry/elaborate.h"

#include <math.h>

static const double ZERO[3] = {0, 0, 0};

static Node unit_axis(Graph *graph, int axis)
{
    return graph_vec3(graph, axis == 0, axis == 1, axis == 2);
}

static Similarity *similarity_new(Elaboration *e)
{
    Similarity *map = arena_new(e->arena, Similarity);
    map->scale      = graph_number(e->graph, 1);
    for (int i = 0; i < 3; i++)
        map->rows[i] = unit_axis(e->graph, i);
    map->shift = graph_constant(e->graph, TYPE_VEC3, ZERO);
    return map;
}

const Similarity *similarity_identity(Elaboration *e) { return similarity_new(e); }

const Similarity *similarity_translation(Elaboration *e, Node shift)
{
    Similarity *map = similarity_new(e);
    map->shift      = shift;
    return map;
}

const Similarity *similarity_scaling(Elaboration *e, Node scale)
{
    Similarity *map = similarity_new(e);
    map->scale      = scale;
    return map;
}

/* Rodrigues: R = cos I + (1 - cos) a a^T + sin [a]x, row by row. */
static void rotation_rows(Elaboration *e, Node axis, Node cosine, Node sine, Node rows[3])
{
    Graph *g     = e->graph;
    Node   one   = graph_number(g, 1);
    Node   versine = graph_op2(g, OP_sub, one, cosine);
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

const Similarity *similarity_rotation(Elaboration *e, Node axis, Node angle)
{
    Similarity *map = similarity_new(e);
    Node unit   = graph_op1(e->graph, OP_normalize, axis);
    Node cosine = snap(e->graph, graph_op1(e->graph, OP_cos, angle));
    Node sine   = snap(e->graph, graph_op1(e->graph, OP_sin, angle));
    rotation_rows(e, unit, cosine, sine, map->rows);
    return map;
}

/* The reflection x - 2 (u.x - w) u. */
const Similarity *similarity_reflection(Elaboration *e, Node normal, Node offset)
{
    Graph      *g   = e->graph;
    Similarity *map = similarity_new(e);
    Node        two = graph_number(g, 2);
    for (int i = 0; i < 3; i++) {
        Node entry  = graph_component(g, normal, (uint32_t)i);
        Node factor = graph_op2(g, OP_mul, entry, two);
        Node outer  = graph_op2(g, OP_scale, normal, factor);
        Node unit   = unit_axis(g, i);
        map->rows[i] = graph_op2(g, OP_sub, unit, outer);
    }
    Node twice = graph_op2(g, OP_mul, offset, two);
    map->shift = graph_op2(g, OP_scale, normal, twice);
    return map;
}

/*
 * The turn that takes one direction to another, by two reflections: first in the plane between
 * from and from+to, which maps from to -to, then in the plane perpendicular to `to`.  Opposite
 * directions leave the first plane undefined: then any perpendicular axis serves.
 */
const Similarity *similarity_alignment(Elaboration *e, Node from, Node to)
{
    Graph *g    = e->graph;
    Node   a    = graph_op1(g, OP_normalize, from);
    Node   b    = graph_op1(g, OP_normalize, to);
    Node   sum  = graph_op2(g, OP_add, a, b);
    Node   size = graph_op1(g, OP_length, sum);
    /* Perpendicular to a: a x (the axis in which a is least). */
    Node ax = graph_component(g, a, 0), small = graph_number(g, 0.8);
    ax             = graph_op1(g, OP_abs, ax);
    Node along_x   = graph_op2(g, OP_less, ax, small);
    Node other     = unit_axis(g, 0), third = unit_axis(g, 1);
    other          = graph_op3(g, OP_select, along_x, other, third);
    Node aside     = graph_op2(g, OP_cross, a, other);
    Node tiny      = graph_number(g, 1e-9);
    Node opposite  = graph_op2(g, OP_less, size, tiny);
    Node bisector  = graph_op3(g, OP_select, opposite, aside, sum);
    bisector       = graph_op1(g, OP_normalize, bisector);
    Node zero      = graph_number(g, 0);
    const Similarity *first  = similarity_reflection(e, bisector, zero);
    /* The first takes a to -b; when they are opposite it leaves a, which is -b, where it is. */
    Node turned              = similarity_turn(e, first, a);
    Node way                 = graph_op2(g, OP_sub, turned, b);
    Node way_size            = graph_op1(g, OP_length, way);
    Node still               = graph_op2(g, OP_less, way_size, tiny);
    Node mirror              = graph_op3(g, OP_select, still, bisector, way);
    mirror                   = graph_op1(g, OP_normalize, mirror);
    const Similarity *second = similarity_reflection(e, mirror, zero);
    return similarity_product(e, second, first);
}

Node similarity_turn(Elaboration *e, const Similarity *f, Node vector)
{
    return graph_op4(e->graph, OP_turn, vector, f->rows[0], f->rows[1], f->rows[2]);
}

/* Row i of a product A B is the sum over j of A_ij times row j of B. */
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

const Similarity *similarity_product(Elaboration *e, const Similarity *f, const Similarity *g)
{
    Graph      *graph = e->graph;
    Similarity *map   = similarity_new(e);
    map->scale        = graph_op2(graph, OP_mul, f->scale, g->scale);
    for (int i = 0; i < 3; i++)
        map->rows[i] = product_row(graph, f->rows[i], g->rows);
    Node turned = similarity_turn(e, f, g->shift);
    turned      = graph_op2(graph, OP_scale, turned, f->scale);
    map->shift  = graph_op2(graph, OP_add, turned, f->shift);
    return map;
}

void transpose_rows(Graph *graph, const Node rows[3], Node transposed[3])
{
    for (uint32_t i = 0; i < 3; i++) {
        Node x        = graph_component(graph, rows[0], i);
        Node y        = graph_component(graph, rows[1], i);
        Node z        = graph_component(graph, rows[2], i);
        transposed[i] = graph_op3(graph, OP_vec3, x, y, z);
    }
}

const Similarity *similarity_inverse(Elaboration *e, const Similarity *f)
{
    Graph      *g   = e->graph;
    Similarity *map = similarity_new(e);
    Node        one = graph_number(g, 1);
    map->scale      = graph_op2(g, OP_div, one, f->scale);
    transpose_rows(g, f->rows, map->rows);
    Node back   = similarity_turn(e, map, f->shift);
    Node factor = graph_op1(g, OP_neg, map->scale);
    map->shift  = graph_op2(g, OP_scale, back, factor);
    return map;
}

/* Entries of an orthonormal matrix never leave [-1, 1], whatever their range was derived as. */
static Range cosine_range(Range range)
{
    return (Range){fmax(-1, fmin(range.low, 1)), fmin(1, fmax(range.high, -1))};
}

Box similarity_box(Elaboration *e, const Similarity *f, Box box)
{
    Range rows[3][3], shift[3], scale = node_range(e, f->scale, 0);
    for (uint32_t i = 0; i < 3; i++) {
        for (uint32_t j = 0; j < 3; j++)
            rows[i][j] = range_mul(scale, cosine_range(node_range(e, f->rows[i], j)));
        shift[i] = node_range(e, f->shift, i);
    }
    return box_move(box_turn(box, rows), shift);
}
