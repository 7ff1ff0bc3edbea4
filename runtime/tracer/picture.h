/*
 * picture.h: the planes of a picture, in memory of the host.
 */
#ifndef KRS_PICTURE_H
#define KRS_PICTURE_H

#include "runtime/device/gpu.h"
#include "runtime/shared/blocks.h"

/* A picture whose wanted planes (bits of KrsPlane) are zero; NULL with the failure noted. */
KrsPicture *picture_new(Gpu *gpu, uint32_t width, uint32_t height, KrsWindow window,
                        uint32_t wanted);

/* The rows of results (bit ROW_... of each) that the planes of a picture come from. */
uint32_t picture_rows(const KrsPicture *picture);

/* Takes `count` finished pixels over into the planes, from the window's pixel number `first` on:
   colour is the mean of `samples` rays.  `results` is the first of them in the row of colours;
   the next row lies `row_pixels` pixels behind. */
void picture_take(KrsPicture *picture, const float *results, size_t row_pixels, size_t first,
                  size_t count, uint32_t samples);

#endif
