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

/* Pixels of a band: room for 80 MB of buffers, none larger than the smallest devices bind. */
#define BAND_PIXELS     (UINT64_C(1) << 18)
/* Bands are halved when the device lacks memory, down to this. */
#define BAND_PIXELS_MIN (UINT64_C(1) << 12)
#define LARGEST_SIDE    16384
#define MOST_SAMPLES    65536
#define MOST_STEPS      16384
/* All loops of an invocation together stay under 32768 iterations: some devices end them
   silently after 65535. */
#define MOST_STEPS_AT_ONCE 8192
#define MOST_TURNS      16384 /* of a lane that takes item after item */
#define MOST_BEAM_STEPS 256   /* of a beam, as in trace.comp */
/* Steps of a pass of the queue: more leave lanes idle, fewer cost passes. */
#define QUEUE_STEPS     16

const char *const krs_phase_names[KRS_PHASE_COUNT] = {
    "beams", "primary", "normals", "shadows", "occlusion", "shading", "resolve",
};

const char *const krs_trace_names[KRS_TRACE_COUNT] = {"default", "plain", "relaxed", "auto"};
const char *const krs_schedule_names[KRS_SCHEDULE_COUNT] = {"default", "pixel", "refill", "queue"};
const char *const krs_shadows_names[KRS_SHADOWS_COUNT] = {"soft", "area"};

/* A render under way. */
typedef struct Job {
    KrsRendering    *rendering;
    Gpu             *gpu;
    KrsRenderOptions options; /* with nothing left to be defaulted */
    KrsView          view;
    FrameBlock       frame;
    Kernel          *trace, *secondary;
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
    renderer_choose(job->rendering->renderer, &o->trace, &o->schedule);
    o->steps_at_once =
        first_of(o->steps_at_once, 0, o->schedule == KRS_SCHEDULE_QUEUE ? QUEUE_STEPS : 512);
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
    return rendering_set_parameters(job->rendering, frame) &&
           rendering_set_lights(job->rendering, job->view.lights, job->view.light_count);
}

/* ---- The buffers of a band ---- */

static void band_destroy(Gpu *gpu, Band *band)
{
    Buffer *buffers[] = {&band->ends, &band->fates, &band->hits, &band->results, &band->fetched,
                         &band->queue, &band->taken};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        buffer_destroy(gpu, buffers[i]);
    band->pixels = 0;
}

/* Beams of a band of so many pixels, whatever its shape and place: every tile of 8x8 pixels that
   it touches, and every one of 32x32. */
static VkDeviceSize most_beams(uint64_t pixels)
{
    return 2 * (pixels / TILE + 2 * LARGEST_SIDE / TILE);
}

static bool band_create(KrsRendering *rendering, uint64_t pixels)
{
    Gpu  *gpu = &rendering->renderer->gpu;
    Band *band = &rendering->band;
    const struct {
        Buffer      *buffer;
        uint32_t     binding; /* of set 1; 0: of none */
        VkDeviceSize bytes;
        Where        where;
        const char  *name;
    } wanted[] = {
        {&band->ends, 1, (pixels + most_beams(pixels)) * sizeof(float), ON_DEVICE, "depths"},
        {&band->hits, 2, pixels * HIT_BYTES, ON_DEVICE, "hits"},
        {&band->results, 3, pixels * sizeof(PixelBlock), ON_DEVICE, "pixels"},
        {&band->fates, 5, pixels * sizeof(uint32_t), ON_DEVICE, "rays"},
        {&band->queue, 6, 2 * pixels * MARCH_BYTES, ON_DEVICE, "queue of rays"},
        {&band->taken, 7, most_beams(pixels) * sizeof(uint32_t), ON_DEVICE, "shares of lanes"},
        {&band->fetched, 0, pixels * sizeof(PixelBlock), SHARED, "pixels to read"},
    };
    if (band->pixels >= pixels)
        return true;
    band_destroy(gpu, band);
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
        if (!buffer_create(gpu, wanted[i].buffer, wanted[i].bytes, wanted[i].where,
                           wanted[i].name)) {
            band_destroy(gpu, band);
            return false;
        }
        if (wanted[i].binding)
            rendering_bind(rendering, rendering->band_set, wanted[i].binding, wanted[i].buffer);
    }
    band->pixels = pixels;
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

/* Runs a kernel over items that all cost alike (pixels.glsl). */
static bool run_all(Job *job, KrsPhase phase, const Kernel *kernel, WorkBlock *work,
                    uint32_t items)
{
    ControlBlock *control = job->rendering->control.bytes;
    control->items = items;
    return run_groups(job, phase, kernel, work, (items + 63) / 64);
}

