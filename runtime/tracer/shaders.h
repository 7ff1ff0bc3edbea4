/*
 * shaders.h: the shaders that contain functions of the scene, in a map (shaders.c).
 *
 * A shader is compiled when it is first asked for.  The functions that return one return NULL, with
 * the failure noted, where that fails.
 */
#ifndef KRS_SHADERS_H
#define KRS_SHADERS_H

#include "runtime/tracer/handles.h"
#include "runtime/tracer/research/research.h"

/* Returns the shader of primary rays.  Method and schedule are chosen, not the defaults.
   `march_group` is the number of a group from 1, 0 for all components, or MARCH_WITHOUT_PLANES or
   MARCH_PACKED. */
Shader *rendering_trace(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                        uint32_t march_group);
/* Returns the shader of beams.  They are wider than a ray, so they need distances that hold in all
   directions, whatever the method of the rays. */
Shader *rendering_beams(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                        uint32_t march_group);
/* Returns the shader of normals, for a march group or for all components (0). */
Shader *rendering_normals_shader(KrsRendering *rendering, KrsNormals normals, uint32_t march_group);
/* Returns the shader of rays to lights and for occlusion; `by_roots`: they go from root to root;
   `planes`: they intersect planes, and are clipped to the box around all else. */
Shader *rendering_secondary(KrsRendering *rendering, KrsSchedule schedule, bool by_roots,
                            bool planes);
/* Returns the shader of the albedo of what rays for occlusion have met. */
Shader *rendering_occluders(KrsRendering *rendering);
/* Returns the shader that evens hits out. */
Shader *rendering_research(KrsRendering *rendering, const ResearchPass *pass);
Shader *rendering_shade(KrsRendering *rendering);
/* Returns the same without a scene: the host finds surfaces (lane_surfaces.h). */
Shader *rendering_shade_found(KrsRendering *rendering);
/* Returns the shader of photons. */
Shader *rendering_photons(KrsRendering *rendering);
Shader *rendering_query(KrsRendering *rendering, KrsSchedule schedule);
Shader *rendering_point_query(KrsRendering *rendering);

/* The shaders of the rays of paths, whatever the rays of the frame are.  `planes`: rays to lights meet planes without a
   march. */
typedef struct PathShaders {
    Shader *march, *normals, *shadows;
    Shader *scatter;                /* scatter.comp, or for previews shade.comp */
    Shader *track, *collide, *beam; /* NULL: there are no media; of lamps in them */
} PathShaders;
bool rendering_paths(KrsRendering *rendering, const KrsRenderOptions *options, KrsPurpose purpose,
                     bool planes, PathShaders *shaders);

/* Tells whether the shaders that a rendering defers have been compiled before, here or as the cache knows: looks for one
   of them, whose key there is *key; of zeros where the scene has none. */
bool shaders_are_known(KrsRendering *rendering, CacheKey *key);
/* Makes the shaders for a purpose, pictures with default options or queries, unless they exist, or are
   those that a rendering defers. */
bool shaders_create(KrsRendering *rendering, KrsPurpose purpose);
/* Makes a map that of an edited scene with the same shaders. */
void shaders_adopt(ShaderMap *map, const KrsScene *scene);
void shaders_destroy(Gpu *gpu, ShaderMap *map);

#endif
