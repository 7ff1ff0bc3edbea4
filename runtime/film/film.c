/*
 * film.c: films: pictures that samples are added to.
 *
 * A picture is rendered in bands of rows, whose buffers are of modest size (band.c).  A film keeps
 * the sums of its samples in host memory, except those of one band.  That band stays in the buffers
 * until the film is read, or until the buffers are needed for another band.  So a picture of one
 * band goes from the device to the host only when it is read.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "runtime/tracer/band.h"
#include "runtime/integrators/integrators.h"
#include "runtime/film/sample_blocks.h"
#include "runtime/film/executor.h"
#include "runtime/film/resident.h"
#include "runtime/film/inputs.h"
#include "runtime/film/lights.h"
#include "runtime/film/mattes.h"
#include "runtime/film/noise.h"
#include "runtime/film/picture.h"
#include "runtime/film/plate.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/rendering.h"
#include "runtime/film/settings.h"
#include "runtime/film/volumes.h"
#include "runtime/tracer/view.h"

static IntegratorPlan *const integrators[KRS_INTEGRATOR_COUNT] = {
    NULL, /* the default is replaced before (settings.c) */
#define KRS_INTEGRATOR(id, name, about) name##_plan,
#include "krs/choices.def"
};

/* ---- films ---- */

/* Returns the rows of tiles of a film. */
static uint32_t tile_rows(const KrsFilm *film)
{
    return (resident_cover(&film->options).height + TILE - 1) / TILE;
}

/* Makes room for the sums of all samples; false with the failure noted. */
static bool make_sums(KrsFilm *film)
{
    Gpu                    *gpu   = &film->rendering->renderer->gpu;
    const KrsRenderOptions *o     = &film->options;
    const bool              noise = noise_is_wanted(o);
    const uint32_t          aovs  = o->aovs | KRS_AOV_COLOR | (noise ? KRS_AOV_NOISE : 0);
    film->sums                    = picture_new(gpu, o->width, o->height, o->crop, aovs);
    if (!film->sums || (o->mattes && !mattes_new(gpu, film->sums)))
        return false;
    if (noise)
        film->kept = gpu_alloc(gpu, resident_kept(o), sizeof *film->kept, "make a film");
    film->more = gpu_alloc(gpu, tile_rows(film), sizeof *film->more, "make a film");
    return film->more && (film->kept || !noise) && lights_make(film);
}

KrsStatus krs_film_new(KrsRendering *rendering, const KrsRenderOptions *options, KrsFilm **out)
{
    Gpu *gpu = &rendering->renderer->gpu;
    *out     = NULL;
    renderer_clear(rendering->renderer);
    KrsFilm *film = gpu_alloc(gpu, 1, sizeof *film, "make a film");
    if (!film)
        return gpu->status;
    film->rendering = rendering;
    film->updates   = rendering->updates;
    if (options)
        film->asked = film->options = *options;
    KrsRenderOptions *o = &film->options;
    if (!settings_complete(rendering, o, &film->asked_schedule) || !make_sums(film)) {
        krs_picture_free(film->sums);
        gpu_release(gpu, film->kept);
        gpu_release(gpu, film->more);
        gpu_release(gpu, film);
        return gpu->status;
    }
    *out = film;
    return KRS_OK;
}

/* Drops the band of a film that the buffers hold, if any. */
static void release_band(KrsFilm *film)
{
    if (film->rendering->resident.film == film)
        film->rendering->resident = (ResidentBand){0};
}

void krs_film_free(KrsFilm *film)
{
    if (!film)
        return;
    release_band(film);
    krs_picture_free(film->sums);
    blocks_free(film);
    gpu_release(&film->rendering->renderer->gpu, film->kept);
    gpu_release(&film->rendering->renderer->gpu, film->more);
    gpu_release(&film->rendering->renderer->gpu, film->lights);
    gpu_release(&film->rendering->renderer->gpu, film);
}

void krs_film_clear(KrsFilm *film)
{
    const uint64_t bytes = film->sums->stats.peak_memory_bytes;
    release_band(film);
    film->samples = film->first;
    memset(film->more, 0, tile_rows(film) * sizeof *film->more);
    blocks_clear(film);
    mattes_clear(film->sums);
    film->sums->stats = (KrsRenderStats){.peak_memory_bytes = bytes};
}

uint32_t krs_film_samples(const KrsFilm *film)
{
    return film->updates == film->rendering->updates ? film->samples : 0;
}

