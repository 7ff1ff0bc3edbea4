/*
 * refine.c: the pictures of a view: a coarse one, in time for the next frame; then all pixels; then more and more samples.
 *
 * Coarse pictures are not interrupted by a change, unless they take far too long: while something
 * moves, each is shown.  Whole ones are interrupted at once, though what the device has begun must
 * end first.  So none is begun while the next change is to be expected at any moment.
 */
#include "live/pictures/painting.h"

#include <math.h>
#include <stdlib.h>

/* The time for which the next view is waited for while something moves. */
#define QUIET_MS 30.0
/* Samples are added in portions that take about this long. */
#define PORTION_MS 400.0
/* The part of the time that compilers are expected to take, or have taken, that lanes take while
   compilers need all processors.  Coarse pictures of what moves are not counted. */
#define LANES_PART 4

/* Takes the progress of a picture: shaders that take over wait for it, unless that takes long. */
bool painter_report_progress(void *user, double done)
{
    Painter     *painter = user;
    const double ms      = painter_now() - painter->begun;
    (void)done;
    if (painter->making == FILM_COARSE)
        return !painter_is_outdated(painter) || ms < painter->grace;
    return !painter_is_outdated(painter) || (atomic_load(&painter->number) == painter->shown &&
                                             painter_lanes_draw(painter) && ms < PORTION_MS);
}

/* Hands a picture of the scene to whoever shows it. */
static KrsStatus publish(Painter *painter, FilmKind kind, double ms)
{
    const uint32_t samples = canvas_samples(painter->drawing, kind);
    KrsPicture    *picture = NULL;
    KrsStatus      status  = canvas_read(painter->drawing, kind, samples == 1 ? 0 : KRS_AOV_COLOR,
                                         &picture);
    if (status != KRS_OK)
        return status;
    painter_order_shaders(painter, &painter->view);
    Shot shot   = {.width   = picture->width,
                   .height  = picture->height,
                   .samples = samples,
                   .whole   = kind == FILM_FULL,
                   .view    = painter->shown,
                   .version = version_number(painter->view.version),
                   .ms      = ms,
                   .stats   = picture->stats};
    shot.pixels = malloc((size_t)shot.width * shot.height * 4);
    if (!shot.pixels) {
        krs_picture_free(picture);
        return KRS_OUT_OF_MEMORY;
    }
    if (painter->view.shading == SHADING_LIGHT)
        krs_picture_to_srgb8(picture, version_scene(painter->view.version), painter->view.stops, 4,
                             shot.pixels);
    else {
        float *slopes = painter->view.shading == SHADING_SLOPE
                            ? canvas_slopes(painter->drawing, picture)
                            : NULL;
        false_color(picture, painter->view.shading, slopes, shot.pixels);
        free(slopes);
    }
    pthread_mutex_lock(&painter->lock);
    free(painter->shot.pixels);
    painter->shot          = shot;
    painter->state.version = version_number(painter->view.version);
    if (samples == 1) {
        KrsPicture *old = painter->aovs;
        painter->aovs   = picture;
        picture         = old;
    }
    pthread_mutex_unlock(&painter->lock);
    krs_picture_free(picture);
    painter->seen         = painter->shown;
    painter->seen_samples = kind == FILM_FULL ? samples : 0;
    painter_wake(painter);
    return KRS_OK;
}

static Resolution *resolution_of(Painter *painter)
{
    return &painter->resolutions[painter_lanes_draw(painter)];
}

static void learn_cost(Painter *painter, FilmKind kind, double ms, double pixels)
{
    if (kind == FILM_FULL)
        resolution_learn_whole(resolution_of(painter), ms, pixels);
    else
        resolution_learn_coarse(resolution_of(painter), ms, pixels);
}

/* Tells whether there is a picture of the view with more samples, by who drew before. */
static bool is_behind(const Painter *painter, uint32_t samples)
{
    return painter->seen == painter->shown && samples < painter->seen_samples;
}

/* Adds samples and shows them. */
static KrsStatus make(Painter *painter, FilmKind kind, uint32_t width, uint32_t height,
                      uint32_t samples, bool again)
{
    painter->making  = kind;
    painter->begun   = painter_now();
    KrsStatus status = canvas_add(painter->drawing, kind, &painter->view, width, height, samples,
                                  again, painter_report_progress, painter);
    if (status != KRS_OK)
        return status;
    const double ms = painter_now() - painter->begun;
    learn_cost(painter, kind, ms / samples, (double)width * height);
    return is_behind(painter, canvas_samples(painter->drawing, kind)) ? KRS_OK
                                                                      : publish(painter, kind, ms);
}

