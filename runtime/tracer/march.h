/*
 * march.h: beams and primary rays.
 */
#ifndef KRS_MARCH_H
#define KRS_MARCH_H

#include "runtime/tracer/job.h"

/* How primary rays and their beams march, all together or those of a group of components. */
typedef struct March {
    Kernel     *rays, *beams; /* beams NULL: there are none */
    KrsSchedule schedule;
    double      flops; /* of a distance */
    bool        boxed; /* rays are clipped to this box, else to that of the scene; */
    double      low[3], high[3];
    bool        windowed; /* and only pixels whose rays may meet it are marched */
} March;

/* Until a ray is found to hit something it misses. */
bool march_clear(Job *job);
/* Finds what the rays hit: beams first, then the rays. */
bool march_run(Job *job, const March *march, const WorkBlock *work);

#endif
