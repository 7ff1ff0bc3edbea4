/*
 * plan.h: a plan: the passes over lists of pixels that render one ray of each pixel.
 *
 * An integrator appends the passes of a frame to a plan.  The plan then runs for each ray of the
 * pixels of each band.
 */
#ifndef KRS_PLAN_H
#define KRS_PLAN_H

#include "rays/rays.h"
#include "rays/surfaces.h"
#include "runtime/tracer/march.h"

/* A list that a pass reads or writes: LIST_... of blocks.h, or one of these. */
typedef uint32_t ListId;
enum {
    LIST_OF_QUARTERS = 1 + LIST_SHARED, /* the quarters of tiles in which something is hit */
    LIST_OF_BAND,                       /* all quarters of tiles of the band */
    LIST_OF_PIXELS,                     /* all slots of pixels of tiles of the band */
    LIST_OF_PATHS,                      /* pixels whose paths go on */
    NO_LIST
};

/* Values of the control block that belong to a pass (blocks.h has their meanings). */
typedef struct PassConstants {
    uint32_t phase, light, value, filters, of_paths, color_row, count;
} PassConstants;

typedef enum PassKind {
    PASS_CLEAR,    /* sets all rays to misses */
    PASS_LANES,    /* primary rays, or those of paths, by lanes of the host, until all have ended */
    PASS_SURFACES, /* what surfaces of hits are, by lanes of the host */
    PASS_OCCLUDERS, /* and of what rays over the hemisphere have met */
    PASS_MARCH,     /* beams, then primary rays until all have ended */
    PASS_ITEMS,     /* a shader over items that all cost the same */
    PASS_RAYS,      /* rays from the items of a list, each to its end */
    PASS_LANE_RAYS  /* the same, by lanes of the host */
} PassKind;

typedef struct Pass {
    PassKind      kind;
    KrsPhase      phase;  /* to which its time is added */
    float         weight; /* its part of the progress, relative to other passes */
    const March  *march;  /* PASS_MARCH alone; the members below are for the others */
    const Shader *shader;
    const Shader *arrive;  /* PASS_LANE_RAYS: behind the rays; `shader` is before them */
    ListId        in, out; /* the list that is read, and the one that is emptied and written */
    bool          with_previous; /* may share a submission with the previous pass */
    bool          clears_shared; /* the words of shared.glsl are cleared before */
    bool          short_items;   /* PASS_ITEMS: no item goes through long loops but a distance's */
    PassConstants constants;
} Pass;

enum { MAX_FUSED = 1 + KRS_MAX_MARCH_GROUPS }; /* passes in one submission */

/* What an integrator does before the passes of each sample of a band. */
typedef struct Before {
    bool (*run)(Job *job, void *own, uint32_t sample); /* NULL: nothing */
    void (*free)(Gpu *gpu, void *own);
    void *own;
} Before;

typedef struct Plan {
    Gpu          *gpu; /* whose allocator the passes come from */
    Pass         *passes;
    size_t        count, room;
    double        weight;                            /* of all passes together */
    March         marches[2 + KRS_MAX_MARCH_GROUPS]; /* of primary rays, and of those of paths */
    size_t        march_count;
    RayField     *field;    /* of PASS_LANES; or NULL.  It and surfaces belong to the rendering */
    SurfaceField *surfaces; /* of PASS_SURFACES; or NULL */
    uint32_t      surface_rows; /* of each hit, then */
    Before        before;
    uint32_t      halo;           /* pixels on each side of a band that are traced as well */
    bool          has_paths;      /* each pixel follows a path */
    bool          by_march_group; /* pixels are listed by the group of components that they hit */
    bool          failed;         /* memory ran out, which is noted */
} Plan;

void plan_add(Plan *plan, Pass pass);
/* Adds a march and its pass. */
void plan_add_march(Plan *plan, const March *march, float weight);
/* Adds a pass of the march that was added last. */
void plan_add_march_again(Plan *plan, float weight);
void plan_free(Plan *plan);
/* Return the rows of each pixel for its path, and for rays of its hit that lanes of the host
   march. */
uint32_t plan_path_rows(const Plan *plan);
/* Runs all passes for ray `index` of every pixel of the band, and adds its light to the results.
   `progress_done` and `progress_share` of the job are those of this run, and are changed. */
bool plan_run(Job *job, const Plan *plan, WorkBlock *work, uint32_t index);

#endif
