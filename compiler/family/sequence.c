/*
 * sequence.c: kernel-reflection sequences.
 *
 * Statements are lowered from the last to the first (math.md, sections 1 and 2.4): a mirror folds
 * the point and gives the instance its next bit, a map takes the point behind it, a kernel joins
 * with the level that it has: the mirrors before it.
 */
#include <math.h>

#include "compiler/family/family.h"
#include "compiler/lower/guards.h"
#include "compiler/lower/join.h"
#include "compiler/lower/sphere_fold.h"
#include "compiler/shape/sequence_box.h"

/* ---- bounding volumes, level by level ---- */

/* Bounds a sequence with spheres or maps that invert, by balls all the way (cover.h). */
static Box bound_inverted(ShapeBuilder *builder, const Shape *krs, LevelBound *bounds)
{
    Cover cover = {0};
    for (uint32_t i = 0; i < krs->stage_count; i++) {
        const SequenceStage *stage = &krs->stages[i];
        if (stage->kind == SEQUENCE_KERNEL) {
            const Shape *kernel = krs->children[stage->kernel];
            if (!box_is_finite(kernel->box) && !box_is_empty(kernel->box)) {
                for (; i < krs->stage_count; i++)
                    bounds[i] = (LevelBound){box_infinite, ball_around(box_infinite)};
                return box_infinite; /* after the last inversion: see check_kernels */
            }
            cover_add(builder->arena, &cover, kernel->box);
        } else if (stage->kind == SEQUENCE_REFLECT) {
            Range u[3];
            for (uint32_t k = 0; k < 3; k++)
                u[k] = node_range(builder, stage->normal, k);
            cover_fold(builder->arena, &cover, u, node_range(builder, stage->offset, 0));
        } else if (stage->kind == SEQUENCE_SPHERE) {
            Range centre[3];
            for (uint32_t k = 0; k < 3; k++)
                centre[k] = node_range(builder, stage->centre, k);
            cover_fold_sphere(builder->arena, &cover, centre,
                              node_range(builder, stage->radius, 0));
        } else {
            MapRange map = map_range(builder, &stage->map);
            cover_map(&cover, &map);
        }
        bounds[i].box  = cover_box(&cover);
        Ball around    = ball_around(bounds[i].box);
        bounds[i].ball = cover_ball(&cover);
        if (around.radius < bounds[i].ball.radius)
            bounds[i].ball = around;
    }
    return cover_box(&cover);
}

/* Bounds a sequence of reflections and similarities. */
static Box bound_sequence(ShapeBuilder *builder, const Shape *krs, LevelBound *bounds)
{
    ReachStage          *reach = arena_new_array(builder->arena, ReachStage, krs->stage_count + 1);
    const BuilderNumbers all   = builder_numbers(builder);
    return sequence_box(&(BoxInput){&all.numbers, krs, NULL, 0}, reach, bounds);
}

static uint32_t count_inversions(const Shape *krs)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < krs->stage_count; i++)
        count += krs->stages[i].kind == SEQUENCE_MAP && krs->stages[i].map.pole != NODE_NONE;
    return count;
}

/* Refuses kernels that are inverted and endless, at the first inversion after them. */
static bool check_kernels(ShapeBuilder *builder, const Shape *krs)
{
    bool                 good      = true;
    const SequenceStage *inversion = NULL;
    for (uint32_t i = krs->stage_count; i-- > 0;) {
        const SequenceStage *stage = &krs->stages[i];
        if (stage->kind == SEQUENCE_MAP && stage->map.pole != NODE_NONE)
            inversion = stage;
        if (stage->kind == SEQUENCE_KERNEL && inversion)
            good = check_invertible(builder, krs->children[stage->kernel], inversion->span) && good;
    }
    return good;
}