/* ---- The phases of one ray per pixel ---- */

/* How trace.comp deals out its items: to so many lanes a group, from tiles of so many pixels a
   side, to a lane so many; and how many steps a lane has in a dispatch. */
typedef struct Dealing {
    uint32_t lanes, side, share, steps;
} Dealing;

static Dealing dealing(const Job *job)
{
    uint32_t steps = job->options.steps_at_once;
    if (job->options.schedule == KRS_SCHEDULE_REFILL)
        return (Dealing){8, 32, 32 * 32 / 8, 8 * steps < MOST_TURNS ? 8 * steps : MOST_TURNS};
    return (Dealing){64, 8, 1, steps};
}

/* Runs a kernel over items of which each takes the steps that it needs (schedule.glsl). */
static bool run_items(Job *job, KrsPhase phase, const Kernel *kernel, WorkBlock *work,
                      uint32_t items, Dealing deal)
{
    ControlBlock *control = job->rendering->control.bytes;
    uint32_t      in_group = deal.lanes * deal.share;
    control->items = items;
    control->share = deal.share;
    work->steps = deal.steps;
    return run_groups(job, phase, kernel, work, (items + in_group - 1) / in_group);
}

static uint32_t tiles_touched(const WorkBlock *work, uint32_t side)
{
    uint32_t tiles = 1;
    for (int i = 0; i < 2; i++)
        tiles *= (work->corner[i] + work->extent[i] - 1) / side - work->corner[i] / side + 1;
    return tiles;
}

/* Beams of all tiles, counted in the whole picture, that the band has a part of. */
static bool march_beams(Job *job, WorkBlock *work)
{
    static const struct { uint32_t phase, side; } sizes[] = {{TRACE_BEAMS_32, 32},
                                                             {TRACE_BEAMS_8, 8}};
    ControlBlock *control = job->rendering->control.bytes;
    Dealing       deal = dealing(job);
    control->source = ITEMS_FRESH;
    deal.share = deal.share < 8 ? deal.share : 8;
    deal.steps = deal.share * MOST_BEAM_STEPS; /* none is saved */
    for (int i = 0; i < 2; i++) {
        control->phase = sizes[i].phase;
        if (!run_items(job, KRS_PHASE_BEAMS, job->trace, work, tiles_touched(work, sizes[i].side),
                       deal))
            return false;
        control->follow = 1;
    }
    return true;
}

/* First every pixel of the band, until all have been begun; then, pass by pass, the rays that
   are not done. */
static bool trace(Job *job, WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    Dealing       deal = dealing(job);
    uint32_t      pixels = work->extent[0] * work->extent[1];
    uint32_t      items = deal.side * deal.side;
    for (int i = 0; i < 2; i++)
        items *= (work->extent[i] + deal.side - 1) / deal.side;
    control->phase = TRACE_RAYS;
    control->source = ITEMS_FRESH;
    control->queued = control->writing = 0;
    for (double left = job->share;; left -= job->share) {
        control->left = 0;
        job->share = 0.9 * left; /* few rays need a second pass */
        if (!run_items(job, KRS_PHASE_PRIMARY, job->trace, work, items, deal))
            return false;
        job->done += job->share;
        if (control->left > 0) {
            control->source = ITEMS_REST;
            continue;
        }
        if (control->queued == 0)
            return true;
        control->source = ITEMS_QUEUED;
        items = control->queued;
        control->queued = 0;
        control->reading = control->writing;
        control->writing = pixels - control->reading;
        deal.share = 1;
        deal.steps = job->options.steps_at_once;
    }
}

/* A phase of secondary.comp, about the pixels that see something. */
static bool look_around(Job *job, KrsPhase phase, uint32_t secondary, WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    Dealing       deal = dealing(job);
    deal.steps = MOST_TURNS;
    while (deal.share > 8 && control->solid / (deal.lanes * deal.share) < 64)
        deal.share /= 2; /* groups enough for every core of the device */
    control->phase = secondary;
    control->source = ITEMS_FRESH;
    do {
        control->left = 0;
        if (!run_items(job, phase, job->secondary, work, control->solid, deal))
            return false;
        control->source = ITEMS_REST;
    } while (control->left > 0);
    return true;
}

