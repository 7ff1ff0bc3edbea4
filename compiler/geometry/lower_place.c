/*
 * lower_place.c: shapes that are moved, turned, scaled, stretched, mirrored or elongated: the point
 * is taken back to where it was before.
 */
#include "compiler/geometry/lowering.h"

/* R^T (point - shift) / scale: where the point was before the map. */
Node before_map(Graph *g, const Map *map, Node point)
{
    Node rows[3];
    transpose_rows(g, map->rows, rows);
    Node moved  = graph_op2(g, OP_sub, point, map->shift);
    Node turned = moved;
    Node e0 = graph_vec3(g, 1, 0, 0), e1 = graph_vec3(g, 0, 1, 0), e2 = graph_vec3(g, 0, 0, 1);
    if (rows[0] != e0 || rows[1] != e1 || rows[2] != e2)
        turned = graph_op4(g, OP_turn, moved, rows[0], rows[1], rows[2]);
    Node one = graph_number(g, 1);
    if (map->scale == one)
        return turned;
    Node factor = graph_op2(g, OP_div, one, map->scale);
    return graph_op2(g, OP_scale, turned, factor);
}

Lowered scale_distance(Lowering *l, Lowered result, Node factor)
{
    if (result.distance != NODE_NONE && factor != graph_number(l->graph, 1))
        result.distance = graph_op2(l->graph, OP_mul, result.distance, factor);
    return result;
}

Lowered lower_behind(Lowering *l, const Shape *child, LowerContext context, const NormalPath *path,
                     Node point)
{
    Lowered result        = lower_shape(l, child, context_behind(path, context, point));
    result.surface.normal = normal_out(l, path, result.surface.normal);
    return result;
}

Node enter_scale(Lowering *l, Node scale)
{
    Node unit = l->unit;
    if (l->guarded)
        l->unit = graph_op2(l->graph, OP_mul, unit, scale);
    return unit;
}

Lowered lower_transform(Lowering *l, const Shape *shape, LowerContext context)
{
    NormalPath path  = normal_path(l, context, 1);
    Node       point = before_map(l->graph, &shape->map, context.point);
    normal_turn(l, &path, shape->map.rows, shape->map.scale);
    Node    unit   = enter_scale(l, shape->map.scale);
    Lowered result = lower_behind(l, shape->children[0], context, &path, point);
    l->unit        = unit;
    return scale_distance(l, result, shape->map.scale);
}

Lowered lower_stretch(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph *g = l->graph;
    Node   x = graph_component(g, shape->values[0], 0), y = graph_component(g, shape->values[0], 1);
    Node   z         = graph_component(g, shape->values[0], 2);
    Node   least     = graph_op2(g, OP_min, x, y);
    least            = graph_op2(g, OP_min, least, z);
    Node       point = graph_op2(g, OP_div, context.point, shape->values[0]);
    NormalPath path  = normal_path(l, context, 1);
    normal_stretch(l, &path, shape->values[0], least);
    Node    unit   = enter_scale(l, least);
    Lowered result = lower_behind(l, shape->children[0], context, &path, point);
    l->unit        = unit;
    return scale_distance(l, result, least);
}

Lowered lower_mirror(Lowering *l, const Shape *shape, LowerContext context)
{
    NormalPath path = normal_path(l, context, 1);
    normal_fold(l, &path, context.point, shape->values[0], shape->values[1]);
    Node point = graph_op3(l->graph, OP_fold, context.point, shape->values[0], shape->values[1]);
    return lower_behind(l, shape->children[0], context, &path, point);
}

/* The last of a chain counts, as with paint. */
Lowered lower_smooth(Lowering *l, const Shape *shape, LowerContext context)
{
    if (l->surfaces && context.smoothing == NODE_NONE)
        context.smoothing = shape->values[0] != NODE_NONE
                                ? shape->values[0]
                                : graph_op2(l->graph, OP_add, context.footprint, context.footprint);
    return lower_shape(l, shape->children[0], context);
}

Lowered lower_elongate(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph *g      = l->graph;
    Node   low    = graph_op1(g, OP_neg, shape->values[0]);
    Node   inside = graph_op3(g, OP_clamp, context.point, low, shape->values[0]);
    Node   point  = graph_op2(g, OP_sub, context.point, inside);
    return lower_shape(l, shape->children[0], context_at(context, point));
}
