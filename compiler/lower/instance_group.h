/*
 * instance_group.h: parts of a CSG node that are alike, and the functions of the instance group that they become.
 */
#ifndef KRS_INSTANCE_GROUP_H
#define KRS_INSTANCE_GROUP_H

#include "compiler/graph/instance_table.h"
#include "compiler/graph/instances/structure.h"
#include "compiler/lower/context.h"
#include "compiler/lower/nearest.h"

/* The expressions of a part: its distance, and a node for each row of surface.def. */
enum { PART_DISTANCE, PART_SURFACE, PART_ROOTS = 1 + sizeof(Surface) / sizeof(Node) };

/* The leaves that the context of parts has in place of what is around the CSG node. */
typedef struct PartLeaves {
    Node point, normal, footprint, level, instance, smoothing;
} PartLeaves;

PartLeaves part_leaves(Graph *graph);

/* The values of instances in one element of a slot, as lists.  They are empty as long as all
   instances have what the first one has; that of nodes also as long as all numbers are known. */
typedef struct SlotElement {
    double number; /* of the first */
    Node   node;   /* NODE_NONE: it is known */
    struct {
        double *items;
        size_t  count, capacity;
    } numbers;
    struct {
        Node  *items;
        size_t count, capacity;
    } nodes;
} SlotElement;

/* Parts that are alike. */
typedef struct InstanceGroup {
    Template *template;
    struct {
        uint32_t *items; /* of the instances, ascending: their places in the CSG node */
        size_t    count, capacity;
    } instances;
    SlotElement *elements; /* of each slot 4 */
    bool        *varies;   /* of each slot: it differs between instances */
    uint32_t *columns; /* of each slot 4: of its elements the column, or NO_COLUMN: equal in all */
    struct Column *sources; /* of each column, the element that it has */
    uint32_t       column_count;
    bool           relocates;         /* InstanceTable */
    double         slope;             /* of the distances of all instances */
    uint32_t       table_number;      /* its table */
    uint32_t       distance, nearest; /* functions; NO_FUNCTION: not made yet */
    uint32_t threshold, lists[2][2];  /* of blends: for surfaces; near and more, of pairs or not */
    uint32_t properties[PART_ROOTS];  /* and what is mixed, behind the sum of shares */
} InstanceGroup;

#define NO_COLUMN   UINT32_MAX
#define NO_FUNCTION UINT32_MAX

/* The way in which the instances of a group are joined. */
typedef struct GroupJoin {
    Graph     *graph;
    Arena     *scratch;
    Arena     *tables; /* for what tables have */
    PartLeaves leaves;
    Blend      blend;
    bool       complement;
    Span       span; /* of the CSG node */
} GroupJoin;

/* group_find.c: what is searched for parts that are alike. */
typedef struct PartFinder {
    const Lowering     *outer; /* of the CSG node */
    const Shape *const *parts;
    uint32_t            count;
    LowerContext        context;  /* of the parts */
    double              reach;    /* LowerContext.reach of all parts together */
    bool                operands; /* their distances are used away from the surface */
    Structures         *structures;
    uint32_t            least; /* instances of a group */
    uint32_t            many;  /* instances that make an instance group, however small they are */
    const uint32_t     *made;  /* CSG nodes with groups, so far */
} PartFinder;

typedef struct InstanceGroups {
    InstanceGroup *items;
    size_t         count, capacity;
} InstanceGroups;

/* Finds the groups; what is needed later is made in the arena.  Groups may be smaller than asked
   for. */
InstanceGroups find_groups(const PartFinder *finder, Arena *arena);
/* Lowers what a part is where parts are, with these groups.  False: it is empty, or too large. */
bool lower_part(const PartFinder *finder, const Shape *shape, struct LoweredGroups *groups,
                Node roots[PART_ROOTS]);
/* instance_groups.c: how many parts a CSG node with instance groups has at least. */
uint32_t min_of_csg(const struct LoweredGroups *groups, bool sharp);
/* group_iterations.c: adds groups of iterations of one loop, and marks their instances. */
void find_iteration_groups(const PartFinder *finder, InstanceGroups *groups, bool *taken,
                           Arena *arena);

/* group_table.c: an empty group of what is like the template. */
InstanceGroup group_new(Template *template, Arena *arena);
/* Adds a part, with what is in its slots. */
void group_add(InstanceGroup *group, uint32_t part, const SlotContent *contents, Arena *scratch);
/* Finds what varies and its columns; false: there would be too many. */
bool group_find_columns(InstanceGroup *group, const GroupJoin *join);
/* Makes the table, of which `stretch` and `span` are set.  `boxes` are of all parts of the CSG node. */
void group_make_table(InstanceGroup *group, const GroupJoin *join, const Box *boxes, double reach,
                      double margin, InstanceTable table);
/* group_cells.c: gives a table with all its numbers a grid and its cells; `boxes` are of its rows. */
void group_make_cells(const InstanceGroup *group, const GroupJoin *join, const Box *boxes,
                      double reach, double margin, InstanceTable *table);
/* Fills the nodes in the slots, for the instance whose number is that node; without one (NODE_NONE)
   of what does not vary. */
void group_slots(const InstanceGroup *group, Graph *graph, Node instance, Node *slots);
/* Does the same, with a parameter in the place of each column: those from slot `first` on. */
void group_slots_of_parameters(const InstanceGroup *group, Graph *graph, uint32_t first,
                               Node *slots);

/* instance_groups.c: the groups of parts of a CSG node that are many and alike.  The other parts are left in *join. */
typedef struct JoinedGroups {
    InstanceGroup *groups;
    uint32_t       count;
    GroupJoin      join; /* of them */
} JoinedGroups;
struct PartJoin;
JoinedGroups find_joined_groups(Lowering *l, struct PartJoin *join, LowerContext context);

/* group_functions.c: whether functions can be made for all that is asked of the surface. */
bool group_has_functions(const InstanceGroup *group, const GroupJoin *join);
/* Tells whether a blend mixes something in which the instances differ. */
bool group_mixes(const InstanceGroup *group, const GroupJoin *join);
/* Tells whether its instances differ in anything but their distances. */
bool group_varies(const InstanceGroup *group, const GroupJoin *join);
/* These return what is asked of the instances of a group where the context is: what they are joined
   to; of blends also their nearest distances, their threshold, the sum of their shares below one,
   and what is mixed by these. */
Node    group_distance(InstanceGroup *group, const GroupJoin *join, LowerContext context);
Nearest group_nearest(InstanceGroup *group, const GroupJoin *join, bool pairs,
                      LowerContext context);
Node    group_threshold(InstanceGroup *group, const GroupJoin *join, LowerContext context);
Node group_share(InstanceGroup *group, const GroupJoin *join, Node threshold, LowerContext context);
Surface group_surface(InstanceGroup *group, const GroupJoin *join, Node threshold,
                      LowerContext context);
/* Returns the instances of a group, joined, where the context is, by themselves. */
Lowered group_lower(InstanceGroup *group, const GroupJoin *join, bool surfaces,
                    LowerContext context);

#endif
