/*
 * render.c: one frame.
 *
 * The picture is made in bands of rows that fit into modest buffers.  For each band and each
 * ray of its pixels the phases follow one another: primary rays, normals, materials, occlusion,
 * lights, and the sum.  Each phase is cut into slices of tiles, short enough that no watchdog
 * minds and an interruption is heard at once; how many tiles that is, is learned on the way, and
 * shows in nothing but the time.
 */
#include <math.h>
#include <string.h>

#include "runtime/tracer/picture.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/view.h"

/* Pixels of a band: room for 50 MB of buffers, half of what the smallest devices bind. */
#define BAND_PIXELS     (UINT64_C(1) << 18)
/* Bands are halved when the device lacks memory, down to this. */
#define BAND_PIXELS_MIN (UINT64_C(1) << 12)
#define LARGEST_SIDE    16384
#define MOST_SAMPLES    65536
#define MOST_STEPS      16384
/* All loops of an invocation together stay under 32768 iterations: some devices end them
   silently after 65535. */
#define MOST_STEPS_AT_ONCE 8192

const char *const krs_phase_names[KRS_PHASE_COUNT] = {
    "beams", "primary", "normals", "shadows", "occlusion", "shading", "resolve",
};

/* A render under way. */
typedef struct Job {
    KrsRendering    *rendering;
    Gpu             *gpu;
    KrsRenderOptions options; /* with nothing left to be defaulted */
    KrsView          view;
    FrameBlock       frame;
    KrsPicture      *picture;
    double           done, share; /* of the whole: before this phase, and of it */
    bool             interrupted;
} Job;

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
    KrsRenderOptions *o = &job->options;
    const KrsImage   *image = &job->view.image;
    o->width = first_of(o->width, image->width, 1280);
    o->height = first_of(o->height, image->height, 720);
    o->samples = first_of(o->samples, image->samples, 1);
    o->planes = first_of(o->planes, 0, KRS_PLANE_ALL);
    o->most_steps = first_of(o->most_steps, 0, MOST_STEPS);
    o->steps_at_once = first_of(o->steps_at_once, 0, 512);
    o->error = o->error != 0 ? o->error : image->error != 0 ? image->error : 0.25;
    o->slice_ms = o->slice_ms != 0 ? o->slice_ms : 50;
    if (o->crop.width == 0)
        o->crop = (KrsWindow){0, 0, o->width, o->height};

    if (o->width > LARGEST_SIDE || o->height > LARGEST_SIDE)
        return refuse(job, "a picture has at most 16384 pixels a side");
    if (o->crop.height == 0 || o->crop.x >= o->width || o->crop.width > o->width - o->crop.x ||
        o->crop.y >= o->height || o->crop.height > o->height - o->crop.y)
        return refuse(job, "the crop is not inside of the picture");
    if (o->samples > MOST_SAMPLES)
        return refuse(job, "there are at most 65536 samples per pixel");
    if (!(o->error > 0) || !(o->error <= 1000))
        return refuse(job, "the permitted error must be above 0 and at most 1000 pixels");
    if (!(o->slice_ms > 0) || o->most_steps > MOST_STEPS || o->steps_at_once > MOST_STEPS_AT_ONCE)
        return refuse(job, "slices must be longer than nothing, and rays have at most 16384 steps");
    return true;
}

/* Reads the frame: camera, lights, parameters. */
static bool settle_frame(Job *job, KrsFrame *frame)
{
    if (krs_frame_view(frame, job->options.camera, &job->view) != KRS_OK)
        return refuse(job, "the scene has no such camera");
    if (!settle_options(job))
        return false;
    const KrsProgram *program = job->rendering->program;
    if (!view_prepare(&job->view, program->low, program->high, job->options.width,
                      job->options.height, &job->frame))
        return refuse(job, "the camera sees nothing: its eye is at its target, or its angle or"
                           " height is not one");
    job->frame.error = (float)job->options.error;
    job->frame.most_steps = job->options.most_steps;
    memcpy(job->rendering->frame.bytes, &job->frame, sizeof job->frame);
    return rendering_set_parameters(job->rendering, frame);
}

/* ---- The buffers of a band ---- */

static void band_destroy(Gpu *gpu, Band *band)
{
    buffer_destroy(gpu, &band->rays);
    buffer_destroy(gpu, &band->hits);
    buffer_destroy(gpu, &band->results);
    buffer_destroy(gpu, &band->fetched);
    band->pixels = 0;
}

