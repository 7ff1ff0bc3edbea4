/*
 * slurm.h: hands a job to Slurm.
 */
#ifndef KRS_FARM_SLURM_H
#define KRS_FARM_SLURM_H

#include "cli/farm/job.h"

/* Writes scripts for sbatch into the folder, runs sbatch, and keeps the numbers of Slurm's jobs there. */
KrsStatus slurm_submit(const FarmJob *job, const Options *options, const char *partition);
/* Cancels what was submitted, if anything was. */
KrsStatus slurm_cancel(const FarmJob *job, const Options *options);

#endif
