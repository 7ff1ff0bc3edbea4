/*
 * choice.c: one of two shapes, by a condition that is the same at every point.
 */
#include "compiler/base/far.h"
#include "compiler/family/family.h"

#include <math.h>

#include "compiler/lower/context.h"
#include "compiler/lower/surface.h"

const Shape *make_choice(ShapeBuilder *builder, Node condition, const Shape *yes, const Shape *no,
                         Span span)
{
    const Shape *children[] = {yes, no};
    Shape       *choice     = shape_new(builder, SHAPE_CHOICE, "if", span, children, 2);
    choice->values[0]       = condition;
    choice->box             = builder_box(builder, choice);
    return choice;
}

static Node distance_or_nowhere(Graph *g, Lowered lowered)
{
    return lowered.distance == NODE_NONE ? graph_number(g, NOWHERE) : lowered.distance;
}

Lowered lower_choice(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph  *g      = l->graph;
    Lowered yes    = lower_shape(l, shape->children[0], context);
    Lowered no     = lower_shape(l, shape->children[1], context);
    Lowered chosen = yes.distance == NODE_NONE ? no : yes;
    if (chosen.distance == NODE_NONE)
        return chosen;
    Node condition  = shape->values[0];
    Node otherwise  = distance_or_nowhere(g, no);
    chosen.distance = graph_op3(g, OP_select, condition, distance_or_nowhere(g, yes), otherwise);
    if (l->surfaces && yes.distance != NODE_NONE && no.distance != NODE_NONE)
        chosen.surface = choose_surface(g, condition, yes.surface, no.surface);
    return chosen;
}
