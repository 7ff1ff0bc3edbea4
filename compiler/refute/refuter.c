/*
 * refuter.c: one shape by itself, lowered and made ready to be searched.
 */
#include "compiler/refute/refuter.h"

#include "compiler/base/splitmix.h"
#include "compiler/graph/rewrite/simplify.h"
#include "compiler/refute/search.h"
#include "compiler/shape/slope.h"

bool is_wrapper(const Shape *shape) { return !shape_info[shape->kind].own; }

/* Most nodes of a shape that is searched: a search keeps much of each. */
enum { MAX_SEARCHED = 100000 };

static Lowering lowering_of(Refuter *r, LoweredShapes *lowered_shapes)
{
    return (Lowering){.graph          = r->graph,
                      .scratch        = r->in->scratch,
                      .lowered_shapes = lowered_shapes,
                      .most           = r->graph->count + MAX_SEARCHED};
}

Node lower_alone(Refuter *r, const Shape *shape, bool lipschitz, LoweredShapes *lowered_shapes)
{
    Lowering     l       = lowering_of(r, lowered_shapes);
    LowerContext context = context_new(graph_leaf(r->graph, OP_POINT), lipschitz);
    Lowered      all     = lower_shape(&l, shape, context);
    r->result->skipped += l.overflow && !lowered_shapes && !lipschitz;
    if (l.overflow || all.distance == NODE_NONE)
        return NODE_NONE;
    return divide_by_slope(r->graph, all.distance, shape->slope);
}

bool search_step(Refuter *r, const Shape *shape, Node step, Node side, bool lipschitz,
                 Search *search)
{
    Arena *scratch  = r->in->scratch;
    Node   roots[2] = {step, side};
    Graph *simple   = graph_simplify(r->graph, roots, 2, scratch);
    if (!search_new(search, simple, roots[0], roots[1], shape->box, scratch))
        return false;
    search->steep  = lipschitz;
    search->figure = shape->figure;
    search->random = r->random;
    (void)splitmix_next(&r->random);
    return true;
}

bool search_of(Refuter *r, const Shape *shape, Node distance, bool lipschitz, Search *search)
{
    return search_step(r, shape, distance, distance, lipschitz, search);
}
