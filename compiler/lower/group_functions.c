/*
 * group_functions.c: the functions of an instance group: distance, nearest instance, and what blends mix.
 *
 * States are what the instances before make, and the bodies join it with one more.  Of blends that share the
 * result, or are of pairs, states are the nearest distances.  Surfaces are mixed by shares, for which the
 * threshold must be known before.  What is not mixed is that of the nearest.
 */
#include "compiler/base/far.h"
#include "compiler/lower/instance_group.h"
#include "compiler/lower/join.h"
#include "compiler/lower/tangent.h"

PartLeaves part_leaves(Graph *graph)
{
    const uint32_t none = UINT32_MAX; /* no table: leaves of a table replace them in bodies */
    PartLeaves     leaves;
    leaves.point     = graph_instance_leaf(graph, OP_INSTANCE_POINT, none);
    leaves.normal    = graph_instance_leaf(graph, OP_INSTANCE_NORMAL, none);
    leaves.footprint = graph_instance_leaf(graph, OP_INSTANCE_FOOTPRINT, none);
    leaves.level     = graph_leaf(graph, OP_LEVEL);
    leaves.instance  = graph_leaf(graph, OP_INSTANCE);
    leaves.smoothing = graph_instance_leaf(graph, OP_INSTANCE_FOOTPRINT, none - 1);
    return leaves;
}

/* ---- what is asked ---- */

/* Tells how blends join what is known of surfaces: surface.def. */
static bool is_mixed(uint32_t root)
{
    static const bool mixed[PART_ROOTS] = {
        false,
#define MIXED                   true
#define NEARER                  false
#define KRS_INNER(name, blends) blends,

#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    KRS_INNER(name, blends)
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) KRS_INNER(name, blends)
#include "krs/surface.def"
    };
    return mixed[root];
}

static bool root_varies(const InstanceGroup *group, uint32_t root, Arena *scratch)
{
    bool  wanted[PART_ROOTS] = {[0] = false};
    bool *needed             = arena_new_array(scratch, bool, group->template->slot_count + 1);
    wanted[root]             = true;
    template_slots_of(group->template, wanted, needed, scratch);
    for (uint32_t i = 0; i < group->template->slot_count; i++)
        if (needed[i] && group->varies[i])
            return true;
    return false;
}

static bool is_function(const InstanceGroup *group, const GroupJoin *join, uint32_t root)
{
    return join->blend.width != NODE_NONE && is_mixed(root) &&
           root_varies(group, root, join->scratch);
}

bool group_mixes(const InstanceGroup *group, const GroupJoin *join)
{
    for (uint32_t root = PART_SURFACE; root < PART_ROOTS; root++)
        if (is_function(group, join, root))
            return true;
    return false;
}

bool group_varies(const InstanceGroup *group, const GroupJoin *join)
{
    for (uint32_t root = PART_SURFACE; root < PART_ROOTS; root++)
        if (root_varies(group, root, join->scratch))
            return true;
    return false;
}

bool group_has_functions(const InstanceGroup *group, const GroupJoin *join)
{
    for (uint32_t root = PART_SURFACE; root < PART_ROOTS; root++) {
        bool wanted[PART_ROOTS] = {[0] = false};
        wanted[root]            = true;
        const Node outer[] = {join->leaves.level, join->leaves.instance, join->leaves.smoothing,
                              graph_leaf(join->graph, OP_FRONT)};
        for (size_t i = 0; i < sizeof outer / sizeof *outer; i++)
            if (is_function(group, join, root) &&
                template_needs(group->template, outer[i], wanted, join->scratch))
                return false;
    }
    return true;
}

/* ---- bodies ---- */

typedef struct InstanceInBody {
    Node distance, property, number;
} InstanceInBody;

/* Returns an instance in the body of a function; `root` is a property that is wanted, too. */
static InstanceInBody instance_in_body(const InstanceGroup *group, const GroupJoin *join,
                                       uint32_t root)
{
    Graph   *g       = join->graph;
    Node     number  = graph_instance_leaf(g, OP_INSTANCE_ROW, group->table_number);
    Node    *slots   = arena_new_array(join->scratch, Node, group->template->slot_count + 1);
    LeafPair pairs[] = {
        {join->leaves.point, graph_instance_leaf(g, OP_INSTANCE_POINT, group->table_number)},
        {join->leaves.normal, graph_instance_leaf(g, OP_INSTANCE_NORMAL, group->table_number)},
        {join->leaves.footprint,
         graph_instance_leaf(g, OP_INSTANCE_FOOTPRINT, group->table_number)}};
    bool wanted[PART_ROOTS] = {[PART_DISTANCE] = true};
    Node roots[PART_ROOTS];
    wanted[root] = true;
    group_slots(group, g, number, slots);
    template_copy(g, group->template, slots, pairs, 3, wanted, roots, join->scratch);
    InstanceInBody instance = {roots[PART_DISTANCE], roots[root], number};
    if (join->complement)
        instance.distance = graph_op1(g, OP_neg, instance.distance);
    return instance;
}

