/*
 * crowd.c: the crowds of a joint, which all its lowerings share.
 */
#include "compiler/lower/crowd.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/graph/instances/crowd_frame.h"
#include "compiler/lower/crowd_group.h"
#include "compiler/lower/join.h"

/* The crowds of a joint, in one kind of context. */
typedef struct JointCrowds {
    struct JointCrowds *next;
    const Shape        *joint;
    LowerContext        context; /* what matters of it */
    CrowdGroup         *groups;
    uint32_t            group_count;
    const Shape       **rest;
    uint32_t            rest_count;
} JointCrowds;

enum { BUCKETS = 256 };

struct LoweredCrowds {
    Graph       *graph;
    Arena       *arena, *tables;
    Alike       *alike;
    PartLeaves   leaves;
    uint32_t     least; /* members of a crowd */
    uint32_t     few;   /* the same of sharp joints, if they are large */
    uint32_t     made;  /* joints with crowds, and functions of outlines */
    JointCrowds *joints[BUCKETS];
};

LoweredCrowds *lowered_crowds_new(Graph *graph, Arena *arena, Arena *tables, uint32_t least)
{
    LoweredCrowds *crowds = arena_new(arena, LoweredCrowds);
    crowds->graph         = graph;
    crowds->arena         = arena;
    crowds->tables        = tables;
    crowds->least = crowds->few = least;
    return crowds;
}

void lowered_crowds_take_few(LoweredCrowds *crowds) { crowds->few = LEAST_OF_FEW; }

uint32_t least_of_joint(const LoweredCrowds *crowds, bool sharp)
{
    return sharp ? crowds->few : crowds->least;
}

/* Whether a loop costs less than the members of a group one by one. */
static bool is_worth_it(const PartFinder *finder, const CrowdGroup *group)
{
    const size_t count = group->members.count;
    return count >= finder->many ||
           (count >= finder->least && (count - 1) * group->template->node_count >= LEAST_SAVED);
}

void lowered_crowds_made(LoweredCrowds *crowds) { crowds->made++; }

/* The context of parts.  Whether there is a level, an instance and a smoothing is as outside. */
static LowerContext context_of_parts(const PartLeaves *leaves, LowerContext outer)
{
    LowerContext context = outer;
    context.point        = leaves->point;
    context.normal       = leaves->normal;
    context.footprint    = leaves->footprint;
    context.level        = outer.level == NODE_NONE ? NODE_NONE : leaves->level;
    context.instance     = outer.instance == NODE_NONE ? NODE_NONE : leaves->instance;
    context.smoothing    = outer.smoothing == NODE_NONE ? NODE_NONE : leaves->smoothing;
    return context;
}

/* ---- tables ---- */

/* How many widths above a result a member is that has no share: a width above the least one, which is no
   more than a width above the result. */
static const double MIXING_REACH = 2;

static double blended_reach(const CrowdGroup *group, const GroupJoin *join)
{
    const Blend *blend = &join->blend;
    if (blend->width == NODE_NONE || blend->widest <= 0)
        return 0;
    double widths = blend_reach(blend->kind, (double)group->members.count);
    if (group_mixes(group, join))
        widths = fmax(widths, MIXING_REACH);
    return widths * blend->widest;
}

/* A distance that is a bound only is at least that to the sides of a box, of which the farthest
   counts. */
static double for_bounds(const PartFinder *finder, const CrowdGroup *group)
{
    for (size_t i = 0; i < group->members.count; i++)
        if (!finder->parts[group->members.items[i]]->exact)
            return sqrt(3);
    return 1;
}

/* Up to which distance that of a group must be right.  Groups are joined with each other and with the
   other parts by the same blend; one that has all parts is not. */
static double needed_reach(const PartFinder *finder, const CrowdGroups *groups, const Blend *blend)
{
    size_t members = 0;
    for (size_t i = 0; i < groups->count; i++)
        members += groups->items[i].members.count;
    size_t operands = groups->count + (members < finder->count);
    if (operands == 1 || blend->width == NODE_NONE)
        return finder->reach;
    return finder->reach + fmax(blend_reach(blend->kind, (double)operands) * blend->widest, 0);
}

