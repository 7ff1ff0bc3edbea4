/*
 * picture.h: the AOVs of a picture, in memory of the host.
 */
#ifndef KRS_PICTURE_H
#define KRS_PICTURE_H

#include "runtime/device/gpu.h"
#include "runtime/shared/blocks.h"

/* Returns a picture whose wanted AOVs (bits of KrsAov) are zero; NULL with the failure noted. */
KrsPicture *picture_new(Gpu *gpu, uint32_t width, uint32_t height, KrsWindow window,
                        uint32_t wanted);

/* Returns how many pixels of the picture are there: those of its window. */
static inline size_t picture_pixels(const KrsPicture *picture)
{
    return (size_t)picture->window.width * picture->window.height;
}

/* Returns the rows of results (bit ROW_... of each) that the AOVs of a picture come from. */
uint32_t picture_rows(const KrsPicture *picture);

/* Copies `count` pixels of results to those AOVs of the picture that are among `aovs`.  They
   become the pixels of the window from number `first` on.  `results` points to the first of them in
   the row of colours; the next row lies `row_pixels` pixels behind. */
void picture_take(KrsPicture *picture, uint32_t aovs, const float *results, size_t row_pixels,
                  size_t first, size_t count);
/* Returns the numbers of AOV `index`, and its bytes per pixel: NULL where the picture does not have
   it. 0: there are no more AOVs. */
size_t picture_plane(const KrsPicture *picture, int index, void **numbers);
/* Returns a copy of the picture with those AOVs that are among `aovs`; NULL with the failure
   noted. */
KrsPicture *picture_copy(Gpu *gpu, const KrsPicture *picture, uint32_t aovs);
/* Frees those AOVs of the picture that are among `aovs`. */
void picture_drop(KrsPicture *picture, uint32_t aovs);
/* Divides the colours, which are sums over `samples`, to get their means; `ended`: the samples of
   pixels that have ended before, 0 for others; NULL: none has. */
void picture_divide(KrsPicture *picture, const uint32_t *ended, uint32_t samples);

/* Shows a plate behind the picture, and its depth where nothing is hit; both are of the whole
   picture, or NULL. */
void picture_compose(KrsPicture *picture, const float *depth, const float (*plate)[4]);

#endif
