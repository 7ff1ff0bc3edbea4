/*
 * painter.h: a thread that makes pictures of what is to be seen, so that nobody waits for them.
 *
 * A change is shown at once, with as few pixels as the time for a frame needs; then with all of
 * them; then with more and more samples.  Until there are shaders for it lanes of the host draw it, where they can.
 */
#ifndef KRS_PAINTER_H
#define KRS_PAINTER_H

#include "live/pictures/canvas.h"

typedef struct PainterOptions {
    KrsRendererOptions renderer;
    void (*wake)(void *user); /* called in the painter's thread: there is something new */
    void       *user;
    double      budget;   /* milliseconds that a frame may take while something moves */
    KrsExecutor executor; /* DEFAULT: lanes until there are shaders, then whichever is faster */
} PainterOptions;

/* A picture of a view. */
typedef struct Shot {
    uint8_t       *pixels;        /* 8-bit sRGB, four bytes a pixel, from the top */
    uint32_t       width, height; /* of these; the view's, or fewer */
    uint32_t       samples;
    bool           whole;         /* with all pixels of the view */
    unsigned       view, version; /* numbers of the view, and of the version that is seen */
    double         ms;            /* what it took to make */
    KrsRenderStats stats;
} Shot;

/* The hits of the first ray of each pixel, for the last view of which there is a picture. */
typedef struct Found {
    bool     hit;
    double   position[3], normal[3], depth;
    uint32_t component, level, instance, steps;
} Found;

typedef struct PainterState {
    bool
              compiling; /* shaders of what is wanted; meanwhile lanes show it, or else the version before is shown */
    double    compiled;     /* the part of them that is done */
    bool      busy;         /* a picture is made or refined */
    KrsStatus status;       /* not KRS_OK: the painter has ended */
    char      message[256]; /* why */
    char      unbuilt[256]; /* why there are no shaders of what is wanted; "" if there are */
    bool      refused;      /* the scene refuses a value, or the time */
    unsigned  version;      /* the number of the one that is shown; 0: none */
    char      device[256];
} PainterState;

typedef struct Painter Painter;

/* Makes a painter, whose device is opened in its thread; NULL: without memory. */
Painter *painter_new(const PainterOptions *options);
void     painter_free(Painter *painter);

/* Shows a view from now on; returns its number. */
unsigned painter_show(Painter *painter, const View *view);
/* Compiles the shaders of a view that may be shown later, unless there is something else to do; true:
   they are there. */
bool painter_prepare(Painter *painter, const View *view);
void painter_set_budget(Painter *painter, double ms);
/* Takes the newest picture, if none took it before; the caller frees its pixels. */
bool painter_take(Painter *painter, Shot *shot);
/* Finds what is in the picture at these parts of its width and height, from the top left. */
Found        painter_find(Painter *painter, double x, double y);
PainterState painter_state(Painter *painter);

#endif
