/*
 * variants.h: kernels with a scene in them: which functions of the scene each calls, and the `#define`s
 * that tell the kernel's own text what has been chosen of the scene's.
 */
#ifndef KRS_VARIANTS_H
#define KRS_VARIANTS_H

#include "runtime/tracer/handles.h"

typedef struct KernelVariant {
    KernelScene scene;
    char        defines[320];
} KernelVariant;

/* Defines of kernels with or without a scene: */
#define NO_TEXELS "#define NO_TEXELS\n" /* see Gpu.texels */
/* rays of panoramas, which cost more, are in kernels of scenes that have some; */
#define PANORAMIC "#define PANORAMIC\n"
/* rays are those of a list (frame.glsl). */
#define LISTED_RAYS "#define LISTED_RAYS\n"

/* As for rendering_trace and its kind. */
KernelVariant variant_of_trace(const KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                               uint32_t group);
KernelVariant variant_of_normals(const KrsRendering *rendering, KrsNormals normals, uint32_t group);
KernelVariant variant_of_secondary(const KrsRendering *rendering, KrsTrace trace,
                                   KrsSchedule schedule);
KernelVariant variant_of_shade(const KrsRendering *rendering);
KernelVariant variant_of_query(const KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule);
KernelVariant variant_of_point_query(const KrsRendering *rendering);
/* The source of a kernel, for as long as the variant is there. */
KernelSource variant_source(const char *file, const KernelVariant *variant);

/* The kernel of a file as it suits every device, for who has none: with the scene, when it includes
   one. */
KernelVariant variant_for_any(const KrsScene *scene, const char *file, const KrsVariant *variant);

#endif
