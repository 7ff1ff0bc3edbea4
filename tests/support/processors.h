/*
 * processors.h: work that all processors share can be done by one of them, to compare both.
 */
#ifndef KRS_TESTS_PROCESSORS_H
#define KRS_TESTS_PROCESSORS_H

#include <sched.h>

/* Leaves one processor to this process; *all are those that it had, for use_processors. */
static inline int use_one_processor(cpu_set_t *all)
{
    cpu_set_t one;
    int       processor = 0;
    if (sched_getaffinity(0, sizeof *all, all) != 0)
        return -1;
    while (!CPU_ISSET(processor, all))
        processor++;
    CPU_ZERO(&one);
    CPU_SET(processor, &one);
    return sched_setaffinity(0, sizeof one, &one);
}

static inline int use_processors(const cpu_set_t *all)
{
    return sched_setaffinity(0, sizeof *all, all);
}

#endif
