/*
 * painter.c: a thread that makes pictures of what is to be seen.
 *
 * Whoever changes the text's structure waits for shaders; another thread compiles them (builder.h).  Until they are there
 * lanes of the host draw (lanes.h), and where they cannot, the version before is shown, from wherever the camera is by
 * then.  Both executors are timed when the shaders are there.  Pictures do not tell who draws, so samples of a view are
 * never fewer than they were.
 *
 * Coarse pictures are not interrupted by a change, unless they take far too long: while something
 * moves, each is shown.  Whole ones are interrupted at once, though what the device has begun must
 * end first.  So none is begun while the next change is to be expected at any moment.
 */
#include "live/pictures/painter.h"

#include "live/pictures/builder.h"
#include "live/pictures/lanes.h"
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
/* The part of the time that compilers are expected to take, or have taken, that lanes take while
   compilers need all processors.  Coarse pictures of what moves are not counted. */
#define LANES_PART 4

/* The times of executors for a coarse picture of a structure. */
typedef struct Timing {
    unsigned structure;
    double   lanes_ms, shaders_ms;
} Timing;

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
    Lanes      lanes;
    Canvas    *canvas;  /* with shaders; NULL: none so far */
    Canvas    *drawing; /* one of both, which draws `view`; NULL: there is no picture so far */
    View       view;
    bool       reduced;        /* it is not all that is wanted */
    bool       orders;         /* its shaders, as soon as there is a picture */
    unsigned   ordered;        /* the structure whose shaders were ordered last, */
    double     ordered_at;     /* and when */
    unsigned   shown;          /* number of `view` */
    unsigned   seen;           /* number of the view that there is a picture of */
    uint32_t   seen_samples;   /* of it; 0: it is a coarse one */
    unsigned   filmed;         /* number of the view whose samples the film with all pixels has, */
    Canvas    *filmed_by;      /* and that film's canvas */
    Resolution resolutions[2]; /* [1]: of lanes */
    Timing     timing;
    double     changed_at; /* when the last view came */
    bool       moving;
    double     begun; /* when the picture that is being made was begun */
    FilmKind   making;
    double     grace; /* milliseconds before a change interrupts it, if it is coarse */
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

static bool lanes_draw(const Painter *painter)
{
    return painter->drawing && painter->drawing == painter->lanes.canvas;
}

/* Takes the progress of a picture: shaders that take over wait for it, unless that takes long. */
static bool report_progress(void *user, double done)
{
    Painter     *painter = user;
    const double ms      = now_ms() - painter->begun;
    (void)done;
    if (painter->making == FILM_COARSE)
        return !is_outdated(painter) || ms < painter->grace;
    return !is_outdated(painter) || (atomic_load(&painter->number) == painter->shown &&
                                     lanes_draw(painter) && ms < PORTION_MS);
}

/* Has the shaders compiled that were put off. */
static void order_shaders(Painter *painter, const View *view)
{
    if (!painter->orders)
        return;
    painter->orders = false;
    if (painter->ordered != version_structure(view->version)) {
        painter->ordered    = version_structure(view->version);
        painter->ordered_at = now_ms();
    }
    atomic_store(&painter->prepares, false);
    builder_start(painter->builder, view);
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
    order_shaders(painter, &painter->view);
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
    wake(painter);
    return KRS_OK;
}

static Resolution *resolution_of(Painter *painter)
{
    return &painter->resolutions[lanes_draw(painter)];
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
    painter->begun   = now_ms();
    KrsStatus status = canvas_add(painter->drawing, kind, &painter->view, width, height, samples,
                                  again, report_progress, painter);
    if (status != KRS_OK)
        return status;
    const double ms = now_ms() - painter->begun;
    learn_cost(painter, kind, ms / samples, (double)width * height);
    return is_behind(painter, canvas_samples(painter->drawing, kind)) ? KRS_OK
                                                                      : publish(painter, kind, ms);
}

static uint32_t divide(uint32_t side, double divisor)
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
    return make(painter, FILM_COARSE, divide(width, divisor), divide(height, divisor), 1, true);
}

/* Tells whether lanes draw what shaders are compiled for. */
static bool lanes_are_early(const Painter *painter)
{
    return lanes_draw(painter) && builder_state(painter->builder).building;
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
    return make(painter, FILM_COARSE, divide(painter->view.width, divisor),
                divide(painter->view.height, divisor), 1, true);
}

/* Returns for how many milliseconds lanes leave the processors to compilers, before they make so many samples of all
   pixels. */
static double find_pause(const Painter *painter, uint32_t samples)
{
    const Estimate *estimate = &painter->lanes.estimate;
    const double    ms       = LANES_PART * samples * estimate->lanes_ms;
    return lanes_are_early(painter) && ms > estimate->compiler_ms
               ? fmax(painter->ordered_at + ms - now_ms(), 0)
               : 0;
}

