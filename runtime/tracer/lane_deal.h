/*
 * lane_deal.h: work of lanes of the host: numbers that are dealt to all processors.
 */
#ifndef KRS_LANE_DEAL_H
#define KRS_LANE_DEAL_H

#include <stdatomic.h>

#include "compiler/base/parallel.h"
#include "runtime/tracer/job.h"

typedef struct LaneDeal {
    atomic_uint next;
    uint32_t    end;               /* of the slice */
    void       *memory[MAX_PARTS]; /* of each part */
} LaneDeal;

/* Runs a task on the numbers below `all`, in slices that end often enough that progress is seen.  Each part has so many
   bytes of memory. */
bool lane_deal(Job *job, LaneDeal *deal, KrsPhase phase, uint32_t all, size_t part_bytes,
               void (*work)(void *task, size_t part, size_t parts), void *task);
/* Takes the next number of a slice; false: there is none. */
bool lane_deal_next(LaneDeal *deal, uint32_t *number);

#endif
