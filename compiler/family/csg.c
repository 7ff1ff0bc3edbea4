/*
 * csg.c: joints of shapes: union, intersection, difference, xor, and morph; sharp or blended.
 */
#include "compiler/family/family.h"

#include <math.h>

#include "compiler/lower/join.h"
#include "compiler/lower/surface.h"

/* ---- how it is made ---- */

const Shape *make_joint(ShapeBuilder *builder, ShapeKind kind, const Shape *const *shapes,
                        uint32_t count, Blend blend, Span span)
{
    Shape *joint = shape_new(builder, kind, shape_info[kind].name, span, shapes, count);
    joint->blend = blend;
    if (blend.width != NODE_NONE)
        check_lipschitz(builder, joint, "a blend", span);
    /* Outside, the least of exact distances is exact; every other joint only bounds it. */
    joint->exact = joint->exact && kind == SHAPE_UNION && blend.width == NODE_NONE;
    for (uint32_t i = 0; i < count; i++) {
        if (i == 0)
            joint->box = shapes[0]->box;
        else if (kind == SHAPE_INTERSECTION)
            joint->box = box_common(joint->box, shapes[i]->box);
        else if (kind != SHAPE_DIFFERENCE)
            joint->box = box_hull(joint->box, shapes[i]->box);
    }
    if (blend.width != NODE_NONE && count > 1) {
        const BlendInfo *info = &blend_info[blend.kind];
        /* Each further operand adds a partial derivative; their squares sum to 1, so the sum of
           n of them is at most sqrt(n): for two operands the factor of the table. */
        joint->slope *= info->slope > 1 ? pow(info->slope, log2(count)) : 1;
        if (kind != SHAPE_INTERSECTION && kind != SHAPE_DIFFERENCE)
            joint->box = box_grow(
                joint->box, info->bulge * node_range(builder, blend.width, 0).high * (count - 1));
    }
    return joint;
}

const Shape *make_morph(ShapeBuilder *builder, const Shape *a, const Shape *b, Node t, Span span)
{
    const Shape *children[] = {a, b};
    Shape       *morph      = shape_new(builder, SHAPE_MORPH, "morph", span, children, 2);
    morph->values[0]        = t;
    check_lipschitz(builder, morph, "`morph`", span);
    morph->exact = false;
    /* Where the mix is 0 one of the distances is at most 0, or both are. */
    morph->box = box_hull(a->box, b->box);
    return morph;
}

/* ---- how it is lowered ---- */

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
    context = joint_context(shape, context);
    return union_of(l, shape, shape->children, shape->child_count, context);
}

Lowered lower_intersection(Lowering *l, const Shape *shape, LowerContext context)
{
    context = joint_context(shape, context);
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
    context       = joint_context(shape, context);
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
    context   = joint_context(shape, context);
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
