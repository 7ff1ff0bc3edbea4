/*
 * offset.c: shapes grown or shrunk by a distance, shells and open surfaces.
 */
#include "compiler/family/family.h"
#include "compiler/family/vary.h"

#include <math.h>

#include "compiler/graph/symbolic/derive.h"
#include "compiler/lower/join.h"

/* ---- how it is made ---- */

static Shape *new_offset(ShapeBuilder *builder, const Shape *shape, Node radius, Span span)
{
    Shape *offset     = shape_around(builder, SHAPE_OFFSET, "offset", shape, span);
    Range  range      = node_range(builder, radius, 0);
    offset->values[0] = radius;
    offset->reach     = fmax(fabs(range.low), fabs(range.high));
    offset->box       = builder_box(builder, offset);
    offset->exact     = shape->exact && range.low >= 0;
    check_lipschitz(builder, offset, "an offset", span);
    return offset;
}

const Shape *make_offset(ShapeBuilder *builder, const Shape *shape, Node radius, Span span)
{
    return new_offset(builder, shape, radius, span);
}

const Shape *make_rounded(ShapeBuilder *builder, const Shape *shape, const Shape *core, Node radius,
                          Span span)
{
    Shape *round   = new_offset(builder, core, radius, span);
    round->rounded = shape;
    return round;
}

const Shape *make_shell(ShapeBuilder *builder, const Shape *shape, Node thickness, Span span)
{
    Shape *shell     = shape_around(builder, SHAPE_SHELL, "shell", shape, span);
    shell->values[0] = thickness;
    shell->reach     = 0.5 * node_range(builder, thickness, 0).high;
    shell->box       = builder_box(builder, shell);
    check_lipschitz(builder, shell, "a shell", span);
    return shell;
}

/* Tells whether normals follow from derivatives: differences see both sides of an open surface. */
static bool is_derivable(ShapeBuilder *builder, const Shape *shape)
{
    Node gradient, number = shape->formula != NODE_NONE ? shape->formula : shape->distance;
    if (shape->kind == SHAPE_PRIMITIVE &&
        graph_gradient(builder->graph, number, &gradient, NULL, builder->scratch) == DERIVED_NOT)
        return false;
    for (uint32_t i = 0; i < shape->child_count; i++)
        if (!is_derivable(builder, shape->children[i]))
            return false;
    return true;
}

const Shape *make_open_surface(ShapeBuilder *builder, const Shape *shape, Node thickness, Span span)
{
    Shape *open_surface         = arena_new(builder->arena, Shape);
    *open_surface               = *make_shell(builder, shape, thickness, span);
    open_surface->name          = "open_surface";
    open_surface->open          = true;
    open_surface->open_surface  = is_derivable(builder, shape);
    open_surface->open_surfaces = open_surface->open_surfaces || open_surface->open_surface;
    return open_surface;
}

/* ---- how it is lowered ---- */

Lowered lower_offset(Lowering *l, const Shape *shape, LowerContext context)
{
    context        = context_lipschitz_within(context, shape->reach);
    Lowered result = lower_operand(l, shape->children[0], context);
    if (result.distance != NODE_NONE)
        result.distance = graph_op2(l->graph, OP_sub, result.distance, shape->values[0]);
    return result;
}

/* Makes an open surface, which is nowhere negative.  A gradient is that of the solid: it does not
   reverse at the open surface. */
static Lowered thin_open_surface(Lowering *l, Lowered solid)
{
    Graph *g    = l->graph;
    Node   size = graph_op1(g, OP_abs, solid.distance);
    if (l->held_constant) {
        Node more = graph_op2(g, OP_sub, size, solid.distance);
        array_push(l->scratch, l->held_constant, more);
        size = graph_op2(g, OP_add, solid.distance, more);
    }
    solid.distance = size;
    return solid;
}

/* Tells whether something that is computed of the surface asks for its side. */
static bool asks_front(Lowering *l, Node node)
{
    const Node front = graph_leaf(l->graph, OP_FRONT);
    return node != front && depends_on_leaf(l->graph, node, front, l->scratch);
}

static void replace_front(Lowering *l, Node *node, Node by)
{
    if (asks_front(l, *node))
        *node = graph_replace_leaf(l->graph, *node, graph_leaf(l->graph, OP_FRONT), by, l->scratch);
}

static bool surface_asks_front(Lowering *l, const Surface *surface)
{
    bool asks = false;
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    asks = asks || asks_front(l, surface->name);
#define KRS_INNER(name, blends) asks = asks || asks_front(l, surface->name);
#include "krs/surface.def"
    return asks;
}

/* Returns 0 where a number is negative, else 1. */
static Node is_positive(Graph *g, Node number)
{
    Node zero = graph_number(g, 0), one = graph_number(g, 1);
    return graph_op3(g, OP_select, graph_op2(g, OP_less, number, zero), zero, one);
}

/* Returns which side of an open surface without thickness is seen: the normal is on the side of the
   ray, the gradient of the solid on its outside.  The solid itself is 0 there, and its sign
   rounding. */
static Node front_of_thin(Lowering *l, const Shape *solid, LowerContext context)
{
    Graph   *g             = l->graph;
    Nodes    held_constant = {0};
    Lowering inner         = *l;
    inner.held_constant    = &held_constant;
    inner.lowered_shapes   = NULL;
    inner.surfaces         = false;
    Node    gradient;
    Lowered all = lower_shape(&inner, solid, context);
    if (all.distance == NODE_NONE || inner.overflow ||
        graph_gradient_of(g, all.distance, held_constant.items, held_constant.count, &gradient,
                          NULL, l->scratch) == DERIVED_NOT)
        return graph_number(g, 1); /* the whole is empty, or refused */
    return is_positive(g, graph_op2(g, OP_dot, gradient, graph_leaf(g, OP_NORMAL)));
}

/* The front of an open surface is where the solid has its outside. */
static void set_front(Lowering *l, const Shape *shape, LowerContext context, bool thin,
                      Lowered *solid)
{
    if (!shape->open || !l->surfaces || solid->distance == NODE_NONE ||
        !(context.fronts || surface_asks_front(l, &solid->surface)))
        return;
    Node front = thin ? front_of_thin(l, shape->children[0], context)
                      : is_positive(l->graph, solid->distance);
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    replace_front(l, &solid->surface.name, front);
#define KRS_INNER(name, blends) replace_front(l, &solid->surface.name, front);
#include "krs/surface.def"
    solid->surface.front = front;
}

Lowered lower_shell(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph *g       = l->graph;
    bool   thin    = l->thin && shape->open_surface;
    l->thin        = false;
    Lowered result = thin ? lower_shape(l, shape->children[0], context)
                          : lower_operand(l, shape->children[0],
                                          context_lipschitz_within(context, shape->reach));
    set_front(l, shape, context, thin, &result);
    if (result.distance == NODE_NONE || thin)
        return thin && result.distance != NODE_NONE ? thin_open_surface(l, result) : result;
    Node half       = graph_number(g, 0.5);
    half            = graph_op2(g, OP_mul, shape->values[0], half);
    Node size       = graph_op1(g, OP_abs, result.distance);
    result.distance = graph_op2(g, OP_sub, size, half);
    return result;
}
