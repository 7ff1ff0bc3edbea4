/*
 * pixel_filter.h: where the rays of a pixel go, so that their plain mean is filtered.
 *
 * Rays are placed with a density in proportion to the filter.  So each counts as much as the
 * others, and a film is a sum of samples, whatever the filter.
 */
#ifndef KRS_PIXEL_FILTER_H
#define KRS_PIXEL_FILTER_H

#include "krs/vulkan.h"

/* Tells how far rays go from the middle of their pixel at most, in pixels. */
double pixel_filter_reach(KrsPixelFilter filter);
/* Returns the place along an axis, in a pixel from 0 to 1, before which the share `part` of the
   filter's weight lies; 1/2 is the middle. */
double pixel_filter_place(KrsPixelFilter filter, double part);

#endif
