/*
 * instance_groups.c: the instance groups of a CSG node, which all its lowerings share.
 */
#include "compiler/lower/instance_groups.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/graph/instances/instance_frame.h"
#include "compiler/lower/instance_group.h"
#include "compiler/lower/join.h"

/* The instance groups of a CSG node, in one kind of context. */
typedef struct CsgGroups {
    struct CsgGroups *next;
    const Shape      *csg_node;
    LowerContext      context; /* what matters of it */
    InstanceGroup    *groups;
    uint32_t          group_count;
    const Shape     **rest;
    uint32_t          rest_count;
} CsgGroups;

enum { BUCKETS = 256 };

struct LoweredGroups {
    Graph      *graph;
    Arena      *arena, *tables;
    Structures *structures;
    PartLeaves  leaves;
    uint32_t    least; /* instances of an instance group */
    uint32_t    few;   /* the same of sharp CSG nodes, if they are large */
    uint32_t    made;  /* CSG nodes with groups, and functions of outlines */
    CsgGroups  *csg_nodes[BUCKETS];
};

LoweredGroups *lowered_groups_new(Graph *graph, Arena *arena, Arena *tables, uint32_t least)
{
    LoweredGroups *groups = arena_new(arena, LoweredGroups);
    groups->graph         = graph;
    groups->arena         = arena;
    groups->tables        = tables;
    groups->least = groups->few = least;
    return groups;
}

void lowered_groups_take_few(LoweredGroups *groups) { groups->few = MIN_OF_FEW; }

uint32_t min_of_csg(const LoweredGroups *groups, bool sharp)
{
    return sharp ? groups->few : groups->least;
}

/* Tells whether a loop costs less than the instances of a group one by one. */
static bool is_worth_it(const PartFinder *finder, const InstanceGroup *group)
{
    const size_t count = group->instances.count;
    return count >= finder->many ||
           (count >= finder->least && (count - 1) * group->template->node_count >= MIN_SAVED);
}

void lowered_groups_made(LoweredGroups *groups) { groups->made++; }

/* Returns the context of parts.  Whether there is a level, an instance and a smoothing is as
   outside. */
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

/* The widths above a result at which an instance has no share: a width above the least one, which
   is no more than a width above the result. */
static const double MIXING_REACH = 2;

static double blended_reach(const InstanceGroup *group, const GroupJoin *join)
{
    const Blend *blend = &join->blend;
    if (blend->width == NODE_NONE || blend->widest <= 0)
        return 0;
    double widths = blend_reach(blend->kind, (double)group->instances.count);
    if (group_mixes(group, join))
        widths = fmax(widths, MIXING_REACH);
    return widths * blend->widest;
}

/* A distance that is a bound only is at least that to the sides of a box, of which the farthest
   counts. */
static double for_bounds(const PartFinder *finder, const InstanceGroup *group)
{
    for (size_t i = 0; i < group->instances.count; i++)
        if (!finder->parts[group->instances.items[i]]->exact)
            return sqrt(3);
    return 1;
}

/* Returns the distance up to which that of a group must be right.  Groups are joined with each
   other and with the other parts by the same blend; one that has all parts is not. */
static double needed_reach(const PartFinder *finder, const InstanceGroups *groups,
                           const Blend *blend)
{
    size_t instances = 0;
    for (size_t i = 0; i < groups->count; i++)
        instances += groups->items[i].instances.count;
    size_t operands = groups->count + (instances < finder->count);
    if (operands == 1 || blend->width == NODE_NONE)
        return finder->reach;
    return finder->reach + fmax(blend_reach(blend->kind, (double)operands) * blend->widest, 0);
}

static double largest_slope(const PartFinder *finder, const InstanceGroup *group)
{
    double slope = 1;
    for (size_t i = 0; i < group->instances.count; i++)
        slope = fmax(slope, finder->parts[group->instances.items[i]]->slope);
    return slope;
}

/* ---- instances that move ---- */

static bool is_of_frame(const Graph *g, Node node) { return g->items[node].time == TIME_FRAME; }

static bool is_rotated(const Graph *g, const Map *map)
{
    return is_of_frame(g, map->scale) || is_of_frame(g, map->rows[0]) ||
           is_of_frame(g, map->rows[1]) || is_of_frame(g, map->rows[2]);
}

/* Returns the transformation that moves a part, seen through what leaves boxes as they are; NULL:
   nothing that depends on the frame does. */
static const Shape *moved_by(const Graph *g, const Shape *part)
{
    while (part->kind == SHAPE_PAINT || part->kind == SHAPE_SMOOTH)
        part = part->children[0];
    const Map *map = &part->map;
    if (part->kind != SHAPE_TRANSFORM)
        return NULL;
    return is_rotated(g, map) || is_of_frame(g, map->shift) ? part : NULL;
}

/* Returns a box that is rotated and scaled by known numbers. */
static Box rotate_box(const Graph *g, const Map *map, Box box)
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

static InstancePlace place_of(Graph *g, const Shape *part)
{
    const Shape *moved  = moved_by(g, part);
    Instances   *groups = graph_instances(g);
    if (!moved)
        return (InstancePlace){part->box, PLACE_FIXED};
    const Map *map   = &moved->map;
    const Box  box   = moved->children[0]->box;
    const Node all[] = {map->scale, map->rows[0], map->rows[1], map->rows[2], map->shift};
    for (int i = is_rotated(g, map) ? 0 : 4; i < 5; i++)
        array_push(groups->arena, &groups->frame_numbers, all[i]);
    return is_rotated(g, map) ? (InstancePlace){box, PLACE_ROTATED}
                              : (InstancePlace){rotate_box(g, map, box), PLACE_SHIFT};
}

