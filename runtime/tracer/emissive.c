/*
 * emissive.c: chooses where what emits light is looked for, and how finely.
 */
#include "runtime/tracer/emissive.h"

#include <assert.h>
#include <math.h>

static_assert((int)MAX_EMISSIVE == (int)KRS_MAX_EMISSIVE, "the same number of balls");

/* Light is looked for so far from the eye, in parts of the distance of the target, where the scene
   has no end. */
#define REACH 16.0
/* Balls are not divided that are smaller than this, in parts of that distance. */
#define MIN_RADIUS 0.08

/* Returns a distance in the scene, as the camera sees it. */
static double find_scale(const KrsCamera *camera)
{
    double square = 0;
    for (int k = 0; k < 3; k++)
        square += (camera->target[k] - camera->eye[k]) * (camera->target[k] - camera->eye[k]);
    return sqrt(square);
}

static void find_region(const KrsProgram *program, const KrsCamera *camera, double low[3],
                        double high[3])
{
    const double reach = REACH * find_scale(camera);
    for (int k = 0; k < 3; k++) {
        const bool ends = isfinite(program->rest_low[k]) && isfinite(program->rest_high[k]);
        low[k]          = ends ? program->rest_low[k] : camera->eye[k] - reach;
        high[k]         = ends ? program->rest_high[k] : camera->eye[k] + reach;
    }
}

uint32_t emissive_find(const KrsProgram *program, const KrsCamera *camera, KrsState *state,
                       const double rebase_origin[3], EmissiveBlock balls[MAX_EMISSIVE])
{
    KrsEmissive  found[KRS_MAX_EMISSIVE];
    double       low[3], high[3];
    const double least = MIN_RADIUS * find_scale(camera);
    find_region(program, camera, low, high);
    const size_t count = krs_state_emissive(state, low, high, least, found);
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++)
            balls[i].middle[k] = (float)(found[i].middle[k] - rebase_origin[k]);
        balls[i].radius   = (float)(1.0001 * found[i].radius);
        balls[i].radiance = (float)found[i].radiance;
    }
    return (uint32_t)count;
}
