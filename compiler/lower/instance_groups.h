/*
 * instance_groups.h: parts of a CSG node that are alike, lowered as one body and a table (graph/instance_table.h).
 */
#ifndef KRS_INSTANCE_GROUPS_H
#define KRS_INSTANCE_GROUPS_H

#include "compiler/lower/context.h"

/* Fewer parts that are alike stay separate: a loop over a list costs as much as some. */
enum { MIN_INSTANCES = 64 };
/* But large parts cost more.  So few are an instance group if all but one have so many operations.  Blends need a
   loop for each property that is mixed. */
enum { MIN_OF_FEW = 6, MIN_SAVED = 350 };

/* The instance groups of a scene, by the CSG nodes that they are parts of.  All lowerings of a CSG node use the
   same.  What tables have is made in an arena of its own.  `least` is MIN_INSTANCES, but in tests. */
typedef struct LoweredGroups LoweredGroups;
LoweredGroups *lowered_groups_new(Graph *graph, Arena *arena, Arena *tables, uint32_t least);
/* Lets few large parts of sharp CSG nodes become groups, too. */
void lowered_groups_take_few(LoweredGroups *groups);

/* Says that the graph's nodes are needed for something else than the shape that is lowered. */
void lowered_groups_made(LoweredGroups *groups);

/* The parts or complements that a CSG node joins, sharply or by a blend. */
typedef struct PartJoin {
    const Shape        *csg_node;
    const Shape *const *parts;
    uint32_t            count;
    bool                complement;
    double              reach; /* LowerContext.reach of all parts together */
} PartJoin;

/* Joins those parts sharply that are many and alike.  The others are left in *join. */
Lowered lower_groups(Lowering *l, PartJoin *join, LowerContext context);

#endif
