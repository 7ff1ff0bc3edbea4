/*
 * blend.c: blends of any number of parts.
 *
 * All parts are operands of one blend (blends.def), whether they are lowered one by one or as instances of groups: so
 * neither their order nor their number shows.
 */
#include "compiler/lower/blend.h"

#include "compiler/lower/instance_group.h"
#include "compiler/lower/join.h"
#include "compiler/lower/surface.h"

/* The operands: parts by themselves, and groups. */
typedef struct Blending {
    Lowering    *l;
    Blend        blend;
    LowerContext context;
    Lowered     *parts;
    Node        *distances; /* of these */
    uint32_t     part_count;
    JoinedGroups groups;
} Blending;

static bool lower_parts(Blending *b, const PartJoin *join)
{
    Graph *g     = b->l->graph;
    b->parts     = arena_new_array(b->l->scratch, Lowered, join->count + 1);
    b->distances = arena_new_array(b->l->scratch, Node, join->count + 1);
    for (uint32_t i = 0; i < join->count; i++) {
        Lowered part = lower_operand(b->l, join->parts[i], b->context);
        if (part.distance == NODE_NONE && join->complement)
            return false;
        if (part.distance == NODE_NONE)
            continue;
        b->parts[b->part_count++] = part;
    }
    for (uint32_t i = b->part_count; i-- > 0;) {
        if (join->complement)
            b->parts[i].distance = graph_op1(g, OP_neg, b->parts[i].distance);
        b->distances[i] = b->parts[i].distance;
    }
    return true;
}

/* Returns the nearest of all operands. */
static Nearest nearest_operands(const Blending *b, bool pairs)
{
    Graph  *g       = b->l->graph;
    Nearest nearest = group_nearest(&b->groups.groups[0], &b->groups.join, pairs, b->context);
    for (uint32_t i = 1; i < b->groups.count; i++) {
        Nearest more = group_nearest(&b->groups.groups[i], &b->groups.join, pairs, b->context);
        nearest      = nearest_merge(g, nearest, more);
    }
    for (uint32_t i = 0; i < b->part_count; i++)
        nearest = nearest_add(g, nearest, b->distances[i]);
    return nearest;
}

/* Joins some groups and separate parts, together more than one. */
static Node join_operands(const Blending *b)
{
    const BlendMany many = blend_many(b->blend.kind);
    if (many.way != MANY_IN_ROW)
        return nearest_end(b->l->graph, b->blend, nearest_operands(b, many.way == MANY_PAIRS));
    Node all = NODE_NONE;
    if (b->part_count > 0)
        all = blend_distances(b->l->graph, b->blend, b->distances, b->part_count);
    for (uint32_t i = b->groups.count; i-- > 0;) {
        Node group = group_distance(&b->groups.groups[i], &b->groups.join, b->context);
        all        = all == NODE_NONE ? group : join_distances(b->l->graph, b->blend, group, all);
    }
    return all;
}

/* ---- surfaces ---- */

/* The mean of some surfaces, the sum of their shares, and the least of their distances. */
typedef struct Mean {
    Surface surface;
    Node    shares, least;
} Mean;

static Mean mean_of_two(Graph *g, Mean a, Mean b)
{
    Mean mean;
    Node nearer  = graph_op2(g, OP_less, a.least, b.least);
    mean.shares  = graph_op2(g, OP_add, a.shares, b.shares);
    Node divisor = graph_op2(g, OP_max, mean.shares, graph_number(g, 1e-30));
    Node weight  = graph_op2(g, OP_div, a.shares, divisor);
    mean.surface = mix_surface(g, nearer, weight, a.surface, b.surface);
    mean.least   = graph_op2(g, OP_min, a.least, b.least);
    return mean;
}

static Node threshold_of_operands(const Blending *b)
{
    return b->groups.count == 0
               ? blend_threshold(b->l->graph, b->blend, b->distances, b->part_count)
               : nearest_threshold(b->l->graph, b->blend, nearest_operands(b, false));
}

static Surface mix_operands(const Blending *b)
{
    Graph *g         = b->l->graph;
    Node   threshold = threshold_of_operands(b);
    Mean   all;
    bool   any = false;
    for (uint32_t i = 0; i < b->groups.count; i++) {
        InstanceGroup   *group = &b->groups.groups[i];
        const GroupJoin *join  = &b->groups.join;
        Nearest          pairs = group_nearest(group, join, false, b->context);
        Mean             next  = {group_surface(group, join, threshold, b->context),
                                  group_share(group, join, threshold, b->context),
                                  graph_component(g, pairs.near, 0)};
        all                    = any ? mean_of_two(g, all, next) : next;
        any                    = true;
    }
    for (uint32_t i = 0; i < b->part_count; i++) {
        Node share = share_below(g, b->blend, threshold, b->distances[i]);
        Mean next  = {b->parts[i].surface, share, b->distances[i]};
        all        = any ? mean_of_two(g, all, next) : next;
        any        = true;
    }
    return all.surface;
}

/* ---- all ---- */

Lowered lower_blend(Lowering *l, PartJoin join, LowerContext context, bool *nowhere)
{
    Blending b      = {.l = l, .blend = join.csg_node->blend, .context = context};
    Lowered  result = lowered_nothing;
    b.groups        = find_joined_groups(l, &join, context);
    *nowhere        = !lower_parts(&b, &join);
    if (*nowhere || b.groups.count + b.part_count == 0)
        return result;
    if (b.groups.count == 1 && b.part_count == 0)
        return group_lower(&b.groups.groups[0], &b.groups.join, l->surfaces, context);
    if (b.groups.count == 0 && b.part_count <= 2)
        return b.part_count == 1 ? b.parts[0] : join_two(l, b.blend, b.parts[0], b.parts[1]);
    result.distance = b.groups.count == 0
                          ? blend_distances(l->graph, b.blend, b.distances, b.part_count)
                          : join_operands(&b);
    if (l->surfaces)
        result.surface = mix_operands(&b);
    return result;
}
