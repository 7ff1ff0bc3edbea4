/*
 * report.h: how far a job is.
 */
#ifndef KRS_FARM_REPORT_H
#define KRS_FARM_REPORT_H

#include "cli/farm/job.h"

/* Prints it to standard output; 1 if pieces have failed for good. */
KrsStatus report_status(const FarmJob *job, const Options *options);
/* Prints what was said while pieces were rendered that have failed. */
KrsStatus report_logs(const FarmJob *job, const Options *options);

#endif