static uint32_t next_function(Graph *g) { return (uint32_t)graph_instances(g)->functions.count; }

/* Bounds the slope of the distance to all instances, which are joined sharply or blended; 0: it has no bound. */
static double slope_of(const InstanceGroup *group, const GroupJoin *join)
{
    double slope = group->slope;
    if (join->blend.width != NODE_NONE)
        slope *= blend_info[join->blend.kind].slope;
    return isfinite(slope) ? slope : 0;
}

/* Makes a blend that fades, -k log of the sum of e^(-d / k).  States are the least distance m, the
   sum of e^((m - d) / k), k, and d for shaders: one power for each instance, and one logarithm for
   all. */
static uint32_t make_sum(const InstanceGroup *group, const GroupJoin *join)
{
    Graph         *g          = join->graph;
    Node           least      = graph_state(g, TYPE_FLOAT, next_function(g), 0);
    Node           sum        = graph_state(g, TYPE_FLOAT, next_function(g), 1);
    InstanceInBody instance   = instance_in_body(group, join, PART_DISTANCE);
    Node           width      = graph_op2(g, OP_max, join->blend.width, graph_number(g, 1e-30));
    Node           difference = graph_op2(g, OP_sub, instance.distance, least);
    Node           nearer     = graph_op2(g, OP_less, instance.distance, least);
    Node           away       = graph_op1(g, OP_neg, graph_op1(g, OP_abs, difference));
    Node           power      = graph_op1(g, OP_exp, graph_op2(g, OP_div, away, width));
    Node           others     = graph_op2(g, OP_mul, sum, power);
    others                    = graph_op2(g, OP_add, others, graph_number(g, 1));
    Node             more     = graph_op2(g, OP_add, sum, power);
    Node             bodies[] = {graph_op2(g, OP_min, least, instance.distance),
                                 graph_op3(g, OP_select, nearer, others, more), width, instance.distance};
    InstanceFunction function = {
        .table_number = group->table_number,
        .type         = TYPE_FLOAT,
        .clear        = true,
        .slope        = slope_of(group, join),
        .sums         = true,
        .ends         = graph_instances(g)->tables.items[group->table_number].cells.tails != NULL,
        .states       = {{TYPE_FLOAT, {NOWHERE}},
                         {TYPE_FLOAT, {0}},
                         {TYPE_FLOAT, {0}},
                         {TYPE_FLOAT, {0}}},
        .state_count  = 4};
    return graph_add_instance_function(g, function, bodies);
}

/* Makes a function whose states are the nearest distances, the width and, of pairs, the number of
   steps.  Without `joined` it joins them as the blend does, else to what that makes of the states. */
static uint32_t make_of_nearest(const InstanceGroup *group, const GroupJoin *join, bool pairs,
                                uint32_t listed, bool threshold)
{
    Graph         *g        = join->graph;
    uint32_t       id       = next_function(g);
    GraphType      type     = pairs ? TYPE_FLOAT : TYPE_VEC4;
    Nearest        before   = {pairs, graph_state(g, type, id, 0), graph_state(g, type, id, 1)};
    InstanceInBody instance = instance_in_body(group, join, PART_DISTANCE);
    Nearest        after    = nearest_add(g, before, instance.distance);
    bool           steps    = pairs && join->blend.steps != NODE_NONE;
    Blend          states   = join->blend;
    threshold               = threshold || (!pairs && blend_many(states.kind).way != MANY_SHARE);
    states.width            = graph_state(g, TYPE_FLOAT, id, 2);
    if (steps)
        states.steps = graph_state(g, TYPE_FLOAT, id, 3);
    Node             bodies[5]   = {after.near, after.more, join->blend.width, join->blend.steps};
    InstanceFunction function    = {.table_number = group->table_number,
                                    .type         = listed == NOT_LISTED ? TYPE_FLOAT : type,
                                    .clear        = !threshold,
                                    .slope        = threshold || listed != NOT_LISTED ? 0
                                                                                      : slope_of(group, join),
                                    .joins        = true,
                                    .listed       = listed,
                                    .states       = {{type, {NOWHERE, NOWHERE, NOWHERE, NOWHERE}},
                                                     {type, {NOWHERE, NOWHERE, NOWHERE, NOWHERE}},
                                                     {TYPE_FLOAT, {0}},
                                                     {TYPE_FLOAT, {0}}},
                                    .state_count  = steps ? 4 : 3};
    bodies[function.state_count] = threshold ? nearest_threshold(g, states, before)
                                             : nearest_end(g, states, before);
    return graph_add_instance_function(g, function, bodies);
}

