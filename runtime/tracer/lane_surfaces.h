/*
 * lane_surfaces.h: surfaces of hits by lanes of the host (rays/surfaces.h), in the buffers of the device: for shaders
 * that do not contain the scene.
 */
#ifndef KRS_LANE_SURFACES_H
#define KRS_LANE_SURFACES_H

#include "rays/surfaces.h"
#include "runtime/tracer/job.h"
#include "runtime/tracer/lane_rays.h"

/* Returns the number of rows of a surface. */
uint32_t lane_surfaces_rows(const KrsRendering *rendering);
/* Returns the surfaces of a state, which belong to the rendering; NULL with the failure noted. */
SurfaceField *lane_surfaces_field(Job *job);
/* Stores the surface of each hit of the band, or of those of paths. */
bool lane_surfaces_find(Job *job, const SurfaceField *field, const WorkBlock *work,
                        const LanePaths *paths);
/* Stores the luminance of what rays over the hemisphere have met, as occluders.comp does.  The list of their slots begins
   at `list` in the queue. */
bool lane_surfaces_find_occluders(Job *job, const SurfaceField *field, uint32_t list,
                                  const WorkBlock *work);

#endif
