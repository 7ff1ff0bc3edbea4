/*
 * saver.c: a thread that renders pictures into files.
 *
 * Each order has a canvas of its own, which is freed behind it: what is shown goes on meanwhile, only
 * more slowly.
 */
#include "live/pictures/saver.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#include "krs/camera.h"
#include "live/pictures/picture_file.h"

/* The part of an order that is done when its shaders are compiled; not more than a frame is. */
#define COMPILED_PART 0.2

const char *const save_names[SAVE_COUNT] = {
#define SAVE(id, name, about) name,
#include "live/pictures/saves.def"
#undef SAVE
};

struct Saver {
    KrsRendererOptions options;
    void (*told)(void *user);
    void           *user;
    pthread_t       thread;
    atomic_bool     given_up;
    atomic_uint     permille;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t  changed;
    bool            quit, ordered;
    SaveOrder       next;
    SaverState      state;
    /* of the thread alone */
    SaveOrder order;
    uint32_t  frame; /* that is made */
    Canvas   *canvas;
};

static uint32_t frames_of(const SaveOrder *order)
{
    return order->kind == SAVE_PICTURE || order->frames < 1 ? 1 : order->frames;
}

static bool tell(Saver *saver, double done)
{
    const unsigned permille = (unsigned)(1000 * fmin(fmax(done, 0), 1));
    if (atomic_exchange(&saver->permille, permille) != permille)
        saver->told(saver->user);
    return !atomic_load(&saver->given_up);
}

static bool tell_compiling(void *user, double done)
{
    Saver *saver = user;
    return tell(saver, done * COMPILED_PART / frames_of(&saver->order));
}

static bool report_progress(void *user, double done)
{
    Saver       *saver  = user;
    const double part   = COMPILED_PART + (1 - COMPILED_PART) * done;
    const double before = saver->frame == 0 ? part : done;
    return tell(saver, (saver->frame + before) / frames_of(&saver->order));
}

/* Sets what a frame of the order shows. */
static void aim(const Saver *saver, View *view)
{
    const SaveOrder *order = &saver->order;
    const double     i     = saver->frame;
    if (order->kind == SAVE_TURNTABLE)
        krs_camera_orbit(&view->camera, 2 * M_PI * i / frames_of(order), 0);
    if (order->kind != SAVE_TIME)
        return;
    view->time          = order->view.time + i / order->fps;
    view->frame_seconds = 1 / order->fps;
}

static void name_file(const Saver *saver, char path[260])
{
    const SaveOrder *order  = &saver->order;
    const char      *ending = order->exr ? "exr" : "png";
    if (order->kind == SAVE_PICTURE)
        snprintf(path, 260, "%s.%s", order->name, ending);
    else
        snprintf(path, 260, "%s-%04u.%s", order->name, saver->frame, ending);
}

static KrsStatus save_frame(Saver *saver, char message[300])
{
    const SaveOrder *order   = &saver->order;
    View             view    = order->view;
    KrsPicture      *picture = NULL;
    char             path[260];
    aim(saver, &view);
    KrsStatus status = canvas_set(saver->canvas, &view);
    if (status == KRS_OK && order->kind == SAVE_TIME && order->camera >= 0)
        status = canvas_camera(saver->canvas, (size_t)order->camera, &view.camera);
    if (status == KRS_OK)
        status = canvas_add(saver->canvas, FILM_FULL, &view, view.width, view.height, view.samples,
                            true, report_progress, saver);
    if (status == KRS_OK)
        status = canvas_read(saver->canvas, FILM_FULL, order->exr ? 0 : KRS_AOV_COLOR, &picture);
    if (status != KRS_OK) {
        snprintf(message, 300, "%.299s", canvas_message(saver->canvas));
        return status;
    }
    name_file(saver, path);
    status = picture_file_write(picture, &view, path, message);
    krs_picture_free(picture);
    return status;
}

