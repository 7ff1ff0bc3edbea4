/*
 * phases.h: a render under way, and one ray of each pixel of a band.
 */
#ifndef KRS_PHASES_H
#define KRS_PHASES_H

#include "runtime/tracer/dispatch.h"
#include "runtime/tracer/renderer.h"

/* A group of components, to be marched by itself. */
typedef struct GroupMarch {
    uint32_t    march_group;
    Kernel     *trace;
    Kernel     *normals; /* NULL: they are found by the whole distance */
    KrsSchedule schedule;
} GroupMarch;

typedef struct Job {
    KrsRendering    *rendering;
    Gpu             *gpu;
    KrsRenderOptions options;  /* with nothing left to be defaulted */
    KrsSchedule      asked;    /* for */
    KrsSchedule      schedule; /* of the kernel that runs now */
    KrsView          view;
    FrameBlock       frame;
    double      rebase_origin[3]; /* that points are given from on the device; 0: they are not */
    Kernel     *trace, *beams, *normals, *shade;
    Kernel     *secondary; /* NULL: there is neither occlusion nor a light with shadows */
    bool        by_roots;  /* its rays go from root to root */
    GroupMarch  group_marches[KRS_MOST_MARCH_GROUPS]; /* the nearest first */
    bool        knows_planes;      /* rays intersect planes without a march (PLANES) */
    uint32_t    group_march_count; /* 0: all are marched together, by `trace` */
    bool        filters_shadows;   /* neighbours share what rays to lights find */
    KrsWindow   window;            /* of the picture: where rays may meet what is marched now */
    KrsWindow   cover;             /* the tiles that the crop has a part of */
    uint32_t    halo;              /* so many pixels around what is asked for are traced as well */
    KrsPicture *picture;
    double      progress_done, progress_share; /* of the whole: before this phase, and of it */
    double      progress_shown;                /* the progress that was reported */
    Chain       chain;
} Job;

/* Traces ray number `index` of every pixel of the band and adds what it sees to the results.
   `progress_done` and `progress_share` of the job are its own. */
bool phases_run(Job *job, WorkBlock *work, uint32_t index);

/* ---- march.c ---- */
/* Finds what the rays hit: beams first, then the rays; of groups of components one by one. */
bool march_all(Job *job, const WorkBlock *work);
/* How many tiles the band has. */
uint32_t tiles_of_band(const WorkBlock *work);

/* ---- per_component.c ---- */
/* Finds the parts that are marched one by one in this frame, and their kernels. */
bool per_component_prepare(Job *job, KrsFrame *frame);
/* Whether all rays of the camera begin outside of everything. */
bool begins_outside(const Job *job, KrsFrame *frame);

#endif
