/*
 * lanes.h: a canvas whose rays lanes of the host march, for views that there are no shaders of.
 */
#ifndef KRS_LIVE_LANES_H
#define KRS_LIVE_LANES_H

#include "live/pictures/canvas.h"

typedef struct Lanes {
    Canvas  *canvas;    /* NULL: the device is none of type CPU, or has failed */
    bool     prepared;  /* it has shaders */
    unsigned structure; /* that it draws; 0: none */
    unsigned refused;   /* that it does not */
    Estimate estimate;  /* of the first view of the structure */
} Lanes;

/* Opens the device, and begins to make the shaders that all pictures need. */
void lanes_open(Lanes *lanes, const KrsRendererOptions *options);
void lanes_close(Lanes *lanes);

/* Tells whether lanes draw what has these needs, if they draw its structure. */
bool lanes_meet(const Needs *needs);

/* Takes lanes over to a view; false: they cannot draw it, or not even the coarsest picture in `budget` milliseconds.
   *fresh: they did not draw its structure before.  `compiling` is asked between shaders, and false ends it. */
bool lanes_take(Lanes *lanes, const View *view, double budget, KrsProgressCallback *compiling,
                void *user, bool *fresh);
/* Notes that lanes have failed at a view of their structure. */
void lanes_give_up(Lanes *lanes, KrsStatus status);

#endif
