/*
 * place.c: shapes that are moved, rotated, scaled, stretched, mirrored or elongated: the point
 * is taken back to where it was before.
 */
#include "compiler/family/family.h"

#include <math.h>

#include "compiler/lower/boundary.h"
#include "compiler/lower/map_chain.h"

/* ---- how it is made ---- */

bool check_invertible(ShapeBuilder *builder, const Shape *shape, Span span)
{
    if (box_is_finite(shape->box) || box_is_empty(shape->box))
        return true;
    Diag *diag  = diag_add(builder->diags, DIAG_ENDLESS_INVERTED, span,
                           "something endless cannot be inverted");
    diag->label = "an inversion";
    diag->help  = "cut it first, with `.within(sphere(10))`, say";
    diag_secondary(builder->diags, diag, shape->span, "this is endless");
    return false;
}

static const Shape *make_inversion(ShapeBuilder *builder, const Shape *shape, const Map *map,
                                   Span span)
{
    if (!check_invertible(builder, shape, span))
        return NULL;
    Shape   *inverted = shape_around(builder, SHAPE_INVERSION, "transform", shape, span);
    MapRange range    = map_range(builder, map);
    Cover    cover    = {0};
    cover_add(builder->arena, &cover, shape->box);
    cover_map(&cover, &range);
    inverted->map   = *map;
    inverted->exact = false;
    inverted->inversions++;
    inverted->box = cover_box(&cover);
    return inverted;
}

/* Transforms a shape by a map without `first`. */
static const Shape *transform_by(ShapeBuilder *builder, const Shape *shape, const Map *map,
                                 Span span)
{
    if (map->pole != NODE_NONE)
        return make_inversion(builder, shape, map, span);
    Shape *moved = shape_around(builder, SHAPE_TRANSFORM, "transform", shape, span);
    moved->map   = *map;
    moved->box   = builder_box(builder, moved);
    return moved;
}

const Shape *make_transform(ShapeBuilder *builder, const Shape *shape, const Map *map, Span span)
{
    if (map->first)
        shape = make_transform(builder, shape, map->first, span);
    if (!shape)
        return NULL;
    Map single   = *map;
    single.first = NULL;
    /* A chain of maps is one map, where it can be. */
    if (shape->kind == SHAPE_TRANSFORM || shape->kind == SHAPE_INVERSION) {
        const Map *product = map_product(builder, &single, &shape->map);
        if (!product->first)
            return shape_named(builder, transform_by(builder, shape->children[0], product, span),
                               shape->given);
    }
    return transform_by(builder, shape, &single, span);
}

const Shape *make_stretch(ShapeBuilder *builder, const Shape *shape, Node factors, Span span)
{
    Shape *stretched     = shape_around(builder, SHAPE_STRETCH, "scale", shape, span);
    stretched->values[0] = factors;
    stretched->exact     = false;
    stretched->box       = builder_box(builder, stretched);
    return stretched;
}

const Shape *make_mirror(ShapeBuilder *builder, const Shape *shape, Node normal, Node offset,
                         Span span)
{
    Shape *mirror     = shape_around(builder, SHAPE_MIRROR, "mirror", shape, span);
    mirror->values[0] = normal;
    mirror->values[1] = offset;
    mirror->exact     = false;
    mirror->box       = builder_box(builder, mirror);
    if (mirror->figure)
        mirror->boundary = boundary_new(builder->arena);
    return mirror;
}

const Shape *make_elongate(ShapeBuilder *builder, const Shape *shape, Node half, Span span)
{
    Shape *longer     = shape_around(builder, SHAPE_ELONGATE, "elongate", shape, span);
    longer->values[0] = half;
    longer->box       = builder_box(builder, longer);
    return longer;
}

