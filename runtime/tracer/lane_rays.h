/*
 * lane_rays.h: rays by lanes of the host (rays/rays.h), in the buffers of the device.
 */
#ifndef KRS_LANE_RAYS_H
#define KRS_LANE_RAYS_H

#include "rays/rays.h"
#include "runtime/tracer/job.h"

/* Whether lanes know these rays: on a device that is the host, of a camera whose rays need no sine and no lens. */
bool lane_rays_suit(const Job *job);
/* Whether they find normals as well, by the octahedron; else shaders do. */
bool lane_rays_find_normals(const Job *job);
/* Whether they meet planes without a march. */
bool lane_rays_know_planes(const Job *job);
/* Marches the ray of each pixel of the band to its end. */
bool lane_rays_march(Job *job, RayField *field, const WorkBlock *work);

/* Marches so many rays that shaders have begun (LANE_... of blocks.h). */
bool lane_rays_march_secondary(Job *job, RayField *field, KrsPhase phase, uint32_t count,
                               const WorkBlock *work);

#endif
