/*
 * lane_cameras.h: rays of a camera by the host, and random points of pixels, as shaders have them (rays.glsl,
 * samples.glsl).
 */
#ifndef KRS_LANE_CAMERAS_H
#define KRS_LANE_CAMERAS_H

#include "runtime/tracer/job.h"

/* The rays of a dispatch: one of each pixel. */
typedef struct CameraRays {
    const FrameBlock *frame;
    KrsProjection     projection;
    float             offset[2];      /* of rays in their pixels */
    uint32_t          number, seed;   /* of each ray in its pixel; of random points */
    bool              through_middle; /* of the lens */
} CameraRays;

/* At t a pixel is width + spread t wide. */
typedef struct CameraRay {
    float origin[3], direction[3], width, spread;
} CameraRay;

/* Returns the rays that the control block tells of. */
CameraRays camera_rays(const Job *job, const WorkBlock *work);
/* Finds the ray of a pixel, which is counted in the picture. */
CameraRay camera_ray(const CameraRays *rays, const uint32_t pixel[2]);

/* Samples the unit square for a ray of a pixel, for use 0: the hemisphere. */
void sample_hemisphere(const uint32_t pixel[2], uint32_t ray, uint32_t seed, float square[2]);

#endif