const Shape *make_krs(ShapeBuilder *builder, const SequenceStage *stages, uint32_t stage_count,
                      const Shape *const *kernels, uint32_t kernel_count, Span span)
{
    Shape *krs       = shape_new(builder, SHAPE_KRS, "krs", span, kernels, kernel_count);
    krs->stages      = stages;
    krs->stage_count = stage_count;
    krs->exact       = false;
    krs->instances   = 0;
    krs->levels      = 0;
    bool spheres     = false;
    for (uint32_t i = 0; i < stage_count; i++) {
        if (stages[i].kind == SEQUENCE_KERNEL)
            krs->instances += kernels[stages[i].kernel]->instances;
        else if (stages[i].kind != SEQUENCE_MAP) {
            krs->instances *= 2;
            krs->levels++;
        }
        spheres = spheres || stages[i].kind == SEQUENCE_SPHERE;
    }
    krs->trapped    = krs->trapped || krs->levels > 0;
    krs->inversions = count_inversions(krs);
    if (krs->inversions && !check_kernels(builder, krs))
        return NULL;
    LevelBound *bounds = arena_new_array(builder->arena, LevelBound, stage_count + 1);
    krs->bounds        = bounds;
    krs->box           = krs->inversions || spheres ? bound_inverted(builder, krs, bounds)
                                                    : bound_sequence(builder, krs, bounds);
    return krs;
}

/* ---- distances ---- */

enum { MAX_HEAP_MIRRORS = 31 };

/* The state between two stages of a sequence, from the last to the first.  Distances behind a mirror
   that is a sphere come out of it together.  So what is behind is a part with a state of its own. */
typedef struct SequenceState {
    const Shape *krs;
    LowerContext context; /* of the sequence, or behind the last sphere */
    MapChain     chain;
    NormalPath   path;
    Node         id;
    uint32_t     level;
    Node         nearest, nearest_at; /* least distance of the folded point from the origin, and the
                                         share of the mirrors passed before it */
    Lowered      result;              /* of the kernels so far */
    PoleBounds   pole_bounds;
    Node         inside;   /* distance of the kernels within the last hull, */
    Node         distance; /* and of the others, each no nearer than its hulls */
    GuardSite   *guard_sites;
    uint32_t     guard_site_count;

    struct SequenceState *outer; /* in front of the last sphere; NULL: there is none */
    SphereFold            fold;  /* by that sphere */
    Node                  unit;  /* `unit` of the lowering in front of it */
} SequenceState;

/* Makes the state before the first `count` stages, up to the next sphere among them. */
static SequenceState *sequence_state_new(Lowering *l, const Shape *krs, LowerContext context,
                                         uint32_t count)
{
    SequenceState *state = arena_new(l->scratch, SequenceState);
    uint32_t       run   = 0;
    while (run < count && krs->stages[count - 1 - run].kind != SEQUENCE_SPHERE)
        run++;
    *state = (SequenceState){.krs         = krs,
                             .context     = context,
                             .chain       = map_chain_new(l->graph, context.point),
                             .path        = normal_path(l, context, 2 * run + 2),
                             .id          = graph_uint(l->graph, 1),
                             .level       = krs->levels,
                             .nearest     = NODE_NONE,
                             .nearest_at  = NODE_NONE,
                             .result      = lowered_nothing,
                             .pole_bounds = {NODE_NONE, {.radius = HUGE_VAL}},
                             .inside      = NODE_NONE,
                             .distance    = NODE_NONE,
                             .guard_sites = arena_new_array(l->scratch, GuardSite, run + 2)};
    return state;
}

/* Sets `orbit_trap` and `orbit_step` for the kernels that come next. */
static void watch_orbit(Lowering *l, SequenceState *state)
{
    Graph *g       = l->graph;
    double mirrors = state->krs->levels, passed = mirrors - state->level;
    if (!l->surfaces || mirrors == 0)
        return;
    Node length = graph_op1(g, OP_length, state->chain.point);
    Node share  = graph_number(g, passed / mirrors);
    if (state->nearest == NODE_NONE) {
        state->nearest    = length;
        state->nearest_at = share;
        return;
    }
    Node nearer       = graph_op2(g, OP_less, length, state->nearest);
    state->nearest_at = graph_op3(g, OP_select, nearer, share, state->nearest_at);
    state->nearest    = graph_op2(g, OP_min, length, state->nearest);
}

