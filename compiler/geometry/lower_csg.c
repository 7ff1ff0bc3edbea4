/*
 * lower_csg.c: joints of shapes: union, intersection, difference, xor, and morph; sharp or blended.
 */
#include "compiler/geometry/lowering.h"

static Node join_distances(Graph *g, Blend blend, Node a, Node b)
{
    if (blend.width == NODE_NONE)
        return graph_op2(g, OP_min, a, b);
    if (blend.kind == BLEND_STAIRS)
        return graph_op4(g, OP_smin_stairs, a, b, blend.width, blend.steps);
    return graph_op3(g, blend_info[blend.kind].op, a, b, blend.width);
}

/* The union of two distances, sharp or blended. */
Lowered join_two(Lowering *l, Blend blend, Lowered a, Lowered b)
{
    Graph *g = l->graph;
    if (a.distance == NODE_NONE)
        return b;
    if (b.distance == NODE_NONE)
        return a;
    Lowered joined  = lowered_nothing;
    joined.distance = join_distances(g, blend, a.distance, b.distance);
    if (!l->surfaces)
        return joined;
    Node nearer = graph_op2(g, OP_less, a.distance, b.distance);
    if (blend.width == NODE_NONE)
        joined.surface = choose_surface(g, nearer, a.surface, b.surface);
    else {
        Node weight    = graph_op3(g, OP_blend_weight, a.distance, b.distance, blend.width);
        joined.surface = mix_surface(g, nearer, weight, a.surface, b.surface);
    }
    return joined;
}

static Lowered complement(Lowering *l, Lowered a)
{
    if (a.distance != NODE_NONE)
        a.distance = graph_op1(l->graph, OP_neg, a.distance);
    return a;
}

LowerContext joint_context(const Shape *shape, LowerContext context)
{
    return shape->blend.width == NODE_NONE ? context : context_lipschitz(context);
}

/* What is only a bound may be small far from the shape; the distance to the sides of its box is a
   bound as well, and with it the points where it is r lie within r of the box, as the boxes of
   shapes.c say. */
Lowered lower_operand(Lowering *l, const Shape *shape, LowerContext context)
{
    Lowered result = lower_shape(l, shape, context_lipschitz(context));
    if (result.distance == NODE_NONE || shape->exact)
        return result;
    Node excess = sides_excess(l->graph, context.point, shape->box);
    if (excess != NODE_NONE)
        result.distance = graph_op2(l->graph, OP_max, result.distance, excess);
    return result;
}

static Lowered lower_joined(Lowering *l, const Shape *joint, const Shape *child,
                            LowerContext context)
{
    return joint->blend.width == NODE_NONE ? lower_shape(l, child, context)
                                           : lower_operand(l, child, context);
}

/* Joined in pairs, so that the graph stays shallow and a blend of many keeps its slope. */
static Lowered union_of(Lowering *l, const Shape *shape, const Shape *const *children,
                        uint32_t count, LowerContext context)
{
    if (count == 0)
        return lowered_nothing;
    if (count == 1)
        return lower_joined(l, shape, children[0], context);
    uint32_t half  = count / 2;
    Lowered  left  = union_of(l, shape, children, half, context);
    Lowered  right = union_of(l, shape, children + half, count - half, context);
    return join_two(l, shape->blend, left, right);
}

Lowered lower_union(Lowering *l, const Shape *shape, LowerContext context)
{
    return union_of(l, shape, shape->children, shape->child_count, context);
}

Lowered lower_intersection(Lowering *l, const Shape *shape, LowerContext context)
{
    /* The complement of the union of the complements. */
    Lowered all = lower_joined(l, shape, shape->children[0], context);
    for (uint32_t i = 1; i < shape->child_count; i++) {
        Lowered next = lower_joined(l, shape, shape->children[i], context);
        if (all.distance == NODE_NONE || next.distance == NODE_NONE)
            return lowered_nothing;
        Lowered joined = join_two(l, shape->blend, complement(l, all), complement(l, next));
        all            = complement(l, joined);
    }
    return all;
}

Lowered lower_difference(Lowering *l, const Shape *shape, LowerContext context)
{
    Lowered left  = lower_joined(l, shape, shape->children[0], context);
    Lowered right = union_of(l, shape, shape->children + 1, shape->child_count - 1, context);
    if (left.distance == NODE_NONE || right.distance == NODE_NONE)
        return left;
    Lowered joined = join_two(l, shape->blend, complement(l, left), right);
    return complement(l, joined);
}

/* What is in one of two: their union less what they share. */
Lowered lower_xor(Lowering *l, const Shape *shape, LowerContext context)
{
    Lowered a = lower_joined(l, shape, shape->children[0], context);
    Lowered b = lower_joined(l, shape, shape->children[1], context);
    if (a.distance == NODE_NONE || b.distance == NODE_NONE)
        return join_two(l, shape->blend, a, b);
    Lowered result = join_two(l, shape->blend, a, b);
    /* What they share is the complement of: */
    Lowered shared  = join_two(l, shape->blend, complement(l, a), complement(l, b));
    result.distance = graph_op2(l->graph, OP_max, result.distance, shared.distance);
    return result;
}

Lowered lower_morph(Lowering *l, const Shape *shape, LowerContext context)
{
    Lowered a = lower_shape(l, shape->children[0], context_lipschitz(context));
    Lowered b = lower_shape(l, shape->children[1], context_lipschitz(context));
    if (a.distance == NODE_NONE || b.distance == NODE_NONE)
        return a.distance == NODE_NONE ? b : a;
    Graph  *g       = l->graph;
    Lowered result  = lowered_nothing;
    Node    one     = graph_number(g, 1);
    Node    weight  = graph_op2(g, OP_sub, one, shape->values[0]);
    result.distance = graph_op3(g, OP_mix, a.distance, b.distance, shape->values[0]);
    if (l->surfaces) {
        Node half      = graph_number(g, 0.5);
        Node nearer    = graph_op2(g, OP_less, shape->values[0], half);
        result.surface = mix_surface(g, nearer, weight, a.surface, b.surface);
    }
    return result;
}
