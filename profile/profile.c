/*
 * profile.c: times frames with and without each part.
 */
#include "profile/profile.h"

#include <math.h>
#include <string.h>

#include "compiler/base/clock.h"
#include "compiler/passes/compile.h"
#include "profile/pixels.h"
#include "profile/rows.h"

/* A scene that is rendered. */
typedef struct Subject {
    const KrsScene *scene;
    KrsState       *state;
    KrsRendering   *rendering;
    KrsFilm        *film;
    KrsCamera       camera;
} Subject;

typedef struct Profiling {
    const ProfileOptions *options;
    const KrsScene       *scene;
    Arena                *arena;
    Profile              *profile;
    Parts                 parts;
    PartProfile          *found; /* of each part */
    KrsScene **without; /* the scene without it, once it is compiled and until it is timed */
    Pixels     pixels;
    Subject    whole;
    double     started;
    KrsStatus  status;
    bool       lanes; /* no shaders are made of the scene: then none are of it without a part */
} Profiling;

/* Milliseconds of a frame: of rays from the camera, and of the light of what they hit; and how many hit something. */
typedef struct FrameTime {
    double rays, light;
    size_t hits;
} FrameTime;

static double elapsed(const Profiling *p) { return clock_seconds(CLOCK_MONOTONIC) - p->started; }

/* Tells whether the work goes on; false: someone has asked to stop. */
static bool report_progress(Profiling *p)
{
    const ProfileOptions *options = p->options;
    if (options->progress &&
        !options->progress(options->user, fmin(elapsed(p) / options->seconds, 1)))
        p->status = KRS_INTERRUPTED;
    return p->status == KRS_OK;
}

/* ---- what is rendered ---- */

static void close_subject(Subject *subject)
{
    krs_film_free(subject->film);
    krs_rendering_free(subject->rendering);
    krs_state_free(subject->state);
    *subject = (Subject){0};
}

static KrsStatus open_film(const Profiling *p, Subject *subject, uint32_t width, uint32_t height)
{
    KrsRenderOptions how = p->options->how;
    if (p->lanes)
        how.methods.executor = KRS_EXECUTOR_LANES;
    krs_film_free(subject->film);
    subject->film = NULL;
    how.width     = width;
    how.height    = height;
    how.samples   = 1;
    how.aovs      = KRS_AOV_COLOR | KRS_AOV_DEPTH;
    return krs_film_new(subject->rendering, &how, &subject->film);
}

static KrsStatus open_subject(const Profiling *p, const KrsScene *scene, Subject *subject)
{
    const ProfileOptions *options = p->options;
    KrsStatus             status  = options->state(options->user, scene, &subject->state);
    subject->scene                = scene;
    if (status == KRS_OK)
        status = krs_rendering_new(options->renderer, scene,
                                   p->lanes ? KRS_FOR_LANES : options->purpose,
                                   &subject->rendering);
    if (status == KRS_OK)
        status = krs_state_camera(subject->state, options->how.camera, &subject->camera);
    if (status == KRS_OK && p->profile->width > 0)
        status = open_film(p, subject, p->profile->width, p->profile->height);
    return status;
}

/* Returns the times of a frame; a time of processors is divided as the other is. */
static FrameTime frame_time(const KrsPicture *picture, double processor_ms)
{
    const KrsRenderStats *stats = &picture->stats;
    const double          scale = processor_ms > 0 ? processor_ms / fmax(stats->total_ms, 1e-9) : 1;
    const double rays = stats->phase_ms[KRS_PHASE_BEAMS] + stats->phase_ms[KRS_PHASE_PRIMARY] +
                        stats->phase_ms[KRS_PHASE_RESOLVE];
    FrameTime time = {scale * rays, scale * (stats->total_ms - rays), 0};
    for (size_t i = 0; i < (size_t)picture->width * picture->height; i++)
        time.hits += isfinite(picture->depth[i]);
    return time;
}

