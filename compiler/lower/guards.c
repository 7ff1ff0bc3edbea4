/*
 * guards.c: skips levels of sequences that are far away (math.md, section 1, "Early-out").
 *
 * The first stages of a sequence make a set that lies in a box.  Outside of it, the distance to the
 * box is a bound for the distance to that set.  The bound suffices where the box is far away
 * compared with its size, or farther than another shape.  So a branch skips the stages there.  It
 * saves time on graphics cards and in queries, but not on lavapipe.
 */
#include "compiler/lower/guards.h"

#include <math.h>

#include "compiler/base/far.h"
#include "compiler/lower/box_distance.h"

/* Boxes are enlarged by this fraction of their largest coordinate, for errors of single
   precision. */
static const double ROUNDING = 1e-6;

/* A box replaces its content from this distance on, in radii of the ball around it.  Smaller values
   skip more work but take more steps.  On the processor all from 0.25 to 1 cost the same within
   10 %. */
static const double FAR = 0.5;

/* Guards go before the outermost stage, and before each run of kernels, where the point has just
   been mapped.  A guarded distance jumps, so there is no guard where the slope is needed. */
bool may_guard(const Lowering *l, const Shape *krs, uint32_t stage, LowerContext context)
{
    const LevelBound *bound  = &krs->bounds[stage];
    bool              last   = stage + 1 == krs->stage_count;
    bool              mapped = krs->stages[stage].kind == SEQUENCE_KERNEL &&
                  (last || krs->stages[stage + 1].kind != SEQUENCE_KERNEL);
    return l->guarded && !context.lipschitz && (last || mapped) && bound->ball.radius > 0 &&
           isfinite(bound->ball.radius) && box_is_finite(bound->box);
}

/* Returns what a distance behind the maps is outside of the sequence. */
static Node distance_outside(Lowering *l, const MapChain *chain, Node distance)
{
    Lowered behind  = lowered_nothing;
    behind.distance = distance;
    return map_chain_out(l, chain, behind).distance;
}

/* Returns the distance from which on the bound suffices.  It is negative, so that the bound always
   suffices, where the box is smaller than a pixel. */
static Node far_from(Lowering *l, const GuardSite *site)
{
    Graph *g       = l->graph;
    Node   radius  = graph_number(g, site->bound->ball.radius);
    Node   near    = graph_number(g, FAR * site->bound->ball.radius);
    Node   outside = graph_op2(g, OP_mul, distance_outside(l, &site->chain, radius), l->unit);
    Node   pixel   = graph_leaf(g, OP_FOOTPRINT);
    Node   small   = graph_op2(g, OP_less, outside, pixel);
    Node   always  = graph_number(g, -NOWHERE);
    return graph_op3(g, OP_select, small, always, distance_outside(l, &site->chain, near));
}

Node guard_at_sites(Lowering *l, const GuardSite *guard_sites, uint32_t count, Node whole)
{
    Graph *g = l->graph;
    for (uint32_t i = count; i-- > 0 && whole != NODE_NONE;) {
        const GuardSite *site    = &guard_sites[i];
        Box              box     = site->bound->box;
        double           largest = 0;
        for (int k = 0; k < 3; k++)
            largest = fmax(largest, fmax(fabs(box.axis[k].low), fabs(box.axis[k].high)));
        Node bound  = box_distance(g, site->chain.point, box_grow(box, ROUNDING * largest));
        bound       = distance_outside(l, &site->chain, bound);
        Node so_far = site->so_far == NODE_NONE ? graph_number(g, NOWHERE) : site->so_far;
        whole       = graph_op4(g, OP_guard, bound, so_far, whole, far_from(l, site));
    }
    return whole;
}
