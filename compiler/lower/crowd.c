/*
 * crowd.c: finds the parts of a joint that are alike.
 *
 * Parts are lowered twice where nothing of the joint's surroundings is, but for leaves.  The first
 * time only hashes of their expressions are kept, and all nodes are dropped.  Of hashes that are
 * frequent enough, the first part is a template of the others.
 */
#include "compiler/lower/crowd.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
    Arena       *arena;
    Alike       *alike;
    PartLeaves   leaves;
    uint32_t     least; /* members of a crowd */
    uint32_t     made;  /* joints with crowds */
    JointCrowds *joints[BUCKETS];
};

LoweredCrowds *lowered_crowds_new(Graph *graph, Arena *arena, uint32_t least)
{
    LoweredCrowds *crowds = arena_new(arena, LoweredCrowds);
    crowds->graph         = graph;
    crowds->arena         = arena;
    crowds->least         = least;
    return crowds;
}

/* ---- parts ---- */

typedef struct Finder {
    LoweredCrowds   *crowds;
    const Lowering  *outer;
    const CrowdJoin *join;
    LowerContext     context;  /* of the parts */
    bool             operands; /* their distances are used away from the surface */
    uint64_t        *hashes;   /* of each part */
    uint64_t        *sorted;
    struct {
        CrowdGroup *items;
        size_t      count, capacity;
    } groups;
    SlotContent *contents; /* space for those of a part */
    uint32_t     content_count;
} Finder;

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

/* False: it is empty, or too large. */
static bool lower_part(const Finder *finder, uint32_t part, Node roots[PART_ROOTS])
{
    const Lowering *outer   = finder->outer;
    const Shape    *shape   = finder->join->parts[part];
    Lowering        l       = {.graph    = outer->graph,
                               .scratch  = outer->scratch,
                               .surfaces = true,
                               .method   = outer->method,
                               .most     = outer->most,
                               .crowds   = outer->crowds};
    Lowered         lowered = finder->operands ? lower_operand(&l, shape, finder->context)
                                               : lower_shape(&l, shape, finder->context);
    roots[PART_DISTANCE]    = lowered.distance;
    memcpy(&roots[PART_SURFACE], &lowered.surface, sizeof lowered.surface);
    return lowered.distance != NODE_NONE && !l.overflow;
}

/* The nodes of the frame in the first `slots` slots. */
static Node *frame_nodes(const Finder *finder, uint32_t slots, size_t *count)
{
    Node *nodes = arena_new_array(finder->outer->scratch, Node, 4 * (size_t)slots + 1);
    *count      = 0;
    for (uint32_t i = 0; i < slots; i++)
        for (int k = 0; k < 4; k++)
            if (finder->contents[i].nodes[k] != NODE_NONE)
                nodes[(*count)++] = finder->contents[i].nodes[k];
    return nodes;
}

/* They have been renumbered. */
static void set_frame_nodes(const Finder *finder, uint32_t slots, const Node *nodes)
{
    for (uint32_t i = 0; i < slots; i++)
        for (int k = 0; k < 4; k++)
            if (finder->contents[i].nodes[k] != NODE_NONE)
                finder->contents[i].nodes[k] = *nodes++;
}

/* Drops what a part was lowered to, unless crowds of its own parts need it.  What the first `slots`
   slots have stays. */
static void drop_part(const Finder *finder, GraphMark mark, uint32_t made, uint32_t slots)
{
    Graph *g = finder->outer->graph;
    size_t count;
    if (finder->crowds->made != made) {
        graph_keep(g);
        return;
    }
    Node *nodes = frame_nodes(finder, slots, &count);
    graph_release_but(g, mark, nodes, count, finder->outer->scratch);
    alike_forget(finder->crowds->alike, mark.count);
    set_frame_nodes(finder, slots, nodes);
}

/* ---- by hashes ---- */