static bool band_create(KrsRendering *rendering, uint64_t pixels)
{
    Gpu         *gpu = &rendering->renderer->gpu;
    Band        *band = &rendering->band;
    VkDeviceSize result_bytes = pixels * sizeof(PixelBlock);
    if (band->pixels >= pixels)
        return true;
    band_destroy(gpu, band);
    if (!buffer_create(gpu, &band->rays, pixels * RAY_BYTES, ON_DEVICE, "rays") ||
        !buffer_create(gpu, &band->hits, pixels * HIT_BYTES, ON_DEVICE, "hits") ||
        !buffer_create(gpu, &band->results, result_bytes, ON_DEVICE, "pixels") ||
        !buffer_create(gpu, &band->fetched, result_bytes, SHARED, "pixels to read")) {
        band_destroy(gpu, band);
        return false;
    }
    band->pixels = pixels;
    const Buffer *buffers[] = {&band->rays, &band->hits, &band->results};
    for (uint32_t i = 0; i < 3; i++)
        rendering_bind(rendering, rendering->band_set, 1 + i, buffers[i]);
    return true;
}

/* Rows of a band of at most `pixels`: whole tiles, and at least one. */
static uint32_t rows_within(uint32_t width, uint64_t pixels)
{
    uint64_t rows = pixels / width / TILE * TILE;
    return rows < TILE ? TILE : (uint32_t)rows;
}

/* Makes room for a band of the picture, for a smaller one when memory is short, and returns its
   rows; 0 when there is no room at all. */
static uint32_t make_room(Job *job)
{
    const KrsWindow *window = &job->options.crop;
    for (uint64_t pixels = BAND_PIXELS; pixels >= BAND_PIXELS_MIN; pixels /= 2) {
        uint32_t rows = rows_within(window->width, pixels);
        rows = rows < window->height ? rows : window->height;
        if (band_create(job->rendering, (uint64_t)rows * window->width)) {
            renderer_clear(job->rendering->renderer);
            return rows;
        }
        if (job->gpu->status != KRS_OUT_OF_MEMORY)
            return 0;
    }
    return 0;
}

/* ---- Slices ---- */

/* A step through [0, count) that visits all and goes far each time, so that neighbouring tiles,
   which cost alike, are spread over a device that deals out contiguous shares. */
static uint32_t spread(const Gpu *gpu, uint32_t count)
{
    if (!gpu_is_cpu(gpu) || count < 3)
        return 1;
    for (uint32_t step = (uint32_t)(0.618 * count);; step++) {
        uint32_t a = count, b = step;
        while (b != 0) {
            uint32_t rest = a % b;
            a = b;
            b = rest;
        }
        if (a == 1)
            return step;
    }
}

/* How many tiles to take next, after `tiles` took `ms`. */
static uint32_t next_slice(uint32_t tiles, double ms, double aim)
{
    double factor = ms > 0 ? aim / ms : 4;
    double next = tiles * fmin(fmax(factor, 0.1), 4);
    return next < 1 ? 1 : next > 65535 ? 65535 : (uint32_t)next;
}

static bool report(Job *job, double within_phase)
{
    if (job->options.progress &&
        !job->options.progress(job->options.user, job->done + job->share * within_phase)) {
        job->interrupted = true;
        gpu_refuse(job->gpu, KRS_INTERRUPTED, "interrupted");
        return false;
    }
    return true;
}

static bool run_groups(Job *job, KrsPhase phase, const Kernel *kernel, WorkBlock *work,
                       uint32_t tiles)
{
    uint32_t *at_once = &job->rendering->tiles_at_once[phase];
    for (uint32_t first = 0; first < tiles;) {
        uint32_t count = *at_once < tiles - first ? *at_once : tiles - first;
        double   ms = 0;
        work->first = first;
        work->groups = count;
        work->stride = spread(job->gpu, count);
        if (!gpu_begin(job->gpu))
            return false;
        rendering_dispatch(job->rendering, kernel, job->rendering->band_set, work, sizeof *work,
                           count);
        if (!gpu_finish(job->gpu, &ms))
            return false;
        job->picture->stats.phase_ms[phase] += ms;
        /* The last slice may be too small to learn much from. */
        if (count == *at_once || ms > job->options.slice_ms)
            *at_once = next_slice(count, ms, job->options.slice_ms);
        first += count;
        if (!report(job, (double)first / tiles))
            return false;
    }
    return true;
}

/* Runs a kernel over all tiles of the band. */
static bool run_phase(Job *job, KrsPhase phase, const Kernel *kernel, WorkBlock *work)
{
    uint32_t across = (work->extent[0] + TILE - 1) / TILE;
    uint32_t down = (work->extent[1] + TILE - 1) / TILE;
    return run_groups(job, phase, kernel, work, across * down);
}

