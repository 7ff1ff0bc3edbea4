/*
 * lower_krs.c: kernel-reflection sequences.
 *
 * From the last statement to the first (math.md, sections 1 and 2.4): a mirror folds the point
 * and gives the instance its next bit, a map takes the point behind it, a kernel joins with the
 * level that it has: the mirrors before it.
 */
#include "compiler/geometry/lowering.h"

#include <math.h>

enum { MOST_HEAP_MIRRORS = 31 };

/* How far the walk has come. */
typedef struct Walk {
    const Shape *krs;
    Place        place; /* of the sequence */
    Passage      passage;
    NormalPath   path;
    Node         id;
    uint32_t     level;
    Lowered      result; /* of the kernels so far */
    Hulls        hulls;
    Node         inside;   /* distance of those that the last hull is around, */
    Node         distance; /* and of the others, none nearer than the hulls around it */
    Stop        *stops;
    uint32_t     stop_count;
} Walk;

static void take_mirror(Lowering *l, Walk *walk, const Stage *stage)
{
    Graph *g     = l->graph;
    Node   point = walk->passage.point;
    if (l->surfaces) {
        Op   next   = walk->krs->levels <= MOST_HEAP_MIRRORS ? OP_push_id : OP_hash_id;
        Node behind = graph_op3(g, OP_front, point, stage->normal, stage->offset);
        walk->id    = graph_op2(g, next, walk->id, behind);
    }
    normal_fold(l, &walk->path, point, stage->normal, stage->offset);
    hulls_fold(l, &walk->hulls, stage->normal, stage->offset);
    walk->passage.point = graph_op3(g, OP_fold, point, stage->normal, stage->offset);
    walk->level--;
}

/* The kernels since the last hull: max(hull, min(a, b)), where nothing waits for what is inside of
   another hull. */
static void leave_hull(Lowering *l, Walk *walk)
{
    Node bound     = walk->inside == NODE_NONE
                         ? NODE_NONE
                         : farther_of(l->graph, walk->inside, walk->hulls.distance);
    walk->distance = nearer_of(l->graph, walk->distance, bound);
    walk->inside   = NODE_NONE;
}

/* `before`: around what the map is applied to, or NULL.  Where something above moves the surface,
   it would show how far from a pole the hulls are: then all are there. */
static void take_map(Lowering *l, Walk *walk, const Stage *stage, const LevelBound *before)
{
    Ball  ball  = before ? before->ball : (Ball){.radius = HUGE_VAL};
    Hulls hulls = walk->hulls;
    if (walk->place.lipschitz)
        hulls.within.radius = HUGE_VAL;
    if (hulls_map(l, &hulls, &walk->passage, &stage->map, ball))
        leave_hull(l, walk);
    walk->hulls = hulls;
    passage_map(l, &walk->passage, &stage->map, &walk->path);
}

/* Nodes become statements in the order in which they are made.  The next fold is what all other
   levels wait for: it stands before the kernel, so that a processor has both in sight. */
static void prepare_fold(Lowering *l, const Walk *walk, const Stage *next)
{
    if (next && next->kind == STAGE_REFLECT)
        graph_op3(l->graph, OP_fold, walk->passage.point, next->normal, next->offset);
}

static void take_kernel(Lowering *l, Walk *walk, const Shape *shape)
{
    Graph *g     = l->graph;
    Place  inner = place_behind(&walk->path, walk->place, walk->passage.point);
    if (l->surfaces) {
        /* Within an outer sequence its level counts, and this instance is hashed in. */
        bool outer     = walk->place.level != NODE_NONE;
        inner.level    = outer ? walk->place.level : graph_number(g, walk->level);
        inner.instance = outer ? graph_op2(g, OP_join_id, walk->place.instance, walk->id)
                               : walk->id;
    }
    Node    unit   = enter_passage(l, &walk->passage);
    Lowered kernel = lower_shape(l, shape, inner);
    l->unit        = unit;
    kernel         = passage_out(l, &walk->passage, kernel);
    normal_kernel(l, &walk->path, walk->result, kernel);
    walk->result = join_two(l, blend_sharp, walk->result, kernel);
    walk->inside = nearer_of(g, walk->inside, kernel.distance);
}

Lowered lower_krs(Lowering *l, const Shape *shape, Place place)
{
    uint32_t count = shape->stage_count;
    Walk     walk  = {.krs      = shape,
                      .place    = place,
                      .passage  = passage_new(l->graph, place.point),
                      .path     = normal_path(l, place, 2 * count),
                      .id       = graph_uint(l->graph, 1),
                      .level    = shape->levels,
                      .result   = lowered_nothing,
                      .hulls    = {NODE_NONE, {.radius = HUGE_VAL}},
                      .inside   = NODE_NONE,
                      .distance = NODE_NONE,
                      .stops    = arena_new_array(l->scratch, Stop, count + 1)};
    for (uint32_t i = count; i-- > 0;) {
        const Stage *stage = &shape->stages[i];
        if (may_stop(l, shape, i, place))
            walk.stops[walk.stop_count++] = (Stop){&shape->bounds[i], walk.passage,
                                                   walk.result.distance};
        switch (stage->kind) {
        case STAGE_REFLECT: take_mirror(l, &walk, stage); break;
        case STAGE_MAP: take_map(l, &walk, stage, i ? &shape->bounds[i - 1] : NULL); break;
        case STAGE_KERNEL:
            prepare_fold(l, &walk, i ? stage - 1 : NULL);
            take_kernel(l, &walk, shape->children[stage->kernel]);
            break;
        }
    }
    Lowered result        = walk.result;
    result.surface.normal = normal_out(l, &walk.path, result.surface.normal);
    leave_hull(l, &walk);
    if (walk.hulls.distance != NODE_NONE)
        result.distance = walk.distance;
    result.distance = guard_stops(l, walk.stops, walk.stop_count, result.distance);
    return result;
}
