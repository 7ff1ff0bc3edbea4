/*
 * builder.c: a thread that compiles the shaders of a view.
 *
 * It has a canvas of its own, so a device of its own: while that compiles, the other shows.  When a
 * build is done the two are exchanged, and each keeps the shaders that it has made.
 */
#include "live/pictures/builder.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

struct Builder {
    KrsRendererOptions options;
    void (*told)(void *user);
    void           *user;
    pthread_t       thread;
    atomic_bool     given_up; /* the build that is under way */
    atomic_uint     permille; /* of it that is done */
    pthread_mutex_t lock;     /* of what follows */
    pthread_cond_t  changed;
    bool            quit;
    bool            wants; /* `wanted` is to be built */
    View            wanted;
    bool            building; /* the canvas is the thread's */
    Needs           needs;    /* of what is built, or was built last */
    Canvas         *canvas;
    KrsStatus       status;
    char            message[256];
};

static bool report_progress(void *user, double done)
{
    Builder *builder = user;
    atomic_store(&builder->permille, (unsigned)(1000 * done));
    builder->told(builder->user);
    return !atomic_load(&builder->given_up);
}

static KrsStatus build(Builder *builder, const View *view)
{
    KrsStatus status = KRS_OK;
    if (!builder->canvas)
        status = canvas_new(&builder->options, KRS_EXECUTOR_KERNELS, &builder->canvas);
    return status == KRS_OK ? canvas_prepare(builder->canvas, view, report_progress, builder)
                            : status;
}

/* Waits for something to build.  False: that was all. */
static bool take(Builder *builder, View *view)
{
    pthread_mutex_lock(&builder->lock);
    while (!builder->quit && !builder->wants)
        pthread_cond_wait(&builder->changed, &builder->lock);
    const bool taken = !builder->quit;
    if (taken) {
        *view             = builder->wanted;
        builder->wanted   = (View){0};
        builder->wants    = false;
        builder->building = true;
        builder->status   = KRS_OK;
        builder->needs    = view_needs(view);
        atomic_store(&builder->given_up, false);
        atomic_store(&builder->permille, 0);
    }
    pthread_mutex_unlock(&builder->lock);
    return taken;
}

/* Ends a build.  One that was given up may go on later; a canvas that failed is not used again. */
static void finish(Builder *builder, KrsStatus status)
{
    const bool failed = status != KRS_OK && status != KRS_INTERRUPTED;
    pthread_mutex_lock(&builder->lock);
    builder->building = false;
    builder->status   = failed ? status : KRS_OK;
    if (failed) {
        snprintf(builder->message, sizeof builder->message, "%s", canvas_message(builder->canvas));
        canvas_free(builder->canvas);
        builder->canvas = NULL;
    }
    pthread_mutex_unlock(&builder->lock);
    builder->told(builder->user);
}

static void *work(void *user)
{
    Builder *builder = user;
    View     view;
    while (take(builder, &view)) {
        finish(builder, build(builder, &view));
        view_free(&view);
    }
    return NULL;
}

Builder *builder_new(const KrsRendererOptions *options, void (*told)(void *user), void *user)
{
    Builder *builder = calloc(1, sizeof *builder);
    if (!builder)
        return NULL;
    builder->options = *options;
    builder->told    = told;
    builder->user    = user;
    atomic_init(&builder->given_up, false);
    atomic_init(&builder->permille, 0);
    pthread_mutex_init(&builder->lock, NULL);
    pthread_cond_init(&builder->changed, NULL);
    if (pthread_create(&builder->thread, NULL, work, builder) == 0)
        return builder;
    free(builder);
    return NULL;
}

void builder_free(Builder *builder)
{
    if (!builder)
        return;
    pthread_mutex_lock(&builder->lock);
    builder->quit = true;
    atomic_store(&builder->given_up, true);
    pthread_cond_signal(&builder->changed);
    pthread_mutex_unlock(&builder->lock);
    pthread_join(builder->thread, NULL);
    canvas_free(builder->canvas);
    view_free(&builder->wanted);
    pthread_mutex_destroy(&builder->lock);
    pthread_cond_destroy(&builder->changed);
    free(builder);
}

void builder_start(Builder *builder, const View *view)
{
    const Needs needs = view_needs(view);
    View        copy, old = {0};
    pthread_mutex_lock(&builder->lock);
    const bool  pending = builder->wants;
    const Needs last    = pending ? view_needs(&builder->wanted) : builder->needs;
    const bool  same    = builder->building && !pending && !atomic_load(&builder->given_up)
                              ? needs.structure == last.structure
                              : needs_are_equal(&needs, &last) &&
                                (pending || builder->status != KRS_OK);
    if (!same && view_copy(view, &copy)) {
        old             = builder->wanted;
        builder->wanted = copy;
        builder->wants  = true;
        atomic_store(&builder->given_up, true);
        pthread_cond_signal(&builder->changed);
    }
    pthread_mutex_unlock(&builder->lock);
    view_free(&old);
}

bool builder_has(Builder *builder, const Needs *needs)
{
    pthread_mutex_lock(&builder->lock);
    const bool has = !builder->building && builder->canvas && canvas_meets(builder->canvas, needs);
    pthread_mutex_unlock(&builder->lock);
    return has;
}

void builder_cancel(Builder *builder)
{
    pthread_mutex_lock(&builder->lock);
    builder->wants = false;
    atomic_store(&builder->given_up, true);
    pthread_mutex_unlock(&builder->lock);
}

Canvas *builder_exchange(Builder *builder, const Needs *needs, bool some, Canvas *other)
{
    Canvas *built = NULL;
    pthread_mutex_lock(&builder->lock);
    if (!builder->building && builder->canvas &&
        (canvas_meets(builder->canvas, needs) ||
         (some && canvas_structure(builder->canvas) == needs->structure))) {
        built           = builder->canvas;
        builder->canvas = other;
    }
    pthread_mutex_unlock(&builder->lock);
    return built;
}

BuilderState builder_state(Builder *builder)
{
    pthread_mutex_lock(&builder->lock);
    BuilderState state = {.building = builder->building || builder->wants,
                          .done     = atomic_load(&builder->permille) / 1000.0,
                          .status   = builder->status};
    snprintf(state.message, sizeof state.message, "%s", builder->message);
    pthread_mutex_unlock(&builder->lock);
    return state;
}
