/*
 * crowd_walk.h: the members that a crowd function visits at a point, one after the other.
 *
 * First come those in the list of the point's cell.  Where more may count the function begins again,
 * with all that are near, until no other member can be nearer than what is found.
 */
#ifndef KRS_CROWD_WALK_H
#define KRS_CROWD_WALK_H

#include "compiler/graph/crowd.h"
#include "compiler/graph/op_values.h"

typedef struct CrowdWalk {
    const CrowdFunction *function;
    const Crowd         *table;
    bool                 to_nearest, by_list; /* goes on behind the list; is still in it */
    double               point[3];
    const uint32_t      *list; /* what is left of it */
    uint32_t             left;
    double               clearance;
    double               radius, clear, wider; /* of the ball that is looked at */
    uint32_t             word;                 /* of near.bits; `bits` are those left of it */
    uint64_t             bits;
    NearMembers          near;
} CrowdWalk;

typedef enum CrowdStep {
    CROWD_MEMBER, /* the next member is *member */
    CROWD_AGAIN,  /* all states begin again */
    CROWD_DONE
} CrowdStep;

/* With `by_cells` only the list counts, as in kernels. */
void crowd_walk_begin(CrowdWalk *walk, const CrowdFunction *function, const Crowd *table,
                      const double point[3], bool by_cells);
/* Only these members count. */
void crowd_walk_along(CrowdWalk *walk, const CrowdFunction *function, const uint32_t *members,
                      uint32_t count);
/* `distance` is the state that is one, after the last member; anything where there is none. */
CrowdStep crowd_walk_next(CrowdWalk *walk, double distance, uint32_t *member);
/* The same in two parts: a member, or none before it is known whether more may count; then whether the
   function begins again.  An earlier distance serves for the first: it finds some members more. */
bool      crowd_walk_member(CrowdWalk *walk, double distance, uint32_t *member);
CrowdStep crowd_walk_widen(CrowdWalk *walk, double distance);
/* What the function is when its states have ended at these numbers: by cells a distance is at most the
   clearance.  The graph is that of its bodies. */
NodeValue crowd_walk_result(const CrowdWalk *walk, const Graph *graph, const NodeValue *states);

#endif
