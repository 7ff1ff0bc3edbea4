/*
 * march.h: beams and primary rays.
 */
#ifndef KRS_MARCH_H
#define KRS_MARCH_H

#include "runtime/tracer/job.h"

/* A march of primary rays and their beams: through all components, or one march group. */
typedef struct March {
    Shader     *rays, *beams; /* beams: NULL without beams */
    KrsSchedule schedule;
    KrsPhase    phase; /* to which the time of its rays is added */
    double      flops; /* operations for one distance */
    bool        boxed; /* rays are clipped to [low, high], else to the scene's box */
    double      low[3], high[3];
    bool        of_paths; /* rays of the listed pixels, from where their paths are */
    bool        windowed; /* only pixels whose rays may meet the box are marched */
} March;

/* Sets all rays of the band to misses. */
bool march_clear(Job *job);
/* Marches the beams of a band, then the rays. */
bool march_run(Job *job, const March *march, const WorkBlock *work);

#endif
