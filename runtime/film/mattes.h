/*
 * mattes.h: which parts of the scene the rays of each pixel hit, and how many hit each.
 */
#ifndef KRS_MATTES_H
#define KRS_MATTES_H

#include "runtime/device/gpu.h"
#include "krs/vulkan.h"
#include "runtime/shared/blocks.h"

/* The rows of results that mattes come from. */
enum { MATTE_ROWS = 1 << ROW_NORMALS | 1 << ROW_COUNTS };

/* Gives a picture mattes without any ray; false with the failure noted. */
bool mattes_new(Gpu *gpu, KrsPicture *picture);
/* Counts a ray of each of `count` pixels, from number `first` of the window on.  `results` is as for
   picture_take. */
void mattes_take(KrsPicture *picture, const float *results, size_t row_pixels, size_t first,
                 size_t count);
/* Forgets all rays. */
void mattes_clear(KrsPicture *picture);
/* Sorts what each pixel has: the most covered first. */
void mattes_sort(KrsPicture *picture);

#endif