/* Renders a frame from the camera of the whole scene; the picture is the caller's, unless `picture` is NULL. */
static KrsStatus time_frame(const Profiling *p, Subject *subject, FrameTime *time,
                            KrsPicture **picture)
{
    const KrsCamera *camera = p->options->camera ? p->options->camera : &p->whole.camera;
    KrsPicture      *made   = NULL;
    krs_film_clear(subject->film);
    const double begun     = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    KrsStatus    status    = krs_film_add(subject->film, subject->state, camera, 1);
    const double processor = 1e3 * (clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - begun);
    if (status == KRS_OK)
        status = krs_film_read(subject->film, KRS_AOV_COLOR | KRS_AOV_DEPTH, &made);
    if (status == KRS_OK)
        *time = frame_time(made, p->profile->of_processors ? processor : 0);
    if (picture)
        *picture = made;
    else
        krs_picture_free(made);
    return status;
}

/* ---- times ---- */

enum { MIN_ROUNDS = 2, MAX_ROUNDS = 15 };
/* The time that the rounds of a part take about, and the shortest frame that is timed, in
   milliseconds. */
static const double ROUNDS_MS = 1500, MIN_FRAME_MS = 25;

/* Keeps the least time, of rays and of light: what else a machine does makes frames slower, never
   faster. */
static void take_least(FrameTime *least, const FrameTime *time, bool first)
{
    least->rays  = first ? time->rays : fmin(least->rays, time->rays);
    least->light = first ? time->light : fmin(least->light, time->light);
    least->hits  = time->hits;
}

static size_t count_rounds(double ms)
{
    return (size_t)fmin(fmax(ROUNDS_MS / fmax(ms, 1e-3), MIN_ROUNDS), MAX_ROUNDS);
}

/* Times frames of the whole scene; the first one prepares. */
static KrsStatus time_whole(Profiling *p)
{
    FrameTime time = {0}, least = {0};
    KrsStatus status = open_film(p, &p->whole, p->profile->width, p->profile->height);
    if (status == KRS_OK)
        status = time_frame(p, &p->whole, &time, NULL);
    const size_t count = count_rounds(time.rays + time.light);
    for (size_t i = 0; i < count && status == KRS_OK; i++) {
        status = time_frame(p, &p->whole, &time, NULL);
        take_least(&least, &time, i == 0);
    }
    p->profile->frame_ms = least.rays + least.light;
    return status;
}

/* Chooses a picture that is large enough. */
static KrsStatus choose_size(Profiling *p)
{
    enum { FIRST_WIDTH = 80, LAST_WIDTH = 1280 };
    Profile                *profile = p->profile;
    const KrsRenderOptions *how     = &p->options->how;
    profile->width                  = how->width > 0 ? how->width : FIRST_WIDTH;
    for (;; profile->width *= 2) {
        profile->height        = how->width > 0 ? how->height
                                                : (uint32_t)fmax(1, profile->width / p->options->aspect);
        const KrsStatus status = time_whole(p);
        if (status != KRS_OK || how->width > 0 || profile->frame_ms >= MIN_FRAME_MS ||
            profile->width >= LAST_WIDTH)
            return status;
    }
}

/* Returns the share that a part saves, as if light had hit as many pixels. */
static double share_saved(const FrameTime *whole, const FrameTime *without)
{
    const double hits  = without->hits > 0 ? (double)whole->hits / (double)without->hits : 1;
    const double frame = without->rays + without->light * hits;
    return 1 - frame / fmax(whole->rays + whole->light, 1e-9);
}

/* Renders both by turns, so that a machine that gets slower does so for both, and finds which share of the time of the
   whole is saved.  The picture is the caller's. */
static KrsStatus compare(Profiling *p, Subject *subject, double *saved, KrsPicture **picture)
{
    FrameTime time, whole = {0}, without = {0};
    KrsStatus status = time_frame(p, subject, &time, picture);
    if (status != KRS_OK)
        return status;
    const size_t count = count_rounds(p->profile->frame_ms + time.rays + time.light);
    for (size_t i = 0; i < count && status == KRS_OK; i++) {
        status = time_frame(p, &p->whole, &time, NULL);
        if (status == KRS_OK)
            take_least(&whole, &time, i == 0);
        if (status == KRS_OK)
            status = time_frame(p, subject, &time, NULL);
        if (status == KRS_OK)
            take_least(&without, &time, i == 0);
    }
    p->profile->frame_ms = fmin(p->profile->frame_ms, whole.rays + whole.light);
    *saved               = share_saved(&whole, &without);
    return status;
}

