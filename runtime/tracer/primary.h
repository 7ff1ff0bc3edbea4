/*
 * primary.h: passes that find what the rays of pixels hit, for any integrator.
 */
#ifndef KRS_PRIMARY_H
#define KRS_PRIMARY_H

#include "runtime/tracer/plan.h"

/* A group of components that is marched by itself, and whose normals are its own. */
typedef struct OwnGroup {
    uint32_t march_group; /* from 1; 0: all else, which is planes */
    Kernel  *normals;
} OwnGroup;

/* How primary rays are found in this frame. */
typedef struct Primary {
    OwnGroup groups[1 + KRS_MOST_MARCH_GROUPS];
    size_t   group_count; /* 0: the normals of all are found by one kernel: */
    Kernel  *normals;
} Primary;

/* Adds the passes that march, and says how normals are found; false with the failure noted. */
bool primary_add_marches(Job *job, Plan *plan, float weight, Primary *primary);
/* Adds those that find normals, behind the pass that lists the pixels that hit something. */
void primary_add_normals(Plan *plan, float weight, const Primary *primary);

#endif
