/*
 * probe.h: whether a machine makes the pictures that the others make.
 */
#ifndef KRS_FARM_PROBE_H
#define KRS_FARM_PROBE_H

#include "cli/farm/job.h"

/* Renders a small picture of the job's first frame, once for each machine and its drivers, and compares its bytes with
   those of the machine that was first.  KRS_NO_DEVICE and words: it differs, as by another driver, so the machine may not
   help. */
KrsStatus probe(const FarmJob *job, const Options *options);

#endif