/* Forgets the samples of a scene that the rendering no longer has, and completes the options for the
   present one.  The picture stays as large as it was. */
static bool follow_rendering(KrsFilm *film)
{
    KrsRenderOptions options = film->asked;
    if (film->updates == film->rendering->updates)
        return true;
    options.width  = film->options.width;
    options.height = film->options.height;
    if (!settings_complete(film->rendering, &options, &film->asked_schedule))
        return false;
    krs_film_clear(film);
    film->options = options;
    film->updates = film->rendering->updates;
    return lights_make(film);
}

/* ---- samples ---- */

/* Returns a window with a halo around it, cut off at the edges of the picture. */
static KrsWindow with_halo(const Job *job, uint32_t halo, KrsWindow window)
{
    const uint32_t right = window.x + window.width + halo, bottom = window.y + window.height + halo;
    window.x      = window.x > halo ? window.x - halo : 0;
    window.y      = window.y > halo ? window.y - halo : 0;
    window.width  = (right < job->options.width ? right : job->options.width) - window.x;
    window.height = (bottom < job->options.height ? bottom : job->options.height) - window.y;
    return window;
}

/* Adds the counters of the shaders to the statistics, and resets them. */
static void take_counters(Job *job)
{
    ControlBlock   *control = job->rendering->control.bytes;
    KrsRenderStats *stats   = job->stats;
    stats->unresolved += control->unresolved;
    stats->clamped += control->clamped;
    stats->evaluations += control->evaluations;
    if (control->max_evaluations > stats->max_evaluations_per_ray)
        stats->max_evaluations_per_ray = control->max_evaluations;
    control->unresolved = control->evaluations = control->max_evaluations = 0;
    control->clamped                                                      = 0;
}

/* Tells whether the first ray of each pixel, which goes through the middle of the lens, is not among the
   samples.  With a few hundred of them it would be seen: as a sharp picture in the blurred one. */
static bool spares_first(const Job *job)
{
    return !job->rays && job->view.camera.aperture > 0 && job->options.samples > 1;
}

/* Finds the AOVs other than colour by that ray. */
static bool find_aovs(Job *job, const Plan *plan, WorkBlock *work)
{
    if (job->first_rows == 1u << ROW_COLORS)
        return true;
    job->progress_share = 0;
    if (!plan_run(job, plan, work, 0))
        return false;
    take_counters(job);
    return resident_clear(job->rendering, 1u << ROW_COLORS);
}

/* The AOVs of the first ray are copied to the film before others write to their rows. */
static bool keep_aovs(KrsRendering *rendering)
{
    if (rendering->resident.has_aovs && !resident_store(rendering))
        return false;
    rendering->resident.has_colors = true;
    return true;
}

/* Tells whether a film cannot go on from what the host has: rays that mattes have counted meanwhile are not taken back where
   samples end by noise. */
static bool begins_anew(const KrsFilm *film) { return film->options.mattes && film->kept; }

/* Samples that take longer are copied to the host in between: no more is lost with the device. */
#define MS_AT_RISK 1000

/* Tells whether what is on the device is to be copied, `begun` at which time more was added.  Rays that mattes count are
   copied one by one; but where their samples end by noise, together. */
static bool is_due(const KrsFilm *film, double begun)
{
    if (film->options.mattes)
        return !begins_anew(film);
    return clock_ms() - begun > MS_AT_RISK;
}

/* Traces ray `index` of each pixel, and adds it to what the buffers hold. */
static bool add_ray(Job *job, const Plan *plan, WorkBlock *work, uint32_t index)
{
    KrsRendering *rendering = job->rendering;
    const bool    mattes    = job->options.mattes;
    if (mattes && index > 0 && !keep_aovs(rendering))
        return false;
    if ((mattes && !resident_clear(rendering, MATTE_ROWS)) || !plan_run(job, plan, work, index))
        return false;
    take_counters(job);
    return !mattes || resident_take_mattes(rendering);
}

/* Adds samples to the band that the buffers hold, *samples at most, and tells how many; `share` is its fraction of all
   progress. */
