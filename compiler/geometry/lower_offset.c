/*
 * lower_offset.c: shapes grown or shrunk by a distance, shells and sheets.
 */
#include "compiler/geometry/lowering.h"

Lowered lower_offset(Lowering *l, const Shape *shape, LowerContext context)
{
    Lowered result = lower_operand(l, shape->children[0], context);
    if (result.distance != NODE_NONE)
        result.distance = graph_op2(l->graph, OP_sub, result.distance, shape->values[0]);
    return result;
}

/* What is nowhere negative.  A gradient is that of the solid: it does not turn at the sheet. */
static Lowered thin_sheet(Lowering *l, Lowered solid)
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

Lowered lower_shell(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph *g       = l->graph;
    bool   thin    = l->thin && shape->sheet;
    l->thin        = false;
    Lowered result = thin ? lower_shape(l, shape->children[0], context)
                          : lower_operand(l, shape->children[0], context);
    if (result.distance == NODE_NONE || thin)
        return thin && result.distance != NODE_NONE ? thin_sheet(l, result) : result;
    Node half       = graph_number(g, 0.5);
    half            = graph_op2(g, OP_mul, shape->values[0], half);
    Node size       = graph_op1(g, OP_abs, result.distance);
    result.distance = graph_op2(g, OP_sub, size, half);
    return result;
}
