/*
 * iteration.c: shapes that a loop makes, which differ in numbers only.
 *
 * The loop was evaluated once, with a leaf of frame time in the place of its variable.  What is known of
 * the result for all values of the leaf holds in each iteration.  Where many iterations are joined they become
 * an instance group (lower/group_iterations.c).  One alone is lowered as the others, and the leaf is replaced.
 */
#include "compiler/family/family.h"
#include "compiler/family/vary.h"
#include "compiler/graph/instances/iterations.h"

void make_iterations(ShapeBuilder *builder, const Shape *shared,
                     const struct IterationSource *source, Node leaf, const double *numbers,
                     const Box *boxes, size_t count, const Shape **iterations)
{
    Shape *first = shape_new(builder, SHAPE_ITERATION, shared->name, shared->span, NULL, 0);
    shape_takes_over(first, shared);
    first->iterated  = shared;
    first->source    = source;
    first->iteration = leaf;
    Shape *all       = arena_new_array(builder->arena, Shape, count);
    for (size_t i = 0; i < count; i++) {
        all[i]        = *first;
        all[i].number = numbers[i];
        all[i].box    = boxes[i];
        iterations[i] = &all[i];
    }
}

static Node in_iteration(Lowering *l, Node node, const void *user)
{
    const Shape *iteration = user;
    return graph_in_iteration(l->graph, node, iteration->iteration, iteration->number, l->scratch);
}

static void copy_trace(Lowering *l, size_t first, const Shape *iteration)
{
    for (size_t i = first; l->lowered_shapes && i < l->lowered_shapes->count; i++) {
        LoweredShape *lowered = &l->lowered_shapes->items[i];
        Node         *nodes[] = {&lowered->point, &lowered->distance};
        for (int k = 0; k < 2; k++)
            if (*nodes[k] != NODE_NONE)
                *nodes[k] = in_iteration(l, *nodes[k], iteration);
    }
}

/* Lowers an iteration without tables of instance groups, which would be those of all iterations. */
Lowered lower_iteration(Lowering *l, const Shape *shape, LowerContext context)
{
    struct LoweredGroups *groups = l->groups;
    const size_t          held   = l->held_constant ? l->held_constant->count : 0;
    const size_t          traced = l->lowered_shapes ? l->lowered_shapes->count : 0;
    l->groups                    = NULL;
    Lowered result               = lower_shape(l, shape->iterated, context);
    l->groups                    = groups;
    if (result.distance != NODE_NONE)
        copy_lowered(l, &result, held, in_iteration, shape);
    copy_trace(l, traced, shape);
    return result;
}
