/*
 * turn.c: shapes that a loop makes, which differ in numbers only.
 *
 * The loop was evaluated once, with a leaf of frame time in the place of its variable.  What is known of
 * the result for all values of the leaf holds in each turn.  Where many turns are joined they become
 * an instance group (lower/group_turns.c).  One alone is lowered as the others, and the leaf is replaced.
 */
#include "compiler/family/family.h"
#include "compiler/family/vary.h"
#include "compiler/graph/instances/turns.h"

void make_turns(ShapeBuilder *builder, const Shape *shared, Node leaf, const double *numbers,
                const Box *boxes, size_t count, const Shape **turns)
{
    Shape *first = shape_new(builder, SHAPE_TURN, shared->name, shared->span, NULL, 0);
    shape_takes_over(first, shared);
    first->turned = shared;
    first->turn   = leaf;
    Shape *all    = arena_new_array(builder->arena, Shape, count);
    for (size_t i = 0; i < count; i++) {
        all[i]        = *first;
        all[i].number = numbers[i];
        all[i].box    = boxes[i];
        turns[i]      = &all[i];
    }
}

static Node in_turn(Lowering *l, Node node, const void *user)
{
    const Shape *turn = user;
    return graph_in_turn(l->graph, node, turn->turn, turn->number, l->scratch);
}

static void copy_trace(Lowering *l, size_t first, const Shape *turn)
{
    for (size_t i = first; l->lowered_shapes && i < l->lowered_shapes->count; i++) {
        LoweredShape *lowered = &l->lowered_shapes->items[i];
        Node         *nodes[] = {&lowered->point, &lowered->distance};
        for (int k = 0; k < 2; k++)
            if (*nodes[k] != NODE_NONE)
                *nodes[k] = in_turn(l, *nodes[k], turn);
    }
}

/* Tables of instance groups in it would be those of all turns. */
Lowered lower_turn(Lowering *l, const Shape *shape, LowerContext context)
{
    struct LoweredGroups *groups = l->groups;
    const size_t          held   = l->held_constant ? l->held_constant->count : 0;
    const size_t          traced = l->lowered_shapes ? l->lowered_shapes->count : 0;
    l->groups                    = NULL;
    Lowered result               = lower_shape(l, shape->turned, context);
    l->groups                    = groups;
    if (result.distance != NODE_NONE)
        copy_lowered(l, &result, held, in_turn, shape);
    copy_trace(l, traced, shape);
    return result;
}
