/*
 * instance_walk.h: the instances that an instance function visits at a point, one after the other.
 *
 * First come those in the list of the point's cell.  Where more may count the function begins again,
 * with all that are near, until no other instance can be nearer than what is found.
 */
#ifndef KRS_INSTANCE_WALK_H
#define KRS_INSTANCE_WALK_H

#include "compiler/graph/instance_table.h"
#include "compiler/graph/op_values.h"

typedef struct InstanceWalk {
    const InstanceFunction *function;
    const InstanceTable    *table;
    bool                    to_nearest, by_list; /* goes on behind the list; is still in it */
    double                  point[3];
    const uint32_t         *list; /* what is left of it */
    uint32_t                left;
    double                  clearance;
    double                  radius, clear, wider; /* of the ball that is looked at */
    uint32_t                word;                 /* of near.bits; `bits` are those left of it */
    uint64_t                bits;
    NearInstances           near;
} InstanceWalk;

typedef enum InstanceStep {
    INSTANCE_NEXT,  /* the next instance is *instance */
    INSTANCE_AGAIN, /* all states begin again */
    INSTANCE_DONE
} InstanceStep;

/* Begins a walk; with `by_cells` only the list counts, as in shaders. */
void instance_walk_begin(InstanceWalk *walk, const InstanceFunction *function,
                         const InstanceTable *table, const double point[3], bool by_cells);
/* Restricts a walk to these instances. */
void instance_walk_along(InstanceWalk *walk, const InstanceFunction *function,
                         const uint32_t *instances, uint32_t count);
/* Takes the next instance; `distance` is the state that is one, after the last instance; anything
   where there is none. */
InstanceStep instance_walk_next(InstanceWalk *walk, double distance, uint32_t *instance);
/* These do the same in two parts: an instance, or none before it is known whether more may count;
   then whether the function begins again.  An earlier distance serves for the first: it finds some
   instances more. */
bool         instance_walk_find(InstanceWalk *walk, double distance, uint32_t *instance);
InstanceStep instance_walk_widen(InstanceWalk *walk, double distance);
/* Returns the value of the function when its states have ended at these numbers: by cells a
   distance is at most the clearance.  The graph is that of its bodies. */
NodeValue instance_walk_result(const InstanceWalk *walk, const Graph *graph,
                               const NodeValue *states);

/* Returns the least distance that a curve may have: it is not farther from its chord than a quarter
   of its bend. */
double instance_arc_min_distance(const InstanceArc *arc, const double point[2]);

#endif
