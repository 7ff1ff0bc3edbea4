/*
 * canvas.c: a scene on a device, and the films of it that a viewer shows.
 */
#include "live/canvas.h"

#include <stdlib.h>
#include <string.h>

/* Milliseconds of a dispatch: between two of them a change is noticed. */
#define SLICE_MS 10

typedef struct Film {
    KrsFilm      *film;
    uint32_t      width, height, samples;
    KrsIntegrator integrator;
} Film;

struct Canvas {
    KrsRenderer  *renderer;
    KrsRendering *rendering;
    KrsFrame     *frame;
    Version      *version;
    Film          films[FILM_COUNT];
    /* Of the picture that is being made: films keep the functions that they were made with. */
    KrsProgressCallback *progress;
    void                *user;
};

bool view_copy(const View *view, View *copy)
{
    const size_t count = view->version ? krs_parameter_count(version_scene(view->version)) : 0;
    *copy              = *view;
    copy->values       = malloc((count + 1) * sizeof *copy->values);
    if (!copy->values)
        return false;
    if (count > 0)
        memcpy(copy->values, view->values, count * sizeof *copy->values);
    version_hold(copy->version);
    return true;
}

void view_free(View *view)
{
    version_release(view->version);
    free(view->values);
    *view = (View){0};
}

KrsStatus canvas_new(const KrsRendererOptions *options, Canvas **canvas)
{
    *canvas = calloc(1, sizeof **canvas);
    return *canvas ? krs_renderer_new(options, &(*canvas)->renderer) : KRS_OUT_OF_MEMORY;
}

static void free_films(Canvas *canvas)
{
    for (int i = 0; i < FILM_COUNT; i++) {
        krs_film_free(canvas->films[i].film);
        canvas->films[i] = (Film){0};
    }
}

void canvas_free(Canvas *canvas)
{
    if (!canvas)
        return;
    free_films(canvas);
    krs_rendering_free(canvas->rendering);
    krs_renderer_free(canvas->renderer);
    krs_frame_free(canvas->frame);
    version_release(canvas->version);
    free(canvas);
}

const char *canvas_message(const Canvas *canvas)
{
    return canvas && canvas->renderer ? krs_renderer_message(canvas->renderer) : "out of memory";
}

Version *canvas_version(const Canvas *canvas) { return canvas->version; }

static KrsStatus begin(Canvas *canvas, const KrsScene *scene, KrsIntegrator integrator)
{
    const bool paths  = integrator > KRS_INTEGRATOR_PREVIEW;
    KrsStatus  status = krs_frame_new(scene, &canvas->frame);
    if (status == KRS_OK)
        status = krs_rendering_new_for(
            canvas->renderer, scene, paths ? KRS_FOR_PATHS : KRS_FOR_PICTURES, &canvas->rendering);
    if (status != KRS_OK) {
        krs_frame_free(canvas->frame);
        canvas->frame = NULL;
    }
    return status;
}

/* Frame and rendering are of the same scene, whatever fails. */
static KrsStatus update(Canvas *canvas, const KrsScene *scene)
{
    KrsFrame *frame  = NULL;
    KrsStatus status = krs_frame_new(scene, &frame);
    if (status == KRS_OK)
        status = krs_rendering_update(canvas->rendering, scene);
    if (status != KRS_OK) {
        krs_frame_free(frame);
        return status;
    }
    krs_frame_free(canvas->frame);
    canvas->frame = frame;
    return KRS_OK;
}

KrsStatus canvas_adopt(Canvas *canvas, Version *version, KrsIntegrator integrator)
{
    const KrsScene *scene = version_scene(version);
    if (version == canvas->version)
        return KRS_OK;
    KrsStatus status = canvas->rendering ? update(canvas, scene) : begin(canvas, scene, integrator);
    if (status != KRS_OK)
        return status;
    version_release(canvas->version);
    canvas->version = version_hold(version);
    return KRS_OK;
}

KrsStatus canvas_set(Canvas *canvas, const View *view)
{
    const KrsScene *scene  = version_scene(canvas->version);
    KrsStatus       status = KRS_OK;
    for (size_t i = 0; i < krs_parameter_count(scene); i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        if (krs_frame_set(canvas->frame, parameter.name, view->values[i], parameter.components) !=
            KRS_OK)
            status = KRS_BAD_ARGUMENT;
    }
    if (krs_frame_set_time(canvas->frame, view->time) != KRS_OK ||
        krs_frame_set_zones(canvas->frame, view->zones, view->zone_count) != KRS_OK)
        status = KRS_BAD_ARGUMENT;
    return status;
}

static bool go_on(void *user, double done)
{
    Canvas *canvas = user;
    return !canvas->progress || canvas->progress(canvas->user, done);
}

/* A film of this size, empty if it is new. */
static KrsStatus make_film(Canvas *canvas, Film *film, const View *view, uint32_t width,
                           uint32_t height)
{
    if (film->film && film->width == width && film->height == height &&
        film->integrator == view->integrator && film->samples == view->samples)
        return KRS_OK;
    KrsRenderOptions options = {.width      = width,
                                .height     = height,
                                .samples    = view->samples,
                                .integrator = view->integrator,
                                .slice_ms   = SLICE_MS,
                                .progress   = go_on,
                                .user       = canvas};
    krs_film_free(film->film);
    *film = (Film){NULL, width, height, view->samples, view->integrator};
    return krs_film_new(canvas->rendering, &options, &film->film);
}

KrsStatus canvas_add(Canvas *canvas, FilmKind kind, const View *view, uint32_t width,
                     uint32_t height, uint32_t samples, bool again, KrsProgressCallback *progress,
                     void *user)
{
    Film     *film   = &canvas->films[kind];
    KrsStatus status = make_film(canvas, film, view, width, height);
    if (status != KRS_OK)
        return status;
    if (again)
        krs_film_clear(film->film);
    canvas->progress = progress;
    canvas->user     = user;
    return krs_film_add(film->film, canvas->frame, &view->camera, samples);
}

uint32_t canvas_samples(const Canvas *canvas, FilmKind kind)
{
    return canvas->films[kind].film ? krs_film_samples(canvas->films[kind].film) : 0;
}

KrsStatus canvas_read(Canvas *canvas, FilmKind kind, uint32_t planes, KrsPicture **picture)
{
    return krs_film_read(canvas->films[kind].film, planes, picture);
}
