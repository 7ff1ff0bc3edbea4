/*
 * crowd_functions.c: the functions of a crowd: distance, nearest member, and what blends mix.
 *
 * Members are joined in their order, as join_two joins two shapes: a state is what the members
 * before make, and the body joins it with one more.  What is not mixed is that of the nearest.
 */
#include "compiler/base/far.h"
#include "compiler/lower/crowd_group.h"
#include "compiler/lower/join.h"
#include "compiler/lower/tangent.h"

PartLeaves part_leaves(Graph *graph)
{
    const uint32_t none = UINT32_MAX; /* no table: leaves of a table replace them in bodies */
    PartLeaves     leaves;
    leaves.point     = graph_crowd_leaf(graph, OP_CROWD_POINT, none);
    leaves.normal    = graph_crowd_leaf(graph, OP_CROWD_NORMAL, none);
    leaves.footprint = graph_crowd_leaf(graph, OP_CROWD_FOOTPRINT, none);
    leaves.level     = graph_leaf(graph, OP_LEVEL);
    leaves.instance  = graph_leaf(graph, OP_INSTANCE);
    leaves.smoothing = graph_crowd_leaf(graph, OP_CROWD_FOOTPRINT, none - 1);
    return leaves;
}

/* ---- what is asked ---- */

/* How blends join what is known of surfaces: surface.def. */
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
#include "compiler/shape/surface.def"
    };
    return mixed[root];
}

static bool root_varies(const CrowdGroup *group, uint32_t root, Arena *scratch)
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

static bool is_function(const CrowdGroup *group, const GroupJoin *join, uint32_t root)
{
    return join->blend.width != NODE_NONE && is_mixed(root) &&
           root_varies(group, root, join->scratch);
}

bool group_mixes(const CrowdGroup *group, const GroupJoin *join)
{
    for (uint32_t root = PART_SURFACE; root < PART_ROOTS; root++)
        if (is_function(group, join, root))
            return true;
    return false;
}

bool group_varies(const CrowdGroup *group, const GroupJoin *join)
{
    for (uint32_t root = PART_SURFACE; root < PART_ROOTS; root++)
        if (root_varies(group, root, join->scratch))
            return true;
    return false;
}

bool group_has_functions(const CrowdGroup *group, const GroupJoin *join)
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

typedef struct Member {
    Node distance, property, number;
} Member;

/* A member in the body of a function; `root` is a property that is wanted, too. */
static Member member_in_body(const CrowdGroup *group, const GroupJoin *join, uint32_t root)
{
    Graph   *g       = join->graph;
    Node     number  = graph_crowd_leaf(g, OP_MEMBER, group->crowd);
    Node    *slots   = arena_new_array(join->scratch, Node, group->template->slot_count + 1);
    LeafPair pairs[] = {
        {join->leaves.point, graph_crowd_leaf(g, OP_CROWD_POINT, group->crowd)},
        {join->leaves.normal, graph_crowd_leaf(g, OP_CROWD_NORMAL, group->crowd)},
        {join->leaves.footprint, graph_crowd_leaf(g, OP_CROWD_FOOTPRINT, group->crowd)}};
    bool wanted[PART_ROOTS] = {[PART_DISTANCE] = true};
    Node roots[PART_ROOTS];
    wanted[root] = true;
    group_slots(group, g, number, slots);
    template_copy(g, group->template, slots, pairs, 3, wanted, roots, join->scratch);
    Member member = {roots[PART_DISTANCE], roots[root], number};
    if (join->complement)
        member.distance = graph_op1(g, OP_neg, member.distance);
    return member;
}

static uint32_t next_function(Graph *g) { return (uint32_t)graph_crowds(g)->functions.count; }

/* A blend that fades, -k log of the sum of e^(-d / k).  States are the least distance m, the sum of
   e^((m - d) / k), k, and d for kernels: one power for each member, and one logarithm for all. */
static uint32_t make_sum(const CrowdGroup *group, const GroupJoin *join)
{
    Graph *g               = join->graph;
    Node   least           = graph_state(g, TYPE_FLOAT, next_function(g), 0);
    Node   sum             = graph_state(g, TYPE_FLOAT, next_function(g), 1);
    Member member          = member_in_body(group, join, PART_DISTANCE);
    Node   width           = graph_op2(g, OP_max, join->blend.width, graph_number(g, 1e-30));
    Node   apart           = graph_op2(g, OP_sub, member.distance, least);
    Node   nearer          = graph_op2(g, OP_less, member.distance, least);
    Node   away            = graph_op1(g, OP_neg, graph_op1(g, OP_abs, apart));
    Node   power           = graph_op1(g, OP_exp, graph_op2(g, OP_div, away, width));
    Node   others          = graph_op2(g, OP_mul, sum, power);
    others                 = graph_op2(g, OP_add, others, graph_number(g, 1));
    Node          more     = graph_op2(g, OP_add, sum, power);
    Node          bodies[] = {graph_op2(g, OP_min, least, member.distance),
                              graph_op3(g, OP_select, nearer, others, more), width, member.distance};
    CrowdFunction function = {.crowd = group->crowd,
                              .type  = TYPE_FLOAT,
                              .clear = true,
                              .sums  = true,
                              .ends  = graph_crowds(g)->tables.items[group->crowd].cells.tails !=
                                      NULL,
                              .states      = {{TYPE_FLOAT, {NOWHERE}},
                                              {TYPE_FLOAT, {0}},
                                              {TYPE_FLOAT, {0}},
                                              {TYPE_FLOAT, {0}}},
                              .state_count = 4};
    return graph_add_crowd_function(g, function, bodies);
}

