/*
 * dispatch.h: submits the dispatches of a picture to the device.
 *
 * On devices of type CPU the host runs one dispatch after the other, in slices, and reads the
 * counters after each.  A graphics card would idle meanwhile.  There dispatches form a chain, and
 * the device computes from the counters how many items each one has (next_dispatch.comp).
 */
#ifndef KRS_DISPATCH_H
#define KRS_DISPATCH_H

#include "runtime/tracer/job.h"

/* Tells whether dispatches form chains.  If so, the host knows the counters only after
   dispatch_finish. */
bool dispatch_chains(const Job *job);

/* Makes a dispatch from the control block as it is now.  The number of items is found out when it
   runs. */
Dispatch dispatch_of(const Job *job, KrsPhase phase, const Shader *shader, const WorkBlock *work,
                     Items items, LaneBudget budget);
/* Runs a dispatch, or adds it to the chain. */
bool dispatch_run(Job *job, const Dispatch *dispatch);
/* Runs dispatches one after the other, in one submission where that is no longer than a slice.
   None may leave items over, or count what a later one reads. */
bool dispatch_fused(Job *job, const Dispatch *dispatches, size_t count);
/* Runs all dispatches in the chain. */
bool dispatch_finish(Job *job);

/* Reports progress within a pass; false: the caller ends it, which is noted. */
bool dispatch_report(Job *job, double within_pass);

/* Returns the budget of a shader whose items take different numbers of steps (schedule.glsl).  It
   follows from the current schedule and the option `steps_at_once`. */
LaneBudget lane_budget(const Job *job);
/* Returns the budget of a shader whose items all cost the same (pixels.glsl). */
LaneBudget pixel_budget(const Job *job);
/* Returns the number of items, where the host knows the counters. */
uint32_t items_now(const Job *job, Items items);

#endif