/* ---- parts ---- */

static PartCost cost_of(const KrsScene *scene)
{
    const KrsProgram *program = krs_scene_program(scene);
    return (PartCost){program->flops, (double)program->operations, (double)program->glsl_length};
}

/* Compiles the scene without a part, and finds what the part adds.  One without which there is no scene costs
   nothing by itself. */
static void compile_without(Profiling *p, size_t index)
{
    const ProfileOptions *options = p->options;
    PartProfile          *found   = &p->found[index];
    found->compiled               = true;
    if (options->compile(options->user, &p->parts.items[index].location, &p->without[index]) !=
        KRS_OK)
        return;
    const PartCost rest = cost_of(p->without[index]), *whole = &p->profile->whole;
    found->cost.flops      = fmax(whole->flops - rest.flops, 0);
    found->cost.operations = fmax(whole->operations - rest.operations, 0);
    found->cost.glsl_bytes = fmax(whole->glsl_bytes - rest.glsl_bytes, 0);
}

static void time_part(Profiling *p, size_t index)
{
    PartProfile *found   = &p->found[index];
    Subject      subject = {0};
    KrsPicture  *picture = NULL;
    double       saved   = 0;
    p->status            = open_subject(p, p->without[index], &subject);
    if (p->status == KRS_OK)
        p->status = compare(p, &subject, &saved, &picture);
    if (p->status == KRS_OK)
        pixels_take(&p->pixels, p->profile->picture, picture, index);
    krs_picture_free(picture);
    close_subject(&subject);
    krs_scene_free(p->without[index]);
    p->without[index] = NULL;
    found->timed      = true;
    found->saved      = saved;
    p->profile->timed++;
}

static bool is_operand_of(const Profiling *p, size_t index, size_t parent)
{
    return p->parts.items[index].parent == parent && !p->parts.items[index].shared;
}

/* Finds the only part without which all of the one around it is gone.  Such parts are not timed; NO_PART: there is none,
   or are several. */
static size_t find_heir(Profiling *p, size_t parent)
{
    const double all   = 0.999999 * p->found[parent].cost.flops;
    size_t       count = 0, heir = NO_PART;
    for (size_t i = parent + 1; i < p->parts.count && all > 0; i++)
        if (is_operand_of(p, i, parent) && p->without[i] && p->found[i].cost.flops >= all) {
            krs_scene_free(p->without[i]);
            p->without[i] = NULL;
            heir          = i;
            count++;
        }
    if (count != 1)
        return NO_PART;
    for (size_t i = parent + 1; i < p->parts.count; i++)
        if (is_operand_of(p, i, parent) && i != heir)
            part_cost_subtract(&p->found[heir].cost, &p->found[i].cost);
    p->found[heir].heir = true;
    return heir;
}

/* Computes what heirs save: what parts around them do, less what their other parts do. */
static void settle_heirs(Profiling *p)
{
    for (size_t i = 0; i < p->parts.count; i++) {
        const size_t parent = p->parts.items[i].parent;
        PartProfile *found  = &p->found[i];
        if (!found->heir)
            continue;
        found->timed = p->found[parent].timed;
        found->saved = p->found[parent].saved;
        for (size_t k = parent + 1; k < p->parts.count; k++)
            if (is_operand_of(p, k, parent) && k != i && p->found[k].timed)
                found->saved -= fmax(p->found[k].saved, 0);
    }
}

/* Opens a part, or the scene: the parts in it get what they are expected to cost, by their operations.  Compilers
   take a third of the time that is left, at most. */
