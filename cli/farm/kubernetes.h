/*
 * kubernetes.h: a description of a job for Kubernetes.
 */
#ifndef KRS_FARM_KUBERNETES_H
#define KRS_FARM_KUBERNETES_H

#include "cli/farm/job.h"

/* Writes kubernetes.yaml into the folder: an Indexed Job whose containers have this image.  Nodes must see the folders
   of the job and of its pictures under the same paths. */
KrsStatus kubernetes_write(const FarmJob *job, const Options *options, const char *image);

#endif
