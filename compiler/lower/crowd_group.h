/*
 * crowd_group.h: parts of a joint that are alike, and the functions of the crowd that they become.
 */
#ifndef KRS_CROWD_GROUP_H
#define KRS_CROWD_GROUP_H

#include "compiler/graph/crowd.h"
#include "compiler/graph/instances/alike.h"
#include "compiler/lower/context.h"
#include "compiler/lower/nearest.h"

/* The expressions of a part: its distance, and a node for each row of surface.def. */
enum { PART_DISTANCE, PART_SURFACE, PART_ROOTS = 1 + sizeof(Surface) / sizeof(Node) };

/* What the context of parts has in place of what is around the joint. */
typedef struct PartLeaves {
    Node point, normal, footprint, level, instance, smoothing;
} PartLeaves;

PartLeaves part_leaves(Graph *graph);

/* What members have in one element of a slot, as lists.  They are empty as long as all members have
   what the first one has; that of nodes also as long as all numbers are known. */
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
typedef struct CrowdGroup {
    Template *template;
    struct {
        uint32_t *items; /* of the members, ascending: their places in the joint */
        size_t    count, capacity;
    } members;
    SlotElement *elements; /* of each slot 4 */
    bool        *varies;   /* of each slot: it differs between members */
    uint32_t *columns; /* of each slot 4: of its elements the column, or NO_COLUMN: equal in all */
    struct Column *sources; /* of each column, the element that it has */
    uint32_t       column_count;
    bool           relocates;         /* Crowd */
    double         slope;             /* of the distances of all members */
    uint32_t       crowd;             /* its table */
    uint32_t       distance, nearest; /* functions; NO_FUNCTION: not made yet */
    uint32_t threshold, lists[2][2];  /* of blends: for surfaces; near and more, of pairs or not */
    uint32_t properties[PART_ROOTS];  /* and what is mixed, behind the sum of shares */
} CrowdGroup;

#define NO_COLUMN   UINT32_MAX
#define NO_FUNCTION UINT32_MAX

/* How the members of a group are joined. */
typedef struct GroupJoin {
    Graph     *graph;
    Arena     *scratch;
    Arena     *tables; /* for what tables have */
    PartLeaves leaves;
    Blend      blend;
    bool       complement;
    Span       span; /* of the joint */
} GroupJoin;

/* crowd_find.c: what is searched for parts that are alike. */
typedef struct PartFinder {
    const Lowering     *outer; /* of the joint */
    const Shape *const *parts;
    uint32_t            count;
    LowerContext        context;  /* of the parts */
    double              reach;    /* LowerContext.reach of all parts together */
    bool                operands; /* their distances are used away from the surface */
    Alike              *alike;
    uint32_t            least; /* members of a group */
    uint32_t            many;  /* members that make a crowd, however small they are */
    const uint32_t     *made;  /* joints with crowds, so far */
} PartFinder;

typedef struct CrowdGroups {
    CrowdGroup *items;
    size_t      count, capacity;
} CrowdGroups;

/* What is needed later is made in the arena.  Groups may be smaller than asked for. */
CrowdGroups find_groups(const PartFinder *finder, Arena *arena);
/* Lowers what a part is where parts are, with these crowds.  False: it is empty, or too large. */
bool lower_part(const PartFinder *finder, const Shape *shape, struct LoweredCrowds *crowds,
                Node roots[PART_ROOTS]);
/* crowd.c: how many parts a joint with crowds has at least. */
uint32_t least_of_joint(const struct LoweredCrowds *crowds, bool sharp);
/* crowd_turns.c: adds groups of turns of one loop, and marks their members. */
void find_turn_groups(const PartFinder *finder, CrowdGroups *groups, bool *taken, Arena *arena);

/* crowd_table.c: an empty group of what is like the template. */
CrowdGroup group_new(Template *template, Arena *arena);
/* Adds a part, with what is in its slots. */
void group_add(CrowdGroup *group, uint32_t part, const SlotContent *contents, Arena *scratch);
/* Finds what varies and its columns; false: there would be too many. */
bool group_find_columns(CrowdGroup *group, const GroupJoin *join);
/* Makes the table, of which `stretch` and `span` are set.  `boxes` are of all parts of the joint. */
void group_make_table(CrowdGroup *group, const GroupJoin *join, const Box *boxes, double reach,
                      double margin, Crowd table);
/* crowd_cells.c: gives a table with all its numbers a grid and its cells; `boxes` are of its rows. */
void group_make_cells(const CrowdGroup *group, const GroupJoin *join, const Box *boxes,
                      double reach, double margin, Crowd *table);
/* The nodes in the slots, for the member whose number is that node; without one (NODE_NONE) of what
   does not vary. */
void group_slots(const CrowdGroup *group, Graph *graph, Node member, Node *slots);
/* The same, with a parameter in the place of each column: those from slot `first` on. */
void group_slots_of_parameters(const CrowdGroup *group, Graph *graph, uint32_t first, Node *slots);

/* crowd.c: the groups of parts of a joint that are many and alike.  The other parts are left in *join. */
typedef struct JoinedCrowds {
    CrowdGroup *groups;
    uint32_t    count;
    GroupJoin   join; /* of them */
} JoinedCrowds;
struct CrowdJoin;
JoinedCrowds find_crowds(Lowering *l, struct CrowdJoin *join, LowerContext context);

/* crowd_functions.c: whether functions can be made for all that is asked of the surface. */
bool group_has_functions(const CrowdGroup *group, const GroupJoin *join);
/* Whether a blend mixes something in which the members differ. */
bool group_mixes(const CrowdGroup *group, const GroupJoin *join);
/* Whether its members differ in anything but their distances. */
bool group_varies(const CrowdGroup *group, const GroupJoin *join);
/* What is asked of the members of a group where the context is: what they are joined to; of blends also
   their nearest distances, their threshold, the sum of their shares below one, and what is mixed by
   these. */
Node    group_distance(CrowdGroup *group, const GroupJoin *join, LowerContext context);
Nearest group_nearest(CrowdGroup *group, const GroupJoin *join, bool pairs, LowerContext context);
Node    group_threshold(CrowdGroup *group, const GroupJoin *join, LowerContext context);
Node    group_share(CrowdGroup *group, const GroupJoin *join, Node threshold, LowerContext context);
Surface group_surface(CrowdGroup *group, const GroupJoin *join, Node threshold,
                      LowerContext context);
/* The members of a group, joined, where the context is, by themselves. */
Lowered group_lower(CrowdGroup *group, const GroupJoin *join, bool surfaces, LowerContext context);

#endif
