/*
 * guards.c: levels of sequences that are far away are left out (math.md, section 1,
 * "Early-out").
 *
 * All that the first stages of a sequence make lies in a box, and from outside of it the box is a
 * bound for all of that.  A ray far away for the size of the box need not know more, and one that
 * is nearer to what has been found already cannot.  A branch is worth this where it saves work,
 * which is on graphics cards and in queries, not on lavapipe.
 */
#include "compiler/lower/guards.h"

#include <math.h>

#include "compiler/lower/box_distance.h"

/* Boxes are made larger by this fraction of the size of their coordinates: single precision. */
static const double ROUNDING = 1e-6;

/* Farther than this fraction of its radius, a box stands for what is in it.  Smaller fractions
   leave more out and make more steps; on the processor all from 0.25 to 1 cost the same within 10 %. */
static const double FAR = 0.5;

/* Farther than any scene. */
static const double NOWHERE = 1e30;

/* Where the point was just mapped, before kernels, and before everything.  What is guarded jumps,
   so not where a slope is needed. */
bool may_guard(const Lowering *l, const Shape *krs, uint32_t stage, LowerContext context)
{
    const LevelBound *bound  = &krs->bounds[stage];
    bool              last   = stage + 1 == krs->stage_count;
    bool              mapped = krs->stages[stage].kind == SEQUENCE_KERNEL &&
                  (last || krs->stages[stage + 1].kind != SEQUENCE_KERNEL);
    return l->guarded && !context.lipschitz && (last || mapped) && bound->ball.radius > 0 &&
           isfinite(bound->ball.radius) && box_is_finite(bound->box);
}

/* A distance behind the maps as one outside of the sequence. */
static Node out(Lowering *l, const MapChain *chain, Node distance)
{
    Lowered behind  = lowered_nothing;
    behind.distance = distance;
    return map_chain_out(l, chain, behind).distance;
}

/* From where on nothing but the bound is of interest: never below where what is left is smaller
   than a pixel. */
static Node far_from(Lowering *l, const GuardSite *site)
{
    Graph *g       = l->graph;
    Node   radius  = graph_number(g, site->bound->ball.radius);
    Node   near    = graph_number(g, FAR * site->bound->ball.radius);
    Node   outside = graph_op2(g, OP_mul, out(l, &site->chain, radius), l->unit);
    Node   pixel   = graph_leaf(g, OP_FOOTPRINT);
    Node   small   = graph_op2(g, OP_less, outside, pixel);
    Node   always  = graph_number(g, -NOWHERE);
    return graph_op3(g, OP_select, small, always, out(l, &site->chain, near));
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
        bound       = out(l, &site->chain, bound);
        Node so_far = site->so_far == NODE_NONE ? graph_number(g, NOWHERE) : site->so_far;
        whole       = graph_op4(g, OP_guard, bound, so_far, whole, far_from(l, site));
    }
    return whole;
}
