/*
 * profiler.h: a thread that finds what the parts of a scene cost, while the window goes on.
 */
#ifndef KRS_PROFILER_H
#define KRS_PROFILER_H

#include "live/pictures/canvas.h"

/* A part, or all others; what several have in common comes behind these. */
typedef struct CostLine {
    char    words[120]; /* "41.2 %  rest of gear(12)" */
    char    place[300]; /* "gear.krs:14"; empty: none */
    uint8_t color[3];   /* of its pixels, 8-bit sRGB */
} CostLine;

#define MAX_COST_LINES 52 /* parts of 2 % and more are 50 at most */

/* The costs of a view. */
typedef struct Costs {
    CostLine lines[MAX_COST_LINES];
    size_t   count, untimed; /* parts for which there was no time */
    uint8_t
        *line_of; /* for each pixel of a coarse picture the line from 1 of what is seen; 0: none */
    uint32_t width, height;
} Costs;
void costs_free(Costs *costs);
/* Gives each pixel of a picture of that view, four bytes from the top, the colour of its part, as bright as its light. */
void costs_tint(const Costs *costs, uint8_t *pixels, uint32_t width, uint32_t height);

typedef struct ProfilerState {
    bool      busy;
    double    done;
    unsigned  orders; /* that have ended */
    KrsStatus status; /* of the last one */
    char      message[300];
} ProfilerState;

typedef struct Profiler Profiler;

/* Scenes are compiled from the file, with these options; all must outlive the profiler.  `told` is called in its
   thread, when the state has changed.  NULL: without memory. */
Profiler *profiler_new(const KrsRendererOptions *renderer, const KrsOptions *scene,
                       const char *path, SuppliedText supplied, void (*told)(void *user),
                       void *user);
void      profiler_free(Profiler *profiler);

/* Times what this view shows; false: it is busy, or there is no memory. */
bool          profiler_start(Profiler *profiler, const View *view);
void          profiler_cancel(Profiler *profiler);
ProfilerState profiler_state(Profiler *profiler);
/* Takes what the last order has found, which the caller frees; false: nothing, or it was taken. */
bool profiler_take(Profiler *profiler, Costs *costs);

#endif