bool shape_plane(ShapeBuilder *builder, const Shape *shape, Node *normal, Node *offset)
{
    Graph *g = builder->graph;
    if (shape->kind == SHAPE_PAINT)
        return shape_plane(builder, shape->children[0], normal, offset);
    if (shape->kind == SHAPE_PRIMITIVE && shape->plane_normal != NODE_NONE) {
        Node size = graph_op1(g, OP_length, shape->plane_normal);
        *normal   = graph_op1(g, OP_normalize, shape->plane_normal);
        *offset   = graph_op2(g, OP_div, shape->plane_offset, size);
        return true;
    }
    if (shape->kind != SHAPE_TRANSFORM || !shape_plane(builder, shape->children[0], normal, offset))
        return false;
    /* n.x <= w becomes (R n).y <= s w + (R n).t for y = s R x + t. */
    *normal      = map_rotate(builder, &shape->map, *normal);
    Node scaled  = graph_op2(g, OP_mul, *offset, shape->map.scale);
    Node shifted = graph_op2(g, OP_dot, *normal, shape->map.shift);
    *offset      = graph_op2(g, OP_add, scaled, shifted);
    return true;
}

bool shape_ball(ShapeBuilder *builder, const Shape *shape, Node *centre, Node *radius)
{
    Graph *g = builder->graph;
    if (shape->kind == SHAPE_PAINT)
        return shape_ball(builder, shape->children[0], centre, radius);
    if (shape->kind == SHAPE_PRIMITIVE && shape->ball_radius != NODE_NONE) {
        *centre = graph_vec3(g, 0, 0, 0);
        *radius = shape->ball_radius;
        return true;
    }
    if (shape->kind != SHAPE_TRANSFORM || !shape_ball(builder, shape->children[0], centre, radius))
        return false;
    *centre = map_apply(builder, &shape->map, *centre);
    *radius = graph_op2(g, OP_mul, *radius, shape->map.scale);
    return true;
}

/* ---- how it is lowered ---- */

Lowered lower_transform(Lowering *l, const Shape *shape, LowerContext context)
{
    NormalPath path  = normal_path(l, context, 1);
    Node       point = before_map(l->graph, &shape->map, context.point);
    normal_rotate(l, &path, shape->map.rows, shape->map.scale);
    context.reach  = reach_behind(l->graph, context.reach, shape->map.scale);
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
    context.reach  = reach_behind(g, context.reach, least);
    Node    unit   = enter_scale(l, least);
    Lowered result = lower_behind(l, shape->children[0], context, &path, point);
    l->unit        = unit;
    return scale_distance(l, result, least);
}

static Lowered mirror_by_part(Lowering *l, const Shape *shape, LowerContext context)
{
    NormalPath path = normal_path(l, context, 1);
    normal_fold(l, &path, context.point, shape->values[0], shape->values[1]);
    Node point = graph_op3(l->graph, OP_fold, context.point, shape->values[0], shape->values[1]);
    return lower_behind(l, shape->children[0], context, &path, point);
}

Lowered lower_mirror(Lowering *l, const Shape *shape, LowerContext context)
{
    return lower_within_boundary(l, shape, context, context.point, mirror_by_part);
}

Lowered lower_elongate(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph *g      = l->graph;
    Node   low    = graph_op1(g, OP_neg, shape->values[0]);
    Node   inside = graph_op3(g, OP_clamp, context.point, low, shape->values[0]);
    Node   point  = graph_op2(g, OP_sub, context.point, inside);
    return lower_shape(l, shape->children[0], context_at(context, point));
}

Lowered lower_inversion(Lowering *l, const Shape *shape, LowerContext context)
{
    NormalPath path  = normal_path(l, context, 2);
    MapChain   chain = map_chain_new(l->graph, context.point);
    Ball       ball  = ball_around(shape->children[0]->box);
    Node       hull  = map_chain_hull(l, &chain, &shape->map, &ball);
    map_chain_append(l, &chain, &shape->map, &path);
    context.reach  = context.reach > 0 ? HUGE_VAL : 0;
    Node    unit   = enter_map_chain(l, &chain);
    Lowered result = lower_behind(l, shape->children[0], context, &path, chain.point);
    l->unit        = unit;
    result         = map_chain_out(l, &chain, result);
    if (result.distance != NODE_NONE)
        result.distance = farther_of(l->graph, result.distance, hull);
    return result;
}
