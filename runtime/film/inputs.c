/*
 * inputs.c: what the caller gives for each pixel, on its way to the device.
 */
#include "runtime/film/inputs.h"

#include <math.h>

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

/* Copies the depths at which rays of a band end to the device, behind the listed rays. */
static void upload_limits(const Job *job, const KrsWindow *traced)
{
    const size_t  listed  = job->rays ? job->rendering->band.pixels : 0;
    ControlBlock *control = job->rendering->control.bytes;
    float *to = (float *)(rendering_listed_rays(job->rendering, job->view.light_count) + listed);
    control->limits = LIGHTS_AT + 2 * (uint32_t)listed +
                      LIGHT_ROWS * ((uint32_t)job->view.light_count + LIGHTS_AT_ONCE);
    for (uint32_t y = traced->y; y < traced->y + traced->height; y++)
        for (uint32_t x = traced->x; x < traced->x + traced->width; x++, to++) {
            *to = job->options.depth[(size_t)y * job->options.width + x];
            *to = isnan(*to) ? INFINITY : *to;
        }
}

size_t inputs_room(const Job *job)
{
    const size_t pixels = job->rendering->band.pixels,
                 in_ray = sizeof(ListedRayBlock) / sizeof(float);
    return (job->rays ? pixels : 0) + (job->options.depth ? (pixels + in_ray - 1) / in_ray : 0);
}

void inputs_upload(const Job *job, const KrsWindow *traced)
{
    if (job->rays)
        upload_rays(job, traced);
    if (job->options.depth)
        upload_limits(job, traced);
}