static uint32_t make_distance(const CrowdGroup *group, const GroupJoin *join)
{
    if (join->blend.width != NODE_NONE && blend_fades(join->blend.kind))
        return make_sum(group, join);
    Graph        *g        = join->graph;
    Node          state    = graph_state(g, TYPE_FLOAT, next_function(g), 0);
    Member        member   = member_in_body(group, join, PART_DISTANCE);
    Node          body     = join_distances(g, join->blend, state, member.distance);
    CrowdFunction function = {.crowd       = group->crowd,
                              .type        = TYPE_FLOAT,
                              .clear       = true,
                              .states      = {{TYPE_FLOAT, {NOWHERE}}},
                              .state_count = 1};
    return graph_add_crowd_function(g, function, &body);
}

static uint32_t make_nearest(const CrowdGroup *group, const GroupJoin *join)
{
    Graph        *g        = join->graph;
    Node          number   = graph_state(g, TYPE_UINT, next_function(g), 0);
    Node          state    = graph_state(g, TYPE_FLOAT, next_function(g), 1);
    Member        member   = member_in_body(group, join, PART_DISTANCE);
    Node          stays    = graph_op2(g, OP_less, state, member.distance);
    Node          bodies[] = {graph_op3(g, OP_select, stays, number, member.number),
                              join_distances(g, join->blend, state, member.distance)};
    CrowdFunction function = {.crowd       = group->crowd,
                              .type        = TYPE_UINT,
                              .states      = {{TYPE_UINT, {0}}, {TYPE_FLOAT, {NOWHERE}}},
                              .state_count = 2,
                              .distance    = 1};
    return graph_add_crowd_function(g, function, bodies);
}

static uint32_t make_property(const CrowdGroup *group, const GroupJoin *join, uint32_t root)
{
    Graph        *g        = join->graph;
    Member        member   = member_in_body(group, join, root);
    GraphType     type     = (GraphType)g->items[member.property].type;
    Node          property = graph_state(g, type, next_function(g), 0);
    Node          state    = graph_state(g, TYPE_FLOAT, next_function(g), 1);
    Node          weight = graph_op3(g, OP_blend_weight, state, member.distance, join->blend.width);
    Node          bodies[] = {graph_op3(g, OP_mix, member.property, property, weight),
                              join_distances(g, join->blend, state, member.distance)};
    CrowdFunction function = {.crowd       = group->crowd,
                              .type        = type,
                              .states      = {{type, {0}}, {TYPE_FLOAT, {NOWHERE}}},
                              .state_count = 2,
                              .distance    = 1};
    return graph_add_crowd_function(g, function, bodies);
}

/* ---- calls ---- */

static Node call_nearest(CrowdGroup *group, const GroupJoin *join, Node point)
{
    if (group->nearest == NO_FUNCTION)
        group->nearest = make_nearest(group, join);
    return graph_crowd(join->graph, OP_crowd_member, group->nearest, point);
}

static Node call_property(CrowdGroup *group, const GroupJoin *join, uint32_t root,
                          LowerContext context)
{
    uint32_t *function = &group->properties[root];
    if (*function == NO_FUNCTION)
        *function = make_property(group, join, root);
    const CrowdFunction *made = &graph_crowds(join->graph)->functions.items[*function];
    Op                   op   = made->type == TYPE_FLOAT ? OP_crowd_number : OP_crowd_vector;
    return graph_crowd_surface(join->graph, op, *function, context.point, context.normal,
                               context.footprint);
}

/* The wanted roots of one member, or of all where they do not vary, where the context is. */
static void copy_outside(const CrowdGroup *group, const GroupJoin *join, Node member,
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
    group_slots(group, join->graph, member, slots);
    template_copy(join->graph, group->template, slots, pairs, count, wanted, roots, join->scratch);
}

static Surface lower_surface(CrowdGroup *group, const GroupJoin *join, LowerContext context)
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
        Node member = call_nearest(group, join, context.point);
        copy_outside(group, join, member, context, nearest, of_nearest);
    }
    for (uint32_t root = PART_SURFACE; root < PART_ROOTS; root++)
        if (nearest[root])
            roots[root] = of_nearest[root];
        else if (!same[root])
            roots[root] = call_property(group, join, root, context);
    Surface surface;
#define KRS_INNER(name, blends) \
    surface.name = roots[PART_SURFACE + offsetof(Surface, name) / sizeof(Node)];

#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    KRS_INNER(name, blends)
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) KRS_INNER(name, blends)
#include "compiler/shape/surface.def"
    surface.tangent = tangent_outwards(join->graph, surface.tangent, context.point, join->scratch);
    return surface;
}

Lowered group_lower(CrowdGroup *group, const GroupJoin *join, bool surfaces, LowerContext context)
{
    Lowered result = lowered_nothing;
    if (group->distance == NO_FUNCTION)
        group->distance = make_distance(group, join);
    result.distance = graph_crowd(join->graph, OP_crowd_distance, group->distance, context.point);
    if (surfaces)
        result.surface = lower_surface(group, join, context);
    return result;
}
