/*
 * lane_rays.h: rays by lanes of the host (rays/rays.h), in the buffers of the device.
 */
#ifndef KRS_LANE_RAYS_H
#define KRS_LANE_RAYS_H

#include "rays/rays.h"
#include "runtime/tracer/job.h"

/* Returns why lanes cannot march the rays of a picture, in words of its author; NULL: they can. */
const char *lane_rays_refuse(const Job *job);
/* Tells whether lanes find normals as well, by the octahedron; else shaders do. */
bool lane_rays_find_normals(const Job *job);
/* Tells whether rays meet planes without a march. */
bool lane_rays_know_planes(const Job *job);
/* Pixels whose paths go on, by their slots. */
typedef struct LanePaths {
    const uint32_t *slots;
    uint32_t        count;
} LanePaths;

/* Marches the ray of each pixel of the band to its end, or those of paths. */
bool lane_rays_march(Job *job, RayField *field, const WorkBlock *work, const LanePaths *paths);

/* Marches so many rays that shaders have begun (LANE_... of blocks.h). */
bool lane_rays_march_secondary(Job *job, RayField *field, KrsPhase phase, uint32_t count,
                               const WorkBlock *work);

/* The results of a trial for all primary rays of a picture: milliseconds of one processor, and
   distances. */
typedef struct LaneTrial {
    double ms, evaluations;
} LaneTrial;

/* Marches small parts of the picture, for about so many milliseconds; false with the failure noted. */
bool lane_rays_try(Job *job, RayField *field, double budget_ms, LaneTrial *trial);

/* Returns the rows of the path of a pixel (PATH_... of blocks.h), which is counted in the band. */
const float (*lane_rays_path(const Job *job, const WorkBlock *work, const uint32_t pixel[2]))[4];
/* These find the pixel of a slot, and the slot of a pixel, which is counted in the band: as in
   hit_lists.glsl. */
void     lane_rays_pixel(const WorkBlock *work, uint32_t slot, uint32_t pixel[2]);
uint32_t lane_rays_slot(const WorkBlock *work, const uint32_t pixel[2]);
/* Returns the column of a number in the order in which quarters of quarters follow each other: its even bits.  The row is
   that of half of the number. */
uint32_t lane_rays_column(uint32_t number);

#endif
