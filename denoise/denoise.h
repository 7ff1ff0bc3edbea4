/*
 * denoise.h: a picture of few samples with less noise, by what is known of its pixels.
 *
 * A pixel becomes a mean of pixels around it that are alike: in colour, for the noise that the colours have, and in
 * what stands in guides without noise: the normal, the colour of the surface, and where it is.
 */
#ifndef KRS_DENOISE_DENOISE_H
#define KRS_DENOISE_DENOISE_H

#include <stdbool.h>
#include <stddef.h>

#include "krs/krs.h"

/* Numbers of all pixels, in rows from the top. */
typedef struct DenoisePlane {
    const float *samples; /* NULL: they are unknown */
    size_t       stride;  /* from one pixel to the next */
} DenoisePlane;

/* Of three planes all are known or none.  A colour that is not finite, or beyond 1e9, is replaced by its neighbours. */
typedef struct DenoisePicture {
    size_t       width, height;
    DenoisePlane color[3];
    DenoisePlane
        deviation; /* the standard deviation of a colour's error; not finite: estimated from colours */
    DenoisePlane normal[3], albedo[3], position[3];
    DenoisePlane depth; /* counts where positions are unknown */
} DenoisePicture;

/* Is told how much is done, from 0 to 1, and returns whether to go on. */
typedef bool DenoiseProgress(void *user, double fraction);

/* Writes finite colours, the same on every machine.  KRS_INTERRUPTED where `progress`, which may be NULL, has said
   so; KRS_OUT_OF_MEMORY. */
KrsStatus denoise(const DenoisePicture *picture, DenoiseProgress *progress, void *user,
                  float (*result)[3]);

#endif
