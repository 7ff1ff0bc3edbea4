/*
 * crowd.h: parts of a joint that are alike, lowered as one body and a table (graph/crowd.h).
 */
#ifndef KRS_LOWER_CROWD_H
#define KRS_LOWER_CROWD_H

#include "compiler/lower/context.h"

/* Fewer parts that are alike stay apart: a loop over a list costs as much as some. */
enum { LEAST_CROWD = 64 };
/* But large parts cost more.  So few are a crowd if all but one have so many operations.  Blends need a
   loop for each property that is mixed. */
enum { LEAST_OF_FEW = 6, LEAST_SAVED = 350 };

/* The crowds of a scene, by the joints that they are parts of.  All lowerings of a joint use the
   same.  What tables have is made in an arena of its own.  `least` is LEAST_CROWD, but in tests. */
typedef struct LoweredCrowds LoweredCrowds;
LoweredCrowds *lowered_crowds_new(Graph *graph, Arena *arena, Arena *tables, uint32_t least);
/* Lets few large parts of sharp joints become crowds, too. */
void lowered_crowds_take_few(LoweredCrowds *crowds);

/* Says that the graph's nodes are needed for something else than the shape that is lowered. */
void lowered_crowds_made(LoweredCrowds *crowds);

/* What a joint joins, which is sharp or a blend: its parts or their complements. */
typedef struct CrowdJoin {
    const Shape        *joint;
    const Shape *const *parts;
    uint32_t            count;
    bool                complement;
    double              reach; /* LowerContext.reach of all parts together */
} CrowdJoin;

/* Sharply joins those parts that are many and alike.  The others are left in *join. */
Lowered lower_crowds(Lowering *l, CrowdJoin *join, LowerContext context);

#endif
