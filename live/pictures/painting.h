/*
 * painting.h: one painter, as its parts see it: painting.c, the thread; executors.c, which chooses who draws a view; and
 * refine.c, which makes the pictures of a view.
 */
#ifndef KRS_PAINTING_H
#define KRS_PAINTING_H

#include "live/pictures/builder.h"
#include "live/pictures/lanes.h"
#include "live/pictures/painter.h"
#include "live/pictures/resolution.h"

#include <pthread.h>
#include <stdatomic.h>

/* A coarse picture is interrupted after so many times its budget. */
#define TIMEOUT 6

/* The times of executors for a coarse picture of a structure. */
typedef struct Timing {
    unsigned structure;
    double   lanes_ms, shaders_ms;
} Timing;

struct Painter {
    PainterOptions  options;
    pthread_t       thread;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t  changed;
    bool            quit;
    double          budget;
    View            wanted;
    Shot            shot; /* not taken yet; without pixels: none */
    KrsPicture     *aovs;
    PainterState    state;
    atomic_uint     number;   /* of the wanted view */
    atomic_bool     told;     /* the builder has something to say */
    atomic_bool     prepares; /* the builder's last order is for later */
    Builder        *builder;
    /* of the thread alone */
    Lanes      lanes;
    Canvas    *canvas;  /* with shaders; NULL: none so far */
    Canvas    *drawing; /* one of both, which draws `view`; NULL: there is no picture so far */
    View       view;
    bool       reduced;        /* it is not all that is wanted */
    bool       orders;         /* its shaders, as soon as there is a picture */
    unsigned   ordered;        /* the structure whose shaders were ordered last, */
    double     ordered_at;     /* and when */
    unsigned   shown;          /* number of `view` */
    unsigned   seen;           /* number of the view that there is a picture of */
    uint32_t   seen_samples;   /* of it; 0: it is a coarse one */
    unsigned   filmed;         /* number of the view whose samples the film with all pixels has, */
    Canvas    *filmed_by;      /* and that film's canvas */
    Resolution resolutions[2]; /* [1]: of lanes */
    Timing     timing;
    double     changed_at; /* when the last view came */
    bool       moving;
    double     begun; /* when the picture that is being made was begun */
    FilmKind   making;
    double     grace; /* milliseconds before a change interrupts it, if it is coarse */
};

/* ---- painting.c ---- */

/* Returns the milliseconds of a clock that only goes forward. */
double painter_now(void);
void   painter_wake(const Painter *painter);
/* Tells whether there is something to do: another view, or news of the builder. */
bool painter_is_outdated(const Painter *painter);

/* ---- executors.c ---- */

/* Takes a view over: chooses who draws it, or has its shaders compiled and shows as much of it as there are shaders for. */
void painter_adopt(Painter *painter, View *next);
/* Tells whether lanes draw the view. */
bool painter_lanes_draw(const Painter *painter);
/* Has the shaders compiled that were put off. */
void painter_order_shaders(Painter *painter, const View *view);

/* ---- refine.c ---- */

/* Makes the picture of a view, up to its last sample or until there is another one. */
KrsStatus painter_refine(Painter *painter);
/* Takes the progress of a picture; false: it is interrupted. */
bool painter_report_progress(void *user, double done);
/* Returns how many samples of the view the film with all pixels has. */
uint32_t painter_samples(const Painter *painter);
/* Returns the side of a coarser picture. */
uint32_t painter_divide(uint32_t side, double divisor);

#endif