static bool add_to_band(Job *job, const Plan *plan, const KrsFilm *film, uint32_t *samples,
                        double share)
{
    const uint32_t   had     = resident_samples(film, job->rendering->resident.from);
    const double     begun   = clock_ms();
    uint32_t         added   = 0;
    const KrsWindow *traced  = &job->rendering->resident.traced;
    const double     done    = job->progress_done;
    ControlBlock    *control = job->rendering->control.bytes;
    WorkBlock        work    = {
                  .corner = {traced->x, traced->y},
                  .extent = {traced->width, traced->height},
    };
    *control = (ControlBlock){
        .projection    = job->rays ? LISTED : (uint32_t)job->view.camera.projection,
        .lights        = (uint32_t)job->view.light_count,
        .separate      = film->options.light_groups,
        .seed          = (uint32_t)(job->options.seed ^ job->options.seed >> 32),
        .no_occlusion  = job->options.no_occlusion,
        .no_background = job->options.plate != NULL,
        .max_radiance = job->options.max_radiance > 0 ? (float)job->options.max_radiance : INFINITY,
    };
    plate_tell(film, control);
    job->later_rows = 1u << ROW_COLORS | (job->options.mattes ? MATTE_ROWS : 0);
    job->first_rows = (picture_rows(film->sums) & ~(1u << ROW_NOISE)) | job->later_rows;
    inputs_upload(job, traced);
    const bool spares = spares_first(job);
    if (spares && had == 0 && !find_aovs(job, plan, &work))
        return false;
    const bool noise      = film->kept != NULL;
    bool       unfinished = true;
    if (noise && !noise_resume(job, plan, &work, had, &unfinished))
        return false;
    for (; added < *samples && unfinished && !(added > 0 && is_due(film, begun)); added++) {
        const uint32_t before = had + added;
        job->progress_share   = share / *samples;
        job->progress_done    = done + job->progress_share * added;
        if (!add_ray(job, plan, &work, before + spares) ||
            (noise && !noise_take(job, plan, &work, before + 1, &unfinished)))
            return false;
    }
    *samples = unfinished ? added : *samples;
    return !noise || noise_restore(job, &work, had + *samples);
}

/* Notes that the host has more samples of a band. */
static void note_stored(Job *job, KrsFilm *film, const ResidentBand *band, uint32_t samples)
{
    for (uint32_t row = band->from / TILE; row * TILE < band->from + band->rows; row++)
        film->more[row] += samples;
    film->stats = *job->stats;
}

/* Adds samples to a band, up to `samples` more than the film has. */
static bool complete_band(Job *job, const Plan *plan, KrsFilm *film, ResidentBand *band,
                          uint32_t samples)
{
    const double    height = job->cover.height, part = job->part * band->rows / height / samples;
    const uint32_t *more = &film->more[band->from / TILE];
    while (*more < samples) {
        uint32_t added     = samples - *more;
        band->has_aovs     = resident_samples(film, band->from) == 0;
        job->progress_done = job->part_begun + job->part * band->from / height + part * *more;
        if (!resident_change(film, band) || !add_to_band(job, plan, film, &added, part * added) ||
            !resident_store(film->rendering))
            return false;
        note_stored(job, film, band, added);
    }
    return true;
}

static bool add_to_bands(Job *job, const Plan *plan, KrsFilm *film, uint32_t samples)
{
    const KrsWindow *cover = &job->cover;
    for (uint32_t from = 0, rows; from < cover->height; from += rows) {
        const uint32_t left = cover->height - from;
        rows                = TILE; /* and as many as the host has as many samples of */
        while (rows < left && rows < film->rows &&
               film->more[(from + rows) / TILE] == film->more[from / TILE])
            rows += TILE;
        rows                   = rows < left ? rows : left;
        const KrsWindow window = {cover->x, cover->y + from, cover->width, rows};
        ResidentBand    band = {film, from, rows, with_halo(job, plan->halo, window), false, true};
        if (!complete_band(job, plan, film, &band, samples))
            return false;
    }
    return true;
}

/* Waits until the driver has compiled the shaders, so that this time does not count for the
   picture. */
static bool wait_for_shaders(Job *job)
{
    double start = clock_ms();
    bool   ready = gpu_wait(job->gpu);
    job->rendering->pipeline_ms += clock_ms() - start;
    return ready;
}

/* Makes buffers for a band of this film, if another film has them or none are made.  The samples of
   the other film are copied to host memory before. */
static bool make_room(Job *job, const Plan *plan, KrsFilm *film)
{
    KrsRendering *rendering = job->rendering;
    if (rendering->resident.film != film || plan->surface_rows > rendering->band.surface_rows ||
        plan_path_rows(plan) > rendering->band.path_rows) {
        if (!resident_store(rendering))
            return false;
        rendering->resident = (ResidentBand){0};
        film->rows = band_allocate(rendering, &job->cover, plan->halo, plan_path_rows(plan),
                                   film->kept != NULL, film->light_count, plan->surface_rows);
    }
    if (film->rows == 0 ||
        !rendering_set_lights(rendering, job->view.lights, job->view.light_count,
                              job->options.light, job->rebase_origin, inputs_room(job)))
        return false;
    rendering_set_emissive(rendering, job->emissive, job->frame.emissive_count);
    inputs_upload_tables(job);
    return true;
}

