/*
 * render.c: one frame.
 *
 * The picture is made in bands of rows that fit into modest buffers (band.c); phases.c makes one
 * ray of each pixel of a band.
 */
#include <math.h>
#include <string.h>

#include "runtime/tracer/band.h"
#include "runtime/tracer/phases.h"
#include "runtime/tracer/picture.h"
#include "runtime/tracer/view.h"

#define MOST_STEPS 16384
/* All loops of an invocation together stay under 32768 iterations: some devices end them
   silently after 65535. */
#define MOST_STEPS_AT_ONCE 8192
/* Steps of a pass of the queue: more leave lanes idle, fewer cost passes. */
#define QUEUE_STEPS 16

/* ---- What is asked for ---- */

static bool refuse(Job *job, const char *words)
{
    gpu_refuse(job->gpu, KRS_BAD_ARGUMENT, "%s", words);
    return false;
}

static uint32_t first_of(uint32_t asked, uint32_t scene, uint32_t otherwise)
{
    return asked ? asked : scene ? scene : otherwise;
}

/* Puts the scene's wishes and the defaults where the caller has none, and checks all. */
static bool settle_options(Job *job)
{
    KrsRenderOptions *o     = &job->options;
    const KrsImage   *image = &job->view.image;
    o->width                = first_of(o->width, image->width, KRS_DEFAULT_WIDTH);
    o->height               = first_of(o->height, image->height, KRS_DEFAULT_HEIGHT);
    o->samples              = first_of(o->samples, image->samples, KRS_DEFAULT_SAMPLES);
    o->planes               = first_of(o->planes, 0, KRS_PLANE_ALL);
    o->most_steps           = first_of(o->most_steps, 0, MOST_STEPS);
    if ((unsigned)o->trace >= KRS_TRACE_COUNT || (unsigned)o->schedule >= KRS_SCHEDULE_COUNT ||
        (unsigned)o->shadows >= KRS_SHADOWS_COUNT ||
        (unsigned)o->components >= KRS_COMPONENTS_COUNT ||
        (unsigned)o->normals >= KRS_NORMALS_COUNT)
        return refuse(job, "there is no such method, schedule, stencil or kind of shadow");
    if (o->normals == KRS_NORMALS_ANALYTIC && !job->rendering->program->gradients)
        return refuse(job, "analytic normals need a scene that was compiled with `gradients`");
    o->normals = rendering_normals(job->rendering, o->normals);
    job->asked = o->schedule;
    rendering_choose(job->rendering, &o->trace, &o->schedule);
    job->schedule = o->schedule;
    if (o->schedule == KRS_SCHEDULE_REFILL && job->gpu->refill_lanes == 0)
        return refuse(job, "the device's lanes cannot exchange numbers, which `refill` needs");
    o->steps_at_once = first_of(o->steps_at_once, 0,
                                o->schedule == KRS_SCHEDULE_QUEUE ? QUEUE_STEPS : 512);
    o->error    = o->error != 0 ? o->error : image->error != 0 ? image->error : KRS_DEFAULT_ERROR;
    o->slice_ms = o->slice_ms != 0 ? o->slice_ms : 50;
    if (o->crop.width == 0)
        o->crop = (KrsWindow){0, 0, o->width, o->height};

    if (o->width > KRS_MOST_SIDE || o->height > KRS_MOST_SIDE)
        return refuse(job, "a picture has at most 16384 pixels a side");
    if (o->crop.height == 0 || o->crop.x >= o->width || o->crop.width > o->width - o->crop.x ||
        o->crop.y >= o->height || o->crop.height > o->height - o->crop.y)
        return refuse(job, "the crop is not inside of the picture");
    if (o->samples > KRS_MOST_SAMPLES)
        return refuse(job, "there are at most 65536 samples per pixel");
    if (!(o->error > 0) || !(o->error <= KRS_MOST_ERROR))
        return refuse(job, "the permitted error must be above 0 and at most 1000 pixels");
    if (!(o->slice_ms > 0) || o->most_steps > MOST_STEPS || o->steps_at_once > MOST_STEPS_AT_ONCE)
        return refuse(job, "slices must be longer than nothing, and rays have at most 16384 steps");
    return true;
}

/* How far around a hit its normal is looked for, in pixels; more than half a pixel: what is finer
   is filtered.  Several rays of a pixel show it by themselves.  bench/minify found the number. */
static float normal_reach(const KrsRenderOptions *options)
{
    bool one_sided = options->normals == KRS_NORMALS_FORWARD ||
                     options->normals == KRS_NORMALS_ANALYTIC;
    return options->no_filter || options->samples > 1 || one_sided ? 0.5f : 0.7f;
}

