/*
 * plan.h: what is done for a ray of each pixel, as passes over lists of pixels.
 *
 * An integrator appends the passes of a frame to a plan.  The plan then runs for each ray of the
 * pixels of each band.
 */
#ifndef KRS_PLAN_H
#define KRS_PLAN_H

#include "runtime/tracer/march.h"

/* What a pass reads: a list of pixels, LIST_... of blocks.h, or one of these. */
typedef uint32_t ListId;
enum {
    LIST_OF_QUARTERS = 1 + LIST_SHARED, /* the quarters of tiles in which something is hit */
    LIST_OF_BAND,                       /* all quarters of tiles of the band */
    NO_LIST
};

/* What a kernel is told for a pass (the control block has the meanings). */
typedef struct PassConstants {
    uint32_t phase, light, value, filters;
} PassConstants;

typedef enum PassKind {
    PASS_CLEAR, /* all rays miss until one is found to hit */
    PASS_MARCH, /* beams, then primary rays until all have ended */
    PASS_ITEMS, /* a kernel over items that all cost alike */
    PASS_RAYS   /* rays from the items of a list, each to its end */
} PassKind;

typedef struct Pass {
    PassKind      kind;
    KrsPhase      phase;  /* whose time it is */
    float         weight; /* of its progress, among all passes */
    const March  *march;  /* of PASS_MARCH; the others have: */
    const Kernel *kernel;
    ListId in, out;   /* the list that is read, and the one that is written from its beginning on */
    bool   with_last; /* counts for none of the last pass: one submission may have both */
    bool   shares_anew; /* no ray has shared anything before it (shared.glsl) */
    PassConstants constants;
} Pass;

enum { MOST_TOGETHER = 1 + KRS_MOST_MARCH_GROUPS }; /* passes in one submission */

typedef struct Plan {
    Gpu     *gpu; /* whose allocator the passes come from */
    Pass    *passes;
    size_t   count, room;
    double   weight; /* the sum */
    March    marches[1 + KRS_MOST_MARCH_GROUPS];
    size_t   march_count;
    uint32_t halo;           /* so many pixels around what is asked for are traced as well */
    bool     by_march_group; /* pixels are listed by the group of components that they hit */
    bool     failed;         /* memory ran out, which is noted */
} Plan;

void plan_add(Plan *plan, Pass pass);
/* Adds a march and its pass. */
void plan_add_march(Plan *plan, const March *march, float weight);
void plan_free(Plan *plan);
/* Runs all passes for ray number `index` of every pixel of the band, and adds what it sees to the
   results.  `progress_done` and `progress_share` of the job are its own. */
bool plan_run(Job *job, const Plan *plan, WorkBlock *work, uint32_t index);

#endif
