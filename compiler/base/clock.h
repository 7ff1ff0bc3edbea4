/*
 * clock.h: what clocks of the system show.
 */
#ifndef KRS_CLOCK_H
#define KRS_CLOCK_H

#include <time.h>

/* Returns the seconds of a clock; 0: there is no such clock, as of a process that has ended. */
static inline double clock_seconds(clockid_t clock)
{
    struct timespec now = {0};
    clock_gettime(clock, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

#endif
