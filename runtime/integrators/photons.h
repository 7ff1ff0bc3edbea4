/*
 * photons.h: the photons of each sample, which tell what light of lights smooth surfaces gather on others.
 */
#ifndef KRS_PHOTONS_H
#define KRS_PHOTONS_H

#include "runtime/tracer/plan.h"

/* Returns what traces the photons of a sample, and puts them among the inputs; .own is NULL, with the failure noted, if
   that cannot be.  They depend on the frame, the seed and the number of the sample alone, so they are the same for all
   bands, crops and ranges of samples. */
Before photons_new(Job *job);

#endif