static double largest_slope(const PartFinder *finder, const CrowdGroup *group)
{
    double slope = 1;
    for (size_t i = 0; i < group->members.count; i++)
        slope = fmax(slope, finder->parts[group->members.items[i]]->slope);
    return slope;
}

/* ---- members that move ---- */

static bool is_of_frame(const Graph *g, Node node) { return g->items[node].time == TIME_FRAME; }

static bool is_turned(const Graph *g, const Map *map)
{
    return is_of_frame(g, map->scale) || is_of_frame(g, map->rows[0]) ||
           is_of_frame(g, map->rows[1]) || is_of_frame(g, map->rows[2]);
}

/* The transformation that moves a part, seen through what leaves boxes as they are; NULL: nothing that
   depends on the frame does. */
static const Shape *moved_by(const Graph *g, const Shape *part)
{
    while (part->kind == SHAPE_PAINT || part->kind == SHAPE_SMOOTH)
        part = part->children[0];
    const Map *map = &part->map;
    if (part->kind != SHAPE_TRANSFORM)
        return NULL;
    return is_turned(g, map) || is_of_frame(g, map->shift) ? part : NULL;
}

/* A box that is turned and scaled by known numbers. */
static Box turn_box(const Graph *g, const Map *map, Box box)
{
    const Node       nodes[]   = {map->scale, map->rows[0], map->rows[1], map->rows[2]};
    NodeValue        values[5] = {{{0}}};
    const NodeValue *by[5];
    for (int i = 0; i < 5; i++)
        by[i] = &values[i];
    for (int i = 0; i < 4; i++)
        memcpy(values[i].v, g->items[nodes[i]].number, sizeof values[i].v);
    return box_under_map(&box, by);
}

static MemberPlace place_of(Graph *g, const Shape *part)
{
    const Shape *moved  = moved_by(g, part);
    Crowds      *crowds = graph_crowds(g);
    if (!moved)
        return (MemberPlace){part->box, PLACE_FIXED};
    const Map *map   = &moved->map;
    const Box  box   = moved->children[0]->box;
    const Node all[] = {map->scale, map->rows[0], map->rows[1], map->rows[2], map->shift};
    for (int i = is_turned(g, map) ? 0 : 4; i < 5; i++)
        array_push(crowds->arena, &crowds->frame_numbers, all[i]);
    return is_turned(g, map) ? (MemberPlace){box, PLACE_TURNED}
                             : (MemberPlace){turn_box(g, map, box), PLACE_SHIFT};
}

/* Where the members of a group are in each frame; nothing if none is known to move. */
static void find_places(const PartFinder *finder, const CrowdGroup *group, const GroupJoin *join,
                        Crowd *table)
{
    const size_t count = group->members.count;
    bool         any   = false;
    for (size_t i = 0; i < count && !join->complement; i++)
        any = any || moved_by(join->graph, finder->parts[group->members.items[i]]);
    if (!any)
        return;
    table->first_place = (uint32_t)graph_crowds(join->graph)->frame_numbers.count;
    table->places      = arena_new_array(join->tables, MemberPlace, count);
    for (size_t i = 0; i < count; i++)
        table->places[i] = place_of(join->graph, finder->parts[group->members.items[i]]);
}

/* The distance is right up to `right`. */
static bool make_crowd(const PartFinder *finder, CrowdGroup *group, const GroupJoin *join,
                       double right, const Box *boxes)
{
    if (!is_worth_it(finder, group) || !group_find_columns(group, join) ||
        !group_has_functions(group, join))
        return false;
    double factor = for_bounds(finder, group);
    double reach  = factor * blended_reach(group, join);
    double margin = factor * right;
    Crowd  table  = {.stretch = factor, .span = join->span, .reach = reach, .margin = margin};
    find_places(finder, group, join, &table);
    group->slope = largest_slope(finder, group);
    group_make_table(group, join, boxes, reach, margin, table);
    return true;
}

static Box *boxes_of(const PartFinder *finder, const GroupJoin *join)
{
    Box *boxes = arena_new_array(join->scratch, Box, finder->count);
    for (uint32_t i = 0; i < finder->count; i++)
        boxes[i] = join->complement ? box_infinite : finder->parts[i]->box;
    return boxes;
}

