/*
 * kernels.h: the kernels that contain functions of the scene, in a map (kernels.c).
 *
 * A kernel is compiled when it is first asked for.  The functions that return one return NULL, with
 * the failure noted, where that fails.
 */
#ifndef KRS_KERNELS_H
#define KRS_KERNELS_H

#include "runtime/tracer/handles.h"

/* The kernel of primary rays.  Method and schedule are chosen, not the defaults.  `march_group` is
   the number of a group from 1, 0 for all components, or MARCH_WITHOUT_PLANES or MARCH_PACKED. */
Kernel *rendering_trace(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                        uint32_t march_group);
/* The kernel of beams.  They are wider than a ray, so they need distances that hold in all
   directions, whatever the method of the rays. */
Kernel *rendering_beams(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                        uint32_t march_group);
/* The kernel of normals, for a march group or for all components (0). */
Kernel *rendering_normals_kernel(KrsRendering *rendering, KrsNormals normals, uint32_t march_group);
/* The kernel of rays to lights and for occlusion; `by_roots`: they go from root to root. */
Kernel *rendering_secondary(KrsRendering *rendering, KrsSchedule schedule, bool by_roots);
/* The kernel of the albedo of what rays for occlusion have met. */
Kernel *rendering_occluders(KrsRendering *rendering);
/* The kernel that evens hits out. */
Kernel *rendering_even_hits(KrsRendering *rendering);
Kernel *rendering_shade(KrsRendering *rendering);
Kernel *rendering_query(KrsRendering *rendering, KrsSchedule schedule);
Kernel *rendering_point_query(KrsRendering *rendering);

/* The kernels of the rays of paths, whatever the rays of the frame are. */
typedef struct PathKernels {
    Kernel *march, *normals, *shadows;
    Kernel *scatter; /* scatter.comp, or for previews shade.comp */
} PathKernels;
bool rendering_paths(KrsRendering *rendering, const KrsRenderOptions *options, KrsPurpose purpose,
                     PathKernels *kernels);

/* Makes the kernels for a purpose, pictures with default options or queries, unless they exist. */
bool kernels_create(KrsRendering *rendering, KrsPurpose purpose);
/* Makes a map that of an edited scene with the same kernels. */
void kernels_adopt(KernelMap *map, const KrsScene *scene);
void kernels_destroy(Gpu *gpu, KernelMap *map);

#endif
