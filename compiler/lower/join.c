/*
 * join.c: unions of lowered shapes, and operands whose distances are used away from the surface.
 */
#include "compiler/lower/join.h"

#include "compiler/lower/box_distance.h"
#include "compiler/lower/surface.h"

Node join_distances(Graph *g, Blend blend, Node a, Node b)
{
    if (blend.width == NODE_NONE)
        return graph_op2(g, OP_min, a, b);
    Node operands[MAX_OPERANDS] = {a, b, blend.width, blend.steps};
    return graph_op(g, blend_info[blend.kind].op, operands);
}

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

/* A bound may be small far from its shape.  The distance to the sides of the shape's box is a bound
   too, and the larger of both is used.  Then points where it is r lie within r of the box, which
   the boxes of csg.c assume. */
Lowered lower_operand(Lowering *l, const Shape *shape, LowerContext context)
{
    Lowered result = lower_shape(l, shape, context_lipschitz_within(context, 0));
    if (result.distance == NODE_NONE || shape->exact)
        return result;
    Node excess = sides_excess(l->graph, context.point, shape->box);
    if (excess != NODE_NONE)
        result.distance = graph_op2(l->graph, OP_max, result.distance, excess);
    return result;
}
