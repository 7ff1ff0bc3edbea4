/*
 * viewer_options.h: what a viewer is started with.
 */
#ifndef KRS_VIEWER_OPTIONS_H
#define KRS_VIEWER_OPTIONS_H

#include "krs/vulkan.h"
#include "live/text/document.h"

/* A value of a parameter to begin with. */
typedef struct ViewerSetting {
    const char   *name;
    const double *values;
    size_t        count;
} ViewerSetting;

typedef struct ViewerOptions {
    const char  *path;
    SuppliedText supplied; /* the scene, where `path` is a pack: nothing can be written into it */
    KrsOptions   scene;
    KrsRendererOptions   renderer;
    uint32_t             width, height; /* of the window; 0: the scene's, or the default */
    uint32_t             samples;       /* of a complete picture; 0: the scene's, or the default */
    KrsIntegrator        integrator;    /* default: the scene's */
    KrsExecutor          executor;      /* of what the window shows (painter.h) */
    const char          *camera;        /* NULL: the first */
    double               time, fps;
    const ViewerSetting *settings;
    size_t               setting_count;
    double (*zones)[4];
    size_t zone_count;
    bool   terminal; /* in place of a window */
    double budget;   /* milliseconds of a frame while something moves; 0: the default */
    /* Told when nothing can be done before the scene has been read (true), and when it has been (false): at the
       beginning, and at the end if it is being read.  NULL: nobody wants to know. */
    void (*reads)(void *user, bool begins);
    /* Asked between frames: true ends the viewer. */
    bool (*stopped)(void *user);
    /* The connection to the display is lost: does not return. */
    void (*lost)(void);
    void *user;
} ViewerOptions;

/* Samples of a complete picture where nobody says. */
#define VIEWER_SAMPLES 16

#endif