/* Samples that take about as long as it may be until the picture is seen to improve. */
static uint32_t choose_portion(Painter *painter, uint32_t missing)
{
    const double ms      = resolution_of(painter)->whole_ms;
    const double portion = ms > 0 ? fmin(fmax(PORTION_MS / ms, 1), 64) : 1;
    return portion < missing ? (uint32_t)portion : missing;
}

/* Waits for the next view, or for shaders, but not for more milliseconds than these. */
static void wait_for_news(Painter *painter, double ms)
{
    const double          until = now_ms() + ms;
    const struct timespec limit = {(time_t)(until / 1e3), (long)(fmod(until, 1e3) * 1e6)};
    pthread_mutex_lock(&painter->lock);
    while (!painter->quit && !is_outdated(painter) && now_ms() < until)
        pthread_cond_clockwait(&painter->changed, &painter->lock, CLOCK_MONOTONIC, &limit);
    pthread_mutex_unlock(&painter->lock);
}

/* Returns how many samples of the view the film with all pixels has. */
static uint32_t samples_of_view(const Painter *painter)
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

/* Makes the picture of a view, up to its last sample or until there is another one. */
static KrsStatus show_view(Painter *painter)
{
    KrsStatus status = KRS_OK;
    if (painter->seen != painter->shown) {
        painter->filmed = 0;
        status          = show_coarse(painter);
        wait_for_news(painter, painter->moving ? QUIET_MS : 0);
    }
    if (status == KRS_OK && !is_outdated(painter))
        status = show_finer(painter);
    while (status == KRS_OK && !is_outdated(painter)) {
        const uint32_t samples = samples_of_view(painter);
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

/* ---- which canvas ---- */

/* Wakes the painter when the builder has news; called in the builder's thread. */
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

/* Has another canvas with shaders from now on. */
static void change_canvas(Painter *painter, Canvas *built)
{
    if (painter->canvas)
        canvas_rest(painter->canvas);
    if (!lanes_draw(painter))
        painter->drawing = built;
    painter->canvas         = built;
    painter->resolutions[0] = (Resolution){.divisor = painter->resolutions[0].divisor};
}

/* Tells whether a canvas has the shaders of a view: the one that there is, or the one that was built.  If
   there is none, it is to be built; one that has some of them is better than one of another text. */
static bool choose_canvas(Painter *painter, const View *next)
{
    const Needs needs = view_needs(next);
    painter->orders   = false;
    if (painter->canvas && canvas_meets(painter->canvas, &needs)) {
        builder_cancel(painter->builder);
        return true;
    }
    const bool other = !painter->canvas || canvas_structure(painter->canvas) != needs.structure;
    Canvas    *built = builder_exchange(painter->builder, &needs, other, painter->canvas);
    if (built)
        change_canvas(painter, built);
    painter->orders = !built || !canvas_meets(built, &needs);
    return !painter->orders;
}

/* Tells whether lanes go on while they make the first shaders. */
static bool goes_on(void *user, double done)
{
    Painter *painter = user;
    (void)done;
    pthread_mutex_lock(&painter->lock);
    const bool quit = painter->quit;
    pthread_mutex_unlock(&painter->lock);
    return !quit;
}

/* Tells whether lanes draw a view that there are no shaders for. */
static bool begin_lanes(Painter *painter, const View *next)
{
    bool fresh;
    if (!lanes_take(&painter->lanes, next, painter->options.budget, goes_on, painter, &fresh))
        return false;
    if (fresh)
        painter->resolutions[1] = (Resolution){.pixel_ms = painter->lanes.estimate.lanes_ms /
                                                           next->width / next->height};
    if (painter->options.executor == KRS_EXECUTOR_LANES ||
        krs_scene_too_large(version_scene(next->version)))
        painter->orders = false;
    return true;
}

/* Returns the milliseconds of a canvas for a coarse picture, the best of so many. */
static double time_canvas(Painter *painter, Canvas *canvas, const View *view, int repeats)
{
    const double   divisor = fmax(painter->resolutions[1].divisor, 1);
    const uint32_t width = divide(view->width, divisor), height = divide(view->height, divisor);
    double         ms     = INFINITY;
    KrsStatus      status = canvas_adopt(canvas, view);
    canvas_set(canvas, view);
    painter->making = FILM_COARSE;
    painter->grace  = TIMEOUT * painter->options.budget;
    for (int i = 0; i < repeats && status == KRS_OK; i++) {
        painter->begun = now_ms();
        status = canvas_add(canvas, FILM_COARSE, view, width, height, 1, true, report_progress,
                            painter);
        ms     = fmin(ms, now_ms() - painter->begun);
    }
    return status == KRS_OK ? ms : INFINITY;
}

/* Times lanes and shaders.  Lanes have drawn the structure already, so it takes one picture; if
   none with all pixels was ready before shaders were, they are slower. */
static void time_executors(Painter *painter, const View *next)
{
    const unsigned structure = version_structure(next->version);
    const bool     late      = painter->seen == painter->shown && painter->seen_samples == 0;
    if (painter->timing.structure == structure)
        return;
    painter->timing = (Timing){structure, INFINITY, 0};
    if (!late) {
        painter->timing.lanes_ms   = time_canvas(painter, painter->lanes.canvas, next, 1);
        painter->timing.shaders_ms = time_canvas(painter, painter->canvas, next, 2);
    }
}

static bool only_camera_differs(const View *a, const View *b)
{
    const size_t count = krs_parameter_count(version_scene(a->version));
    return a->version == b->version && a->time == b->time &&
           memcmp(a->values, b->values, count * sizeof *a->values) == 0;
}

/* Tells whether lanes draw a view that there are shaders for.  Those need no tapes of other values.  Who has begun a picture
   goes on, unless the other would have all samples earlier. */
static bool keep_lanes(Painter *painter, const View *next)
{
    const Needs    needs   = view_needs(next);
    const uint32_t samples = samples_of_view(painter),
                   all     = next->shading == SHADING_LIGHT ? next->samples : 1;
    if (!lanes_meet(&needs) || painter->lanes.structure != needs.structure)
        return false;
    if (painter->options.executor == KRS_EXECUTOR_LANES)
        return true;
    if (!painter->view.version || !only_camera_differs(next, &painter->view))
        return false;
    time_executors(painter, next);
    const double left = lanes_draw(painter) ? all - fmin(samples, all) : all;
    return left * painter->timing.lanes_ms <= all * painter->timing.shaders_ms;
}

/* Takes values of parameters of the same name, where there are such. */
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

/* Shows as much of the next view as the canvas that draws has shaders for. */
static void follow(Painter *painter, View *next)
{
    View *view = &painter->view, old = *view;
    if (version_structure(next->version) == canvas_structure(painter->drawing)) {
        view_free(view);
        *view = *next;
        *next = (View){0};
    } else {
        take_values(view, next);
        *view         = *next;
        view->version = old.version;
        view->values  = old.values;
    }
    canvas_reduce(painter->drawing, view);
}

static void adopt_view(Painter *painter, View *next)
{
    const bool before = painter->reduced, ready = choose_canvas(painter, next),
               lanes = ready ? keep_lanes(painter, next) : begin_lanes(painter, next);
    painter->reduced = !ready && !lanes;
    if (before || painter->reduced)
        painter->seen = painter->filmed = 0;
    if (ready && !lanes && lanes_draw(painter))
        canvas_rest(painter->lanes.canvas);
    if (!painter->reduced) {
        painter->drawing = lanes ? painter->lanes.canvas : painter->canvas;
        view_free(&painter->view);
        painter->view = *next;
        *next         = (View){0};
        return;
    }
    order_shaders(painter, next);
    if (painter->drawing)
        follow(painter, next);
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
    const bool refused = canvas_set(painter->drawing, &painter->view) != KRS_OK;
    pthread_mutex_lock(&painter->lock);
    painter->state.refused = refused;
    pthread_mutex_unlock(&painter->lock);
}

static KrsStatus paint_view(Painter *painter)
{
    KrsStatus status = canvas_adopt(painter->drawing, &painter->view);
    if (status != KRS_OK)
        return status;
    set_values(painter);
    status = show_view(painter);
    order_shaders(painter, &painter->view); /* there was no time for a picture */
    return status;
}

/* Goes on without lanes, which have failed at a view that they seemed to draw. */
static void give_up_lanes(Painter *painter, KrsStatus status)
{
    lanes_give_up(&painter->lanes, status);
    painter->drawing = NULL;
    painter->seen = painter->filmed = 0;
    atomic_store(&painter->told, true);
}

static void *paint(void *user)
{
    Painter *painter = user;
    View     next    = {0};
    if (painter->options.executor != KRS_EXECUTOR_KERNELS)
        lanes_open(&painter->lanes, &painter->options.renderer);
    while (wait_for_view(painter, &next)) {
        KrsStatus status = KRS_OK;
        if (next.version)
            adopt_view(painter, &next);
        view_free(&next);
        if (painter->drawing)
            status = paint_view(painter);
        if (status != KRS_OK && lanes_draw(painter)) {
            give_up_lanes(painter, status);
            continue;
        }
        const BuilderState building = builder_state(painter->builder);
        if (status != KRS_OK)
            say_failed(painter, status, canvas_message(painter->canvas));
        else if (!painter->drawing && !painter->canvas && building.status != KRS_OK)
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
    lanes_close(&painter->lanes);
    canvas_free(painter->canvas);
    view_free(&painter->view);
    view_free(&painter->wanted);
    free(painter->shot.pixels);
    krs_picture_free(painter->aovs);
    pthread_mutex_destroy(&painter->lock);
    pthread_cond_destroy(&painter->changed);
    free(painter);
}