/* Adds the next bit of the instance: whether a mirror is passed. */
static void push_bit(Lowering *l, SequenceState *state, Node behind)
{
    Op next   = state->krs->levels <= MAX_HEAP_MIRRORS ? OP_push_id : OP_hash_id;
    state->id = graph_op2(l->graph, next, state->id, behind);
}

static void take_mirror(Lowering *l, SequenceState *state, const SequenceStage *stage)
{
    Graph *g     = l->graph;
    Node   point = state->chain.point;
    if (l->surfaces)
        push_bit(l, state, graph_op3(g, OP_front, point, stage->normal, stage->offset));
    normal_fold(l, &state->path, point, stage->normal, stage->offset);
    pole_bounds_fold(l, &state->pole_bounds, stage->normal, stage->offset);
    state->chain.point = graph_op3(g, OP_fold, point, stage->normal, stage->offset);
    state->level--;
    watch_orbit(l, state);
}

/* Joins the kernels since the last hull: max(hull, min(a, b)), where nothing waits for what is
   inside of another hull. */
static void leave_hull(Lowering *l, SequenceState *state)
{
    Node bound      = state->inside == NODE_NONE
                          ? NODE_NONE
                          : farther_of(l->graph, state->inside, state->pole_bounds.distance);
    state->distance = nearer_of(l->graph, state->distance, bound);
    state->inside   = NODE_NONE;
}

/* Applies a map; `before`: around what it is applied to, or NULL.  If something above moves the
   surface, it would show how far from a pole the hulls are: then all hulls are used. */
static void take_map(Lowering *l, SequenceState *state, const SequenceStage *stage,
                     const LevelBound *before)
{
    Ball       ball        = before ? before->ball : (Ball){.radius = HUGE_VAL};
    PoleBounds pole_bounds = state->pole_bounds;
    if (state->context.lipschitz)
        pole_bounds.within.radius = HUGE_VAL;
    if (pole_bounds_append(l, &pole_bounds, &state->chain, &stage->map, ball))
        leave_hull(l, state);
    state->pole_bounds = pole_bounds;
    map_chain_append(l, &state->chain, &stage->map, &state->path);
}

/* Prepares the next fold before the kernel.  Nodes become statements in the order in which they are
   made, and the next fold is what all other levels wait for: so a processor has both in sight. */
static void prepare_fold(Lowering *l, const SequenceState *state, const SequenceStage *next)
{
    if (next && next->kind == SEQUENCE_REFLECT)
        graph_op3(l->graph, OP_fold, state->chain.point, next->normal, next->offset);
}

/* A kernel, or what is behind a sphere, joins with those so far. */
static void join_kernel(Lowering *l, SequenceState *state, Lowered kernel)
{
    kernel = map_chain_out(l, &state->chain, kernel);
    normal_kernel(l, &state->path, state->result, kernel);
    state->result = join_two(l, blend_sharp, state->result, kernel);
    state->inside = nearer_of(l->graph, state->inside, kernel.distance);
}

/* Tells how far from the surface distances must be right behind a map that inverts. */
static double reach_behind_inversion(double reach) { return reach > 0 ? HUGE_VAL : 0; }

