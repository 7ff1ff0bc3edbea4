/*
 * origin.c: whether points on the device are relative to an origin near the eye, and to which.
 *
 * Rounding is visible where surfaces are far from the origin of the scene and near to the eye
 * (compiler/passes/precision.c).  The distance at the eye tells how near they may be.  Where that is too near,
 * rays through a grid over the picture tell what is seen: the ground below a camera that looks
 * ahead is not.
 */
#include "runtime/tracer/origin.h"

#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "runtime/tracer/slots.h"
#include "runtime/tracer/view.h"

enum { GRID = 8, RAYS = GRID * GRID };

/* Rays end at this part of a pixel from the surface, which is near enough to tell how far it is. */
static const double PART_OF_PIXEL = 0.25;

/* A part of what is seen may be blurred by up to MAX_BLUR.  So may all of it, where coordinates are not
   MUCH_GAIN times as large as camera-relative ones. */
static const double MAX_BLUR = 2, MUCH_GAIN = 6;

/* The part that is seen from the eye, or a bound on it. */
typedef struct Sight {
    double eye;     /* its largest coordinate */
    double nearest; /* the distance of the nearest surface */
    double pixel;   /* the width of a pixel there */
    size_t count;   /* of hits; 0: nothing is hit, or there are no rays through a grid */
    KrsHit hits[RAYS];
} Sight;

static double pixel_at(const Viewer *viewer, double distance)
{
    return view_width(viewer->camera, viewer->rays, viewer->height, distance);
}

static void look(const Viewer *viewer, KrsState *state, Sight *sight)
{
    double origins[RAYS][3], directions[RAYS][3];
    for (int i = 0; i < RAYS; i++) {
        const double place[2] = {(2 * (i % GRID) + 1.0) / GRID - 1,
                                 (2 * (i / GRID) + 1.0) / GRID - 1};
        if (viewer->rays || !view_ray(viewer->camera, viewer->width, viewer->height, place,
                                      origins[i], directions[i]))
            return;
    }
    if (krs_raycast(state, (const double(*)[3])origins, (const double(*)[3])directions, RAYS,
                    HUGE_VAL, PART_OF_PIXEL * sight->pixel, sight->hits) != KRS_OK)
        return;
    for (int i = 0; i < RAYS; i++)
        if (sight->hits[i].hit)
            sight->hits[sight->count++] = sight->hits[i];
}

static bool blurs(const Viewer *viewer, double coordinate, double distance, double gain,
                  double blur)
{
    const double pixel = pixel_at(viewer, distance);
    return coordinate > gain * krs_seen_reach(distance, pixel, viewer->height) &&
           krs_normal_blur(coordinate, pixel) > blur;
}

/* Tells whether normals are blurred too much somewhere, or most of them are. */
static bool blurs_normals(const Viewer *viewer, const Sight *sight)
{
    size_t blurred = 0;
    for (size_t i = 0; i < sight->count; i++) {
        const double coordinate = largest3(sight->hits[i].point), t = sight->hits[i].t;
        if (blurs(viewer, coordinate, t, KRS_MIN_GAIN, MAX_BLUR))
            return true;
        blurred += blurs(viewer, coordinate, t, MUCH_GAIN, KRS_MIN_BLUR);
    }
    return sight->count > 0 ? 2 * blurred > sight->count
                            : blurs(viewer, sight->eye - sight->nearest, sight->nearest, MUCH_GAIN,
                                    KRS_MIN_BLUR);
}

/* Returns the nearest point that is seen; the eye, where nothing is. */
static const double *nearest_point(const Sight *sight, const double eye[3])
{
    const KrsHit *nearest = NULL;
    for (size_t i = 0; i < sight->count; i++)
        nearest = nearest && nearest->t <= sight->hits[i].t ? nearest : &sight->hits[i];
    return nearest ? nearest->point : eye;
}

void origin_choose(const KrsRendering *rendering, KrsState *state, const Viewer *viewer,
                   double origin[3])
{
    const double(*eye)[3] = (const double(*)[3]) & viewer->camera->eye;
    Sight sight           = {.eye = largest3(*eye)};
    memset(origin, 0, 3 * sizeof *origin);
    if (!rendering_rebases(rendering))
        return;
    if (krs_distance(state, eye, 1, &sight.nearest) != KRS_OK)
        sight.nearest = 0;
    sight.nearest = fabs(sight.nearest);
    sight.pixel   = pixel_at(viewer, sight.nearest);
    bool moves    = krs_needs_rebase(sight.eye, sight.pixel);
    bool differs  = !rendering->program->algebraic; /* else normals are by derivatives */
    if (!moves &&
        !(differs && krs_may_blur_normals(sight.eye, sight.nearest, sight.pixel, viewer->height)))
        return;
    look(viewer, state, &sight);
    if (moves || (differs && blurs_normals(viewer, &sight)))
        memcpy(origin, nearest_point(&sight, *eye), 3 * sizeof *origin);
}
