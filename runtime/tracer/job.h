/*
 * job.h: samples of a picture under way, and what is sent to the device for them.
 */
#ifndef KRS_JOB_H
#define KRS_JOB_H

#include <stddef.h>

#include "runtime/tracer/handles.h"

/* How many items a dispatch has: `each` times a counter of the control block, as it is when the
   dispatch runs, and 0 afterwards if `resets`; or just `each`. */
typedef struct Items {
    uint32_t each;
    uint32_t counter; /* its number among the words of the block; 0: none */
    bool     resets;
} Items;
#define WORD_OF(counter)          (offsetof(ControlBlock, counter) / sizeof(uint32_t))
#define ITEMS_COUNTED(each, name) ((Items){(each), WORD_OF(name), false})
#define ITEMS_KNOWN(count)        ((Items){(count), 0, false})

/* How items are assigned to lanes (schedule.glsl): lanes of a workgroup, items of a lane, and the
   steps that a lane may take in a dispatch. */
typedef struct LaneBudget {
    uint32_t lanes, items_per_lane, steps;
} LaneBudget;
#define MOST_LANE_STEPS 16384 /* of a lane that takes item after item */
#define MOST_BEAM_STEPS 256   /* of a beam, as in trace.comp */

typedef struct Dispatch {
    KrsPhase      phase;
    const Kernel *kernel;
    ControlBlock  control; /* what the host tells the kernel; no counters */
    WorkBlock     work;
    Items         items;
    uint32_t      in_group;      /* items of a group */
    uint32_t      clears;        /* the counter that is 0 before it, as in Items */
    bool          clears_shared; /* rays have shared nothing before it (shared.glsl) */
} Dispatch;

/* Dispatches that wait to be sent together. */
typedef struct Chain {
    Dispatch list[MOST_CHAINED];
    uint32_t count;
} Chain;

typedef struct Job {
    KrsRendering    *rendering;
    Gpu             *gpu;
    KrsRenderOptions options;  /* with nothing left to be defaulted */
    KrsSchedule      asked;    /* for */
    KrsSchedule      schedule; /* of the kernel that runs now */
    KrsView          view;
    const KrsRays   *rays; /* of a list; NULL: they are those of the view's camera */
    FrameBlock       frame;
    double    rebase_origin[3]; /* that points are given from on the device; 0: they are not */
    bool      begins_outside;   /* whether all rays begin outside of everything */
    KrsWindow cover;            /* the tiles that the crop has a part of */
    KrsWindow window;           /* of the picture: where rays may meet what is marched now */
    KrsRenderStats *stats;      /* that grow */
    double          progress_done, progress_share; /* of the whole: before this pass, and of it */
    double          progress_shown;                /* the progress that was reported */
    Chain           chain;
} Job;

/* Notes why a call is refused; returns false. */
bool job_refuse(Job *job, const char *words);
/* Reads a frame: the camera (NULL: the one of the options) or the rays, lights and parameters; of the
   options none may be left to be defaulted (settings.h). */
bool job_read_frame(Job *job, KrsFrame *frame, const KrsCamera *camera);
/* How wide a pixel in the middle of the picture, or a ray of the list, is at a distance. */
double job_pixel(const Job *job, double distance);
/* The kernel without a scene for the rays of this frame. */
const Kernel *job_pixel_kernel(const Job *job, PixelKernel kernel);
/* Whether the rays of tiles share beams. */
bool job_has_beams(const Job *job);

/* How many tiles a band has. */
uint32_t tiles_of_band(const WorkBlock *work);

#endif
