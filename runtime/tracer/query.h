/*
 * query.h: points and rays that a program asks about.
 */
#ifndef KRS_QUERY_H
#define KRS_QUERY_H

#include "runtime/tracer/handles.h"

/* ---- point_query.c ---- */
enum { POINTS_AT_ONCE = 16384 };
/* Makes room for that many points, and their answers. */
bool point_query_prepare(KrsRendering *rendering);
/* The material and surface at a point, as shaders compute them: the members of KrsHit that surface.def has, and these. */
typedef struct SurfacePoint {
    float distance;  /* as the function of the surface computes it */
    float normal[3]; /* for lighting */
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) uint32_t name;
#include "krs/surface.def"
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    float name KRS_NUMBERS_##type;
#include "krs/surface.def"
} SurfacePoint;
/* Finds distances as krs_device_distance does, and what is at the points; either may be NULL.
   Where the distance is constant around a point the normal by differences is 0, and what is there
   is that of some part. */
KrsStatus point_query_sample(KrsRendering *rendering, KrsState *state, const float (*points)[3],
                             size_t count, float *distances, SurfacePoint *surfaces);
/* Tells how large what is asked about is: the longest side of the box around all but planes; 1 where that has
   no end. */
double point_query_size(const KrsRendering *rendering);
/* Finds what is at the first `count` of them, with normals by differences over a thousandth of the
   coordinates and this step; 0: the distance alone. */
bool point_query_run(KrsRendering *rendering, uint32_t count, double step);
#define POINT_QUERY_STEP 1e-4

/* ---- query.c ---- */
/* Tells whether what the device says of `count` rays can be used: each has missed, or has its own place
   among the `ends` of rays. */
bool ray_hits_are_valid(const RayHitBlock *ray_hits, uint32_t count, uint32_t ends);

#endif