static int compare_hashes(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

static void hash_parts(Finder *finder)
{
    uint32_t count = finder->join->count;
    finder->hashes = arena_new_array(finder->outer->scratch, uint64_t, count);
    finder->sorted = arena_new_array(finder->outer->scratch, uint64_t, count);
    for (uint32_t i = 0; i < count; i++) {
        Node      roots[PART_ROOTS];
        uint32_t  made = finder->crowds->made;
        GraphMark mark = graph_mark(finder->outer->graph);
        if (lower_part(finder, i, roots))
            finder->hashes[i] = alike_hash(finder->crowds->alike, roots, PART_ROOTS) | 1;
        drop_part(finder, mark, made, 0);
        finder->sorted[i] = finder->hashes[i];
    }
    qsort(finder->sorted, count, sizeof *finder->sorted, compare_hashes);
}

/* How many hashes are less. */
static uint32_t rank(const Finder *finder, uint64_t hash)
{
    uint32_t low = 0, high = finder->join->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (finder->sorted[middle] < hash)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool is_frequent(const Finder *finder, uint64_t hash)
{
    return hash != 0 && rank(finder, hash + 1) - rank(finder, hash) >= finder->crowds->least;
}

/* ---- groups ---- */

static void add_member(Finder *finder, CrowdGroup *group, uint32_t part)
{
    Arena *scratch = finder->outer->scratch;
    array_push(scratch, &group->members, part);
    for (uint32_t i = 0; i < group->template->slot_count; i++)
        array_push(scratch, &group->contents, finder->contents[i]);
}

static bool matches(Finder *finder, const Template *template, const Node *roots)
{
    if (finder->content_count < template->slot_count) {
        finder->content_count = template->slot_count;
        finder->contents      = arena_new_array(finder->outer->scratch, SlotContent,
                                                template->slot_count);
    }
    return template_match(finder->crowds->alike, template, roots, finder->contents);
}

static CrowdGroup *find_group(Finder *finder, const Node *roots)
{
    uint64_t hash = alike_hash(finder->crowds->alike, roots, PART_ROOTS);
    for (size_t i = 0; i < finder->groups.count; i++) {
        CrowdGroup *group = &finder->groups.items[i];
        if (group->template->hash == hash && matches(finder, group->template, roots))
            return group;
    }
    return NULL;
}

static CrowdGroup *new_group(Finder *finder, const Node *roots)
{
    CrowdGroup group = {.distance = NO_FUNCTION, .nearest = NO_FUNCTION};
    for (uint32_t i = 0; i < PART_ROOTS; i++)
        group.properties[i] = NO_FUNCTION;
    group.template = template_new(finder->crowds->alike, roots, PART_ROOTS, finder->crowds->arena);
    matches(finder, group.template, roots);
    array_push(finder->crowds->arena, &finder->groups, group);
    return &finder->groups.items[finder->groups.count - 1];
}

static void group_parts(Finder *finder)
{
    Graph *g = finder->outer->graph;
    for (uint32_t i = 0; i < finder->join->count; i++) {
        if (!is_frequent(finder, finder->hashes[i]))
            continue;
        Node        roots[PART_ROOTS];
        uint32_t    made  = finder->crowds->made;
        GraphMark   mark  = graph_mark(g);
        bool        there = lower_part(finder, i, roots);
        CrowdGroup *group = there ? find_group(finder, roots) : NULL;
        if (group || !there)
            drop_part(finder, mark, made, group ? group->template->slot_count : 0);
        else {
            graph_keep(g);
            group = new_group(finder, roots);
        }
        if (there)
            add_member(finder, group, i);
    }
}

/* ---- tables ---- */

/* How many widths above a result a member is that changes what is mixed by less than a
   thousandth. */
static const double MIXING_REACH = 5;

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
static double for_bounds(const Finder *finder, const CrowdGroup *group)
{
    for (size_t i = 0; i < group->members.count; i++)
        if (!finder->join->parts[group->members.items[i]]->exact)
            return sqrt(3);
    return 1;
}

static bool make_crowd(const Finder *finder, CrowdGroup *group, const GroupJoin *join,
                       const Box *boxes)
{
    if (group->members.count < finder->crowds->least || !group_find_columns(group, join) ||
        !group_has_functions(group, join))
        return false;
    double factor = for_bounds(finder, group);
    double reach  = factor * blended_reach(group, join);
    double margin = isfinite(reach) ? factor * finder->context.reach : HUGE_VAL;
    Crowd  table  = {.stretch = factor, .span = finder->join->joint->span};
    group_make_table(group, join, boxes, isfinite(reach) ? reach : 0, margin, table);
    return true;
}

static Box *boxes_of(const CrowdJoin *join, Arena *scratch)
{
    Box *boxes = arena_new_array(scratch, Box, join->count);
    for (uint32_t i = 0; i < join->count; i++)
        boxes[i] = join->complement ? box_infinite : join->parts[i]->box;
    return boxes;
}

static void make_crowds(const Finder *finder, const GroupJoin *join, JointCrowds *made)
{
    Arena     *arena    = finder->crowds->arena;
    uint32_t   count    = finder->join->count;
    bool      *in_crowd = arena_new_array(join->scratch, bool, count);
    const Box *boxes    = boxes_of(finder->join, join->scratch);
    made->groups        = arena_new_array(arena, CrowdGroup, finder->groups.count + 1);
    made->rest          = arena_new_array(arena, const Shape *, count);
    for (size_t i = 0; i < finder->groups.count; i++) {
        CrowdGroup *group = &finder->groups.items[i];
        if (!make_crowd(finder, group, join, boxes))
            continue;
        for (size_t k = 0; k < group->members.count; k++)
            in_crowd[group->members.items[k]] = true;
        made->groups[made->group_count++] = *group;
    }
    for (uint32_t i = 0; i < count; i++)
        if (!in_crowd[i])
            made->rest[made->rest_count++] = finder->join->parts[i];
    finder->crowds->made += made->group_count > 0;
}

/* ---- joints ---- */

static GroupJoin group_join(const Lowering *l, const CrowdJoin *join)
{
    return (GroupJoin){l->graph, l->scratch, l->crowds->leaves, join->joint->blend,
                       join->complement};
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
    Finder       finder  = {.crowds   = crowds,
                            .outer    = l,
                            .join     = join,
                            .context  = parts,
                            .operands = !sharp || context.reach > 0};
    GroupJoin    members = group_join(l, join);
    JointCrowds *made    = arena_new(crowds->arena, JointCrowds);
    made->joint          = join->joint;
    made->context        = parts;
    hash_parts(&finder);
    group_parts(&finder);
    make_crowds(&finder, &members, made);
    made->next = *bucket;
    *bucket    = made;
    return made;
}

Lowered lower_crowds(Lowering *l, CrowdJoin *join, LowerContext context)
{
    Lowered all = lowered_nothing;
    if (!l->crowds || join->count < l->crowds->least || join->joint->sheets || l->overflow)
        return all;
    if (!l->crowds->alike) {
        l->crowds->alike  = alike_new(l->graph, l->crowds->arena);
        l->crowds->leaves = part_leaves(l->graph);
    }
    JointCrowds *made    = find_joint(l, join, context);
    GroupJoin    members = group_join(l, join);
    for (uint32_t i = 0; i < made->group_count; i++) {
        Lowered crowd = group_lower(&made->groups[i], &members, l->surfaces, context);
        all           = join_two(l, join->joint->blend, all, crowd);
    }
    join->parts = made->rest;
    join->count = made->rest_count;
    return all;
}