static void make_crowds(const PartFinder *finder, const GroupJoin *join, JointCrowds *made,
                        Arena *arena)
{
    CrowdGroups groups   = find_groups(finder, arena);
    uint32_t    count    = finder->count;
    bool       *in_crowd = arena_new_array(join->scratch, bool, count);
    const Box  *boxes    = boxes_of(finder, join);
    double      right    = needed_reach(finder, &groups, &join->blend);
    made->groups         = arena_new_array(arena, CrowdGroup, groups.count + 1);
    made->rest           = arena_new_array(arena, const Shape *, count);
    for (size_t i = 0; i < groups.count; i++) {
        CrowdGroup *group = &groups.items[i];
        if (!make_crowd(finder, group, join, right, boxes))
            continue;
        for (size_t k = 0; k < group->members.count; k++)
            in_crowd[group->members.items[k]] = true;
        made->groups[made->group_count++] = *group;
    }
    for (uint32_t i = 0; i < count; i++)
        if (!in_crowd[i])
            made->rest[made->rest_count++] = finder->parts[i];
}

/* ---- joints ---- */

static GroupJoin group_join(const Lowering *l, const CrowdJoin *join)
{
    return (GroupJoin){l->graph,           l->scratch,       l->crowds->tables, l->crowds->leaves,
                       join->joint->blend, join->complement, join->joint->span};
}

/* Whether the crowds of a joint in one context serve in another.  Surfaces need to know whether
   there is a level, an instance and a smoothing. */
static bool serves(const JointCrowds *made, const Lowering *l, LowerContext parts)
{
    const LowerContext *of      = &made->context;
    bool                outside = of->level == parts.level && of->instance == parts.instance &&
                   of->smoothing == parts.smoothing;
    return of->lipschitz == parts.lipschitz && of->reach == parts.reach &&
           (outside || !l->surfaces);
}

static JointCrowds *find_joint(Lowering *l, const CrowdJoin *join, LowerContext context)
{
    LoweredCrowds *crowds = l->crowds;
    LowerContext   parts  = context_of_parts(&crowds->leaves, context);
    JointCrowds  **bucket = &crowds->joints[(uintptr_t)join->joint / sizeof(Shape) % BUCKETS];
    for (JointCrowds *made = *bucket; made; made = made->next)
        if (made->joint == join->joint && serves(made, l, parts))
            return made;
    bool         sharp   = join->joint->blend.width == NODE_NONE;
    PartFinder   finder  = {.outer    = l,
                            .parts    = join->parts,
                            .count    = join->count,
                            .context  = parts,
                            .reach    = join->reach,
                            .operands = !sharp || context.reach > 0,
                            .alike    = crowds->alike,
                            .least    = least_of_joint(crowds, sharp),
                            .many     = crowds->least,
                            .made     = &crowds->made};
    GroupJoin    members = group_join(l, join);
    JointCrowds *made    = arena_new(crowds->arena, JointCrowds);
    made->joint          = join->joint;
    made->context        = parts;
    make_crowds(&finder, &members, made, crowds->arena);
    crowds->made += made->group_count > 0;
    made->next = *bucket;
    *bucket    = made;
    return made;
}

JoinedCrowds find_crowds(Lowering *l, CrowdJoin *join, LowerContext context)
{
    JoinedCrowds found = {.count = 0};
    const bool   sharp = join->joint->blend.width == NODE_NONE;
    if (!l->crowds || join->count < least_of_joint(l->crowds, sharp) || join->joint->sheets ||
        l->overflow)
        return found;
    if (!l->crowds->alike) {
        l->crowds->alike  = alike_new(l->graph, l->crowds->arena);
        l->crowds->leaves = part_leaves(l->graph);
    }
    found.join        = group_join(l, join);
    JointCrowds *made = find_joint(l, join, context);
    found.groups      = made->groups;
    found.count       = made->group_count;
    join->parts       = made->rest;
    join->count       = made->rest_count;
    return found;
}

Lowered lower_crowds(Lowering *l, CrowdJoin *join, LowerContext context)
{
    Lowered      all   = lowered_nothing;
    JoinedCrowds found = find_crowds(l, join, context);
    for (uint32_t i = 0; i < found.count; i++) {
        Lowered crowd = group_lower(&found.groups[i], &found.join, l->surfaces, context);
        all           = join_two(l, join->joint->blend, all, crowd);
    }
    return all;
}
