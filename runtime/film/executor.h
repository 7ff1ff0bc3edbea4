/*
 * executor.h: who marches the rays of a film.
 */
#ifndef KRS_EXECUTOR_H
#define KRS_EXECUTOR_H

#include "runtime/tracer/job.h"

/* Replaces KRS_EXECUTOR_DEFAULT in the options of a job of so many samples, whose frame is read, and compiles the shaders of
   its rendering where they are needed and were left for later.  False with the failure noted. */
bool executor_choose(Job *job, uint32_t samples);

#endif
