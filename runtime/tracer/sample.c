/*
 * sample.c: the scene at points, as the device computes it.
 */
#include <string.h>

#include "runtime/tracer/renderer.h"

/* Points of one dispatch. */
#define BATCH 16384u
enum { GROUP = 64 };

static bool prepare(KrsRendering *rendering)
{
    Gpu *gpu = &rendering->renderer->gpu;
    if (!rendering->sample.pipeline &&
        !kernel_create(gpu, &rendering->sample,
                       &(KernelSource){"sample.comp", rendering->program->glsl, NULL},
                       rendering->renderer->layout, &rendering->spirv_ms, &rendering->pipeline_ms))
        return false;
    if (!rendering->points.buffer &&
        !buffer_create(gpu, &rendering->points, BATCH * sizeof(PointBlock), SHARED, "points"))
        return false;
    if (!rendering->answers.buffer &&
        !buffer_create(gpu, &rendering->answers, BATCH * sizeof(AnswerBlock), SHARED, "answers"))
        return false;
    rendering_bind(rendering, rendering->points_set, 0, &rendering->frame);
    rendering_bind(rendering, rendering->points_set, 1, &rendering->points);
    rendering_bind(rendering, rendering->points_set, 2, &rendering->answers);
    return true;
}

static void take_answer(const AnswerBlock *answer, float *distance, KrsSurfacePoint *surface)
{
    if (distance)
        *distance = answer->distance;
    if (!surface)
        return;
    *surface = (KrsSurfacePoint){
        .distance = answer->surface_distance,
        .roughness = answer->roughness,
        .metallic = answer->metallic,
        .component = answer->component,
        .level = answer->level,
        .instance = answer->instance,
    };
    memcpy(surface->color, answer->color, sizeof surface->color);
    memcpy(surface->emission, answer->emission, sizeof surface->emission);
}

static bool run_batch(KrsRendering *rendering, const float (*points)[3], uint32_t count)
{
    Gpu        *gpu = &rendering->renderer->gpu;
    PointBlock *to = rendering->points.bytes;
    double      ms = 0;
    for (uint32_t i = 0; i < count; i++)
        memcpy(to[i].point, points[i], sizeof points[i]);
    if (!gpu_begin(gpu))
        return false;
    rendering_dispatch(rendering, &rendering->sample, rendering->points_set, &count, sizeof count,
                       (count + GROUP - 1) / GROUP);
    return gpu_finish(gpu, &ms);
}

KrsStatus krs_sample(KrsRendering *rendering, KrsFrame *frame, const float (*points)[3],
                     size_t count, float *distances, KrsSurfacePoint *surfaces)
{
    renderer_clear(rendering->renderer);
    if (!prepare(rendering) || !rendering_set_parameters(rendering, frame))
        return rendering->renderer->gpu.status;
    for (size_t first = 0; first < count; first += BATCH) {
        uint32_t batch = count - first < BATCH ? (uint32_t)(count - first) : BATCH;
        if (!run_batch(rendering, points + first, batch))
            return rendering->renderer->gpu.status;
        const AnswerBlock *answers = rendering->answers.bytes;
        for (uint32_t i = 0; i < batch; i++)
            take_answer(&answers[i], distances ? &distances[first + i] : NULL,
                        surfaces ? &surfaces[first + i] : NULL);
    }
    return KRS_OK;
}