/* Records what the film keeps of its first sample: the rebase origin and the matrices. */
static void begin_film(const Job *job, KrsFilm *film)
{
    const KrsRenderOptions *o = &film->options;
    memcpy(film->rebase_origin, job->rebase_origin, sizeof film->rebase_origin);
    view_matrices(job->rays ? NULL : &job->view.camera, o->width, o->height, film->sums);
}

/* Adds samples by a finished plan. */
static bool run(Job *job, const Plan *plan, KrsFilm *film, uint32_t samples)
{
    if (!make_room(job, plan, film) || !wait_for_shaders(job))
        return false;
    if (film->samples == film->first)
        begin_film(job, film);
    const double   start       = clock_ms();
    const uint64_t submissions = job->gpu->submissions;
    const bool     good        = add_to_bands(job, plan, film, samples);
    job->stats->wall_ms += clock_ms() - start;
    job->stats->submissions += job->gpu->submissions - submissions;
    return good;
}

/* The samples that one call adds to a film, or one moment of it. */
typedef struct Addition {
    KrsState        *state;
    const KrsCamera *camera; /* NULL: that of the options, or rays */
    const KrsRays   *rays;
    uint32_t         samples;
    double           part_begun, part; /* of the progress of the call */
} Addition;

static Job job_of(KrsFilm *film, const Addition *a)
{
    Job job              = {.rendering      = film->rendering,
                            .gpu            = &film->rendering->renderer->gpu,
                            .options        = film->options,
                            .asked_schedule = film->asked_schedule,
                            .schedule       = film->options.methods.schedule,
                            .rays           = a->rays,
                            .cover          = resident_cover(&film->options),
                            .part_begun     = a->part_begun,
                            .part           = a->part,
                            .stats          = &film->sums->stats};
    job.options.slice_ms = ldexp(job.options.slice_ms,
                                 -(int)renderer_halvings(film->rendering->renderer));
    return job;
}

/* Adds what the host does not have already.  *begun: samples may have been added, so the film can no longer stay as it
   was. */
static bool try_moment(KrsFilm *film, const Addition *a, bool *begun)
{
    Job job = job_of(film, a);
    if (!rendering_ready(film->rendering->renderer) || !job_read_frame(&job, a->state, a->camera) ||
        !volumes_find(&job) || !executor_choose(&job, a->samples))
        return false;
    *begun                     = true;
    film->sums->stats.executor = job.options.methods.executor;
    film->rendering->catches   = plate_catches(film);
    Plan plan                  = {.gpu = job.gpu};
    bool good                  = integrators[job.options.integrator](&job, &plan) &&
                run(&job, &plan, film, a->samples);
    plan_free(&plan);
    return good;
}

/* Tells how many samples of rows of tiles the host has of those that are added. */
static uint64_t count_stored(const KrsFilm *film)
{
    uint64_t count = 0;
    for (uint32_t row = 0; row < tile_rows(film); row++)
        count += film->more[row];
    return count;
}

/* Prepares a film for going on after its device was lost; false: it cannot. */
static bool go_back(KrsFilm *film)
{
    if (!begins_anew(film)) {
        film->sums->stats = film->stats;
        return true;
    }
    if (film->samples == film->first)
        krs_film_clear(film);
    return film->samples == film->first;
}

static void say_losses(Gpu *gpu, int losses)
{
    char message[sizeof gpu->message];
    memcpy(message, gpu->message, sizeof message);
    gpu_refuse(gpu, gpu->status, "%.400s, %d times in a row", message, losses);
}

static KrsStatus add_moment(KrsFilm *film, const Addition *a)
{
    Gpu     *gpu    = &film->rendering->renderer->gpu;
    uint64_t stored = 0;
    int      losses = 0;
    bool     begun  = false;
    memset(film->more, 0, tile_rows(film) * sizeof *film->more);
    film->stats = film->sums->stats;
    while (!try_moment(film, a, &begun)) {
        const uint64_t now = count_stored(film);
        losses             = now > stored ? 1 : losses + 1;
        stored             = now > stored ? now : stored;
        if (gpu->lost && losses <= MAX_LOSSES && go_back(film))
            continue;
        if (losses > MAX_LOSSES)
            say_losses(gpu, losses);
        if (begun)
            krs_film_clear(film);
        return gpu->status;
    }
    film->samples += a->samples;
    memset(film->more, 0, tile_rows(film) * sizeof *film->more);
    return KRS_OK;
}

