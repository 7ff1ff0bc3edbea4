/*
 * executors.c: who draws a view: shaders, or lanes of the host.
 *
 * Whoever changes the text's structure waits for shaders; another thread compiles them (builder.h).  Until they are there
 * lanes of the host draw (lanes.h), and where they cannot, the version before is shown, from wherever the camera is by
 * then.  Both executors are timed when the shaders are there.  Pictures do not tell who draws, so samples of a view are
 * never fewer than they were.
 */
#include "live/pictures/painting.h"

#include <math.h>
#include <string.h>

bool painter_lanes_draw(const Painter *painter)
{
    return painter->drawing && painter->drawing == painter->lanes.canvas;
}

void painter_order_shaders(Painter *painter, const View *view)
{
    if (!painter->orders)
        return;
    painter->orders = false;
    if (painter->ordered != version_structure(view->version)) {
        painter->ordered    = version_structure(view->version);
        painter->ordered_at = painter_now();
    }
    atomic_store(&painter->prepares, false);
    builder_start(painter->builder, view);
}

/* Has another canvas with shaders from now on. */
static void change_canvas(Painter *painter, Canvas *built)
{
    if (painter->canvas)
        canvas_rest(painter->canvas);
    if (!painter_lanes_draw(painter))
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

/* Tells whether a picture by lanes is wanted still. */
static bool is_wanted(void *user, double done)
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
    if (!lanes_take(&painter->lanes, next, painter->options.budget, is_wanted, painter, &fresh))
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
    const uint32_t width   = painter_divide(view->width, divisor),
                   height  = painter_divide(view->height, divisor);
    double    ms           = INFINITY;
    KrsStatus status       = canvas_adopt(canvas, view);
    canvas_set(canvas, view);
    painter->making = FILM_COARSE;
    painter->grace  = TIMEOUT * painter->options.budget;
    for (int i = 0; i < repeats && status == KRS_OK; i++) {
        painter->begun = painter_now();
        status         = canvas_add(canvas, FILM_COARSE, view, width, height, 1, true,
                                    painter_report_progress, painter);
        ms             = fmin(ms, painter_now() - painter->begun);
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
    const uint32_t samples = painter_samples(painter),
                   all     = next->shading == SHADING_LIGHT ? next->samples : 1;
    if (!lanes_meet(&needs) || painter->lanes.structure != needs.structure)
        return false;
    if (painter->options.executor == KRS_EXECUTOR_LANES)
        return true;
    if (!painter->view.version || !only_camera_differs(next, &painter->view))
        return false;
    time_executors(painter, next);
    const double left = painter_lanes_draw(painter) ? all - fmin(samples, all) : all;
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

void painter_adopt(Painter *painter, View *next)
{
    const bool before = painter->reduced, ready = choose_canvas(painter, next),
               lanes = ready ? keep_lanes(painter, next) : begin_lanes(painter, next);
    painter->reduced = !ready && !lanes;
    if (before || painter->reduced)
        painter->seen = painter->filmed = 0;
    if (ready && !lanes && painter_lanes_draw(painter))
        canvas_rest(painter->lanes.canvas);
    if (!painter->reduced) {
        painter->drawing = lanes ? painter->lanes.canvas : painter->canvas;
        view_free(&painter->view);
        painter->view = *next;
        *next         = (View){0};
        return;
    }
    painter_order_shaders(painter, next);
    if (painter->drawing)
        follow(painter, next);
}
