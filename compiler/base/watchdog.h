/*
 * watchdog.h: how long a process has worked, and how long without progress.
 *
 * A clock on the wall does not tell: a process may be stopped, its machine asleep, or its processors busy with
 * others.  So someone samples often, and what is between two samples counts
 *     - not at all, if the process is stopped;
 *     - as the processor time that it got, if one of its threads can run;
 *     - as time, if all of its threads wait for something else: a device, a file, each other.
 * What is longer than WATCHDOG_LONGEST_GAP counts as that: who samples was then stopped as well.
 */
#ifndef KRS_WATCHDOG_H
#define KRS_WATCHDOG_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

#define WATCHDOG_LONGEST_GAP 0.2 /* seconds */

/* The state of a process at a moment. */
typedef struct ProcessSample {
    double   now;       /* seconds of a clock that only goes forward */
    double   processor; /* seconds that all of its threads have had */
    bool     runnable, stopped;
    bool     idle;     /* it waits for something to do: that is no work */
    uint64_t progress; /* counts its steps */
} ProcessSample;

typedef struct Watchdog {
    bool          begun;
    ProcessSample last;
    double        worked;    /* seconds */
    double        fruitless; /* seconds of work since the last step */
} Watchdog;

/* Adds what has happened since the last sample; `watchdog` begins zeroed. */
void watchdog_add(Watchdog *watchdog, const ProcessSample *sample);

/* Fills in all but `idle` and `progress`; `before` is the last sample, or zeroed.  The thread that samples does not
   count as one of the process.  Where the system does not tell what threads do, they count as waiting. */
void watchdog_sample(pid_t process, const ProcessSample *before, ProcessSample *sample);

#endif