static void open_part(Profiling *p, size_t parent, double share)
{
    const double end = (2 * elapsed(p) + p->options->seconds) / 3;
    double       sum = 0;
    for (size_t i = 0; i < p->parts.count; i++)
        p->found[i].asked = p->found[i].asked || p->parts.items[i].parent == parent;
    for (size_t i = 0; i < p->parts.count && elapsed(p) < end && report_progress(p); i++)
        if (p->parts.items[i].parent == parent) {
            compile_without(p, i);
            sum += p->found[i].cost.flops;
        }
    for (size_t i = 0; i < p->parts.count; i++)
        if (p->parts.items[i].parent == parent && p->without[i])
            p->found[i].expected = sum > 0 ? share * p->found[i].cost.flops / sum : 0;
    const size_t heir = parent == NO_PART ? NO_PART : find_heir(p, parent);
    if (heir != NO_PART)
        open_part(p, heir, share * p->found[heir].cost.flops / p->found[parent].cost.flops);
}

/* Parts in another one are not timed where their operations are less of all than that; what is shown always is, since
   it may cost light. */
static const double MIN_FLOPS = 0.01;

static bool is_worth_timing(const Profiling *p, size_t index)
{
    return p->without[index] && (p->parts.items[index].parent == NO_PART ||
                                 p->found[index].cost.flops >= MIN_FLOPS * p->profile->whole.flops);
}

static size_t next_part(const Profiling *p)
{
    size_t best = NO_PART;
    for (size_t i = 0; i < p->parts.count; i++)
        if (is_worth_timing(p, i) &&
            (best == NO_PART || p->found[i].expected > p->found[best].expected))
            best = i;
    return best;
}

static void time_parts(Profiling *p)
{
    open_part(p, NO_PART, 1);
    while (elapsed(p) < p->options->seconds && report_progress(p)) {
        const size_t next = next_part(p);
        if (next == NO_PART)
            break;
        time_part(p, next);
        if (p->found[next].saved >= 2 * PROFILE_MIN)
            open_part(p, next, p->found[next].saved);
    }
    settle_heirs(p);
    for (size_t i = 0; i < p->parts.count; i++)
        p->found[i].ms = p->found[i].saved * p->profile->frame_ms;
    for (size_t i = 0; i < p->parts.count; i++)
        p->profile->untimed += p->found[i].asked &&
                               (!p->found[i].compiled || is_worth_timing(p, i));
}

KrsStatus profile_make(const ProfileOptions *options, const KrsScene *scene, Arena *arena,
                       Profile *profile)
{
    FrameTime time;
    Profiling p = {.options = options, .scene = scene, .arena = arena, .profile = profile};
    *profile    = (Profile){.whole         = cost_of(scene),
                            .of_processors = options->alone &&
                                             krs_renderer_device(options->renderer).kind ==
                                                 KRS_DEVICE_CPU};
    p.started   = clock_seconds(CLOCK_MONOTONIC);
    p.lanes     = krs_scene_too_large(scene) != NULL;
    p.parts     = parts_of(scene, arena);
    p.found     = arena_new_array(arena, PartProfile, p.parts.count + 1);
    p.without   = arena_new_array(arena, KrsScene *, p.parts.count + 1);
    p.status    = open_subject(&p, scene, &p.whole);
    if (p.status == KRS_OK)
        p.status = choose_size(&p);
    if (p.status == KRS_OK)
        p.status = time_frame(&p, &p.whole, &time, &profile->picture);
    if (p.status == KRS_OK) {
        p.pixels = pixels_new((size_t)profile->width * profile->height, &p.parts, arena);
        time_parts(&p);
    }
    close_subject(&p.whole);
    for (size_t i = 0; i < p.parts.count; i++)
        krs_scene_free(p.without[i]);
    if (p.status != KRS_OK) {
        profile_free(profile);
        return p.status;
    }
    profile_rows(&p.parts, p.found, arena, profile);
    profile->row_of = pixels_rows(&p.pixels, &p.parts, p.found, profile, arena);
    return KRS_OK;
}

void profile_free(Profile *profile)
{
    krs_picture_free(profile->picture);
    profile->picture = NULL;
}
