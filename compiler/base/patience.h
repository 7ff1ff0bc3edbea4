/*
 * patience.h: how long a process has worked, and how long without progress.
 *
 * A clock on the wall does not tell: a process may be stopped, its machine asleep, or its processors busy with
 * others.  So someone looks often, and what is between two looks counts
 *     - not at all, if the process is stopped;
 *     - as the processor time that it got, if one of its threads can run;
 *     - as time, if all of its threads wait for something else: a device, a file, each other.
 * What is longer than PATIENCE_LONGEST_LOOK counts as that: who looks was then stopped as well.
 */
#ifndef KRS_PATIENCE_H
#define KRS_PATIENCE_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

#define PATIENCE_LONGEST_LOOK 0.2 /* seconds */

/* What is seen of a process at a moment. */
typedef struct Look {
    double   now;       /* seconds of a clock that only goes forward */
    double   processor; /* seconds that all of its threads have had */
    bool     runnable, stopped;
    bool     idle;     /* it waits for something to do: that is no work */
    uint64_t progress; /* counts its steps */
} Look;

typedef struct Patience {
    bool   begun;
    Look   last;
    double worked;    /* seconds */
    double fruitless; /* seconds of work since the last step */
} Patience;

/* Adds what has happened since the last look; `patience` begins zeroed. */
void patience_add(Patience *patience, const Look *look);

/* Fills in all but `idle` and `progress`; `before` is the last look, or zeroed.  The thread that looks does not
   count as one of the process.  Where the system does not tell what threads do, they count as waiting. */
void patience_look(pid_t process, const Look *before, Look *look);

#endif
