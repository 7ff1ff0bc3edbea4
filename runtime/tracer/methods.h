/*
 * methods.h: which method, schedule and grouping of components suit a scene on a device.
 */
#ifndef KRS_METHODS_H
#define KRS_METHODS_H

#include "runtime/tracer/handles.h"

/* Puts what `make bench` found fastest for such a scene on such a device where the default is
   asked for. */
void rendering_choose(const KrsRendering *rendering, KrsTrace *trace, KrsSchedule *schedule);
/* As many steps as are wanted of a lane in a dispatch, or as many as may be. */
uint32_t rendering_steps_within(const KrsRendering *rendering, uint32_t wanted);
/* The schedule for the rays of a group that is marched by itself. */
KrsSchedule rendering_schedule_of_march_group(const KrsRendering *rendering, KrsSchedule asked,
                                              uint32_t march_group);
/* Whether there is a kernel of MARCH_WITHOUT_PLANES. */
bool rendering_knows_planes(const KrsRendering *rendering);
/* Whether groups of components are marched one after the other, where that can be. */
bool rendering_marches_per_component(const KrsRendering *rendering, KrsComponents components);
/* Whether rays march by this method part by part, where that can be. */
bool rendering_marches_packed(const KrsRendering *rendering, KrsComponents components,
                              KrsTrace trace);
/* Whether rays go by what lies ahead of them (krs_along). */
bool rendering_goes_along(const KrsRendering *rendering, KrsTrace trace);
/* The normals that are meant: by derivatives where all is algebraic, else the octahedron's. */
KrsNormals rendering_normals(const KrsRendering *rendering, KrsNormals normals);
/* Whether primary rays by this method go from root to root.  Then so do secondary ones. */
bool rendering_has_roots(const KrsRendering *rendering, KrsTrace trace);

#endif