static bool light_up(Job *job, WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    job->share /= (double)job->view.light_count;
    for (size_t i = 0; i < job->view.light_count; i++, job->done += job->share) {
        control->light = (uint32_t)i;
        if (!look_around(job, KRS_PHASE_SHADOWS, SECONDARY_SHADOW, work))
            return false;
        control->phase = SHADE_ONE_LIGHT;
        if (!run_all(job, KRS_PHASE_SHADING, &job->rendering->renderer->shade, work,
                     control->solid))
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

/* The steps from rays to light, and their shares of the time, about. */
typedef enum Step {
    STEP_TRACE, STEP_BACKGROUND, STEP_NORMALS, STEP_MATERIAL, STEP_OCCLUSION, STEP_LIGHTS,
    STEP_FINISH, STEP_COUNT
} Step;
static const double step_share[STEP_COUNT] = {0.5, 0.02, 0.1, 0.03, 0.1, 0.22, 0.03};

static bool run_step(Job *job, Step step, WorkBlock *work)
{
    KrsRendering *r = job->rendering;
    ControlBlock *control = r->control.bytes;
    uint32_t      pixels = work->extent[0] * work->extent[1];
    switch (step) {
    case STEP_TRACE:
        return trace(job, work);
    case STEP_BACKGROUND:
        control->solid = 0;
        return run_all(job, KRS_PHASE_RESOLVE, &r->renderer->background, work, pixels);
    case STEP_NORMALS:
        return look_around(job, KRS_PHASE_NORMALS, SECONDARY_NORMALS, work);
    case STEP_MATERIAL:
        return run_all(job, KRS_PHASE_SHADING, &r->material, work, control->solid);
    case STEP_OCCLUSION:
        return look_around(job, KRS_PHASE_OCCLUSION, SECONDARY_OCCLUSION, work);
    case STEP_LIGHTS:
        return light_up(job, work);
    case STEP_FINISH:
        control->phase = SHADE_FINISH;
        return run_all(job, KRS_PHASE_RESOLVE, &r->renderer->shade, work, control->solid);
    case STEP_COUNT: break;
    }
    return false;
}

/* One ray of every pixel of the band; `done` and `share` of the job are its own. */
static bool render_ray(Job *job, WorkBlock *work, uint32_t index)
{
    const double  whole = job->share;
    ControlBlock *control = job->rendering->control.bytes;
    place_ray(index, job->options.seed, work->offset);
    control->ray = index;
    control->first_ray = index == 0;
    control->follow = 0;
    job->share = 0; /* too short to be seen */
    if (!job->options.no_beams && job->view.camera.projection != KRS_PANORAMA &&
        !march_beams(job, work))
        return false;
    double done = job->done;
    for (Step step = 0; step < STEP_COUNT; done += whole * step_share[step], step++) {
        job->done = done;
        job->share = whole * step_share[step];
        if (!run_step(job, step, work))
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

/* Where nothing is hit, most of a pixel stays zero. */
static bool clear_results(Job *job)
{
    double ms = 0;
    if (!gpu_begin(job->gpu))
        return false;
    vkCmdFillBuffer(job->gpu->commands, job->rendering->band.results.buffer, 0, VK_WHOLE_SIZE, 0);
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
    *control = (ControlBlock){
        .projection = (uint32_t)job->view.camera.projection,
        .lights = (uint32_t)job->view.light_count,
        .shadows = job->options.shadows,
    };
    if (!clear_results(job))
        return false;
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
    Kernel       *kernels[] = {job->trace, job->secondary, &r->material, &r->renderer->background,
                               &r->renderer->shade};
    WorkBlock     work = {.groups = 1, .stride = 1};
    double        start = clock_ms(), ms = 0;
    *(ControlBlock *)r->control.bytes = (ControlBlock){.share = 1};
    for (size_t i = 0; i < sizeof kernels / sizeof kernels[0]; i++) {
        if (kernels[i]->warm)
            continue;
        if (!gpu_begin(job->gpu))
            return false;
        rendering_dispatch(r, kernels[i], r->band_set, &work, sizeof work, 1);
        if (!gpu_finish(job->gpu, &ms))
            return false;
        kernels[i]->warm = true;
        r->pipeline_ms += clock_ms() - start;
        start = clock_ms();
    }
    return true;
}

static bool render(Job *job)
{
    const KrsWindow *window = &job->options.crop;
    uint32_t         rows = make_room(job);
    job->trace = rendering_trace(job->rendering, job->options.trace, job->options.schedule);
    job->secondary = rendering_secondary(job->rendering, job->options.schedule);
    if (rows == 0 || !job->trace || !job->secondary || !warm_up(job))
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