/* Joins instances one after the other: by sharp CSG nodes, and blends for which the order means
   nothing. */
static uint32_t make_row(const InstanceGroup *group, const GroupJoin *join)
{
    Graph           *g        = join->graph;
    Node             state    = graph_state(g, TYPE_FLOAT, next_function(g), 0);
    InstanceInBody   instance = instance_in_body(group, join, PART_DISTANCE);
    Node             body     = join_distances(g, join->blend, state, instance.distance);
    InstanceFunction function = {.table_number = group->table_number,
                                 .type         = TYPE_FLOAT,
                                 .clear        = true,
                                 .slope        = slope_of(group, join),
                                 .states       = {{TYPE_FLOAT, {NOWHERE}}},
                                 .state_count  = 1};
    return graph_add_instance_function(g, function, &body);
}

static uint32_t make_distance(const InstanceGroup *group, const GroupJoin *join)
{
    const bool sharp = join->blend.width == NODE_NONE;
    if (!sharp && blend_fades(join->blend.kind))
        return make_sum(group, join);
    const BlendMany many = blend_many(join->blend.kind);
    if (sharp || many.way == MANY_IN_ROW)
        return make_row(group, join);
    return make_of_nearest(group, join, many.way == MANY_PAIRS, NOT_LISTED, false);
}

static uint32_t make_nearest(const InstanceGroup *group, const GroupJoin *join)
{
    Graph           *g        = join->graph;
    Node             number   = graph_state(g, TYPE_UINT, next_function(g), 0);
    Node             state    = graph_state(g, TYPE_FLOAT, next_function(g), 1);
    InstanceInBody   instance = instance_in_body(group, join, PART_DISTANCE);
    Node             stays    = graph_op2(g, OP_less, state, instance.distance);
    Node             bodies[] = {graph_op3(g, OP_select, stays, number, instance.number),
                                 graph_op2(g, OP_min, state, instance.distance)};
    InstanceFunction function = {.table_number = group->table_number,
                                 .type         = TYPE_UINT,
                                 .states       = {{TYPE_UINT, {0}}, {TYPE_FLOAT, {NOWHERE}}},
                                 .state_count  = 2,
                                 .distance     = 1};
    return graph_add_instance_function(g, function, bodies);
}

/* Makes the weighted mean of a property, or without one (PART_DISTANCE) the sum of shares. */
static uint32_t make_property(const InstanceGroup *group, const GroupJoin *join, uint32_t root)
{
    Graph         *g         = join->graph;
    InstanceInBody instance  = instance_in_body(group, join, root);
    GraphType      type      = (GraphType)g->items[instance.property].type;
    Node           property  = graph_state(g, type, next_function(g), 0);
    Node           least     = graph_state(g, TYPE_FLOAT, next_function(g), 1);
    Node           sum       = graph_state(g, TYPE_FLOAT, next_function(g), 2);
    Node           threshold = graph_instance_leaf(g, OP_INSTANCE_THRESHOLD, group->table_number);
    Node           share     = share_below(g, join->blend, threshold, instance.distance);
    Node           more      = graph_op2(g, OP_add, sum, share);
    Node weight   = graph_op2(g, OP_div, sum, graph_op2(g, OP_max, more, graph_number(g, 1e-30)));
    Node mean     = graph_op3(g, OP_mix, instance.property, property, weight);
    Node bodies[] = {root == PART_DISTANCE ? graph_op2(g, OP_add, property, share) : mean,
                     graph_op2(g, OP_min, least, instance.distance), more};
    InstanceFunction function = {
        .table_number = group->table_number,
        .type         = type,
        .states       = {{type, {0}}, {TYPE_FLOAT, {NOWHERE}}, {TYPE_FLOAT, {0}}},
        .state_count  = root == PART_DISTANCE ? 2 : 3,
        .distance     = 1};
    return graph_add_instance_function(g, function, bodies);
}

/* ---- calls ---- */

static Node call_nearest(InstanceGroup *group, const GroupJoin *join, Node point)
{
    if (group->nearest == NO_FUNCTION)
        group->nearest = make_nearest(group, join);
    return graph_instance_call(join->graph, OP_instance_index, group->nearest, point);
}

