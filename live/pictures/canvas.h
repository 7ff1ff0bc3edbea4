/*
 * canvas.h: a scene on a device, and the films of it that a viewer shows.
 *
 * A canvas belongs to one thread at a time.
 */
#ifndef KRS_CANVAS_H
#define KRS_CANVAS_H

#include "live/pictures/false_color.h"
#include "live/text/document.h"
#include "krs/vulkan.h"

/* The scene and settings that are to be seen. */
typedef struct View {
    Version  *version; /* held */
    KrsCamera camera;
    double    time;
    double (*values)[4]; /* of each parameter of the version */
    double        zones[KRS_MAX_ZONES][4];
    size_t        zone_count;
    uint32_t      width, height;
    KrsIntegrator integrator;
    uint32_t      samples;       /* how many make the picture complete */
    double        stops;         /* brighter than the scene's exposure */
    double        frame_seconds; /* between frames, for shutters; 0: they count as closed */
    ShadingMode   shading;
} View;

/* Copies a view for view_free; false: without memory. */
bool view_copy(const View *view, View *copy);
void view_free(View *view);

/* A coarse picture for what moves, and the whole one. */
typedef enum FilmKind { FILM_COARSE, FILM_FULL, FILM_COUNT } FilmKind;

typedef struct Canvas Canvas;

/* Opens a device.  `executor` marches the rays of all its pictures: KERNELS, or LANES, which make previews alone, and
   without shaders of the scene.  The caller frees the canvas whatever the status; NULL: without memory. */
KrsStatus canvas_new(const KrsRendererOptions *options, KrsExecutor executor, Canvas **canvas);
void      canvas_free(Canvas *canvas);
/* Tells whether the device is of type CPU. */
bool canvas_is_of_cpu(const Canvas *canvas);
/* Returns one line about the last failure. */
const char *canvas_message(const Canvas *canvas);

/* The properties that the shaders of a view depend on. */
typedef struct Needs {
    unsigned structure; /* of the version */
    bool     paths;     /* or previews */
    unsigned lens;   /* 2: the camera has a lens; 1: it is a panorama; those with more serve all */
    unsigned zones;  /* there is room for so many */
    bool     points; /* distances of points are asked for */
} Needs;
Needs view_needs(const View *view);
bool  needs_are_equal(const Needs *a, const Needs *b);
/* Tells whether a canvas shows what has these needs without compiling shaders. */
bool canvas_meets(const Canvas *canvas, const Needs *needs);

/* Returns the structure that a canvas has shaders of; 0: none. */
unsigned canvas_structure(const Canvas *canvas);
/* Takes out of a view of that structure what the canvas has no shaders for. */
void canvas_reduce(const Canvas *canvas, View *view);

/* The times of executors for a view, by estimate: milliseconds of a sample of all pixels by lanes,
   and of compilers. */
typedef struct Estimate {
    double lanes_ms, compiler_ms;
} Estimate;

/* Takes the canvas over to a view, and estimates it.  KRS_BAD_ARGUMENT: lanes cannot draw it. */
KrsStatus canvas_try_lanes(Canvas *canvas, const View *view, Estimate *estimate);
/* Compiles the shaders of a view; `compiling` may be NULL. */
KrsStatus canvas_prepare(Canvas *canvas, const View *view, KrsProgressCallback *compiling,
                         void *user);
/* Takes the canvas over to the view's version, if it has another one.  If that fails, the version
   before stays. */
KrsStatus canvas_adopt(Canvas *canvas, const View *view);
/* Frees what pictures need. */
void canvas_rest(Canvas *canvas);

/* Sets the state to the view's values and time.  Those that the scene refuses stay as they were:
   KRS_BAD_ARGUMENT. */
KrsStatus canvas_set(Canvas *canvas, const View *view);

/* Finds a camera of the scene, as it is at the values and the time. */
KrsStatus canvas_camera(Canvas *canvas, size_t index, KrsCamera *camera);

/* Adds samples to a film of this size, which begins anew when `again`.  `progress` is asked between slices. */
KrsStatus canvas_add(Canvas *canvas, FilmKind kind, const View *view, uint32_t width,
                     uint32_t height, uint32_t samples, bool again, KrsProgressCallback *progress,
                     void *user);
uint32_t  canvas_samples(const Canvas *canvas, FilmKind kind);
/* Reads the picture of a film, with these AOVs (0: all that it has); the caller frees it. */
KrsStatus canvas_read(Canvas *canvas, FilmKind kind, uint32_t aovs, KrsPicture **picture);

/* Tells how fast the distance changes along the normal of each pixel of a picture, of how fast it may; 0
   where nothing is hit.  The caller frees the numbers; NULL: it failed. */
float *canvas_slopes(Canvas *canvas, const KrsPicture *picture);

#endif