/* Points on the device are relative to the eye where single precision would show in what is nearest
   to it. */
static void choose_rebase_origin(Job *job, KrsFrame *frame)
{
    const KrsCamera *camera = &job->view.camera;
    float            zones[KRS_MOST_ZONES][4];
    double           nearest = 0, far = 0;
    if (!job->rendering->program->camera_relative || krs_frame_zones(frame, zones) > 0)
        return;
    for (int i = 0; i < 3; i++)
        far = fmax(far, fabs(camera->eye[i]));
    if (krs_distance(frame, &camera->eye, 1, &nearest) != KRS_OK)
        nearest = 0;
    if (krs_needs_rebase(far, view_pixel(camera, job->options.height, fabs(nearest))))
        memcpy(job->rebase_origin, camera->eye, sizeof job->rebase_origin);
}

static bool is_camera_relative(const Job *job)
{
    return job->rebase_origin[0] != 0 || job->rebase_origin[1] != 0 || job->rebase_origin[2] != 0;
}

/* Reads the frame: camera, lights, parameters. */
static bool settle_frame(Job *job, KrsFrame *frame)
{
    if (krs_frame_view(frame, job->options.camera, &job->view) != KRS_OK)
        return refuse(job, "the scene has no such camera");
    if (!settle_options(job))
        return false;
    choose_rebase_origin(job, frame);
    const KrsProgram *program = job->rendering->program;
    KrsView           seen    = job->view;
    double            low[3], high[3];
    for (int i = 0; i < 3; i++) {
        seen.camera.eye[i] -= job->rebase_origin[i];
        seen.camera.target[i] -= job->rebase_origin[i];
        low[i]  = program->low[i] - job->rebase_origin[i];
        high[i] = program->high[i] - job->rebase_origin[i];
    }
    if (!view_prepare(&seen, low, high, job->options.width, job->options.height, &job->frame))
        return refuse(job, "the camera sees nothing: its eye is at its target, or its angle or"
                           " height is not one");
    job->frame.error        = (float)job->options.error;
    job->frame.most_steps   = job->options.most_steps;
    job->frame.normal_reach = normal_reach(&job->options);
    memcpy(job->rendering->frame.bytes, &job->frame, sizeof job->frame);
    return rendering_set_parameters(job->rendering, frame) &&
           (!is_camera_relative(job) ||
            rendering_rebase(job->rendering, frame, job->rebase_origin)) &&
           rendering_set_lights(job->rendering, job->view.lights, job->view.light_count,
                                job->rebase_origin);
}

/* ---- Bands ---- */

/* The rows that are asked for: colours are summed up, what sees nothing is all zero, but places,
   which are infinitely far away. */
static bool clear_results(Job *job, uint32_t rows, VkDeviceSize row_bytes)
{
    const uint32_t infinite = 0x7f800000;
    const Buffer  *results  = &job->rendering->band.results;
    double         ms       = 0;
    if (!gpu_begin(job->gpu))
        return false;
    for (VkDeviceSize row = 0; row < RESULT_ROWS; row++)
        if (rows >> row & 1)
            vkCmdFillBuffer(job->gpu->commands, results->buffer, row * row_bytes, row_bytes,
                            row == ROW_POSITIONS ? infinite : 0);
    return gpu_finish(job->gpu, &ms);
}

static bool fetch(Job *job, uint32_t rows, VkDeviceSize row_bytes)
{
    double       ms = 0; /* copying is no phase */
    VkBufferCopy copies[RESULT_ROWS];
    uint32_t     count = 0;
    if (job->rendering->band.results.bytes)
        return true;
    if (!gpu_begin(job->gpu))
        return false;
    for (VkDeviceSize row = 0; row < RESULT_ROWS; row++)
        if (rows >> row & 1)
            copies[count++] = (VkBufferCopy){row * row_bytes, row * row_bytes, row_bytes};
    vkCmdCopyBuffer(job->gpu->commands, job->rendering->band.results.buffer,
                    job->rendering->band.fetched.buffer, count, copies);
    return gpu_finish(job->gpu, &ms);
}

/* Back to the origin of the world; where nothing is there is no position. */
static void place_positions(Job *job, const float *places, size_t first, size_t count)
{
    float *position = job->picture->position;
    for (size_t k = 0; position && k < count; k++)
        for (int i = 0; i < 3; i++) {
            float *number   = &position[3 * (first + k) + i];
            bool   is_place = isfinite(places[k * RESULT_NUMBERS + DEPTH_NUMBER]);
            *number         = is_place ? (float)(*number + job->rebase_origin[i]) : 0;
        }
}

/* Takes the rows of the cover from `from` on over from what was traced for them, as far as they are
   in the crop. */