static Node call_property(InstanceGroup *group, const GroupJoin *join, uint32_t root,
                          LowerContext context, Node threshold)
{
    uint32_t *function = &group->properties[root];
    if (*function == NO_FUNCTION)
        *function = make_property(group, join, root);
    const InstanceFunction *made = &graph_instances(join->graph)->functions.items[*function];
    Op                      op = made->type == TYPE_FLOAT ? OP_instance_number : OP_instance_vector;
    return graph_instance_surface(join->graph, op, *function, context.point, context.normal,
                                  context.footprint, threshold);
}

static Node call_distance(const GroupJoin *join, uint32_t function, LowerContext context)
{
    const InstanceFunction *made = &graph_instances(join->graph)->functions.items[function];
    Op                      op = made->type == TYPE_VEC4 ? OP_instance_list : OP_instance_distance;
    return graph_instance_call(join->graph, op, function, context.point);
}

/* Copies the wanted roots of one instance, or of all where they do not vary, where the context is. */
static void copy_outside(const InstanceGroup *group, const GroupJoin *join, Node instance,
                         LowerContext context, const bool *wanted, Node *roots)
{
    const PartLeaves *leaves = &join->leaves;
    const LeafPair    all[]  = {
            {leaves->point, context.point},         {leaves->normal, context.normal},
            {leaves->footprint, context.footprint}, {leaves->level, context.level},
            {leaves->instance, context.instance},   {leaves->smoothing, context.smoothing}};
    LeafPair pairs[6];
    uint32_t count = 0;
    for (int i = 0; i < 6; i++)
        if (all[i].by != NODE_NONE)
            pairs[count++] = all[i];
    Node *slots = arena_new_array(join->scratch, Node, group->template->slot_count + 1);
    group_slots(group, join->graph, instance, slots);
    template_copy(join->graph, group->template, slots, pairs, count, wanted, roots, join->scratch);
}

Surface group_surface(InstanceGroup *group, const GroupJoin *join, Node threshold,
                      LowerContext context)
{
    bool same[PART_ROOTS] = {[0] = false}, nearest[PART_ROOTS] = {[0] = false}, any = false;
    Node roots[PART_ROOTS], of_nearest[PART_ROOTS];
    for (uint32_t root = PART_SURFACE; root < PART_ROOTS; root++) {
        same[root]    = !root_varies(group, root, join->scratch);
        nearest[root] = !same[root] && !is_function(group, join, root);
        any           = any || nearest[root];
    }
    copy_outside(group, join, NODE_NONE, context, same, roots);
    if (any) {
        Node instance = call_nearest(group, join, context.point);
        copy_outside(group, join, instance, context, nearest, of_nearest);
    }
    for (uint32_t root = PART_SURFACE; root < PART_ROOTS; root++)
        if (nearest[root])
            roots[root] = of_nearest[root];
        else if (!same[root])
            roots[root] = call_property(group, join, root, context, threshold);
    Surface surface;
#define KRS_INNER(name, blends) \
    surface.name = roots[PART_SURFACE + offsetof(Surface, name) / sizeof(Node)];

#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    KRS_INNER(name, blends)
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) KRS_INNER(name, blends)
#include "krs/surface.def"
    surface.tangent = tangent_outwards(join->graph, surface.tangent, context.point, join->scratch);
    return surface;
}

Node group_distance(InstanceGroup *group, const GroupJoin *join, LowerContext context)
{
    if (group->distance == NO_FUNCTION)
        group->distance = make_distance(group, join);
    return call_distance(join, group->distance, context);
}

Nearest group_nearest(InstanceGroup *group, const GroupJoin *join, bool pairs, LowerContext context)
{
    Nearest nearest = {.pairs = pairs};
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t *function = &group->lists[pairs][i];
        if (*function == NO_FUNCTION)
            *function = make_of_nearest(group, join, pairs, i, false);
        *(i ? &nearest.more : &nearest.near) = call_distance(join, *function, context);
    }
    return nearest;
}

Node group_threshold(InstanceGroup *group, const GroupJoin *join, LowerContext context)
{
    if (group->threshold == NO_FUNCTION)
        group->threshold = make_of_nearest(group, join, false, NOT_LISTED, true);
    return call_distance(join, group->threshold, context);
}

Node group_share(InstanceGroup *group, const GroupJoin *join, Node threshold, LowerContext context)
{
    return call_property(group, join, PART_DISTANCE, context, threshold);
}

Lowered group_lower(InstanceGroup *group, const GroupJoin *join, bool surfaces,
                    LowerContext context)
{
    Lowered result  = lowered_nothing;
    result.distance = group_distance(group, join, context);
    if (surfaces) {
        const bool sharp     = join->blend.width == NODE_NONE;
        Node       threshold = sharp ? graph_number(join->graph, 0)
                                     : group_threshold(group, join, context);
        result.surface       = group_surface(group, join, threshold, context);
    }
    return result;
}
