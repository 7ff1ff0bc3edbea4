/*
 * held.h: a film, and the band of it that the buffers of its rendering hold.
 */
#ifndef KRS_HELD_H
#define KRS_HELD_H

#include "runtime/tracer/handles.h"

struct KrsFilm {
    KrsRendering    *rendering;
    KrsRenderOptions options; /* with nothing left to be defaulted */
    KrsSchedule      asked;
    KrsPicture      *sums;             /* colours are sums over the samples */
    uint32_t         samples;          /* of each pixel so far */
    uint32_t         rows;             /* of a band; 0: none has been made */
    double           rebase_origin[3]; /* that positions of the first sample are given from */
};

/* Takes what the buffers have over into their film, if it is not there. */
bool held_store(KrsRendering *rendering);
/* Makes the buffers hold a band of the film: as it is so far, where it has samples. */
bool held_change(KrsFilm *film, const HeldBand *wanted);

#endif
