/*
 * kernels.h: the kernels with a scene in them: a map from what a kernel is made from to the kernel.
 */
#ifndef KRS_KERNELS_H
#define KRS_KERNELS_H

#include "runtime/tracer/renderer.h"

/* Makes the kernels that a picture by default, or questions, need, unless they are there. */
bool kernels_create(KrsRendering *rendering, KrsPurpose purpose);
void kernels_destroy(Gpu *gpu, KernelMap *map);

#endif