static KrsStatus save(Saver *saver, char message[300])
{
    const uint32_t frames = frames_of(&saver->order);
    const bool     large  = krs_scene_too_large(version_scene(saver->order.view.version)) != NULL;
    KrsStatus      status = canvas_new(
             &saver->options, large ? KRS_EXECUTOR_LANES : KRS_EXECUTOR_KERNELS, &saver->canvas);
    if (status == KRS_OK)
        status = canvas_prepare(saver->canvas, &saver->order.view, tell_compiling, saver);
    if (status != KRS_OK)
        snprintf(message, 300, "%.299s", canvas_message(saver->canvas));
    for (saver->frame = 0; status == KRS_OK && saver->frame < frames; saver->frame++)
        status = save_frame(saver, message);
    if (status == KRS_INTERRUPTED)
        snprintf(message, 300, "given up; %u of %u saved", saver->frame > 0 ? saver->frame - 1 : 0,
                 frames);
    else if (status == KRS_OK && frames > 1)
        snprintf(message, 300, "saved %u frames: %s-0000.%s and so on", frames, saver->order.name,
                 saver->order.exr ? "exr" : "png");
    else if (status == KRS_OK)
        snprintf(message, 300, "saved %s.%s", saver->order.name, saver->order.exr ? "exr" : "png");
    canvas_free(saver->canvas);
    saver->canvas = NULL;
    return status;
}

static bool take(Saver *saver)
{
    pthread_mutex_lock(&saver->lock);
    while (!saver->quit && !saver->ordered)
        pthread_cond_wait(&saver->changed, &saver->lock);
    const bool taken = !saver->quit;
    if (taken) {
        saver->order   = saver->next;
        saver->next    = (SaveOrder){0};
        saver->ordered = false;
    }
    pthread_mutex_unlock(&saver->lock);
    return taken;
}

static void *work(void *user)
{
    Saver *saver = user;
    while (take(saver)) {
        char            message[300] = "";
        const KrsStatus status       = save(saver, message);
        view_free(&saver->order.view);
        pthread_mutex_lock(&saver->lock);
        saver->state.busy   = false;
        saver->state.status = status;
        saver->state.orders++;
        snprintf(saver->state.message, sizeof saver->state.message, "%s", message);
        pthread_mutex_unlock(&saver->lock);
        saver->told(saver->user);
    }
    return NULL;
}

Saver *saver_new(const KrsRendererOptions *options, void (*told)(void *user), void *user)
{
    Saver *saver = calloc(1, sizeof *saver);
    if (!saver)
        return NULL;
    saver->options = *options;
    saver->told    = told;
    saver->user    = user;
    atomic_init(&saver->given_up, false);
    atomic_init(&saver->permille, 0);
    pthread_mutex_init(&saver->lock, NULL);
    pthread_cond_init(&saver->changed, NULL);
    if (pthread_create(&saver->thread, NULL, work, saver) == 0)
        return saver;
    free(saver);
    return NULL;
}

void saver_free(Saver *saver)
{
    if (!saver)
        return;
    saver_cancel(saver);
    pthread_mutex_lock(&saver->lock);
    saver->quit = true;
    pthread_cond_signal(&saver->changed);
    pthread_mutex_unlock(&saver->lock);
    pthread_join(saver->thread, NULL);
    view_free(&saver->next.view);
    pthread_mutex_destroy(&saver->lock);
    pthread_cond_destroy(&saver->changed);
    free(saver);
}

bool saver_start(Saver *saver, const SaveOrder *order)
{
    View copy;
    if (!view_copy(&order->view, &copy))
        return false;
    pthread_mutex_lock(&saver->lock);
    const bool free_now = !saver->state.busy;
    if (free_now) {
        saver->next       = *order;
        saver->next.view  = copy;
        saver->ordered    = true;
        saver->state.busy = true;
        atomic_store(&saver->given_up, false);
        atomic_store(&saver->permille, 0);
        pthread_cond_signal(&saver->changed);
    }
    pthread_mutex_unlock(&saver->lock);
    if (!free_now)
        view_free(&copy);
    return free_now;
}

void saver_cancel(Saver *saver) { atomic_store(&saver->given_up, true); }

SaverState saver_state(Saver *saver)
{
    pthread_mutex_lock(&saver->lock);
    SaverState state = saver->state;
    pthread_mutex_unlock(&saver->lock);
    state.done = atomic_load(&saver->permille) / 1000.0;
    return state;
}
