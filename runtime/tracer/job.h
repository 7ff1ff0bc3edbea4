/*
 * job.h: a job: samples of a picture that are being rendered, and the dispatches for them.
 */
#ifndef KRS_JOB_H
#define KRS_JOB_H

#include <stddef.h>

#include "runtime/tracer/handles.h"

/* The number of items of a dispatch: `each`, or `each` times a counter of the control block.  The
   counter is read when the dispatch runs, and is 0 afterwards if `resets`. */
typedef struct Items {
    uint32_t each;
    uint32_t counter; /* the index of its word in the block; 0: none */
    bool     resets;
} Items;
#define WORD_OF(counter)          (offsetof(ControlBlock, counter) / sizeof(uint32_t))
#define ITEMS_COUNTED(each, name) ((Items){(each), WORD_OF(name), false})
#define ITEMS_KNOWN(count)        ((Items){(count), 0, false})

/* The assignment of items to lanes (schedule.glsl): the lanes of a workgroup, the items of a lane,
   and its most steps in a dispatch. */
typedef struct LaneBudget {
    uint32_t lanes, items_per_lane, steps;
} LaneBudget;
#define MAX_LANE_STEPS 16384 /* for all items that a lane takes in a dispatch */
#define MAX_BEAM_STEPS 256   /* for a beam, as in trace.comp */

typedef struct Dispatch {
    KrsPhase      phase;
    const Shader *shader;
    ControlBlock  control; /* the host's part of it; the counters are not used */
    WorkBlock     work;
    Items         items;
    uint32_t      in_group;      /* items of a workgroup */
    uint32_t      clears;        /* a counter to set to 0 before, as in Items; 0: none */
    bool          clears_shared; /* the words of shared.glsl are cleared before */
} Dispatch;

/* Dispatches that wait to be submitted together. */
typedef struct Chain {
    Dispatch list[MAX_CHAINED];
    uint32_t count;
} Chain;

typedef struct Job {
    KrsRendering    *rendering;
    Gpu             *gpu;
    KrsState        *state;
    KrsRenderOptions options;        /* complete: none asks for a default */
    KrsSchedule      asked_schedule; /* as the caller asked for it */
    KrsSchedule      schedule;       /* of the current shader */
    KrsView          view;
    const KrsRays   *rays; /* a list of rays; NULL: they are those of the view's camera */
    uint32_t         first_rows, later_rows; /* of results that rays store: the first, others */
    FrameBlock       frame;
    uint32_t         photons_at;             /* the row of inputs where there is room for photons */
    EmissiveBlock    emissive[MAX_EMISSIVE]; /* frame.emissive_count of them */
    double           rebase_origin[3];       /* points on the device are relative to it */
    bool             begins_outside;         /* all rays begin outside of all solids */
    KrsWindow        cover;                  /* the crop, extended to whole tiles */
    KrsWindow        window;           /* the pixels whose rays may meet what is marched now */
    KrsRenderStats  *stats;            /* the job adds to them */
    double           part_begun, part; /* progress before these samples; their part of 1 */
    double           progress_done, progress_share; /* done before this pass; its part of 1 */
    double           progress_shown;                /* the last progress that was reported */
    Chain            chain;
} Job;

/* Tells whether points on the device are relative to another origin than the scene's. */
static inline bool job_is_camera_relative(const Job *job)
{
    return job->rebase_origin[0] != 0 || job->rebase_origin[1] != 0 || job->rebase_origin[2] != 0;
}

/* Notes why a call is refused; returns false. */
bool job_refuse(Job *job, const char *words);
/* Reads a state: lights, parameters, and the camera or the rays of a list.  `camera` may be NULL
   for that of the options, which must be complete (settings.h). */
bool job_read_frame(Job *job, KrsState *state, const KrsCamera *camera);
/* Returns the shader without a scene for the rays of this frame. */
const Shader *job_pixel_shader(const Job *job, PixelShader shader);
/* Tells whether rays to lights and for occlusion intersect planes without a march. */
bool job_light_meets_planes(const Job *job);
/* Finds the box around all components but planes, relative to the rebase origin. */
void job_find_rest(const Job *job, double low[3], double high[3]);
/* Tells whether beams march the empty space that the rays of a tile share. */
bool job_has_beams(const Job *job);

/* Returns the number of 8x8 tiles of a band. */
uint32_t tiles_of_band(const WorkBlock *work);

#endif
