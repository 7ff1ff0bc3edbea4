/*
 * band.h: the buffers of a band: rows of tiles that are rendered together.
 */
#ifndef KRS_BAND_H
#define KRS_BAND_H

#include "runtime/tracer/handles.h"

/* Allocates buffers for a band of `cover`, a window of whole tiles, with `halo` more pixels on each side.  Each pixel has
   `path_rows` for its path and for rays of its hit, a row of results for each of `lights`, and `surface_rows` for what the
   host finds of its hit; with `noise` also what its error is estimated from.  When memory is short the band has fewer rows.
   Returns its rows; 0, with the failure noted, when even the smallest band does not fit. */
uint32_t band_allocate(KrsRendering *rendering, const KrsWindow *cover, uint32_t halo,
                       uint32_t path_rows, bool noise, uint32_t lights, uint32_t surface_rows);

#endif
