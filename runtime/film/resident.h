/*
 * resident.h: a film, and the band of it that is in the buffers of its rendering.
 */
#ifndef KRS_RESIDENT_H
#define KRS_RESIDENT_H

#include "runtime/film/doublings.h"
#include "runtime/tracer/handles.h"

struct KrsFilm {
    KrsRendering    *rendering;
    KrsRenderOptions asked;          /* by the caller */
    KrsRenderOptions options;        /* complete: none asks for a default */
    KrsSchedule      asked_schedule; /* before it was completed */
    uint32_t         updates;        /* of its rendering that it has followed */
    KrsPicture      *sums;           /* colours are sums over the samples */
    float (*kept)[4];                /* see resident_kept; NULL: no error is estimated */
    /* Sums of the light of each light, where they are separate: all pixels of the crop for the
       first, then for the next.  The sums of `sums` are those of the rest. */
    float (*lights)[4];
    uint32_t light_count; /* 0: they are not separate; the last CAUGHT_ROWS are of the plate */
    uint32_t samples; /* number of the next sample of each pixel, unless it has ended by noise */
    uint32_t first,
        closed;          /* numbers of the first sample, and of the first that is not in `exact` */
    bool divided;        /* others have further samples of the picture */
    Exact (*exact)[4];   /* sums of blocks that are closed; NULL: none is */
    Doubling *doublings; /* NULL: no block is closed, or no error is estimated */
    uint32_t  rows;      /* of a band; 0: no band has been made */
    double    rebase_origin[3]; /* positions of the first sample are relative to it */
    /* While samples are added: how many the host has beyond those before, of each row of tiles, and
       what statistics were then. */
    uint32_t      *more;
    KrsRenderStats stats;
};

static inline size_t film_pixels(const KrsFilm *film)
{
    return (size_t)film->options.crop.width * film->options.crop.height;
}

/* Returns the crop of a film extended to whole tiles: the rays of a tile share a beam, and pixels
   of a tile go on together (noise.comp), which must not depend on the crop. */
KrsWindow resident_cover(const KrsRenderOptions *options);
/* Tells how many numbers of four members `kept` has: of each pixel of these tiles in the rows of colours,
   noise and earlier sums. */
enum { KEPT_COLORS, KEPT_NOISE, KEPT_EARLIER, KEPT_ROWS };
size_t resident_kept(const KrsRenderOptions *options);

/* Tells how many samples the host has of a band that begins at this row of the tiles. */
uint32_t resident_samples(const KrsFilm *film, uint32_t from);
/* Copies the samples in the buffers to their film, unless it has them. */
bool resident_store(KrsRendering *rendering);
/* Makes the buffers hold a band of the film, with the samples that the host has of it. */
bool resident_change(KrsFilm *film, const ResidentBand *wanted);

/* Makes some rows of the results in the buffers as they are without a hit: bits ROW_... of each. */
bool resident_clear(KrsRendering *rendering, uint32_t rows);
/* Copies the samples as well, and counts the rays in the buffers for the mattes of their film: both, or neither. */
bool resident_take_mattes(KrsRendering *rendering);

#endif
