/*
 * phases.h: a render under way, and one ray of each pixel of a band.
 */
#ifndef KRS_PHASES_H
#define KRS_PHASES_H

#include "runtime/tracer/dispatch.h"
#include "runtime/tracer/renderer.h"

/* A group of components, to be marched by itself. */
typedef struct MarchPart {
    uint32_t group;
    Kernel  *trace;
    Kernel  *normals; /* NULL: they are found by the whole distance */
    KrsSchedule schedule;
} MarchPart;

typedef struct Job {
    KrsRendering    *rendering;
    Gpu             *gpu;
    KrsRenderOptions options; /* with nothing left to be defaulted */
    KrsSchedule      asked;    /* for */
    KrsSchedule      schedule; /* of the items that are dealt out now */
    KrsView          view;
    FrameBlock       frame;
    double           anchor[3]; /* that points are given from on the device; 0: they are not */
    Kernel          *trace, *beams, *around, *shade;
    Kernel          *shadows, *roots; /* of rays to lights, and to points of lights where those go
                                         from root to root; NULL where no light needs it */
    MarchPart        parts[KRS_MOST_GROUPS]; /* the nearest first */
    bool             rest;                   /* planes are not marched, but known (FLATS) */
    uint32_t         part_count;             /* 0: all are marched together, by `trace` */
    bool             sparse; /* shadows and occlusion are found for a quarter of the pixels */
    KrsWindow        window; /* of the picture: where rays may meet what is marched now */
    KrsWindow        cover;  /* the tiles that the crop has a part of: what is traced */
    KrsPicture      *picture;
    double           done, share; /* of the whole: before this phase, and of it */
    double           shown;       /* the progress that was reported */
    Chain            chain;
} Job;

/* Whether rays to a light go to points of it, not to all of it at once. */
bool lights_by_points(const Job *job, const KrsLight *light);

/* Traces ray number `index` of every pixel of the band and adds what it sees to the results.
   `done` and `share` of the job are its own. */
bool phases_run(Job *job, WorkBlock *work, uint32_t index);

/* ---- apart.c ---- */
/* Finds the parts that are marched one by one in this frame, and their kernels. */
bool apart_prepare(Job *job, KrsFrame *frame);
/* Whether all rays of the camera begin outside of everything. */
bool begins_outside(const Job *job, KrsFrame *frame);

#endif
