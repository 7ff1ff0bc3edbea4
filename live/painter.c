/*
 * painter.c: a thread that makes pictures of what is to be seen.
 *
 * Coarse pictures are not interrupted by a change, unless they take far too long: while something
 * moves, each is shown.  Whole ones are interrupted at once.
 */
#include "live/painter.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* A coarse picture is interrupted after so many times its budget. */
#define PATIENCE 6
/* Samples are added in portions that take about this long. */
#define PORTION_MS 400.0

struct Painter {
    PainterOptions  options;
    pthread_t       thread;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t  changed;
    bool            quit;
    double          budget;
    View            wanted;
    Shot            shot; /* not taken yet; without pixels: none */
    KrsPicture     *planes;
    PainterState    state;
    atomic_uint     number; /* of the wanted view */
    /* of the thread alone */
    Canvas  *canvas;
    View     view;
    unsigned shown;                  /* number of `view` */
    double   ms_per_pixel, fixed_ms; /* what a picture costs; 0: not known yet */
    double   divisor;                /* of the sides of coarse pictures */
    bool     fresh;                  /* the next picture also waits for shaders */
    double   begun;                  /* when the picture that is being made was begun */
    FilmKind making;
};

static double now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

static void wake(const Painter *painter)
{
    if (painter->options.wake)
        painter->options.wake(painter->options.user);
}

/* ---- what others may ask ---- */

unsigned painter_show(Painter *painter, const View *view)
{
    View copy, old;
    if (!view_copy(view, &copy))
        return atomic_load(&painter->number);
    pthread_mutex_lock(&painter->lock);
    old             = painter->wanted;
    painter->wanted = copy;
    unsigned number = atomic_fetch_add(&painter->number, 1) + 1;
    pthread_cond_signal(&painter->changed);
    pthread_mutex_unlock(&painter->lock);
    view_free(&old);
    return number;
}

void painter_set_budget(Painter *painter, double ms)
{
    pthread_mutex_lock(&painter->lock);
    painter->budget = ms;
    pthread_mutex_unlock(&painter->lock);
}

bool painter_take(Painter *painter, Shot *shot)
{
    pthread_mutex_lock(&painter->lock);
    *shot                = painter->shot;
    painter->shot.pixels = NULL;
    pthread_mutex_unlock(&painter->lock);
    return shot->pixels != NULL;
}

Found painter_find(Painter *painter, double x, double y)
{
    Found found = {0};
    pthread_mutex_lock(&painter->lock);
    const KrsPicture *planes = painter->planes;
    if (planes && x >= 0 && x < 1 && y >= 0 && y < 1) {
        const size_t at = (size_t)(y * planes->height) * planes->width +
                          (size_t)(x * planes->width);
        found = (Found){.hit       = planes->component[at] != 0,
                        .depth     = planes->depth[at],
                        .component = planes->component[at],
                        .level     = planes->level[at],
                        .instance  = planes->instance[at],
                        .steps     = planes->steps[at]};
        for (int i = 0; i < 3; i++) {
            found.position[i] = planes->position[3 * at + i];
            found.normal[i]   = planes->normal[3 * at + i];
        }
    }
    pthread_mutex_unlock(&painter->lock);
    return found;
}

PainterState painter_state(Painter *painter)
{
    pthread_mutex_lock(&painter->lock);
    PainterState state = painter->state;
    pthread_mutex_unlock(&painter->lock);
    return state;
}

/* ---- the thread ---- */

static void say_doing(Painter *painter, bool compiling, bool busy)
{
    pthread_mutex_lock(&painter->lock);
    const bool news          = painter->state.compiling != compiling;
    painter->state.compiling = compiling;
    painter->state.busy      = busy;
    pthread_mutex_unlock(&painter->lock);
    if (news)
        wake(painter);
}

static void say_failed(Painter *painter, KrsStatus status)
{
    pthread_mutex_lock(&painter->lock);
    painter->state.status = status;
    snprintf(painter->state.message, sizeof painter->state.message, "%s",
             canvas_message(painter->canvas));
    pthread_mutex_unlock(&painter->lock);
    wake(painter);
}

static bool is_outdated(const Painter *painter)
{
    return atomic_load(&painter->number) != painter->shown;
}

