/*
 * executor.c: who marches the rays of a film.
 *
 * Lanes of the host trace at once.  Shaders take less time for most scenes, but compilers take theirs first.  So small parts of a
 * picture are marched by lanes, and shaders are compiled only when lanes would take longer than compilers and shaders do,
 * the pictures before counted, those of other processes too.  So together they take at most twice as long as who would have
 * been the better choice.
 */
#include "runtime/film/executor.h"

#include <math.h>
#include <string.h>

#include "compiler/base/parallel.h"
#include "runtime/tracer/lane_fields.h"
#include "runtime/tracer/lane_rays.h"
#include "runtime/tracer/methods.h"
#include "runtime/tracer/rendering.h"
#include "runtime/tracer/shaders.h"

/* The time that small parts are marched, at about. */
#define TRIAL_MS 10
/* The times of rays to a light that casts shadows, and of those over the hemisphere, in parts of
   that of primary rays. */
#define SHADOW_RAYS    0.8
#define OCCLUSION_RAYS 3.0
/* Milliseconds of compilers for the shaders of a picture, for each byte of the scene's text, and for numbers that it reads from
   the parameter block, by the power of their count.  Measured on two cores with Mesa 22.3 for all examples with either
   --specialize, and for unions of 10 to 120 parts that differ. */
#define COMPILE_MS          210.0
#define COMPILE_MS_OF_BYTE  2.4e-3
#define COMPILE_MS_OF_SLOTS 0.27
#define POWER_OF_SLOTS      1.5
/* Those of drivers that load what caches have. */
#define LOAD_MS         20.0
#define LOAD_MS_OF_BYTE 6e-4
/* Multiplications and additions of shaders in a millisecond, with those that they skip. */
#define FLOPS_OF_MS 4e7

/* ---- What the cache has ---- */

static double load_loss(Gpu *gpu, CacheKey key)
{
    size_t length = 0;
    double loss   = 0;
    void  *bytes  = cache_load(&gpu->cache, CACHE_LOSS, key, &length);
    if (bytes && length == sizeof loss)
        memcpy(&loss, bytes, sizeof loss);
    gpu_release(gpu, bytes);
    return loss;
}

static void store_loss(Gpu *gpu, const LaneTimes *times)
{
    const double loss = times->lost_before + times->lost;
    if (times->keeps && times->lost > 0)
        cache_store(&gpu->cache, CACHE_LOSS, times->key, &loss, sizeof loss);
}

/* ---- Times ---- */

/* known: the cache has the shaders. */
static double compile_ms(const KrsProgram *program, bool known)
{
    const double bytes = (double)program->glsl_length;
    return known ? LOAD_MS + LOAD_MS_OF_BYTE * bytes
                 : COMPILE_MS + COMPILE_MS_OF_BYTE * bytes +
                       COMPILE_MS_OF_SLOTS * pow(program->value_slots, POWER_OF_SLOTS);
}

/* Measures what a sample takes, with the rays to lights; false with the failure noted. */
static bool try_lanes(Job *job, LaneTrial *trial)
{
    RayField *field = lane_fields_rays(job->rendering, job->state, lane_rays_know_planes(job));
    double    parts = 1 + (job->options.no_occlusion ? 0 : OCCLUSION_RAYS);
    for (size_t i = 0; i < job->view.light_count; i++)
        parts += job->view.lights[i].shadow ? SHADOW_RAYS : 0;
    if (!field || !lane_rays_try(job, field, TRIAL_MS, trial))
        return false;
    trial->ms *= parts / (double)parallel_parts();
    trial->evaluations *= parts;
    return true;
}

/* Measures what a sample of a pixel takes. */
static bool find_times(Job *job, LaneTimes *times)
{
    const double      pixels  = (double)job->options.width * job->options.height;
    const KrsProgram *program = job->rendering->program;
    CacheKey          key;
    LaneTrial         trial;
    if (!try_lanes(job, &trial))
        return false;
    const bool known = shaders_are_known(job->rendering, &key);
    *times           = (LaneTimes){.compile     = compile_ms(program, known),
                                   .known       = true,
                                   .keeps       = !known,
                                   .key         = key,
                                   .lost_before = known ? 0 : load_loss(job->gpu, key),
                                   .lanes       = trial.ms / pixels,
                                   .shaders     = trial.evaluations * program->flops / pixels / FLOPS_OF_MS};
    return true;
}

/* Tells whether lanes go on; false with *failed where memory has run out. */
static bool lanes_are_faster(Job *job, uint32_t samples, bool *failed)
{
    KrsRendering *r     = job->rendering;
    LaneTimes    *times = &r->lane_times;
    if (!times->known && !find_times(job, times)) {
        *failed = true;
        return false;
    }
    const double rays = (double)job->options.width * job->options.height * samples;
    times->lost += rays * (times->lanes - times->shaders);
    store_loss(job->gpu, times);
    return times->lost_before + times->lost <= times->compile;
}

/* Compiles what was left for later. */
static bool compile(KrsRendering *r)
{
    if (!r->deferred)
        return true;
    r->deferred = false;
    return shaders_create(r, r->purpose);
}

bool executor_choose(Job *job, uint32_t samples)
{
    KrsRendering *r        = job->rendering;
    KrsExecutor  *executor = &job->options.methods.executor;
    bool          failed   = false;
    if (*executor == KRS_EXECUTOR_DEFAULT) {
        const bool lanes = (r->deferred || r->purpose == KRS_FOR_LANES) && !lane_rays_refuse(job) &&
                           rendering_lanes_find_surfaces(r) &&
                           (!r->deferred || lanes_are_faster(job, samples, &failed));
        *executor = lanes ? KRS_EXECUTOR_LANES : KRS_EXECUTOR_KERNELS;
    }
    return !failed &&
           (*executor == KRS_EXECUTOR_LANES ? shaders_create(r, KRS_FOR_LANES) : compile(r));
}

bool executor_try_lanes(Job *job, double *lanes_ms, double *compiler_ms)
{
    LaneTrial   trial;
    const char *reason = lane_rays_refuse(job);
    if (!reason && !rendering_lanes_find_surfaces(job->rendering))
        reason = "a shader of the scene finds what they hit";
    if (reason)
        gpu_refuse(job->gpu, KRS_BAD_ARGUMENT, "lanes cannot draw this alone: %s", reason);
    if (reason || !try_lanes(job, &trial))
        return false;
    *lanes_ms = trial.ms;
    CacheKey key;
    *compiler_ms = job->rendering->deferred ? compile_ms(job->rendering->program,
                                                         shaders_are_known(job->rendering, &key))
                                            : 0;
    return true;
}
