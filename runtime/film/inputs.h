/*
 * inputs.h: what the caller gives for each pixel: rays, and depths at which rays end.
 */
#ifndef KRS_INPUTS_H
#define KRS_INPUTS_H

#include "runtime/tracer/job.h"

/* Returns the room that they need behind the lights, in rays of a list. */
size_t inputs_room(const Job *job);
/* Copies those of a band to the device, behind the lights, and says in the control block where. */
void inputs_upload(const Job *job, const KrsWindow *traced);
/* Copies what is the same for all bands: the map of a plate, and media.  Says in the job where photons go. */
void inputs_upload_tables(Job *job);

#endif
