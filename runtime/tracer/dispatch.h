/*
 * dispatch.h: how the kernels of a picture reach the device.
 *
 * On devices of type CPU the host runs one dispatch after the other, in slices, and looks at what
 * they have counted.  A graphics card would wait for it each time: there dispatches form a chain,
 * and the device finds by the counters how many items each has (plan.comp).
 */
#ifndef KRS_DISPATCH_H
#define KRS_DISPATCH_H

#include <stddef.h>

#include "runtime/tracer/renderer.h"

typedef struct Job Job;

/* How many items a dispatch has: `each` times a counter of the control block, as it is when the
   dispatch runs, and 0 afterwards if `resets`; or just `each`. */
typedef struct Items {
    uint32_t each;
    uint32_t counter; /* its number among the words of the block; 0: none */
    bool     resets;
} Items;
#define WORD_OF(counter)          (offsetof(ControlBlock, counter) / sizeof(uint32_t))
#define ITEMS_COUNTED(each, name) ((Items){(each), WORD_OF(name), false})
#define ITEMS_KNOWN(count)        ((Items){(count), 0, false})

/* How items are assigned to lanes (schedule.glsl): lanes of a workgroup, items of a lane, and the
   steps that a lane may take in a dispatch. */
typedef struct LaneBudget {
    uint32_t lanes, items_per_lane, steps;
} LaneBudget;
#define MOST_LANE_STEPS 16384 /* of a lane that takes item after item */

typedef struct Dispatch {
    KrsPhase      phase;
    const Kernel *kernel;
    ControlBlock  control; /* what the host tells the kernel; no counters */
    WorkBlock     work;
    Items         items;
    uint32_t      in_group;      /* items of a group */
    uint32_t      clears;        /* the counter that is 0 before it, as in Items */
    bool          clears_shared; /* rays have shared nothing before it (shared.glsl) */
} Dispatch;

/* Dispatches that wait to be sent together. */
typedef struct Chain {
    Dispatch list[MOST_CHAINED];
    uint32_t count;
} Chain;

/* Whether dispatches form chains: then counters are known to the host after dispatch_finish. */
bool dispatch_chains(const Job *job);

/* A dispatch by what the control block says now, but for its items. */
Dispatch dispatch_of(const Job *job, KrsPhase phase, const Kernel *kernel, const WorkBlock *work,
                     Items items, LaneBudget budget);
/* Runs it, or adds it to the chain. */
bool dispatch_run(Job *job, const Dispatch *dispatch);
/* One after the other, none of which leaves an item over or counts for the next: in one submission
   where that is no longer than a slice. */
bool dispatch_together(Job *job, const Dispatch *dispatches, size_t count);
/* Runs what is in the chain. */
bool dispatch_finish(Job *job);

/* A kernel over items of which each takes the steps that it needs (schedule.glsl), */
bool dispatch_items(Job *job, KrsPhase phase, const Kernel *kernel, const WorkBlock *work,
                    Items items, LaneBudget budget);
/* by the schedule of the kernel that runs now and the steps at once that were asked for, */
LaneBudget lane_budget(const Job *job);
/* or that all cost alike (pixels.glsl): the budget of such a dispatch. */
bool       dispatch_pixels(Job *job, KrsPhase phase, const Kernel *kernel, const WorkBlock *work,
                           Items items);
LaneBudget pixel_budget(const Job *job);
/* How many there are, where the host knows what was counted. */
uint32_t items_now(const Job *job, Items items);

#endif
