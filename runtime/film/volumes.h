/*
 * volumes.h: media that scatter light, as shaders find them among the inputs (volumes.glsl).
 */
#ifndef KRS_FILM_VOLUMES_H
#define KRS_FILM_VOLUMES_H

#include "runtime/tracer/job.h"

/* Tells whether the paths of a picture meet media. */
bool volumes_are_met(const Job *job);
/* Finds bounds of densities for the state of the job, unless they are found already; false with the failure
   noted. */
bool volumes_find(Job *job);
/* Returns how many rows of the inputs there are of media. */
size_t volumes_rows(const Job *job);
/* Copies them. */
void volumes_copy(const Job *job, uint32_t (*rows)[4]);

#endif