static bool go_on(void *user, double done)
{
    Painter *painter = user;
    (void)done;
    if (painter->making == FILM_FULL)
        return !is_outdated(painter);
    return !is_outdated(painter) || now_ms() - painter->begun < PATIENCE * painter->options.budget;
}

/* Hands a picture of the scene to whoever shows it. */
static KrsStatus publish(Painter *painter, FilmKind kind, double ms)
{
    const uint32_t samples = canvas_samples(painter->canvas, kind);
    KrsPicture    *picture = NULL;
    KrsStatus      status  = canvas_read(painter->canvas, kind, samples == 1 ? 0 : KRS_PLANE_COLOR,
                                         &picture);
    if (status != KRS_OK)
        return status;
    Shot shot   = {.width   = picture->width,
                   .height  = picture->height,
                   .samples = samples,
                   .whole   = kind == FILM_FULL,
                   .view    = painter->shown,
                   .ms      = ms,
                   .stats   = picture->stats};
    shot.pixels = malloc((size_t)shot.width * shot.height * 4);
    if (!shot.pixels) {
        krs_picture_free(picture);
        return KRS_OUT_OF_MEMORY;
    }
    if (painter->view.look == LOOK_LIGHT)
        krs_picture_to_srgb8(picture, version_scene(painter->view.version), painter->view.stops, 4,
                             shot.pixels);
    else
        false_color(picture, painter->view.look, shot.pixels);
    pthread_mutex_lock(&painter->lock);
    free(painter->shot.pixels);
    painter->shot          = shot;
    painter->state.version = version_number(painter->view.version);
    if (samples == 1) {
        KrsPicture *old = painter->planes;
        painter->planes = picture;
        picture         = old;
    }
    pthread_mutex_unlock(&painter->lock);
    krs_picture_free(picture);
    wake(painter);
    return KRS_OK;
}

/* A picture costs something even if it has few pixels: passes wait for each other.  Whole pictures
   tell what a pixel costs, coarse ones the rest. */
static void learn_cost(Painter *painter, FilmKind kind, double ms, double pixels)
{
    if (kind == FILM_FULL || painter->ms_per_pixel <= 0)
        painter->ms_per_pixel = ms / pixels;
    if (kind == FILM_COARSE)
        painter->fixed_ms = fmax(ms - pixels * painter->ms_per_pixel, 0);
}

/* Adds samples and shows them. */
static KrsStatus make(Painter *painter, FilmKind kind, uint32_t width, uint32_t height,
                      uint32_t samples, bool again)
{
    painter->making  = kind;
    painter->begun   = now_ms();
    KrsStatus status = canvas_add(painter->canvas, kind, &painter->view, width, height, samples,
                                  again, go_on, painter);
    if (status != KRS_OK)
        return status;
    const double ms = now_ms() - painter->begun;
    if (!painter->fresh)
        learn_cost(painter, kind, ms / samples, (double)width * height);
    painter->fresh = false;
    return publish(painter, kind, ms);
}

/* How many times fewer pixels each side of a coarse picture has, for it to be in time. */
static double choose_divisor(const Painter *painter)
{
    static const double steps[] = {1, 1.5, 2, 3, 4, 6, 8, 12, 16, 24, 32};
    const double        pixels  = (double)painter->view.width * painter->view.height;
    /* What pixels do not cause, fewer of them do not mend: they have half of the time in any case. */
    const double budget = painter->options.budget;
    const double left   = fmax(budget - painter->fixed_ms, budget / 2);
    const double needed = painter->ms_per_pixel > 0 ? sqrt(pixels * painter->ms_per_pixel / left)
                                                    : 8;
    /* It stays where it would do, so that the picture does not flicker. */
    if (painter->divisor > needed && painter->divisor < 2.2 * needed)
        return painter->divisor;
    size_t i = 0;
    while (i + 1 < sizeof steps / sizeof *steps && steps[i] < needed)
        i++;
    return steps[i];
}

static uint32_t divide(uint32_t side, double divisor)
{
    const double less = floor(side / divisor);
    return less < 1 ? 1 : (uint32_t)less;
}

static KrsStatus show_coarse(Painter *painter)
{
    painter->divisor = choose_divisor(painter);
    if (painter->divisor <= 1)
        return KRS_OK;
    return make(painter, FILM_COARSE, divide(painter->view.width, painter->divisor),
                divide(painter->view.height, painter->divisor), 1, true);
}