static void take_band(Job *job, const KrsWindow *traced, uint32_t from, uint32_t rows)
{
    const KrsWindow *cover = &job->cover, *crop = &job->options.crop;
    const Band      *buffers = &job->rendering->band;
    const float *results = buffers->results.bytes ? buffers->results.bytes : buffers->fetched.bytes;
    size_t       band    = (size_t)traced->height * traced->width;
    for (uint32_t y = cover->y + from; y < cover->y + from + rows; y++) {
        if (y < crop->y || y >= crop->y + crop->height)
            continue;
        size_t row   = (size_t)(y - traced->y) * traced->width + (crop->x - traced->x);
        size_t first = (size_t)(y - crop->y) * crop->width;
        picture_take(job->picture, results + row * RESULT_NUMBERS, band, first, crop->width,
                     job->options.samples);
        place_positions(job, results + (ROW_POSITIONS * band + row) * RESULT_NUMBERS, first,
                        crop->width);
    }
}

/* A window and the halo around it, as far as the picture reaches. */
static KrsWindow with_halo(const Job *job, KrsWindow window)
{
    const uint32_t halo  = job->halo;
    const uint32_t right = window.x + window.width + halo, bottom = window.y + window.height + halo;
    window.x      = window.x > halo ? window.x - halo : 0;
    window.y      = window.y > halo ? window.y - halo : 0;
    window.width  = (right < job->options.width ? right : job->options.width) - window.x;
    window.height = (bottom < job->options.height ? bottom : job->options.height) - window.y;
    return window;
}

static bool render_band(Job *job, uint32_t from, uint32_t rows)
{
    const KrsWindow *cover     = &job->cover;
    const KrsWindow  band      = {cover->x, cover->y + from, cover->width, rows};
    const KrsWindow  traced    = with_halo(job, band);
    ControlBlock    *control   = job->rendering->control.bytes;
    KrsRenderStats  *stats     = &job->picture->stats;
    VkDeviceSize     row_bytes = (VkDeviceSize)traced.height * traced.width * RESULT_BYTES;
    WorkBlock        work      = {
                    .corner = {traced.x, traced.y},
                    .extent = {traced.width, traced.height},
    };
    *control = (ControlBlock){
        .projection   = (uint32_t)job->view.camera.projection,
        .lights       = (uint32_t)job->view.light_count,
        .seed         = (uint32_t)(job->options.seed ^ job->options.seed >> 32),
        .rows         = picture_rows(job->picture),
        .no_occlusion = job->options.no_occlusion,
    };
    if (!clear_results(job, control->rows, row_bytes))
        return false;
    for (uint32_t i = 0; i < job->options.samples; i++) {
        double band_share   = (double)rows / cover->height;
        job->progress_share = band_share / job->options.samples;
        job->progress_done  = (double)from / cover->height + job->progress_share * i;
        if (!phases_run(job, &work, i))
            return false;
        stats->unresolved += control->unresolved;
        stats->evaluations += control->evaluations;
        if (control->most_evaluations > stats->most_evaluations_per_ray)
            stats->most_evaluations_per_ray = control->most_evaluations;
        control->unresolved = control->evaluations = control->most_evaluations = 0;
    }
    if (!fetch(job, control->rows, row_bytes))
        return false;
    take_band(job, &traced, from, rows);
    return true;
}

/* Lets the driver finish with the kernels, so that the clock of the picture does not see it. */
static bool wait_for_kernels(Job *job)
{
    double start = clock_ms();
    bool   ready = gpu_wait(job->gpu);
    job->rendering->pipeline_ms += clock_ms() - start;
    return ready;
}

/* What a tile has in common must not depend on the crop, so whole tiles are traced. */
static KrsWindow whole_tiles(const KrsRenderOptions *options)
{
    const KrsWindow *crop   = &options->crop;
    KrsWindow        cover  = {crop->x / TILE * TILE, crop->y / TILE * TILE, 0, 0};
    uint32_t         right  = (crop->x + crop->width + TILE - 1) / TILE * TILE;
    uint32_t         bottom = (crop->y + crop->height + TILE - 1) / TILE * TILE;
    cover.width             = (right < options->width ? right : options->width) - cover.x;
    cover.height            = (bottom < options->height ? bottom : options->height) - cover.y;
    return cover;
}

