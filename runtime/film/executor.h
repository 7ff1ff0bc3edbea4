/*
 * executor.h: who marches the rays of a film.
 */
#ifndef KRS_EXECUTOR_H
#define KRS_EXECUTOR_H

#include "runtime/tracer/job.h"

/* Replaces KRS_EXECUTOR_DEFAULT in the options of a job of so many samples, whose frame is read, and compiles the shaders of
   its rendering where they are needed and were left for later.  False with the failure noted. */
bool executor_choose(Job *job, uint32_t samples);
/* Tells about how many milliseconds lanes take for a sample of a job whose frame is read, and compilers for its shaders.
   False, with the reason noted: lanes cannot march its rays, or need a shader that contains the scene. */
bool executor_try_lanes(Job *job, double *lanes_ms, double *compiler_ms);

#endif
