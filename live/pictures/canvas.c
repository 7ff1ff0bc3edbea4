/*
 * canvas.c: a scene on a device, and the films of it that a viewer shows.
 */
#include "live/pictures/canvas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Milliseconds of a dispatch: between two of them a change is noticed. */
#define SLICE_MS 10

typedef struct Film {
    KrsFilm      *film;
    uint32_t      width, height, samples;
    KrsIntegrator integrator;
    double        frame_seconds;
} Film;

struct Canvas {
    KrsRenderer  *renderer;
    KrsExecutor   executor;
    KrsRendering *rendering;
    KrsState     *state;
    Version      *version;
    Needs         made;        /* whose shaders there are; the most of each kind */
    bool          previews;    /* such shaders there are */
    bool          paths_first; /* what the rendering is for */
    Film          films[FILM_COUNT];
    /* The progress of the picture that is being made: films keep the functions that they were made
       with. */
    KrsProgressCallback *progress;
    void                *user;
    /* The progress of shaders while canvas_prepare compiles. */
    KrsProgressCallback *compiling;
    void                *compiling_user;
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

static bool tell_compiling(void *user, double done)
{
    Canvas *canvas = user;
    return !canvas->compiling || canvas->compiling(canvas->compiling_user, done);
}

KrsStatus canvas_new(const KrsRendererOptions *options, KrsExecutor executor, Canvas **canvas)
{
    KrsRendererOptions with = *options;
    *canvas                 = calloc(1, sizeof **canvas);
    if (!*canvas)
        return KRS_OUT_OF_MEMORY;
    (*canvas)->executor = executor;
    with.progress       = tell_compiling;
    with.progress_user  = *canvas;
    return krs_renderer_new(&with, &(*canvas)->renderer);
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
    krs_state_free(canvas->state);
    version_release(canvas->version);
    free(canvas);
}

bool canvas_is_of_cpu(const Canvas *canvas)
{
    return krs_renderer_device(canvas->renderer).kind == KRS_DEVICE_CPU;
}

const char *canvas_message(const Canvas *canvas)
{
    return canvas && canvas->renderer ? krs_renderer_message(canvas->renderer) : "out of memory";
}

/* ---- shaders ---- */

static unsigned lens_of(const KrsCamera *camera)
{
    return camera->aperture > 0 ? 2 : camera->projection == KRS_PANORAMA ? 1 : 0;
}

/* Returns the number of zones, these or more, that shaders have room for (krs/vulkan.h). */
static unsigned room_for(size_t zones)
{
    unsigned room = zones > 0;
    while (room < zones)
        room *= 2;
    return room;
}

Needs view_needs(const View *view)
{
    return (Needs){.structure = version_structure(view->version),
                   .paths     = view->integrator > KRS_INTEGRATOR_PREVIEW,
                   .lens      = lens_of(&view->camera),
                   .zones     = room_for(view->zone_count),
                   .points    = view->shading == SHADING_SLOPE};
}

bool needs_are_equal(const Needs *a, const Needs *b)
{
    return a->structure == b->structure && a->paths == b->paths && a->lens == b->lens &&
           a->zones == b->zones && a->points == b->points;
}

bool canvas_meets(const Canvas *canvas, const Needs *needs)
{
    const Needs *made = &canvas->made;
    return made->structure == needs->structure && (needs->paths ? made->paths : canvas->previews) &&
           needs->lens <= made->lens && needs->zones <= made->zones &&
           needs->points <= made->points;
}

unsigned canvas_structure(const Canvas *canvas) { return canvas->made.structure; }

void canvas_reduce(const Canvas *canvas, View *view)
{
    const Needs *made = &canvas->made;
    if (view->integrator > KRS_INTEGRATOR_PREVIEW && !made->paths)
        view->integrator = KRS_INTEGRATOR_PREVIEW;
    else if (view->integrator <= KRS_INTEGRATOR_PREVIEW && !canvas->previews)
        view->integrator = KRS_INTEGRATOR_PATH;
    if (made->lens < 2)
        view->camera.aperture = 0;
    if (made->lens < 1 && view->camera.projection == KRS_PANORAMA) {
        view->camera.projection = KRS_PERSPECTIVE;
        view->camera.fov        = 1;
    }
    if (view->zone_count > made->zones)
        view->zone_count = made->zones;
    if (view->shading == SHADING_SLOPE && !made->points)
        view->shading = SHADING_LIGHT;
}

/* The cameras of a scene are served by its shaders from the beginning. */
static unsigned lens_of_scene(const Canvas *canvas)
{
    const KrsScene *scene = version_scene(canvas->version);
    unsigned        most  = 0;
    for (size_t i = 0; i < krs_camera_count(scene); i++) {
        KrsCamera      camera;
        const unsigned lens = krs_state_camera(canvas->state, i, &camera) == KRS_OK
                                  ? lens_of(&camera)
                                  : 0;
        most                = lens > most ? lens : most;
    }
    return most;
}

static void note_made(Canvas *canvas, const Needs *needs)
{
    Needs         *made = &canvas->made;
    const bool     same = made->structure == needs->structure;
    const Needs    old  = same ? *made : (Needs){0};
    const unsigned lens = lens_of_scene(canvas);
    canvas->previews    = !needs->paths || (same && canvas->previews);
    *made               = *needs;
    made->paths         = needs->paths || old.paths;
    made->lens          = made->lens > old.lens ? made->lens : old.lens;
    made->lens          = made->lens > lens ? made->lens : lens;
    made->zones         = made->zones > old.zones ? made->zones : old.zones;
    made->points        = made->points || old.points;
}

/* Makes state and rendering; what there was stays if that fails. */
static KrsStatus make_rendering(Canvas *canvas, const KrsScene *scene, bool paths)
{
    const KrsPurpose purpose   = canvas->executor == KRS_EXECUTOR_LANES ? KRS_FOR_FIRST_PICTURES
                                 : paths                                ? KRS_FOR_PATHS
                                                                        : KRS_FOR_PICTURES;
    KrsState        *state     = NULL;
    KrsRendering    *rendering = NULL;
    KrsStatus        status    = krs_state_new(scene, &state);
    if (status == KRS_OK)
        status = krs_rendering_new(canvas->renderer, scene, purpose, &rendering);
    if (status != KRS_OK) {
        krs_state_free(state);
        return status;
    }
    free_films(canvas);
    krs_rendering_free(canvas->rendering);
    krs_state_free(canvas->state);
    canvas->rendering   = rendering;
    canvas->state       = state;
    canvas->paths_first = paths;
    return KRS_OK;
}

/* Updates the state and the rendering to another scene: both, or neither where something fails. */
static KrsStatus update(Canvas *canvas, const KrsScene *scene)
{
    KrsState *state  = NULL;
    KrsStatus status = krs_state_new(scene, &state);
    if (status == KRS_OK)
        status = krs_rendering_update(canvas->rendering, scene);
    if (status != KRS_OK) {
        krs_state_free(state);
        return status;
    }
    krs_state_free(canvas->state);
    canvas->state = state;
    return KRS_OK;
}

KrsStatus canvas_adopt(Canvas *canvas, const View *view)
{
    const KrsScene *scene = version_scene(view->version);
    const bool      paths = view_needs(view).paths;
    if (view->version == canvas->version)
        return KRS_OK;
    const bool updates = canvas->rendering &&
                         (canvas->paths_first == paths ||
                          version_structure(view->version) == version_structure(canvas->version));
    KrsStatus status = updates ? update(canvas, scene) : make_rendering(canvas, scene, paths);
    if (status != KRS_OK)
        return status;
    if (canvas->executor == KRS_EXECUTOR_LANES) {
        canvas->made     = (Needs){.structure = version_structure(view->version)};
        canvas->previews = true;
    } else if (canvas->made.structure != version_structure(view->version)) {
        canvas->made     = (Needs){0};
        canvas->previews = false;
    }
    version_release(canvas->version);
    canvas->version = version_hold(view->version);
    return KRS_OK;
}

/* The sides of a picture that only compiles; lanes need no shader for more rays. */
#define MIN_SIDE          32
#define MIN_SIDE_OF_LANES 8

/* Makes a small picture: some shaders are compiled when one needs them. */
static KrsStatus try_out(Canvas *canvas, const View *view)
{
    KrsStatus status = canvas_adopt(canvas, view);
    if (status != KRS_OK)
        return status;
    canvas_set(canvas, view); /* values that are refused need no other shaders */
    const uint32_t side = canvas->executor == KRS_EXECUTOR_LANES ? MIN_SIDE_OF_LANES : MIN_SIDE;
    status              = canvas_add(canvas, FILM_COARSE, view, side, side, 1, true, NULL, NULL);
    if (status != KRS_OK || view->shading != SHADING_SLOPE)
        return status;
    const float point[1][3] = {{0, 0, 0}};
    float       distance;
    return krs_device_distance(canvas->rendering, canvas->state, point, 1, &distance);
}

KrsStatus canvas_prepare(Canvas *canvas, const View *view, KrsProgressCallback *compiling,
                         void *user)
{
    const Needs needs      = view_needs(view);
    canvas->compiling      = compiling;
    canvas->compiling_user = user;
    const KrsStatus status = try_out(canvas, view);
    canvas->compiling      = NULL;
    if (status == KRS_OK)
        note_made(canvas, &needs);
    return status;
}

void canvas_rest(Canvas *canvas) { free_films(canvas); }

KrsStatus canvas_set(Canvas *canvas, const View *view)
{
    const KrsScene *scene  = version_scene(canvas->version);
    KrsStatus       status = KRS_OK;
    for (size_t i = 0; i < krs_parameter_count(scene); i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        if (krs_state_set(canvas->state, parameter.name, view->values[i], parameter.components) !=
            KRS_OK)
            status = KRS_BAD_ARGUMENT;
    }
    if (krs_state_set_time(canvas->state, view->time) != KRS_OK ||
        krs_state_set_zones(canvas->state, view->zones, view->zone_count) != KRS_OK)
        status = KRS_BAD_ARGUMENT;
    return status;
}

KrsStatus canvas_camera(Canvas *canvas, size_t index, KrsCamera *camera)
{
    return krs_state_camera(canvas->state, index, camera);
}

static bool report_progress(void *user, double done)
{
    Canvas *canvas = user;
    return !canvas->progress || canvas->progress(canvas->user, done);
}

/* Makes a film of this size, empty if it is new. */
static KrsStatus make_film(Canvas *canvas, Film *film, const View *view, uint32_t width,
                           uint32_t height)
{
    if (film->film && film->width == width && film->height == height &&
        film->integrator == view->integrator && film->samples == view->samples &&
        film->frame_seconds == view->frame_seconds)
        return KRS_OK;
    KrsRenderOptions options = {.width         = width,
                                .height        = height,
                                .samples       = view->samples,
                                .integrator    = view->integrator,
                                .frame_seconds = view->frame_seconds,
                                .slice_ms      = SLICE_MS,
                                .methods       = {.executor = canvas->executor},
                                .progress      = report_progress,
                                .user          = canvas};
    krs_film_free(film->film);
    *film = (Film){NULL, width, height, view->samples, view->integrator, view->frame_seconds};
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
    return krs_film_add(film->film, canvas->state, &view->camera, samples);
}

KrsStatus canvas_try_lanes(Canvas *canvas, const View *view, Estimate *estimate)
{
    Film     *film   = &canvas->films[FILM_FULL];
    KrsStatus status = canvas_adopt(canvas, view);
    if (status == KRS_OK) {
        canvas_set(canvas, view);
        status = make_film(canvas, film, view, view->width, view->height);
    }
    return status == KRS_OK ? krs_film_try_lanes(film->film, canvas->state, &view->camera,
                                                 &estimate->lanes_ms, &estimate->compiler_ms)
                            : status;
}

uint32_t canvas_samples(const Canvas *canvas, FilmKind kind)
{
    return canvas->films[kind].film ? krs_film_samples(canvas->films[kind].film) : 0;
}

KrsStatus canvas_read(Canvas *canvas, FilmKind kind, uint32_t aovs, KrsPicture **picture)
{
    return krs_film_read(canvas->films[kind].film, aovs, picture);
}

/* Slopes are measured so far before and behind the surface, in parts of the depth. */
#define SLOPE_STEP 5e-4

/* Places two points for each pixel that hits something. */
static size_t place_points(const KrsPicture *picture, float (*points)[3], float *steps)
{
    const size_t count = (size_t)picture->width * picture->height;
    size_t       used  = 0;
    for (size_t i = 0; i < count; i++) {
        const float step = (float)(SLOPE_STEP * fabs(picture->depth[i]));
        if (picture->component[i] == 0)
            continue;
        for (int side = 0; side < 2; side++)
            for (int k = 0; k < 3; k++)
                points[2 * used + (size_t)side][k] = picture->position[3 * i + (size_t)k] +
                                                     (side ? step : -step) *
                                                         picture->normal[3 * i + (size_t)k];
        steps[used++] = step;
    }
    return used;
}

float *canvas_slopes(Canvas *canvas, const KrsPicture *picture)
{
    const size_t count = (size_t)picture->width * picture->height;
    float(*points)[3]  = malloc(2 * count * sizeof *points);
    float *steps = malloc(count * sizeof *steps), *slopes = calloc(count, sizeof *slopes);
    float *distances = malloc(2 * count * sizeof *distances);
    bool   good      = points && steps && slopes && distances;
    if (good) {
        const size_t used = place_points(picture, points, steps);
        good = krs_device_distance(canvas->rendering, canvas->state, (const float(*)[3])points,
                                   2 * used, distances) == KRS_OK;
        for (size_t i = 0, at = 0; good && i < count; i++)
            if (picture->component[i] != 0) {
                slopes[i] = fabsf(distances[2 * at + 1] - distances[2 * at]) / (2 * steps[at]);
                at++;
            }
    }
    free(points);
    free(steps);
    free(distances);
    if (!good) {
        free(slopes);
        slopes = NULL;
    }
    return slopes;
}
