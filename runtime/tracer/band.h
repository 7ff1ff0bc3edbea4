/*
 * band.h: the buffers of a band, some rows of the picture that are made at once.
 */
#ifndef KRS_BAND_H
#define KRS_BAND_H

#include "runtime/tracer/handles.h"

/* Makes room for a band of a window of tiles, with a halo around it, for a smaller one when memory is
   short, and returns its rows; 0 when there is no room at all. */
uint32_t band_allocate(KrsRendering *rendering, const KrsWindow *cover, uint32_t halo);

#endif