/* Finds when the shutter opens and closes, in seconds after the frame's time; false: it makes no
   blur. */
static bool find_shutter(const KrsFilm *film, const Addition *a, double seconds[2])
{
    KrsCamera camera = {0};
    if (a->camera)
        camera = *a->camera;
    else if (a->rays || krs_state_camera(a->state, film->options.camera, &camera) != KRS_OK)
        return false;
    for (int i = 0; i < 2; i++)
        seconds[i] = camera.shutter[i] * film->options.frame_seconds;
    return seconds[1] > seconds[0];
}

/* Adds each sample at a time of its own while the shutter is open.  Its times are multiples of the
   golden ratio, modulo 1, which fill it evenly; the first, whose AOVs are kept, is the middle. */
static KrsStatus add_moments(KrsFilm *film, const Addition *a, const double shutter[2])
{
    const double golden = 0.61803398874989485, begin = krs_state_time(a->state);
    KrsStatus    status = KRS_OK;
    for (uint32_t i = 0; i < a->samples && status == KRS_OK; i++) {
        double   part   = 0.5 + golden * film->samples;
        Addition moment = *a;
        part -= floor(part);
        moment.samples    = 1;
        moment.part       = a->part / a->samples;
        moment.part_begun = a->part_begun + moment.part * i;
        status            = krs_state_set_time(a->state,
                                               begin + shutter[0] + part * (shutter[1] - shutter[0]));
        if (status == KRS_OK)
            status = add_moment(film, &moment);
        else
            gpu_refuse(&film->rendering->renderer->gpu, status,
                       "the scene is not finite while the shutter is open");
    }
    krs_state_set_time(a->state, begin);
    return status;
}

static KrsStatus add(KrsFilm *film, const Addition *a)
{
    Gpu   *gpu = &film->rendering->renderer->gpu;
    double shutter[2];
    renderer_clear(film->rendering->renderer);
    if (!follow_rendering(film))
        return gpu->status;
    if (a->samples == 0 || a->samples > KRS_MAX_SAMPLES - film->samples) {
        gpu_refuse(gpu, KRS_BAD_ARGUMENT, "%s", "a film has 1 to 65536 samples per pixel");
        return gpu->status;
    }
    const bool moments = find_shutter(film, a, shutter);
    KrsStatus  status  = KRS_OK;
    for (uint32_t done = 0; done < a->samples && status == KRS_OK;) {
        Addition portion = *a;
        if (!blocks_close(film)) {
            krs_film_clear(film);
            return gpu->status;
        }
        portion.samples    = blocks_room(film, a->samples - done);
        portion.part       = a->part * portion.samples / a->samples;
        portion.part_begun = a->part_begun + a->part * done / a->samples;
        status = moments ? add_moments(film, &portion, shutter) : add_moment(film, &portion);
        done += portion.samples;
    }
    return status;
}

KrsStatus krs_film_add(KrsFilm *film, KrsState *state, const KrsCamera *camera, uint32_t samples)
{
    return add(film, &(Addition){state, camera, NULL, samples, 0, 1});
}

KrsStatus krs_film_add_rays(KrsFilm *film, KrsState *state, const KrsRays *rays)
{
    return add(film, &(Addition){state, NULL, rays, 1, 0, 1});
}

KrsStatus krs_film_try_lanes(KrsFilm *film, KrsState *state, const KrsCamera *camera,
                             double *lanes_ms, double *compiler_ms)
{
    Gpu *gpu = &film->rendering->renderer->gpu;
    if (!rendering_ready(film->rendering->renderer) || !follow_rendering(film))
        return gpu->status;
    Job        job  = job_of(film, &(Addition){state, camera, NULL, 1, 0, 1});
    const bool good = job_read_frame(&job, state, camera) &&
                      executor_try_lanes(&job, lanes_ms, compiler_ms);
    return good ? KRS_OK : gpu->status;
}

/* ---- reading ---- */

