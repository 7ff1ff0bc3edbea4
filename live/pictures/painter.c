/*
 * painter.c: a thread that makes pictures of what is to be seen.
 *
 * Whoever changes the text's structure waits for shaders; another thread compiles them (builder.h),
 * and until they are there the version before is shown, from wherever the camera is by then.
 *
 * Coarse pictures are not interrupted by a change, unless they take far too long: while something
 * moves, each is shown.  Whole ones are interrupted at once, though what the device has begun must
 * end first.  So none is begun while the next change is to be expected at any moment.
 */
#include "live/pictures/painter.h"

#include "live/pictures/builder.h"
#include "live/pictures/resolution.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* A coarse picture is interrupted after so many times its budget. */
#define TIMEOUT 6
/* Something moves if one view follows another so soon; then the next one is waited for. */
#define MOVING_MS 250.0
#define QUIET_MS  30.0
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
    KrsPicture     *aovs;
    PainterState    state;
    atomic_uint     number;   /* of the wanted view */
    atomic_bool     told;     /* the builder has something to say */
    atomic_bool     prepares; /* the builder's last order is for later */
    Builder        *builder;
    /* of the thread alone */
    Canvas    *canvas;
    View       view;
    unsigned   shown; /* number of `view` */
    Resolution resolution;
    double     changed_at; /* when the last view came */
    bool       moving;
    double     begun; /* when the picture that is being made was begun */
    FilmKind   making;
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

