/*
 * trial.h: what a window of `krs view` shows pictures of (live/pictures/painter.h), without the window.
 */
#ifndef KRS_BENCH_TRIAL_H
#define KRS_BENCH_TRIAL_H

#include "live/pictures/painter.h"

/* Pixels of the window, and milliseconds of a picture while something moves. */
enum { TRIAL_WIDTH = 640, TRIAL_HEIGHT = 360, TRIAL_BUDGET = 40 };

typedef struct Trial {
    const char *path;
    Document   *document;
    Painter    *painter;
    View        view;
    unsigned    number; /* of the view that was shown last */
    bool        whole;  /* the last picture of it has all pixels */
} Trial;

/* Seconds of a clock. */
double trial_now(void);

/* Begins to read a scene, and to paint by an executor; the device is KRS_DEVICE, the folder of caches KRS_VIEW_CACHE.  All
   functions end the process where they fail. */
Trial trial_open(const char *path, KrsExecutor executor, KrsSpecialize specialize);
void  trial_close(Trial *trial);
/* Takes the version of the document, with the defaults of its parameters, and the camera that the scene has. */
void trial_take_version(Trial *trial);
void trial_take_camera(Trial *trial);
void trial_show(Trial *trial);
/* Waits for the next picture of the last view: its width. */
uint32_t trial_await(Trial *trial, bool whole);
/* Waits until nothing is drawn, and then until no shaders are compiled. */
void trial_await_rest(Trial *trial);
void trial_await_shaders(Trial *trial);

#endif
