/*
 * figure.c: plane figures made solid, by extrusion and by revolution.
 */
#include "compiler/family/family.h"

#include <math.h>

#include "compiler/lower/boundary.h"
#include "compiler/lower/normal.h"

/* ---- how it is made ---- */

const Shape *make_extrude(ShapeBuilder *builder, const Shape *figure, Node height, Span span)
{
    Graph *g         = builder->graph;
    Shape *solid     = shape_around(builder, SHAPE_EXTRUDE, "extrude", figure, span);
    Node   half      = graph_number(g, 0.5);
    solid->values[0] = graph_op2(g, OP_mul, height, half);
    solid->box       = builder_box(builder, solid);
    solid->figure    = false;
    return solid;
}

const Shape *make_revolve(ShapeBuilder *builder, const Shape *figure, Node offset, Span span)
{
    Shape *solid     = shape_around(builder, SHAPE_REVOLVE, "revolve", figure, span);
    solid->values[0] = offset;
    solid->figure    = false;
    Range x          = range_add(figure->box.axis[0], node_range(builder, offset, 0));
    /* The axis cuts a figure that crosses it: the distance inside the cut is only a bound. */
    solid->exact = figure->exact && x.low >= 0;
    solid->box   = builder_box(builder, solid);
    double number;
    if (graph_known_component(builder->graph, offset, 0, &number))
        solid->boundary = boundary_about(builder->arena, -number);
    return solid;
}

/* ---- how it is lowered ---- */

Lowered lower_extrude(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph  *g = l->graph;
    Node    x = graph_component(g, context.point, 0), y = graph_component(g, context.point, 1);
    Node    zero   = graph_number(g, 0);
    Node    flat   = graph_op3(g, OP_vec3, x, y, zero);
    Lowered result = lower_shape(l, shape->children[0], context_at(context, flat));
    if (result.distance == NODE_NONE)
        return result;
    Node height     = graph_component(g, context.point, 2);
    height          = graph_op1(g, OP_abs, height);
    height          = graph_op2(g, OP_sub, height, shape->values[0]);
    Node inside     = graph_op2(g, OP_max, result.distance, height);
    inside          = graph_op2(g, OP_min, inside, zero);
    Node across     = graph_op2(g, OP_max, result.distance, zero);
    Node along      = graph_op2(g, OP_max, height, zero);
    Node outside    = graph_op2(g, OP_vec2, across, along);
    outside         = graph_op1(g, OP_length, outside);
    result.distance = graph_op2(g, OP_add, inside, outside);
    return result;
}

/* Returns the point of the figure's plane that comes to a point. */
static Node point_before_revolving(Graph *g, const Shape *shape, Node point)
{
    Node x = graph_component(g, point, 0), y = graph_component(g, point, 1);
    Node z      = graph_component(g, point, 2);
    Node axis   = graph_op2(g, OP_vec2, x, z);
    Node offset = graph_op1(g, OP_length, axis);
    offset      = graph_op2(g, OP_sub, offset, shape->values[0]);
    Node zero   = graph_number(g, 0);
    return graph_op3(g, OP_vec3, offset, y, zero);
}

static Lowered revolve_figure(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph     *g    = l->graph;
    Node       flat = point_before_revolving(g, shape, context.point);
    NormalPath path = normal_path(l, context, 1);
    normal_rotate_about_y(l, &path, context.point, graph_vec3(g, 1, 0, 0));
    return lower_behind(l, shape->children[0], context, &path, flat);
}

Lowered lower_revolve(Lowering *l, const Shape *shape, LowerContext context)
{
    Node flat = point_before_revolving(l->graph, shape, context.point);
    return lower_within_boundary(l, shape, context, flat, revolve_figure);
}
