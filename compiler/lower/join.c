/*
 * join.c: unions of lowered shapes, and operands whose distances are used away from the surface.
 */
#include "compiler/lower/join.h"

#include "compiler/lower/box_distance.h"
#include "compiler/lower/instance_group.h"
#include "compiler/lower/surface.h"

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

/* Tells whether outside of its box a distance is that to the sides of the box or more, whatever it is a bound of.
   Operands of blends are made so (lower_operand), and blends that are no steeper are less than their
   operands by no more than their boxes grow.  A difference is no less than what it is taken from.  A
   sharp CSG node may have a part that is nowhere, which is far from no place. */
static bool keeps_to_box(const Lowering *l, const Shape *shape)
{
    const bool difference = shape->kind == SHAPE_DIFFERENCE;
    const bool joins      = difference || shape->kind == SHAPE_UNION ||
                       shape->kind == SHAPE_INTERSECTION;
    const bool sharp = shape->blend.width == NODE_NONE;
    if (shape->exact)
        return true;
    if (!joins || shape->open_surfaces ||
        (l->groups && shape->child_count >= min_of_csg(l->groups, sharp)) ||
        (!sharp && blend_info[shape->blend.kind].slope > 1))
        return false;
    for (uint32_t i = 0; i < (difference ? 1 : shape->child_count); i++)
        if (box_is_empty(shape->children[i]->box) ||
            (sharp && !keeps_to_box(l, shape->children[i])))
            return false;
    return true;
}

/* A bound may be small far from its shape.  The distance to the sides of the shape's box is a bound
   too, and the larger of both is used.  Then points where it is r lie within r of the box, which
   the boxes of csg.c assume.  What is nowhere has no box to be far from, and is left out. */
Lowered lower_operand(Lowering *l, const Shape *shape, LowerContext context)
{
    if (box_is_empty(shape->box))
        return lowered_nothing;
    Lowered result = lower_shape(l, shape, context_lipschitz_within(context, 0));
    if (result.distance == NODE_NONE || keeps_to_box(l, shape))
        return result;
    Node excess = sides_excess(l->graph, context.point, shape->box);
    if (excess != NODE_NONE)
        result.distance = graph_op2(l->graph, OP_max, result.distance, excess);
    return result;
}