/* The kernels of primary rays and beams, of all components or part by part. */
static bool find_marches(Job *job, KrsFrame *frame)
{
    const KrsRenderOptions *options = &job->options;
    /* Balls that are tried know of no inside. */
    if (job->options.trace >= KRS_TRACE_BINARY && !begins_outside(job, frame))
        job->options.trace = KRS_TRACE_PLAIN;
    if (!per_component_prepare(job, frame))
        return false;
    if (job->group_march_count > 0)
        return true;
    bool outside      = begins_outside(job, frame);
    job->knows_planes = rendering_knows_planes(job->rendering) && outside;
    bool packed       = outside &&
                  rendering_marches_packed(job->rendering, options->components, options->trace);
    uint32_t group = packed ? MARCH_PACKED : job->knows_planes ? MARCH_WITHOUT_PLANES : 0;
    job->trace     = rendering_trace(job->rendering, options->trace, options->schedule, group);
    job->beams     = options->no_beams
                         ? job->trace
                         : rendering_beams(job->rendering, options->trace, options->schedule, group);
    return job->trace && job->beams;
}

/* Whether there is occlusion, or a light that casts shadows. */
static bool needs_secondary(const Job *job)
{
    bool needed = !job->options.no_occlusion;
    for (size_t i = 0; i < job->view.light_count; i++)
        needed = needed || job->view.lights[i].shadow;
    return needed;
}

/* The kernel of rays to lights and for occlusion, if it is needed. */
static bool find_secondary(Job *job)
{
    const KrsRenderOptions *options = &job->options;
    if (!needs_secondary(job))
        return true;
    job->by_roots  = rendering_has_roots(job->rendering, options->trace);
    job->secondary = rendering_secondary(job->rendering, options->schedule, job->by_roots);
    return job->secondary != NULL;
}

static bool render(Job *job, KrsFrame *frame)
{
    job->filters_shadows = !job->options.no_upsampling && job->options.shadows == KRS_SHADOWS_SOFT;
    job->halo  = !job->options.no_occlusion || (job->filters_shadows && needs_secondary(job)) ? TILE
                                                                                              : 0;
    job->cover = whole_tiles(&job->options);
    uint32_t rows = band_allocate(job);
    if (rows == 0)
        return false;
    if (!find_marches(job, frame))
        return false;
    job->normals = rendering_normals_kernel(job->rendering, job->options.normals, 0);
    job->shade   = rendering_shade(job->rendering);
    if (!job->normals || !job->shade || !find_secondary(job) || !wait_for_kernels(job))
        return false;
    double   start       = clock_ms();
    uint64_t submissions = job->gpu->submissions;
    for (uint32_t from = 0; from < job->cover.height; from += rows) {
        uint32_t left = job->cover.height - from;
        if (!render_band(job, from, left < rows ? left : rows))
            return false;
    }
    job->picture->stats.wall_ms     = clock_ms() - start;
    job->picture->stats.submissions = job->gpu->submissions - submissions;
    return true;
}

static void finish_stats(Job *job)
{
    KrsRenderStats   *stats   = &job->picture->stats;
    const KrsProgram *program = job->rendering->program;
    stats->spirv_ms           = job->rendering->spirv_ms;
    stats->pipeline_ms        = job->rendering->pipeline_ms;
    stats->device_time        = job->gpu->times != VK_NULL_HANDLE;
    for (int phase = 0; phase < KRS_PHASE_COUNT; phase++)
        stats->total_ms += stats->phase_ms[phase];
    const KrsWindow *window     = &job->options.crop;
    stats->rays                 = (uint64_t)job->options.samples * window->width * window->height;
    stats->evaluations_per_ray  = (double)stats->evaluations / (double)stats->rays;
    stats->flops_per_evaluation = program->flops;
    double primary              = stats->phase_ms[KRS_PHASE_PRIMARY];
    stats->gflops = primary > 0 ? (double)stats->evaluations * program->flops / primary / 1e6 : 0;
    stats->peak_memory_bytes += job->gpu->memory_peak;
    memcpy(stats->device, job->gpu->properties.deviceName, sizeof stats->device);
}

KrsStatus krs_render(KrsRendering *rendering, KrsFrame *frame, const KrsRenderOptions *options,
                     KrsPicture **picture)
{
    Job job = {.rendering = rendering, .gpu = &rendering->renderer->gpu};
    if (options)
        job.options = *options;
    *picture = NULL;
    renderer_clear(rendering->renderer);
    if (!settle_frame(&job, frame))
        return job.gpu->status;
    job.picture = picture_new(job.gpu, job.options.width, job.options.height, job.options.crop,
                              job.options.planes);
    if (!job.picture)
        return job.gpu->status;
    view_matrices(&job.view.camera, job.options.width, job.options.height, job.picture);
    if (!render(&job, frame)) {
        krs_picture_free(job.picture);
        return job.gpu->status;
    }
    finish_stats(&job);
    *picture = job.picture;
    return KRS_OK;
}