static void take_kernel(Lowering *l, SequenceState *state, const Shape *shape)
{
    Graph       *g     = l->graph;
    LowerContext inner = context_behind(&state->path, state->context, state->chain.point);
    if (l->surfaces) {
        /* Within an outer sequence its level counts, and this instance is hashed in. */
        bool outer     = state->context.level != NODE_NONE;
        inner.level    = outer ? state->context.level : graph_number(g, state->level);
        inner.instance = outer ? graph_op2(g, OP_join_id, state->context.instance, state->id)
                               : state->id;
    }
    bool whole     = state->chain.shrink == NODE_NONE;
    inner.reach    = whole ? reach_behind(g, inner.reach, state->chain.scale)
                           : reach_behind_inversion(inner.reach);
    Node    unit   = enter_map_chain(l, &state->chain);
    Lowered kernel = lower_shape(l, shape, inner);
    l->unit        = unit;
    if (state->nearest != NODE_NONE && kernel.surface.trap == NODE_NONE)
        kernel.surface.trap = graph_op2(g, OP_vec2, state->nearest, state->nearest_at);
    join_kernel(l, state, kernel);
}

/* Folds the point by the mirror of a stage; returns the state behind it. */
static SequenceState *enter_sphere(Lowering *l, SequenceState *state, uint32_t index)
{
    const Shape         *krs   = state->krs;
    const SequenceStage *stage = &krs->stages[index];
    Ball                 ball  = index ? krs->bounds[index - 1].ball : (Ball){.radius = HUGE_VAL};
    Node                 point = state->chain.point;
    SphereFold           fold  = sphere_fold_at(l->graph, stage, point, ball);
    if (l->surfaces)
        push_bit(l, state, sphere_front(l->graph, stage, point));
    normal_sphere(l, &state->path, stage, point, &fold);
    LowerContext context  = context_behind(&state->path, state->context, fold.point);
    context.reach         = reach_behind_inversion(context.reach);
    SequenceState *behind = sequence_state_new(l, krs, context, index);
    behind->id            = state->id;
    behind->level         = state->level - 1;
    behind->nearest       = state->nearest;
    behind->nearest_at    = state->nearest_at;
    behind->outer         = state;
    behind->fold          = fold;
    behind->unit          = enter_map_chain(l, &state->chain);
    if (l->guarded)
        enter_scale(l, graph_op2(l->graph, OP_div, graph_number(l->graph, 1), fold.sigma));
    watch_orbit(l, behind);
    return behind;
}

/* Returns the kernels that the stages of a state have met, joined. */
static Lowered end_state(Lowering *l, SequenceState *state)
{
    Lowered result        = state->result;
    result.surface.normal = normal_out(l, &state->path, result.surface.normal);
    leave_hull(l, state);
    if (state->pole_bounds.distance != NODE_NONE)
        result.distance = state->distance;
    result.distance = guard_at_sites(l, state->guard_sites, state->guard_site_count,
                                     result.distance);
    return result;
}

/* Returns the state in front of the last sphere, with what is behind it. */
static SequenceState *leave_sphere(Lowering *l, SequenceState *state)
{
    Lowered behind = end_state(l, state);
    l->unit        = state->unit;
    join_kernel(l, state->outer, sphere_fold_out(l, &state->fold, behind));
    return state->outer;
}

Lowered lower_krs(Lowering *l, const Shape *shape, LowerContext context)
{
    SequenceState *state = sequence_state_new(l, shape, context, shape->stage_count);
    watch_orbit(l, state);
    for (uint32_t i = shape->stage_count; i-- > 0;) {
        const SequenceStage *stage = &shape->stages[i];
        if (may_guard(l, shape, i, context))
            state->guard_sites[state->guard_site_count++] = (GuardSite){
                &shape->bounds[i], state->chain, state->result.distance};
        switch (stage->kind) {
        case SEQUENCE_REFLECT: take_mirror(l, state, stage); break;
        case SEQUENCE_SPHERE: state = enter_sphere(l, state, i); break;
        case SEQUENCE_MAP: take_map(l, state, stage, i ? &shape->bounds[i - 1] : NULL); break;
        case SEQUENCE_KERNEL:
            prepare_fold(l, state, i ? stage - 1 : NULL);
            take_kernel(l, state, shape->children[stage->kernel]);
            break;
        }
    }
    while (state->outer)
        state = leave_sphere(l, state);
    return end_state(l, state);
}
