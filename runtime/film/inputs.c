/*
 * inputs.c: what the caller gives for each pixel, on its way to the device.
 */
#include "runtime/film/inputs.h"

#include <math.h>

#include "runtime/film/plate.h"
#include "runtime/film/plate_map.h"
#include "runtime/film/volumes.h"
#include "runtime/tracer/rendering.h"

/* Copies the listed rays of a band to the device, behind the lights. */
static void upload_rays(const Job *job, const KrsWindow *traced)
{
    const KrsRays  *rays = job->rays;
    ListedRayBlock *to   = rendering_listed_rays(job->rendering, job->view.light_count);
    for (uint32_t y = traced->y; y < traced->y + traced->height; y++)
        for (uint32_t x = traced->x; x < traced->x + traced->width; x++, to++) {
            const size_t  pixel     = (size_t)y * job->options.width + x;
            const double *direction = rays->directions[pixel];
            const double  length    = hypot(hypot(direction[0], direction[1]), direction[2]);
            for (int i = 0; i < 3; i++) {
                to->origin[i]    = (float)(rays->origins[pixel][i] - job->rebase_origin[i]);
                to->direction[i] = (float)(direction[i] / length);
            }
            to->width  = (float)rays->width;
            to->spread = (float)rays->spread;
        }
}

/* Depths have the room of so many rays of a list. */
static size_t rays_of_limits(const Job *job)
{
    const size_t in_ray = sizeof(ListedRayBlock) / sizeof(float);
    return (job->rendering->band.pixels + in_ray - 1) / in_ray;
}

/* The planes of a plate in the pixels of a band have such room likewise, and its map. */
static size_t rays_of_planes(const Job *job)
{
    return job->rendering->catches ? (job->rendering->band.pixels + 1) / 2 : 0;
}

static size_t rays_of_map(const Job *job)
{
    return plate_map_exists(job) ? (plate_map_rows(job) + 1) / 2 : 0;
}

/* Two rows are as large as a ray. */
static size_t rays_of_volumes(const Job *job) { return (volumes_rows(job) + 1) / 2; }

static size_t rays_of_photons(const Job *job)
{
    return job->options.caustics == KRS_CAUSTICS_PHOTONS ? (PHOTON_INPUT_ROWS + 1) / 2 : 0;
}

/* Copies the depths at which rays of a band end to the device, behind the listed rays, and the planes
   of a plate behind them.  The map of the plate is there already. */
static void upload_limits(const Job *job, const KrsWindow *traced)
{
    const size_t    listed  = job->rays ? job->rendering->band.pixels : 0;
    ControlBlock   *control = job->rendering->control.bytes;
    ListedRayBlock *limits  = rendering_listed_rays(job->rendering, job->view.light_count) + listed;
    float          *to      = (float *)limits;
    control->limits         = LIGHTS_AT + 2 * (uint32_t)listed +
                      LIGHT_ROWS * ((uint32_t)job->view.light_count + LIGHTS_AT_ONCE);
    control->plate_planes = control->limits + 2 * (uint32_t)rays_of_limits(job);
    if (job->rendering->catches)
        plate_find_planes(job, traced, (float(*)[4])(limits + rays_of_limits(job)));
    if (plate_map_exists(job))
        control->plate_map = control->plate_planes + 2 * (uint32_t)rays_of_planes(job);
    for (uint32_t y = traced->y; y < traced->y + traced->height; y++)
        for (uint32_t x = traced->x; x < traced->x + traced->width; x++, to++) {
            *to = job->options.depth[(size_t)y * job->options.width + x];
            *to = isnan(*to) ? INFINITY : *to;
        }
}

size_t inputs_room(const Job *job)
{
    const size_t pixels = job->rendering->band.pixels;
    return (job->rays ? pixels : 0) + (job->options.depth ? rays_of_limits(job) : 0) +
           rays_of_planes(job) + rays_of_map(job) + rays_of_volumes(job) + rays_of_photons(job);
}

void inputs_upload_tables(Job *job)
{
    const size_t    of_photons = inputs_room(job) - rays_of_photons(job);
    const size_t    of_volumes = of_photons - rays_of_volumes(job);
    const size_t    of_map     = of_volumes - rays_of_map(job);
    ListedRayBlock *rays       = rendering_listed_rays(job->rendering, job->view.light_count);
    FrameBlock     *frame      = job->rendering->frame.bytes;
    if (plate_map_exists(job))
        plate_map_make(job, (uint32_t(*)[4])(rays + of_map));
    job->photons_at = LIGHTS_AT + 2 * (uint32_t)of_photons +
                      LIGHT_ROWS * ((uint32_t)job->view.light_count + LIGHTS_AT_ONCE);
    if (volumes_rows(job) == 0)
        return;
    volumes_copy(job, (uint32_t(*)[4])(rays + of_volumes));
    frame->volumes_at = LIGHTS_AT + 2 * (uint32_t)of_volumes +
                        LIGHT_ROWS * ((uint32_t)job->view.light_count + LIGHTS_AT_ONCE);
}

void inputs_upload(const Job *job, const KrsWindow *traced)
{
    if (job->rays)
        upload_rays(job, traced);
    if (job->options.depth)
        upload_limits(job, traced);
}
