/*
 * noise.c: runs noise.comp while samples are added.
 */
#include "runtime/film/noise.h"

#include <math.h>

#include "runtime/film/doublings.h"
#include "runtime/film/picture.h"
#include "runtime/tracer/dispatch.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/rendering.h"

static_assert((int)MIN_NOISE_SAMPLES == KRS_MIN_NOISY_SAMPLES, "noise.comp");

bool noise_is_wanted(const KrsRenderOptions *options)
{
    return options->noise > 0 || options->aovs & KRS_AOV_NOISE;
}

/* Runs a phase of the shader over all quarters of tiles of the band. */
static bool run_phase(Job *job, const WorkBlock *work, uint32_t phase, uint32_t samples)
{
    KrsRendering *r       = job->rendering;
    ControlBlock *control = r->control.bytes;
    const Shader *shader  = renderer_noise(r->renderer, &r->spirv_ms, &r->pipeline_ms);
    if (!shader || !gpu_wait(job->gpu))
        return false;
    const uint32_t sampled_at = control->sampled_at;
    job->progress_share       = 0;
    control->phase            = phase;
    control->value            = samples;
    control->sampled_at       = r->band.sampled_at;
    const Dispatch dispatch   = dispatch_of(job, KRS_PHASE_RESOLVE, shader, work,
                                            ITEMS_KNOWN(tiles_of_band(work) * QUARTERS_OF_TILE),
                                            pixel_budget(job));
    const bool     good       = dispatch_run(job, &dispatch) && dispatch_finish(job);
    control->sampled_at       = sampled_at;
    return good;
}

/* Lists the pixels that go on, by `phase`, and those whose rays they need. */
static bool list_pixels(Job *job, const Plan *plan, const WorkBlock *work, uint32_t phase,
                        uint32_t samples, bool *unfinished)
{
    KrsRendering *r       = job->rendering;
    ControlBlock *control = r->control.bytes;
    control->sampled      = 0;
    if (!run_phase(job, work, phase, samples) ||
        (plan->halo > 0 && !run_phase(job, work, NOISE_SPREADS, samples)))
        return false;
    *unfinished         = control->sampled > 0;
    control->sampled_at = r->band.sampled_at;
    if (plan->halo > 0)
        control->sampled_at += tiles_of_band(work) * QUARTERS_OF_TILE;
    return true;
}

/* Sets the bound of errors; samples never end by a bound of -1. */
static void set_bound(Job *job)
{
    ControlBlock *control = job->rendering->control.bytes;
    control->noise        = job->options.noise > 0 ? (float)job->options.noise : -1;
    control->noise_floor  = (float)job->options.noise_floor;
}

bool noise_resume(Job *job, const Plan *plan, const WorkBlock *work, uint32_t samples,
                  bool *unfinished)
{
    set_bound(job);
    return samples < MIN_NOISE_SAMPLES || job->options.noise == 0 ||
           list_pixels(job, plan, work, NOISE_LISTS, samples, unfinished);
}

bool noise_take(Job *job, const Plan *plan, const WorkBlock *work, uint32_t samples,
                bool *unfinished)
{
    if (samples < FIRST_NOISE_SAMPLES || !is_power_of_two(samples))
        return true;
    if (job->options.noise == 0 && samples > SAMPLES_OF_BLOCK)
        return true; /* sample_blocks.c and doublings.c do it */
    if (samples == FIRST_NOISE_SAMPLES)
        return run_phase(job, work, NOISE_BEGINS, samples);
    return list_pixels(job, plan, work, NOISE_ENDS_SAMPLES, samples, unfinished);
}

bool noise_restore(Job *job, const WorkBlock *work, uint32_t samples)
{
    return samples < MIN_NOISE_SAMPLES || job->options.noise == 0 ||
           run_phase(job, work, NOISE_RESTORES, samples);
}

/* Returns the number of samples at which errors were estimated last; 0: never. */
static uint32_t last_estimate(uint32_t samples)
{
    uint32_t at = 2 * FIRST_NOISE_SAMPLES;
    while (at <= samples / 2)
        at *= 2;
    return at <= samples ? at : 0;
}

float noise_since(uint32_t samples)
{
    return sqrtf((float)last_estimate(samples) / (float)samples);
}

void noise_finish(KrsPicture *picture)
{
    const size_t pixels = picture_pixels(picture);
    const float  since  = noise_since(picture->samples);
    for (size_t k = 0; picture->noise && k < pixels; k++)
        if (picture->pixel_samples[k] == 0) {
            picture->pixel_samples[k] = picture->samples;
            picture->noise[k]         = since > 0 ? since * picture->noise[k] : INFINITY;
        }
}