/* ---- The phases of one ray per pixel ---- */

/* A beam may end anywhere, so what it has not done in as many steps is left to the rays; the
   number does not depend on slices, which must not be seen. */
enum { MOST_BEAM_STEPS = 256 };

/* Beams of all tiles, counted in the whole picture, that the band has a part of. */
static bool march_beams(Job *job, WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    uint32_t      beams = 1;
    for (int i = 0; i < 2; i++)
        beams *= (work->corner[i] + work->extent[i] - 1) / TILE - work->corner[i] / TILE + 1;
    work->steps = MOST_BEAM_STEPS;
    control->beams = MARCH_BEAMS;
    if (!run_groups(job, KRS_PHASE_BEAMS, &job->rendering->trace, work,
                    (beams + TILE * TILE - 1) / (TILE * TILE)))
        return false;
    control->beams = FOLLOW_BEAMS;
    return true;
}

static bool trace(Job *job, WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    work->steps = job->options.steps_at_once;
    for (double left = job->share;; left -= job->share) {
        control->marching = 0;
        job->share = 0.9 * left; /* few rays need a second pass */
        if (!run_phase(job, KRS_PHASE_PRIMARY, &job->rendering->trace, work))
            return false;
        if (control->marching == 0)
            return true;
        job->done += job->share;
        control->beginning = 0;
    }
}

static bool light_up(Job *job, WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    job->share /= (double)job->view.light_count;
    for (size_t i = 0; i < job->view.light_count; i++, job->done += job->share) {
        const KrsLight *light = &job->view.lights[i];
        control->light_kind = (light->positional ? LIGHT_POSITIONAL : 0) |
                              (light->shadow ? LIGHT_CASTS_SHADOWS : 0);
        work->light_softness = (float)light->softness;
        for (int k = 0; k < 3; k++) {
            work->light_vector[k] = (float)light->vector[k];
            work->light_color[k] = (float)light->color[k];
        }
        if (!run_phase(job, KRS_PHASE_SHADOWS, &job->rendering->secondary, work))
            return false;
    }
    return true;
}

/* The place of ray `index` within its pixel.  Ray 0 goes through the centre; the others follow
   the R2 sequence (multiples of the powers of the plastic number, modulo 1), which fills the
   pixel evenly however many there are, moved by the seed. */
static void place_ray(uint32_t index, uint64_t seed, float offset[2])
{
    static const double step[2] = {0.75487766624669276, 0.56984029099805327};
    for (int i = 0; i < 2; i++) {
        uint64_t hash = seed * 2 + (uint64_t)i; /* splitmix64 */
        hash = (hash ^ hash >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
        hash = (hash ^ hash >> 27) * UINT64_C(0x94d049bb133111eb);
        hash ^= hash >> 31;
        double moved = seed && index ? (double)(hash >> 11) / 9007199254740992.0 : 0;
        double place = 0.5 + step[i] * index + moved;
        offset[i] = (float)(place - floor(place));
    }
}

/* One ray of every pixel of the band; `done` and `share` of the job are its own. */
static bool render_ray(Job *job, WorkBlock *work, uint32_t index)
{
    const double start = job->done, whole = job->share;
    KrsRendering *r = job->rendering;
    ControlBlock *control = r->control.bytes;
    place_ray(index, job->options.seed, work->offset);
    control->beams = NO_BEAMS;
    control->beginning = 1;
    job->share = 0; /* too short to be seen */
    if (!job->options.no_beams && job->view.camera.projection != KRS_PANORAMA &&
        !march_beams(job, work))
        return false;
    static const struct {
        KrsPhase phase;
        uint32_t secondary;
        double   from, to; /* of the time, about */
    } steps[] = {
        {KRS_PHASE_PRIMARY, 0, 0, 0.5},
        {KRS_PHASE_NORMALS, SECONDARY_NORMALS, 0.5, 0.6},
        {KRS_PHASE_SHADING, 0, 0.6, 0.65},
        {KRS_PHASE_OCCLUSION, SECONDARY_OCCLUSION, 0.65, 0.75},
        {KRS_PHASE_SHADOWS, SECONDARY_SHADOW, 0.75, 0.97},
        {KRS_PHASE_RESOLVE, 0, 0.97, 1},
    };
    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++) {
        KrsPhase phase = steps[i].phase;
        bool     ran;
        job->done = start + whole * steps[i].from;
        job->share = whole * (steps[i].to - steps[i].from);
        control->phase = steps[i].secondary;
        control->beginning = phase == KRS_PHASE_PRIMARY || index == 0;
        switch (phase) {
        case KRS_PHASE_PRIMARY: ran = trace(job, work); break;
        case KRS_PHASE_SHADOWS: ran = light_up(job, work); break;
        case KRS_PHASE_SHADING: ran = run_phase(job, phase, &r->material, work); break;
        case KRS_PHASE_RESOLVE: ran = run_phase(job, phase, &r->renderer->resolve, work); break;
        default:                ran = run_phase(job, phase, &r->secondary, work);
        }
        if (!ran)
            return false;
    }
    return true;
}

