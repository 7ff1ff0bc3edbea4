/*
 * variants.h: what a kernel with a scene is made from: the functions of the scene that it calls,
 * and `#define`s.  These tell its own text what was chosen for the scene's.
 */
#ifndef KRS_VARIANTS_H
#define KRS_VARIANTS_H

#include "runtime/tracer/handles.h"

typedef struct KernelVariant {
    KernelScene scene;
    char        defines[420];
} KernelVariant;

/* Defines of kernels with or without a scene. */
#define NO_TEXELS    "#define NO_TEXELS\n"    /* see Gpu.texels */
#define FRAME_TEXELS "#define FRAME_TEXELS\n" /* frame.glsl */
/* How kernels read on a device: buffers only, texels too, or the blocks of the frame as texels too. */
typedef enum KernelReads { READ_BUFFERS, READ_TEXELS, READ_FRAME_TEXELS, KERNEL_READS } KernelReads;
KernelReads variants_reads(const Gpu *gpu);
/* Only scenes with a panorama have kernels for its rays, which cost more. */
#define PANORAMIC "#define PANORAMIC\n"
/* Cameras have an aperture, a shift or two eyes. */
#define LENS "#define PANORAMIC\n#define LENS\n"
/* Rays come from a list (frame.glsl). */
#define LISTED_RAYS "#define LISTED_RAYS\n"
/* Rays are those of paths that have begun (frame.glsl). */
#define PATH_RAYS "#define PATH_RAYS\n"
/* The sky is a picture (sky_map.glsl). */
#define SKY_MAP "#define SKY_MAP\n"
#define CATCHES "#define CATCHES\n"
/* Rays are those of the picture or those of paths, as the pass says. */
#define MIXED_RAYS "#define MIXED_RAYS\n"

/* The variants of the kernels of kernels.h, with the same arguments. */
KernelVariant variant_of_trace(const KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                               uint32_t group);
KernelVariant variant_of_normals(const KrsRendering *rendering, KrsNormals normals, uint32_t group);
KernelVariant variant_of_secondary(const KrsRendering *rendering, KrsTrace trace,
                                   KrsSchedule schedule, KrsIntegrator integrator);
KernelVariant variant_of_occluders(const KrsRendering *rendering);
KernelVariant variant_of_shade(const KrsRendering *rendering);
KernelVariant variant_of_scatter(const KrsRendering *rendering, KrsStarts starts,
                                 KrsIntegrator integrator);
KernelVariant variant_of_even_hits(const KrsRendering *rendering);
KernelVariant variant_of_query(const KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule);
KernelVariant variant_of_point_query(const KrsRendering *rendering);
/* The source of a kernel.  It points into the variant, which must live as long. */
KernelSource variant_source(const char *file, const KernelVariant *variant);

/* The variant of a kernel that suits every device, for callers that have none.  It contains the
   scene if the file includes one. */
KernelVariant variant_for_any(const KrsScene *scene, const char *file, const KrsVariant *variant);

#endif
