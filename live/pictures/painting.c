/*
 * painting.c: a thread that makes pictures of what is to be seen: it waits for a view, has an executor chosen for it
 * (executors.c), and makes its pictures (refine.c).
 */
#include "live/pictures/painting.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "compiler/base/clock.h"

/* Something moves if one view follows another so soon. */
#define MOVING_MS 250.0

double painter_now(void) { return 1e3 * clock_seconds(CLOCK_MONOTONIC); }

void painter_wake(const Painter *painter)
{
    if (painter->options.wake)
        painter->options.wake(painter->options.user);
}

bool painter_is_outdated(const Painter *painter)
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
    if (!painter->state.busy && !painter_is_outdated(painter) && !builds) {
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
    painter_wake(painter);
}

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
    painter_wake(painter);
}

/* Waits for another view, or for shaders.  False: that was the last one. */
static bool wait_for_view(Painter *painter, View *next)
{
    bool taken = false;
    pthread_mutex_lock(&painter->lock);
    painter->state.busy = false;
    while (!painter->quit && !painter_is_outdated(painter))
        pthread_cond_wait(&painter->changed, &painter->lock);
    atomic_store(&painter->told, false);
    if (!painter->quit && view_copy(&painter->wanted, next)) {
        painter->shown          = atomic_load(&painter->number);
        painter->options.budget = painter->budget;
        painter->state.busy     = true;
        painter->moving         = painter_now() - painter->changed_at < MOVING_MS;
        painter->changed_at     = painter_now();
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
    status = painter_refine(painter);
    painter_order_shaders(painter, &painter->view); /* there was no time for a picture */
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
            painter_adopt(painter, &next);
        view_free(&next);
        if (painter->drawing)
            status = paint_view(painter);
        if (status != KRS_OK && painter_lanes_draw(painter)) {
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
        painter_wake(painter); /* it is idle now */
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
