/*
 * picture.h: the planes of a picture, in memory of the host.
 */
#ifndef KRS_PICTURE_H
#define KRS_PICTURE_H

#include "runtime/device/gpu.h"
#include "runtime/tracer/blocks.h"

/* A picture whose wanted planes (bits of KrsPlane) are zero; NULL with the failure noted. */
KrsPicture *picture_new(Gpu *gpu, uint32_t width, uint32_t height, KrsWindow window,
                        uint32_t wanted);

/* Takes `count` finished pixels over into the planes, from the window's pixel number `first` on:
   colour is the mean of `samples` rays.  Counts them in the statistics. */
void picture_take(KrsPicture *picture, const PixelBlock *pixels, size_t first, size_t count,
                  uint32_t samples);

#endif