/* Samples that take about as long as it may be until the picture is seen to improve. */
static uint32_t choose_portion(const Painter *painter, uint32_t missing)
{
    const double ms      = painter->ms_per_pixel * painter->view.width * painter->view.height;
    const double portion = ms > 0 ? fmin(fmax(PORTION_MS / ms, 1), 64) : 1;
    return portion < missing ? (uint32_t)portion : missing;
}

/* Makes the picture of a new view, up to its last sample or until there is another one. */
static KrsStatus show_view(Painter *painter)
{
    const View *view   = &painter->view;
    KrsStatus   status = show_coarse(painter);
    if (status == KRS_OK && !is_outdated(painter))
        status = make(painter, FILM_FULL, view->width, view->height, 1, true);
    while (status == KRS_OK && !is_outdated(painter)) {
        const uint32_t samples = canvas_samples(painter->canvas, FILM_FULL);
        if (samples >= view->samples || view->look != LOOK_LIGHT)
            break; /* other looks are of the first sample */
        status = make(painter, FILM_FULL, view->width, view->height,
                      choose_portion(painter, view->samples - samples), false);
    }
    return status == KRS_INTERRUPTED ? KRS_OK : status;
}

static KrsStatus adopt(Painter *painter)
{
    if (painter->view.version == canvas_version(painter->canvas))
        return KRS_OK;
    const bool first = !canvas_version(painter->canvas);
    say_doing(painter, true, true);
    KrsStatus status = canvas_adopt(painter->canvas, painter->view.version,
                                    painter->view.integrator);
    painter->fresh   = first || version_changes(painter->view.version).kind == KRS_CHANGE_STRUCTURE;
    say_doing(painter, false, true);
    return status;
}

/* Waits for another view, and takes it.  False: that was the last one. */
static bool take_view(Painter *painter)
{
    View next;
    bool taken = false;
    pthread_mutex_lock(&painter->lock);
    painter->state.busy = false;
    while (!painter->quit && !is_outdated(painter))
        pthread_cond_wait(&painter->changed, &painter->lock);
    if (!painter->quit && view_copy(&painter->wanted, &next)) {
        view_free(&painter->view);
        painter->view           = next;
        painter->shown          = atomic_load(&painter->number);
        painter->options.budget = painter->budget;
        painter->state.busy     = true;
        taken                   = true;
    }
    pthread_mutex_unlock(&painter->lock);
    return taken;
}

static void set_values(Painter *painter)
{
    const bool refused = canvas_set(painter->canvas, &painter->view) != KRS_OK;
    pthread_mutex_lock(&painter->lock);
    painter->state.refused = refused;
    pthread_mutex_unlock(&painter->lock);
}

static void *paint(void *user)
{
    Painter  *painter = user;
    KrsStatus status  = canvas_new(&painter->options.renderer, &painter->canvas);
    while (status == KRS_OK && take_view(painter)) {
        status = adopt(painter);
        if (status != KRS_OK)
            break;
        set_values(painter);
        status = show_view(painter);
        wake(painter); /* it is idle now */
    }
    if (status != KRS_OK)
        say_failed(painter, status);
    return NULL;
}

Painter *painter_new(const PainterOptions *options)
{
    Painter *painter = calloc(1, sizeof *painter);
    if (!painter)
        return NULL;
    painter->options = *options;
    painter->budget  = options->budget;
    pthread_mutex_init(&painter->lock, NULL);
    pthread_cond_init(&painter->changed, NULL);
    atomic_init(&painter->number, 0);
    if (pthread_create(&painter->thread, NULL, paint, painter) == 0)
        return painter;
    free(painter);
    return NULL;
}

void painter_free(Painter *painter)
{
    if (!painter)
        return;
    pthread_mutex_lock(&painter->lock);
    painter->quit = true;
    atomic_fetch_add(&painter->number, 1);
    pthread_cond_signal(&painter->changed);
    pthread_mutex_unlock(&painter->lock);
    pthread_join(painter->thread, NULL);
    canvas_free(painter->canvas);
    view_free(&painter->view);
    view_free(&painter->wanted);
    free(painter->shot.pixels);
    krs_picture_free(painter->planes);
    pthread_mutex_destroy(&painter->lock);
    pthread_cond_destroy(&painter->changed);
    free(painter);
}