uint32_t painter_divide(uint32_t side, double divisor)
{
    const double less = floor(side / divisor);
    return less < 1 ? 1 : (uint32_t)less;
}

static KrsStatus show_coarse(Painter *painter)
{
    const uint32_t width = painter->view.width, height = painter->view.height;
    const double   divisor = resolution_divide(resolution_of(painter), (double)width * height,
                                               painter->options.budget);
    if (divisor <= 1)
        return KRS_OK;
    painter->grace = TIMEOUT * painter->options.budget;
    return make(painter, FILM_COARSE, painter_divide(width, divisor),
                painter_divide(height, divisor), 1, true);
}

/* Tells whether lanes draw what shaders are compiled for. */
static bool lanes_are_early(const Painter *painter)
{
    return painter_lanes_draw(painter) && builder_state(painter->builder).building;
}

/* Makes the finest picture that lanes have time for, where that is worth it. */
static KrsStatus show_finer(Painter *painter)
{
    const Estimate *estimate = &painter->lanes.estimate;
    const double    divisor  = sqrt(LANES_PART * estimate->lanes_ms / estimate->compiler_ms);
    if (!lanes_are_early(painter) || divisor <= 1 ||
        1.3 * divisor > painter->resolutions[1].divisor || painter->seen != painter->shown ||
        painter->seen_samples > 0)
        return KRS_OK;
    painter->grace = 0;
    return make(painter, FILM_COARSE, painter_divide(painter->view.width, divisor),
                painter_divide(painter->view.height, divisor), 1, true);
}

/* Returns for how many milliseconds lanes leave the processors to compilers, before they make so many samples of all
   pixels. */
static double find_pause(const Painter *painter, uint32_t samples)
{
    const Estimate *estimate = &painter->lanes.estimate;
    const double    ms       = LANES_PART * samples * estimate->lanes_ms;
    return lanes_are_early(painter) && ms > estimate->compiler_ms
               ? fmax(painter->ordered_at + ms - painter_now(), 0)
               : 0;
}

/* Returns how many samples take about as long as it may be until the picture is seen to improve. */
static uint32_t choose_portion(Painter *painter, uint32_t missing)
{
    const double ms      = resolution_of(painter)->whole_ms;
    const double portion = ms > 0 ? fmin(fmax(PORTION_MS / ms, 1), 64) : 1;
    return portion < missing ? (uint32_t)portion : missing;
}

/* Waits for the next view, or for shaders, but not for more milliseconds than these. */
static void wait_for_news(Painter *painter, double ms)
{
    const double          until = painter_now() + ms;
    const struct timespec limit = {(time_t)(until / 1e3), (long)(fmod(until, 1e3) * 1e6)};
    pthread_mutex_lock(&painter->lock);
    while (!painter->quit && !painter_is_outdated(painter) && painter_now() < until)
        pthread_cond_clockwait(&painter->changed, &painter->lock, CLOCK_MONOTONIC, &limit);
    pthread_mutex_unlock(&painter->lock);
}

uint32_t painter_samples(const Painter *painter)
{
    return painter->filmed == painter->shown && painter->filmed_by == painter->drawing
               ? canvas_samples(painter->drawing, FILM_FULL)
               : 0;
}

/* Adds samples to the picture with all pixels. */
static KrsStatus refine(Painter *painter, uint32_t samples)
{
    const View     *view   = &painter->view;
    const KrsStatus status = make(
        painter, FILM_FULL, view->width, view->height,
        samples == 0 ? 1 : choose_portion(painter, view->samples - samples), samples == 0);
    painter->filmed    = painter->shown;
    painter->filmed_by = painter->drawing;
    return status;
}

KrsStatus painter_refine(Painter *painter)
{
    KrsStatus status = KRS_OK;
    if (painter->seen != painter->shown) {
        painter->filmed = 0;
        status          = show_coarse(painter);
        wait_for_news(painter, painter->moving ? QUIET_MS : 0);
    }
    if (status == KRS_OK && !painter_is_outdated(painter))
        status = show_finer(painter);
    while (status == KRS_OK && !painter_is_outdated(painter)) {
        const uint32_t samples = painter_samples(painter);
        /* Other shading modes are of the first sample. */
        if (samples >= (painter->view.shading == SHADING_LIGHT ? painter->view.samples : 1))
            break;
        const double pause = find_pause(painter, samples + 1);
        if (pause > 0)
            wait_for_news(painter, pause);
        else
            status = refine(painter, samples);
    }
    return status == KRS_INTERRUPTED ? KRS_OK : status;
}
