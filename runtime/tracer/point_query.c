/*
 * point_query.c: the scene at points, as the device computes it.
 */
#include "runtime/tracer/query.h"

#include <math.h>
#include <string.h>

#include "runtime/shared/answers.h"
#include "runtime/tracer/shaders.h"
#include "runtime/tracer/layouts.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/rendering.h"

enum { WORKGROUP_SIZE = 64 };

bool point_query_prepare(KrsRendering *rendering)
{
    Gpu *gpu = &rendering->renderer->gpu;
    if (!rendering->points.buffer &&
        !buffer_create(gpu, &rendering->points, POINTS_AT_ONCE * sizeof(PointBlock), SHARED,
                       "points"))
        return false;
    if (!rendering->answers.buffer &&
        !buffer_create(gpu, &rendering->answers, POINTS_AT_ONCE * sizeof(AnswerBlock), SHARED,
                       "answers"))
        return false;
    rendering_bind_frame(rendering, rendering->points_set);
    rendering_bind(rendering, rendering->points_set, POINTS_BINDING, &rendering->points);
    rendering_bind(rendering, rendering->points_set, ANSWERS_BINDING, &rendering->answers);
    return true;
}

static void take_answer(const AnswerBlock *answer, float *distance, SurfacePoint *surface)
{
    if (distance)
        *distance = answer->distance;
    if (!surface)
        return;
    surface->distance = answer->surface_distance;
    memcpy(surface->normal, answer->normal, sizeof surface->normal);
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) surface->name = answer->name[0];
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    memcpy(&surface->name, answer->name, sizeof surface->name);
#include "krs/surface.def"
}

double point_query_size(const KrsRendering *rendering)
{
    const KrsProgram *program = rendering->program;
    double            size    = 0;
    for (int k = 0; k < 3; k++)
        size = fmax(size, program->rest_high[k] - program->rest_low[k]);
    return size > 0 && isfinite(size) ? size : 1;
}

bool point_query_run(KrsRendering *rendering, uint32_t count, double step)
{
    const PointWorkBlock work = {.count = count, .taps = step > 0 ? 7 : 1, .min_step = (float)step};
    Gpu                 *gpu  = &rendering->renderer->gpu;
    Shader              *shader = rendering_point_query(rendering);
    double               ms     = 0;
    if (!shader || !gpu_begin(gpu))
        return false;
    rendering_dispatch(rendering, shader, rendering->points_set, &work, sizeof work,
                       (count + WORKGROUP_SIZE - 1) / WORKGROUP_SIZE);
    return gpu_finish(gpu, &ms);
}

KrsStatus point_query_sample(KrsRendering *rendering, KrsState *state, const float (*points)[3],
                             size_t count, float *distances, SurfacePoint *surfaces)
{
    if (!rendering_ready(rendering->renderer))
        return rendering->renderer->gpu.status;
    if (!points && count > 0) {
        gpu_refuse(&rendering->renderer->gpu, KRS_BAD_ARGUMENT, "there are no points");
        return KRS_BAD_ARGUMENT;
    }
    if (!point_query_prepare(rendering) || !rendering_set_parameters(rendering, state, NULL))
        return rendering->renderer->gpu.status;
    for (size_t first = 0; first < count; first += POINTS_AT_ONCE) {
        size_t      left  = count - first;
        uint32_t    batch = left < POINTS_AT_ONCE ? (uint32_t)left : POINTS_AT_ONCE;
        PointBlock *to    = rendering->points.bytes;
        for (uint32_t i = 0; i < batch; i++) {
            to[i] = (PointBlock){0};
            memcpy(to[i].point, points[first + i], sizeof points[0]);
        }
        if (!point_query_run(rendering, batch, surfaces ? POINT_QUERY_STEP : 0))
            return rendering->renderer->gpu.status;
        const AnswerBlock *answers = rendering->answers.bytes;
        for (uint32_t i = 0; i < batch; i++)
            take_answer(&answers[i], distances ? &distances[first + i] : NULL,
                        surfaces ? &surfaces[first + i] : NULL);
    }
    return KRS_OK;
}

/* Tells whether single precision can square the points. */
static bool are_in_reach(const float (*points)[3], size_t count)
{
    for (size_t i = 0; points && i < count; i++)
        for (int k = 0; k < 3; k++)
            if (!(fabsf(points[i][k]) <= (float)KRS_MAX_COORDINATE))
                return false;
    return true;
}

KrsStatus krs_device_distance(KrsRendering *rendering, KrsState *state, const float (*points)[3],
                              size_t count, float *distances)
{
    if (!are_in_reach(points, count)) {
        renderer_clear(rendering->renderer);
        gpu_refuse(&rendering->renderer->gpu, KRS_BAD_ARGUMENT,
                   "points have finite coordinates below 1e18");
        return KRS_BAD_ARGUMENT;
    }
    return point_query_sample(rendering, state, points, count, distances, NULL);
}
