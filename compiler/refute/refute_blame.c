/*
 * refute_blame.c: which shape is to blame for a distance that was refuted.
 *
 * All shapes that the lowering of a refuted one meets are looked at in the very points in which it
 * is refuted, each in its own space.  The smallest of them that is refuted too is next, and so on;
 * where none is, the parts of the last are searched from these points on.
 */
#include "compiler/refute/refute_blame.h"

#include <math.h>

#include "compiler/refute/search.h"

/* Returns by how much a lowered shape breaks its claim at two points; below 1: it does not. */
static double claim_ratio(const LoweredShape *lowered, bool lipschitz, const NodeValue *at_p,
                          const NodeValue *at_q)
{
    const double *p = at_p[lowered->point].v, *q = at_q[lowered->point].v;
    double a = at_p[lowered->distance].v[0], b = at_q[lowered->distance].v[0], square = 0, size = 1;
    if (isnan(a) || isnan(b))
        return isfinite(p[0] + p[1] + p[2]) ? INFINITY : 0;
    for (int i = 0; i < 3; i++) {
        square += (p[i] - q[i]) * (p[i] - q[i]);
        size += fabs(p[i]);
    }
    double rise = lipschitz && !lowered->shape->estimate ? fabs(a - b)
                  : (a > 0) != (b > 0)                   ? fmax(fabs(a), fabs(b))
                                                         : 0;
    return fmax(0, rise / lowered->shape->slope - 1e-9 * size) / fmax(sqrt(square), 1e-9 * size);
}

/* All shapes that were lowered in a refuted shape, with their values at its two points. */
typedef struct LoweringTrace {
    LoweredShapes lowered_shapes; /* those with a distance; nodes are of `graph` */
    Graph        *graph;
    NodeValue    *at_p, *at_q;
} LoweringTrace;

static void run_at(const Tape *tape, const NodeValue *parameters, const double point[3],
                   NodeValue *values)
{
    tape_run_frame(tape, parameters, values);
    tape_run_point(tape, point, values);
}

static LoweringTrace trace_of(Refuter *r, const Finding *finding)
{
    const Shape  *shape = r->suspects.items[finding->suspect].shape;
    Arena        *arena = r->in->scratch;
    LoweringTrace trace = {0};
    LoweredShapes all   = {0};
    (void)lower_alone(r, shape, finding->lipschitz, &all);
    for (size_t i = 0; i < all.count; i++)
        if (all.items[i].distance != NODE_NONE && all.items[i].shape != shape)
            array_push(arena, &trace.lowered_shapes, all.items[i]);
    size_t count = trace.lowered_shapes.count;
    Node  *roots = arena_new_array(arena, Node, 2 * count + 1);
    for (size_t i = 0; i < count; i++) {
        roots[2 * i]     = trace.lowered_shapes.items[i].point;
        roots[2 * i + 1] = trace.lowered_shapes.items[i].distance;
    }
    trace.graph = r->graph;
    trace.at_p  = arena_new_array(arena, NodeValue, r->graph->count);
    trace.at_q  = arena_new_array(arena, NodeValue, r->graph->count);
    Tape tape   = tape_new(r->graph, roots, 2 * count, arena);
    run_at(&tape, finding->parameters, finding->witness.p, trace.at_p);
    run_at(&tape, finding->parameters, finding->witness.q, trace.at_q);
    return trace;
}

static size_t suspect_of(const Refuter *r, const Shape *shape)
{
    for (size_t i = 0; i < r->suspects.count; i++)
        if (r->suspects.items[i].shape == shape)
            return i;
    return SIZE_MAX;
}

/* Searches a shape from two points on, at the parameters of a finding, which it replaces when the
   shape is refuted as well. */
static bool refute_from(Refuter *r, size_t suspect, const double p[3], const double q[3],
                        uint64_t operations, Finding *finding)
{
    const Shape *shape     = r->suspects.items[suspect].shape;
    bool         lipschitz = finding->lipschitz && !shape->estimate;
    Node         distance  = lower_alone(r, shape, lipschitz, NULL);
    Search       search;
    if (distance == NODE_NONE || !search_of(r, shape, distance, lipschitz, &search))
        return false;
    bool constant = finding->witness.fault == FAULT_CONSTANT;
    if (search_start(&search, finding->parameters) == constant)
        return false; /* this one is finite, or for another reason not to be searched */
    if (constant)
        search.worst.fault = FAULT_CONSTANT;
    else if (p)
        search_from(&search, p, q, operations / 4);
    if (!constant)
        search_run(&search, operations - (p ? operations / 4 : 0));
    if (!constant && !search_refuted(&search))
        return false;
    finding->suspect   = suspect;
    finding->lipschitz = lipschitz;
    finding->witness   = search.worst;
    return true;
}

/* Goes from a refuted shape to a smaller one that is refuted; false: there is none. */
static bool descend(Refuter *r, Finding *finding, uint64_t operations)
{
    LoweringTrace       trace = trace_of(r, finding);
    const LoweredShape *best  = NULL;
    double              worst = 0;
    for (size_t i = 0; i < trace.lowered_shapes.count; i++) {
        const LoweredShape *lowered = &trace.lowered_shapes.items[i];
        double ratio = claim_ratio(lowered, finding->lipschitz, trace.at_p, trace.at_q);
        bool   less  = !best || lowered->shape->depth < best->shape->depth ||
                    (lowered->shape->depth == best->shape->depth && ratio > worst);
        if (is_wrapper(lowered->shape) || !(ratio > 1 + 1e-6) || !less)
            continue;
        best  = lowered;
        worst = ratio;
    }
    size_t suspect = best ? suspect_of(r, best->shape) : SIZE_MAX;
    return suspect != SIZE_MAX && refute_from(r, suspect, trace.at_p[best->point].v,
                                              trace.at_q[best->point].v, operations, finding);
}

/* Does the same where no part is refuted in these points: each part is searched by itself. */
static bool search_parts(Refuter *r, Finding *finding, uint64_t operations)
{
    const Shape *shape = r->suspects.items[finding->suspect].shape;
    for (uint32_t i = 0; i < shape->child_count; i++) {
        size_t suspect = suspect_of(r, shape->children[i]);
        if (suspect != SIZE_MAX &&
            refute_from(r, suspect, NULL, NULL, operations / shape->child_count, finding))
            return true;
        arena_free(r->in->scratch);
    }
    return false;
}

void find_culprit(Refuter *r, Finding *finding)
{
    uint64_t operations = r->total / 20;
    while (!r->stopped && finding->witness.fault != FAULT_BOX) {
        bool placed  = finding->witness.fault != FAULT_CONSTANT;
        bool smaller = placed && descend(r, finding, operations);
        arena_free(r->in->scratch);
        if (!smaller && !search_parts(r, finding, operations))
            return;
        arena_free(r->in->scratch);
    }
}