/* Finds where the instances of a group are in each frame; nothing if none is known to move. */
static void find_places(const PartFinder *finder, const InstanceGroup *group, const GroupJoin *join,
                        InstanceTable *table)
{
    const size_t count = group->instances.count;
    bool         any   = false;
    for (size_t i = 0; i < count && !join->complement; i++)
        any = any || moved_by(join->graph, finder->parts[group->instances.items[i]]);
    if (!any)
        return;
    table->first_place = (uint32_t)graph_instances(join->graph)->frame_numbers.count;
    table->places      = arena_new_array(join->tables, InstancePlace, count);
    for (size_t i = 0; i < count; i++)
        table->places[i] = place_of(join->graph, finder->parts[group->instances.items[i]]);
}

/* The distance is right up to `right`. */
static bool make_group(const PartFinder *finder, InstanceGroup *group, const GroupJoin *join,
                       double right, const Box *boxes)
{
    if (!is_worth_it(finder, group) || !group_find_columns(group, join) ||
        !group_has_functions(group, join))
        return false;
    double        factor = for_bounds(finder, group);
    double        reach  = factor * blended_reach(group, join);
    double        margin = factor * right;
    InstanceTable table = {.stretch = factor, .span = join->span, .reach = reach, .margin = margin};
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

static void make_groups(const PartFinder *finder, const GroupJoin *join, CsgGroups *made,
                        Arena *arena)
{
    InstanceGroups groups       = find_groups(finder, arena);
    uint32_t       count        = finder->count;
    bool          *in_instances = arena_new_array(join->scratch, bool, count);
    const Box     *boxes        = boxes_of(finder, join);
    double         right        = needed_reach(finder, &groups, &join->blend);
    made->groups                = arena_new_array(arena, InstanceGroup, groups.count + 1);
    made->rest                  = arena_new_array(arena, const Shape *, count);
    for (size_t i = 0; i < groups.count; i++) {
        InstanceGroup *group = &groups.items[i];
        if (!make_group(finder, group, join, right, boxes))
            continue;
        for (size_t k = 0; k < group->instances.count; k++)
            in_instances[group->instances.items[k]] = true;
        made->groups[made->group_count++] = *group;
    }
    for (uint32_t i = 0; i < count; i++)
        if (!in_instances[i])
            made->rest[made->rest_count++] = finder->parts[i];
}

/* ---- CSG nodes ---- */

static GroupJoin group_join(const Lowering *l, const PartJoin *join)
{
    return (GroupJoin){l->graph,
                       l->scratch,
                       l->groups->tables,
                       l->groups->leaves,
                       join->csg_node->blend,
                       join->complement,
                       join->csg_node->span};
}

/* Tells whether the instance groups of a CSG node in one context serve in another.  Surfaces need to know whether
   there is a level, an instance and a smoothing. */
static bool serves(const CsgGroups *made, const Lowering *l, LowerContext parts)
{
    const LowerContext *of      = &made->context;
    bool                outside = of->level == parts.level && of->instance == parts.instance &&
                   of->smoothing == parts.smoothing;
    return of->lipschitz == parts.lipschitz && of->reach == parts.reach &&
           (outside || !l->surfaces);
}

static CsgGroups *find_csg_node(Lowering *l, const PartJoin *join, LowerContext context)
{
    LoweredGroups *groups = l->groups;
    LowerContext   parts  = context_of_parts(&groups->leaves, context);
    CsgGroups    **bucket = &groups->csg_nodes[(uintptr_t)join->csg_node / sizeof(Shape) % BUCKETS];
    for (CsgGroups *made = *bucket; made; made = made->next)
        if (made->csg_node == join->csg_node && serves(made, l, parts))
            return made;
    bool       sharp     = join->csg_node->blend.width == NODE_NONE;
    PartFinder finder    = {.outer      = l,
                            .parts      = join->parts,
                            .count      = join->count,
                            .context    = parts,
                            .reach      = join->reach,
                            .operands   = !sharp || context.reach > 0,
                            .structures = groups->structures,
                            .least      = min_of_csg(groups, sharp),
                            .many       = groups->least,
                            .made       = &groups->made};
    GroupJoin  instances = group_join(l, join);
    CsgGroups *made      = arena_new(groups->arena, CsgGroups);
    made->csg_node       = join->csg_node;
    made->context        = parts;
    make_groups(&finder, &instances, made, groups->arena);
    groups->made += made->group_count > 0;
    made->next = *bucket;
    *bucket    = made;
    return made;
}

JoinedGroups find_joined_groups(Lowering *l, PartJoin *join, LowerContext context)
{
    JoinedGroups found = {.count = 0};
    const bool   sharp = join->csg_node->blend.width == NODE_NONE;
    if (!l->groups || join->count < min_of_csg(l->groups, sharp) || join->csg_node->open_surfaces ||
        l->overflow)
        return found;
    if (!l->groups->structures) {
        l->groups->structures = structures_new(l->graph, l->groups->arena);
        l->groups->leaves     = part_leaves(l->graph);
    }
    found.join      = group_join(l, join);
    CsgGroups *made = find_csg_node(l, join, context);
    found.groups    = made->groups;
    found.count     = made->group_count;
    join->parts     = made->rest;
    join->count     = made->rest_count;
    return found;
}

Lowered lower_groups(Lowering *l, PartJoin *join, LowerContext context)
{
    Lowered      all   = lowered_nothing;
    JoinedGroups found = find_joined_groups(l, join, context);
    for (uint32_t i = 0; i < found.count; i++) {
        Lowered group = group_lower(&found.groups[i], &found.join, l->surfaces, context);
        all           = join_two(l, join->csg_node->blend, all, group);
    }
    return all;
}
