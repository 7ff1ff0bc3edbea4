/*
 * band.h: the buffers of a band: rows of tiles that are rendered together.
 */
#ifndef KRS_BAND_H
#define KRS_BAND_H

#include "runtime/tracer/handles.h"

/* Allocates buffers for a band of `cover`, a window of whole tiles, with `halo` more pixels on each
   side; `path_rows`: of the path of each pixel, and of rays of its hit; `noise`: its error is estimated; `lights` have rows of
   results of their own; `surface_rows`: of each hit, that the host finds.  When memory is short the band has fewer rows.  Returns its rows; 0, with the failure noted, when even the smallest band
   does not fit. */
uint32_t band_allocate(KrsRendering *rendering, const KrsWindow *cover, uint32_t halo,
                       uint32_t path_rows, bool noise, uint32_t lights, uint32_t surface_rows);

#endif
