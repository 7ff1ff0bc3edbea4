/*
 * methods.h: which method, schedule and grouping of components suit a scene on a device.
 */
#ifndef KRS_METHODS_H
#define KRS_METHODS_H

#include "runtime/tracer/handles.h"

/* Replaces defaults by what `make bench` found fastest for such a scene on such a device. */
void rendering_choose(const KrsRendering *rendering, KrsTrace *trace, KrsSchedule *schedule);
/* Returns the steps of a lane in a dispatch: `wanted`, or the most that its loops permit. */
uint32_t rendering_steps_within(const KrsRendering *rendering, uint32_t wanted);
/* Tells whether a primary ray is saved when the steps of its dispatch are used up.  Else it is marched to
   its end; the steps of the dispatch and those of a ray are few enough for that. */
bool rendering_saves_rays(const KrsRendering *rendering, KrsSchedule schedule);
/* Returns the schedule for the rays of a march group that is marched by itself. */
KrsSchedule rendering_schedule_of_march_group(const KrsRendering *rendering, KrsSchedule asked,
                                              uint32_t march_group);
/* Tells whether rays intersect planes without a march, by shaders for MARCH_WITHOUT_PLANES. */
bool rendering_knows_planes(const KrsRendering *rendering);
/* Tells whether rays to lights and for occlusion may do so, if the camera is outside of all. */
bool rendering_light_meets_planes(const KrsRendering *rendering, KrsIntegrator integrator);
/* Tells whether lanes can find surfaces: no ray goes on behind one, and shaders can read what is found. */
bool rendering_lanes_find_surfaces(const KrsRendering *rendering);
/* Tells whether march groups are marched one after the other; false where they cannot be. */
bool rendering_marches_per_component(const KrsRendering *rendering, KrsComponents components);
/* Tells whether each ray marches scene part by scene part with this method; false where it cannot. */
bool rendering_marches_packed(const KrsRendering *rendering, KrsComponents components,
                              KrsTrace trace);
/* Tells whether rays by this method have beams before them. */
bool rendering_has_beams(const KrsRendering *rendering, KrsTrace trace);
/* Tells whether rays step by what lies ahead in their direction (krs_along), not by the distance. */
bool rendering_goes_along(const KrsRendering *rendering, KrsTrace trace);
/* Tells whether shaders for all march groups are for the rays of the picture and for those of its paths. */
bool rendering_mixes_rays(const KrsRendering *rendering);
/* Tells whether many noises of a surface are one loop: less for the driver to translate, but
   iterations cost. */
bool rendering_gathers_noises(const KrsRendering *rendering);
/* Returns the kind of normals to compute.  The default is by derivatives in algebraic scenes, else
   by the octahedron.  Scenes with sheets have no choice: by derivatives. */
KrsNormals rendering_normals(const KrsRendering *rendering, KrsNormals normals);
/* Tells whether primary rays by this method go from root to root.  If so, secondary rays do, too. */
bool rendering_has_roots(const KrsRendering *rendering, KrsTrace trace);

#endif