/* Tells whether there is something to do: another view, or news of the builder. */
static bool is_outdated(const Painter *painter)
{
    return atomic_load(&painter->number) != painter->shown || atomic_load(&painter->told);
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

bool painter_prepare(Painter *painter, const View *view)
{
    const Needs needs = view_needs(view);
    if (builder_has(painter->builder, &needs))
        return true;
    pthread_mutex_lock(&painter->lock);
    const bool builds = builder_state(painter->builder).building &&
                        !atomic_load(&painter->prepares); /* what is wanted now */
    if (!painter->state.busy && !is_outdated(painter) && !builds) {
        atomic_store(&painter->prepares, true);
        builder_start(painter->builder, view);
    }
    pthread_mutex_unlock(&painter->lock);
    return false;
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
    const KrsPicture *aovs = painter->aovs;
    if (aovs && x >= 0 && x < 1 && y >= 0 && y < 1) {
        const size_t at = (size_t)(y * aovs->height) * aovs->width + (size_t)(x * aovs->width);
        found           = (Found){.hit       = aovs->component[at] != 0,
                                  .depth     = aovs->depth[at],
                                  .component = aovs->component[at],
                                  .level     = aovs->level[at],
                                  .instance  = aovs->instance[at],
                                  .steps     = aovs->steps[at]};
        for (int i = 0; i < 3; i++) {
            found.position[i] = aovs->position[3 * at + i];
            found.normal[i]   = aovs->normal[3 * at + i];
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
    const BuilderState building = builder_state(painter->builder);
    const bool         later    = atomic_load(&painter->prepares);
    state.compiling             = building.building && !later;
    state.compiled              = building.done;
    snprintf(state.unbuilt, sizeof state.unbuilt, "%s",
             building.status == KRS_OK || later ? "" : building.message);
    return state;
}

/* ---- the thread ---- */

static void say_failed(Painter *painter, KrsStatus status, const char *message)
{
    pthread_mutex_lock(&painter->lock);
    painter->state.status = status;
    snprintf(painter->state.message, sizeof painter->state.message, "%s", message);
    pthread_mutex_unlock(&painter->lock);
    wake(painter);
}

static bool report_progress(void *user, double done)
{
    Painter *painter = user;
    (void)done;
    if (painter->making == FILM_FULL)
        return !is_outdated(painter);
    return !is_outdated(painter) || now_ms() - painter->begun < TIMEOUT * painter->options.budget;
}

/* Hands a picture of the scene to whoever shows it. */
static KrsStatus publish(Painter *painter, FilmKind kind, double ms)
{
    const uint32_t samples = canvas_samples(painter->canvas, kind);
    KrsPicture    *picture = NULL;
    KrsStatus      status  = canvas_read(painter->canvas, kind, samples == 1 ? 0 : KRS_AOV_COLOR,
                                         &picture);
    if (status != KRS_OK)
        return status;
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
                            ? canvas_slopes(painter->canvas, picture)
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
    wake(painter);
    return KRS_OK;
}

static void learn_cost(Painter *painter, FilmKind kind, double ms, double pixels)
{
    if (kind == FILM_FULL)
        resolution_learn_whole(&painter->resolution, ms, pixels);
    else
        resolution_learn_coarse(&painter->resolution, ms, pixels);
}

/* Adds samples and shows them. */
static KrsStatus make(Painter *painter, FilmKind kind, uint32_t width, uint32_t height,
                      uint32_t samples, bool again)
{
    painter->making  = kind;
    painter->begun   = now_ms();
    KrsStatus status = canvas_add(painter->canvas, kind, &painter->view, width, height, samples,
                                  again, report_progress, painter);
    if (status != KRS_OK)
        return status;
    const double ms = now_ms() - painter->begun;
    learn_cost(painter, kind, ms / samples, (double)width * height);
    return publish(painter, kind, ms);
}

static uint32_t divide(uint32_t side, double divisor)
{
    const double less = floor(side / divisor);
    return less < 1 ? 1 : (uint32_t)less;
}

static KrsStatus show_coarse(Painter *painter)
{
    const uint32_t width = painter->view.width, height = painter->view.height;
    const double   divisor = resolution_divide(&painter->resolution, (double)width * height,
                                               painter->options.budget);
    if (divisor <= 1)
        return KRS_OK;
    return make(painter, FILM_COARSE, divide(width, divisor), divide(height, divisor), 1, true);
}

/* Samples that take about as long as it may be until the picture is seen to improve. */
static uint32_t choose_portion(const Painter *painter, uint32_t missing)
{
    const double ms      = painter->resolution.whole_ms;
    const double portion = ms > 0 ? fmin(fmax(PORTION_MS / ms, 1), 64) : 1;
    return portion < missing ? (uint32_t)portion : missing;
}

/* Waits, while something moves, for the next view. */
static void wait_for_quiet(Painter *painter)
{
    const double          until = now_ms() + (painter->moving ? QUIET_MS : 0);
    const struct timespec limit = {(time_t)(until / 1e3), (long)(fmod(until, 1e3) * 1e6)};
    pthread_mutex_lock(&painter->lock);
    while (!painter->quit && !is_outdated(painter) && now_ms() < until)
        pthread_cond_clockwait(&painter->changed, &painter->lock, CLOCK_MONOTONIC, &limit);
    pthread_mutex_unlock(&painter->lock);
}

/* Makes the picture of a new view, up to its last sample or until there is another one. */
static KrsStatus show_view(Painter *painter)
{
    const View *view   = &painter->view;
    KrsStatus   status = show_coarse(painter);
    wait_for_quiet(painter);
    if (status == KRS_OK && !is_outdated(painter))
        status = make(painter, FILM_FULL, view->width, view->height, 1, true);
    while (status == KRS_OK && !is_outdated(painter)) {
        const uint32_t samples = canvas_samples(painter->canvas, FILM_FULL);
        if (samples >= view->samples || view->shading != SHADING_LIGHT)
            break; /* other shading modes are of the first sample */
        status = make(painter, FILM_FULL, view->width, view->height,
                      choose_portion(painter, view->samples - samples), false);
    }
    return status == KRS_INTERRUPTED ? KRS_OK : status;
}

/* ---- which canvas ---- */

/* Called in the builder's thread. */
static void hear_builder(void *user)
{
    Painter           *painter = user;
    const BuilderState state   = builder_state(painter->builder);
    if (!state.building && !atomic_load(&painter->prepares)) {
        pthread_mutex_lock(&painter->lock);
        atomic_store(&painter->told, true);
        pthread_cond_signal(&painter->changed);
        pthread_mutex_unlock(&painter->lock);
    }
    wake(painter);
}

/* Shows another canvas from now on. */
static void change_canvas(Painter *painter, Canvas *built)
{
    if (painter->canvas)
        canvas_rest(painter->canvas);
    painter->canvas     = built;
    painter->resolution = (Resolution){.divisor = painter->resolution.divisor};
}

/* Tells whether a canvas has the shaders of a view: the one that is shown, or the one that was built.  If
   there is none, it is built; one that has some of them is better than one of another text. */
static bool choose_canvas(Painter *painter, const View *next)
{
    const Needs needs = view_needs(next);
    if (painter->canvas && canvas_meets(painter->canvas, &needs)) {
        builder_cancel(painter->builder);
        return true;
    }
    const bool other = !painter->canvas || canvas_structure(painter->canvas) != needs.structure;
    Canvas    *built = builder_exchange(painter->builder, &needs, other, painter->canvas);
    if (built)
        change_canvas(painter, built);
    if (built && canvas_meets(built, &needs))
        return true;
    atomic_store(&painter->prepares, false);
    builder_start(painter->builder, next);
    return false;
}

/* Values of parameters of the same name, where there are such. */
static void take_values(View *view, const View *from)
{
    const KrsScene *scene = version_scene(view->version), *other = version_scene(from->version);
    for (size_t i = 0; i < krs_parameter_count(scene); i++)
        for (size_t k = 0; k < krs_parameter_count(other); k++) {
            KrsParameter a, b;
            krs_parameter(scene, i, &a);
            krs_parameter(other, k, &b);
            if (strcmp(a.name, b.name) == 0 && a.components == b.components)
                memcpy(view->values[i], from->values[k], sizeof *view->values);
        }
}

/* Shows as much of the next view as the canvas has shaders for. */
static void follow(Painter *painter, View *next)
{
    View *view = &painter->view, old = *view;
    if (version_structure(next->version) == canvas_structure(painter->canvas)) {
        view_free(view);
        *view = *next;
        *next = (View){0};
    } else {
        take_values(view, next);
        *view         = *next;
        view->version = old.version;
        view->values  = old.values;
    }
    canvas_reduce(painter->canvas, view);
}

static void adopt_view(Painter *painter, View *next)
{
    if (choose_canvas(painter, next)) {
        view_free(&painter->view);
        painter->view = *next;
        *next         = (View){0};
    } else if (painter->canvas) {
        follow(painter, next);
    }
}

/* Waits for another view, or for shaders.  False: that was the last one. */
static bool wait_for_view(Painter *painter, View *next)
{
    bool taken = false;
    pthread_mutex_lock(&painter->lock);
    painter->state.busy = false;
    while (!painter->quit && !is_outdated(painter))
        pthread_cond_wait(&painter->changed, &painter->lock);
    atomic_store(&painter->told, false);
    if (!painter->quit && view_copy(&painter->wanted, next)) {
        painter->shown          = atomic_load(&painter->number);
        painter->options.budget = painter->budget;
        painter->state.busy     = true;
        painter->moving         = now_ms() - painter->changed_at < MOVING_MS;
        painter->changed_at     = now_ms();
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

static KrsStatus paint_view(Painter *painter)
{
    KrsStatus status = canvas_adopt(painter->canvas, &painter->view);
    if (status != KRS_OK)
        return status;
    set_values(painter);
    return show_view(painter);
}

static void *paint(void *user)
{
    Painter *painter = user;
    View     next    = {0};
    while (wait_for_view(painter, &next)) {
        KrsStatus status = KRS_OK;
        if (next.version)
            adopt_view(painter, &next);
        view_free(&next);
        if (painter->canvas)
            status = paint_view(painter);
        const BuilderState building = builder_state(painter->builder);
        if (status != KRS_OK)
            say_failed(painter, status, canvas_message(painter->canvas));
        else if (!painter->canvas && building.status != KRS_OK)
            say_failed(painter, status = building.status, building.message);
        if (status != KRS_OK)
            break;
        wake(painter); /* it is idle now */
    }
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
    atomic_init(&painter->told, false);
    atomic_init(&painter->prepares, false);
    painter->builder = builder_new(&options->renderer, hear_builder, painter);
    if (painter->builder && pthread_create(&painter->thread, NULL, paint, painter) == 0)
        return painter;
    builder_free(painter->builder);
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
    builder_free(painter->builder);
    canvas_free(painter->canvas);
    view_free(&painter->view);
    view_free(&painter->wanted);
    free(painter->shot.pixels);
    krs_picture_free(painter->aovs);
    pthread_mutex_destroy(&painter->lock);
    pthread_cond_destroy(&painter->changed);
    free(painter);
}
