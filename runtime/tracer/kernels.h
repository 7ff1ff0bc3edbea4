/*
 * kernels.h: the kernels with a scene in them: a map from what a kernel is made from to the kernel.
 *
 * Each is compiled when it is first asked for; NULL with the failure noted.
 */
#ifndef KRS_KERNELS_H
#define KRS_KERNELS_H

#include "runtime/tracer/handles.h"

/* The kernel of primary rays for a method and a schedule (neither is the default), of a group of
   components, of all (0), or MARCH_WITHOUT_PLANES. */
Kernel *rendering_trace(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                        uint32_t march_group);
/* The same for beams, which need distances for all directions. */
Kernel *rendering_beams(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                        uint32_t march_group);
/* The kernel of normals, of a march group or of all (0). */
Kernel *rendering_normals_kernel(KrsRendering *rendering, KrsNormals normals, uint32_t march_group);
/* The kernel of rays to lights and for occlusion. */
Kernel *rendering_secondary(KrsRendering *rendering, KrsSchedule schedule, bool by_roots);
Kernel *rendering_shade(KrsRendering *rendering);
Kernel *rendering_query(KrsRendering *rendering, KrsSchedule schedule);
Kernel *rendering_point_query(KrsRendering *rendering);

/* Makes the kernels that a picture by default, or questions, need, unless they are there. */
bool kernels_create(KrsRendering *rendering, KrsPurpose purpose);
void kernels_destroy(Gpu *gpu, KernelMap *map);

#endif
