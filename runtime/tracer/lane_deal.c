/*
 * lane_deal.c: work of lanes of the host, dealt to all processors.
 */
#include "runtime/tracer/lane_deal.h"

#include "runtime/tracer/dispatch.h"

bool lane_deal(Job *job, LaneDeal *deal, KrsPhase phase, uint32_t all, size_t part_bytes,
               void (*work)(void *task, size_t part, size_t parts), void *task)
{
    char    *memory  = gpu_alloc(job->gpu, parallel_parts(), part_bytes, "run lanes of the host");
    uint32_t at_once = (uint32_t)parallel_parts();
    bool     good    = memory != NULL;
    for (size_t i = 0; i < parallel_parts() && good; i++)
        deal->memory[i] = memory + i * part_bytes;
    for (uint32_t begin = 0; begin < all && good; begin = deal->end) {
        const double start = clock_ms();
        deal->next         = begin;
        deal->end          = all - begin < at_once ? all : begin + at_once;
        run_in_parallel(work, task);
        const double ms = clock_ms() - start;
        job->stats->phase_ms[phase] += ms;
        at_once = ms > job->options.slice_ms ? (at_once + 1) / 2 : 2 * at_once;
        good    = dispatch_report(job, (double)deal->end / all);
    }
    gpu_release(job->gpu, memory);
    return good;
}

bool lane_deal_next(LaneDeal *deal, uint32_t *number)
{
    return (*number = atomic_fetch_add(&deal->next, 1)) < deal->end;
}
