/*
 * primitive.c: shapes that hold no others: their distance at a point, and, where a gradient
 * is wanted, a plane that has it.
 */
#include "compiler/family/family.h"

#include "compiler/graph/symbolic/derive.h"
#include "compiler/lower/context.h"

/* ---- how it is made ---- */

Shape *primitive_new(ShapeBuilder *builder, const char *name, Node distance, Box box, Span span)
{
    Shape *primitive    = shape_new(builder, SHAPE_PRIMITIVE, name, span, NULL, 0);
    primitive->distance = primitive->declared = distance;
    primitive->box                            = box;
    primitive->exact                          = false;
    primitive->without_uv                     = primitive;
    return primitive;
}

void claim_slope(ShapeBuilder *builder, Shape *primitive, double slope)
{
    double derived     = slope > 1 ? slope_everywhere(builder, primitive->declared) : HUGE_VAL;
    primitive->claimed = !(derived < slope);
    primitive->derived = primitive->claimed ? slope : derived;
    if (!primitive->claimed)
        own_field_facts(builder, primitive)->region = box_infinite;
    primitive->distance = divide_by_slope(builder->graph, primitive->declared, primitive->derived);
}

bool derive_slope(ShapeBuilder *builder, Shape *primitive, Span distance, Blame *blame)
{
    Box       regions[2] = {box_infinite, primitive->box};
    int       count      = box_is_finite(primitive->box) ? 2 : 1;
    Steepness slope;
    bool      bounded = find_slope(builder, primitive->declared, regions, count, distance, &slope);
    *blame            = slope.blame;
    if (!bounded)
        return false;
    primitive->derived                          = slope.bound;
    own_field_facts(builder, primitive)->region = slope.region;
    primitive->per_frame                        = slope.slot != NODE_NONE;
    primitive->distance = extend_from_region(builder, primitive->declared, &slope);
    return true;
}

const Shape *make_empty(ShapeBuilder *builder, Span span)
{
    return shape_new(builder, SHAPE_EMPTY, "nothing", span, NULL, 0);
}

/* ---- how it is lowered ---- */

/* Returns a number with this value and this gradient: with n and the rest w held constant, dot(n,
   q) + w changes with the point q as a plane does. */
static Node with_gradient(Lowering *l, Node value, Node n, Node point)
{
    Graph *g     = l->graph;
    Node   along = graph_op2(g, OP_dot, n, point);
    Node   w     = graph_op2(g, OP_sub, value, along);
    array_push(l->scratch, l->held_constant, n);
    array_push(l->scratch, l->held_constant, w);
    return graph_op2(g, OP_add, along, w);
}

/* Returns the gradient by the formula f: the bound by which it is marched costs many times as
   much.  NODE_NONE: the formula has no derivative. */
static Node tangent_by_formula(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph       *g    = l->graph;
    Substitution with = substitute_point(context.point);
    Node         gradient;
    if (graph_gradient(g, shape->formula, &gradient, NULL, l->scratch) == DERIVED_NOT)
        return NODE_NONE;
    gradient   = graph_substitute(g, gradient, with, l->scratch);
    Node f     = graph_substitute(g, shape->formula, with, l->scratch);
    Node n     = graph_op1(g, OP_normalize, gradient);
    Node steep = graph_op1(g, OP_length, gradient);
    steep      = graph_op2(g, OP_max, steep, graph_number(g, 1e-30));
    return with_gradient(l, graph_op2(g, OP_div, f, steep), n, context.point);
}

/* Tells whether a distance is the length of a vector that vanishes at the surface, with a sign: rounding
   decides which way that vector points. */
static bool is_signed_length(const Graph *g, Node distance)
{
    const Expr *e = &g->items[distance];
    for (int i = 0; e->op == OP_mul && i < 2; i++) {
        Op size = (Op)g->items[e->operands[i]].op;
        if ((size == OP_sqrt || size == OP_length) && !graph_is_constant(g, e->operands[1 - i]))
            return true;
    }
    return false;
}

/* Returns the gradient by differences at a thousandth of the coordinates to each side. */
static Node tangent_by_differences(Lowering *l, const Shape *shape, LowerContext context,
                                   Node distance)
{
    Graph *g    = l->graph;
    Node   size = graph_op1(g, OP_abs, context.point), sides[3], seen[2];
    for (uint32_t i = 0; i < 3; i++)
        sides[i] = graph_component(g, size, i);
    Node step = graph_op2(g, OP_max, sides[0], sides[1]);
    step      = graph_op2(g, OP_max, step, sides[2]);
    step      = graph_op2(g, OP_add, step, graph_number(g, 0.1));
    step      = graph_op2(g, OP_mul, step, graph_number(g, 1e-3));
    for (uint32_t i = 0; i < 3; i++) {
        Node axis   = graph_vec3(g, i == 0, i == 1, i == 2);
        Node offset = graph_op2(g, OP_scale, axis, step);
        for (int side = 0; side < 2; side++) {
            Node point = graph_op2(g, side ? OP_sub : OP_add, context.point, offset);
            seen[side] = graph_substitute(g, shape->distance, substitute_point(point), l->scratch);
        }
        sides[i] = graph_op2(g, OP_sub, seen[0], seen[1]);
    }
    Node n = graph_op1(g, OP_normalize, graph_op(g, OP_vec3, sides));
    return with_gradient(l, distance, n, context.point);
}

Lowered lower_primitive(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph       *g    = l->graph;
    Substitution with = substitute_point(context.point);
    Lowered      leaf = lowered_nothing;
    if (l->held_constant && shape->formula != NODE_NONE && !context.lipschitz)
        leaf.distance = tangent_by_formula(l, shape, context);
    if (shape->outline && (l->groups || l->far) && context.reach > 0)
        leaf.distance = lower_outline_distance(l, shape, context);
    if (leaf.distance == NODE_NONE)
        leaf.distance = graph_substitute(g, shape->distance, with, l->scratch);
    if (l->held_constant && is_signed_length(g, shape->distance))
        leaf.distance = tangent_by_differences(l, shape, context, leaf.distance);
    if (l->held_constant)
        return leaf;
    if (shape->bound != NODE_NONE && !context.lipschitz) {
        Node bound    = graph_substitute(g, shape->bound, with, l->scratch);
        leaf.distance = graph_op2(g, OP_max, leaf.distance, bound);
    }
    if (l->surfaces) {
        leaf.surface.level    = context.level == NODE_NONE ? graph_number(g, 0) : context.level;
        leaf.surface.instance = context.instance == NODE_NONE ? graph_uint(g, 1) : context.instance;
        leaf.surface.normal   = context.normal;
        if (shape->uv != NODE_NONE)
            leaf.surface.uv = graph_substitute(g, shape->uv, with, l->scratch);
        if (shape->trap != NODE_NONE)
            leaf.surface.trap = graph_substitute(g, shape->trap, with, l->scratch);
    }
    return leaf;
}

Lowered lower_empty(Lowering *l, const Shape *shape, LowerContext context)
{
    (void)l;
    (void)shape;
    (void)context;
    return lowered_nothing;
}
