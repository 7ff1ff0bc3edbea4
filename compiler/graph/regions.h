/*
 * regions.h: what is needed only where a guard does not decide.
 *
 * A guard (ops.def) leaves its third operand, the rest, out where its bound decides.  What
 * nothing else needs is the region of the guard; regions lie within each other.  Whoever runs or
 * writes a graph takes a region up only after its guard has not decided.
 */
#ifndef KRS_REGIONS_H
#define KRS_REGIONS_H

#include "compiler/graph/graph.h"

#define REGION_ALWAYS 0u         /* of what is needed whatever guards say */
#define NO_REGION     UINT32_MAX /* of what is not needed; the body of what is no guard */

typedef struct Region {
    Node     guard; /* NODE_NONE for REGION_ALWAYS */
    uint32_t parent, depth;
    Node     first; /* the region's nodes in order, by `next`; NODE_NONE ends */
} Region;

typedef struct Regions {
    uint32_t *of;   /* of a node: its region; of a guard, the one that it is in */
    uint32_t *body; /* of a guard: the region of its rest */
    Node     *next;
    struct {
        Region *items;
        size_t  count, capacity;
    } list;
} Regions;

/* Finds the regions of all nodes of point time that the roots need.  `of` and `body` have graph->count
   elements, NO_REGION where there is none.  `regions` is zero, or was found before in the same graph and arena:
   its memory is then used again. */
void graph_regions(Regions *regions, const Graph *graph, const Node *roots, size_t root_count,
                   Arena *arena);

#endif