/* ---- Bands ---- */

static bool fetch(Job *job, uint64_t pixels)
{
    double ms = 0; /* copying is no phase */
    if (!gpu_begin(job->gpu))
        return false;
    vkCmdCopyBuffer(job->gpu->commands, job->rendering->band.results.buffer,
                    job->rendering->band.fetched.buffer, 1,
                    &(VkBufferCopy){.size = pixels * sizeof(PixelBlock)});
    return gpu_finish(job->gpu, &ms);
}

static bool render_band(Job *job, uint32_t from, uint32_t rows)
{
    const KrsWindow *window = &job->options.crop;
    ControlBlock    *control = job->rendering->control.bytes;
    WorkBlock        work = {
        .corner = {window->x, window->y + from},
        .extent = {window->width, rows},
    };
    *control = (ControlBlock){.projection = (uint32_t)job->view.camera.projection};
    for (uint32_t i = 0; i < job->options.samples; i++) {
        double band_share = (double)rows / window->height;
        job->share = band_share / job->options.samples;
        job->done = (double)from / window->height + job->share * i;
        if (!render_ray(job, &work, i))
            return false;
        job->picture->stats.unresolved += control->unresolved;
        job->picture->stats.evaluations += control->beam_evaluations;
        control->unresolved = control->beam_evaluations = 0;
    }
    if (!fetch(job, (uint64_t)rows * window->width))
        return false;
    picture_take(job->picture, job->rendering->band.fetched.bytes, (size_t)from * window->width,
                 (size_t)rows * window->width, job->options.samples);
    return true;
}

/* A driver may compile a kernel only when it first runs: let it, on no pixels, before the clock
   of the picture starts. */
static bool warm_up(Job *job)
{
    KrsRendering *r = job->rendering;
    const Kernel *kernels[] = {&r->trace, &r->secondary, &r->material, &r->renderer->resolve};
    WorkBlock     work = {.groups = 1, .stride = 1};
    double        start = clock_ms(), ms = 0;
    for (size_t i = 0; i < sizeof kernels / sizeof kernels[0] && !r->warm; i++) {
        if (!gpu_begin(job->gpu))
            return false;
        rendering_dispatch(r, kernels[i], r->band_set, &work, sizeof work, 1);
        if (!gpu_finish(job->gpu, &ms))
            return false;
    }
    if (!r->warm)
        r->pipeline_ms += clock_ms() - start;
    r->warm = true;
    return true;
}

static bool render(Job *job)
{
    const KrsWindow *window = &job->options.crop;
    uint32_t         rows = make_room(job);
    if (rows == 0 || !warm_up(job))
        return false;
    double start = clock_ms();
    for (uint32_t from = 0; from < window->height; from += rows) {
        uint32_t left = window->height - from;
        if (!render_band(job, from, left < rows ? left : rows))
            return false;
    }
    job->picture->stats.wall_ms = clock_ms() - start;
    return true;
}

static void finish_stats(Job *job)
{
    KrsRenderStats   *stats = &job->picture->stats;
    const KrsProgram *program = job->rendering->program;
    stats->spirv_ms = job->rendering->spirv_ms;
    stats->pipeline_ms = job->rendering->pipeline_ms;
    stats->device_time = job->gpu->times != VK_NULL_HANDLE;
    for (int phase = 0; phase < KRS_PHASE_COUNT; phase++)
        stats->total_ms += stats->phase_ms[phase];
    const KrsWindow *window = &job->options.crop;
    stats->rays = (uint64_t)job->options.samples * window->width * window->height;
    stats->evaluations_per_ray = (double)stats->evaluations / (double)stats->rays;
    stats->flops_per_evaluation = program->flops;
    double primary = stats->phase_ms[KRS_PHASE_PRIMARY];
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
    if (!render(&job)) {
        krs_picture_free(job.picture);
        return job.gpu->status;
    }
    finish_stats(&job);
    *picture = job.picture;
    return KRS_OK;
}
