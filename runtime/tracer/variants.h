/*
 * variants.h: what a shader with a scene is made from: the functions of the scene that it calls,
 * and `#define`s.  These tell its own text what was chosen for the scene's.
 */
#ifndef KRS_VARIANTS_H
#define KRS_VARIANTS_H

#include "runtime/tracer/handles.h"
#include "runtime/tracer/research/research.h"

typedef struct ShaderVariant {
    ShaderScene scene;
    char        defines[420];
} ShaderVariant;

/* Defines of shaders with or without a scene. */
#define NO_TEXELS    "#define NO_TEXELS\n"    /* see Gpu.texels */
#define FRAME_TEXELS "#define FRAME_TEXELS\n" /* frame.glsl */
/* The ways in which shaders read on a device: buffers only, texels too, or the blocks of the frame
   as texels too. */
typedef enum ShaderReads { READ_BUFFERS, READ_TEXELS, READ_FRAME_TEXELS, SHADER_READS } ShaderReads;
ShaderReads variants_reads(const Gpu *gpu);
/* Scenes with a panorama alone have shaders for its rays, which cost more. */
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

/* These return the variants of the shaders of shaders.h, with the same arguments. */
ShaderVariant variant_of_trace(const KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                               uint32_t group);
ShaderVariant variant_of_normals(const KrsRendering *rendering, KrsNormals normals, uint32_t group);
ShaderVariant variant_of_secondary(const KrsRendering *rendering, KrsTrace trace,
                                   KrsSchedule schedule, KrsIntegrator integrator, bool planes);
ShaderVariant variant_of_occluders(const KrsRendering *rendering);
ShaderVariant variant_of_shade(const KrsRendering *rendering);
/* Returns the same without a scene: the host finds surfaces. */
ShaderVariant variant_of_shade_found(const KrsRendering *rendering);
ShaderVariant variant_of_photons(const KrsRendering *rendering);
ShaderVariant variant_of_scatter(const KrsRendering *rendering, KrsStarts starts,
                                 KrsIntegrator integrator, bool photons);
/* Of media that scatter light: where they do, and what comes of it. */
ShaderVariant variant_of_track(const KrsRendering *rendering);
ShaderVariant variant_of_beam(const KrsRendering *rendering);
ShaderVariant variant_of_collide(const KrsRendering *rendering, KrsIntegrator integrator);
ShaderVariant variant_of_research(const KrsRendering *rendering, const ResearchPass *pass);
ShaderVariant variant_of_query(const KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule);
ShaderVariant variant_of_point_query(const KrsRendering *rendering);
/* Returns the source of a shader.  It points into the variant, which must live as long. */
ShaderSource variant_source(const char *file, const ShaderVariant *variant);

/* Returns the variant of a shader that suits every device, for callers that have none.  It contains
   the scene if the file includes one. */
ShaderVariant variant_for_any(const KrsScene *scene, const char *file, const KrsVariant *variant);

#endif