/* Copies all samples to the host; the time that it takes counts for the picture. */
static bool store_all(KrsFilm *film)
{
    KrsRendering  *rendering   = film->rendering;
    const double   start       = clock_ms();
    const uint64_t submissions = rendering->renderer->gpu.submissions;
    const bool     blocks      = film->divided || film->exact;
    const bool     good        = (!blocks || blocks_close(film)) &&
                      (rendering->resident.film != film || resident_store(rendering));
    film->sums->stats.wall_ms += clock_ms() - start;
    film->sums->stats.submissions += rendering->renderer->gpu.submissions - submissions;
    return good;
}

/* Samples of all pixels together. */
static uint64_t count_rays(const KrsFilm *film)
{
    const size_t    pixels = film_pixels(film);
    const uint32_t *ended  = film->sums->pixel_samples;
    uint64_t        rays   = 0;
    for (size_t k = 0; k < pixels; k++)
        rays += ended && ended[k] > 0 ? ended[k] : film->samples - film->first;
    return rays;
}

/* Turns the sums of a film into a picture with statistics; false with the failure noted. */
static bool finish(const KrsFilm *film, KrsPicture *picture)
{
    KrsRenderStats     *stats     = &picture->stats;
    const KrsRendering *rendering = film->rendering;
    const Gpu          *gpu       = &rendering->renderer->gpu;
    const double        flops     = rendering->program->flops;
    const double marching = stats->phase_ms[KRS_PHASE_PRIMARY] + stats->phase_ms[KRS_PHASE_BOUNCES];
    stats->spirv_ms       = rendering->spirv_ms;
    stats->pipeline_ms    = rendering->pipeline_ms;
    stats->shaders        = gpu->shaders_made;
    stats->device_time    = gpu->has_clock;
    for (int phase = 0; phase < KRS_PHASE_COUNT; phase++)
        stats->total_ms += stats->phase_ms[phase];
    stats->rays                 = count_rays(film);
    stats->evaluations_per_ray  = (double)stats->evaluations / (double)stats->rays;
    stats->flops_per_evaluation = flops;
    stats->gflops = marching > 0 ? (double)stats->evaluations * flops / marching / 1e6 : 0;
    stats->peak_memory_bytes += gpu->memory_peak;
    snprintf(stats->device, sizeof stats->device, "%s", gpu_describe(gpu).name);
    picture->samples = film->samples - film->first;
    blocks_finish(film, picture);
    if (!lights_finish(film, picture) || !plate_finish(film, picture))
        return false;
    picture_divide(picture, film->sums->pixel_samples, picture->samples);
    noise_finish(picture);
    picture_compose(picture, film->options.depth, film->options.plate);
    mattes_sort(picture);
    return true;
}

KrsStatus krs_film_read(KrsFilm *film, uint32_t aovs, KrsPicture **picture)
{
    Gpu           *gpu    = &film->rendering->renderer->gpu;
    const uint32_t wanted = aovs ? aovs : film->options.aovs;
    *picture              = NULL;
    renderer_clear(film->rendering->renderer);
    if (krs_film_samples(film) == 0 || wanted & ~film->options.aovs) {
        gpu_refuse(gpu, KRS_BAD_ARGUMENT, "%s",
                   krs_film_samples(film) == 0 ? "the film has no samples yet"
                                               : "the film was made without some of these AOVs");
        return gpu->status;
    }
    if (store_all(film))
        *picture = picture_copy(gpu, film->sums, wanted);
    if (*picture && !finish(film, *picture)) {
        krs_picture_free(*picture);
        *picture = NULL;
    }
    return *picture ? KRS_OK : gpu->status;
}

/* Renders by a film that is read once, so its sums become the picture without a copy. */
KrsStatus krs_render(KrsRendering *rendering, KrsState *state, const KrsRenderOptions *options,
                     KrsPicture **picture)
{
    KrsFilm  *film   = NULL;
    KrsStatus status = krs_film_new(rendering, options, &film);
    *picture         = NULL;
    if (status == KRS_OK)
        status = krs_film_add(film, state, NULL, film->options.samples);
    for (int i = 0; i < MAX_LOSSES && film && begins_anew(film) && rendering->renderer->gpu.lost;
         i++)
        status = krs_film_add(film, state, NULL, film->options.samples);
    if (status == KRS_OK && !(store_all(film) && finish(film, film->sums)))
        status = rendering->renderer->gpu.status;
    if (status == KRS_OK) {
        picture_drop(film->sums, ~film->options.aovs);
        *picture   = film->sums;
        film->sums = NULL;
    }
    krs_film_free(film);
    return status;
}
