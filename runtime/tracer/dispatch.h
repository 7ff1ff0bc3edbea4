/*
 * dispatch.h: how the kernels of a picture reach the device.
 *
 * On devices of type CPU the host runs one dispatch after the other, in slices, and looks at what
 * they have counted.  A graphics card would wait for it each time: there dispatches form a chain,
 * and the device finds by the counters how many items each has (next_dispatch.comp).
 */
#ifndef KRS_DISPATCH_H
#define KRS_DISPATCH_H

#include "runtime/tracer/job.h"

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

/* The budget of a kernel over items of which each takes the steps that it needs (schedule.glsl), by
   the schedule of the kernel that runs now and the steps at once that were asked for; */
LaneBudget lane_budget(const Job *job);
/* over items that all cost alike (pixels.glsl). */
LaneBudget pixel_budget(const Job *job);
/* How many there are, where the host knows what was counted. */
uint32_t items_now(const Job *job, Items items);

#endif
