/*
 * primary.h: passes that find what the rays of pixels hit, for any integrator.
 */
#ifndef KRS_PRIMARY_H
#define KRS_PRIMARY_H

#include "runtime/tracer/plan.h"

/* A march group, and the shader that finds its normals. */
typedef struct OwnGroup {
    uint32_t march_group; /* from 1; 0: what is in no group, which is planes */
    Shader  *normals;
} OwnGroup;

/* The shaders that find normals in this frame. */
typedef struct Primary {
    OwnGroup groups[1 + KRS_MAX_MARCH_GROUPS];
    size_t   group_count; /* 0: `normals` finds those of all hits */
    Shader  *normals;     /* for all components */
} Primary;

/* Adds the passes that march, and fills in *primary unless it is NULL: then no normals are wanted.
   False with the failure noted. */
bool primary_add_marches(Job *job, Plan *plan, float weight, Primary *primary);
/* Returns the march of rays that surfaces have sent on, which may begin anywhere, by this shader. */
March primary_march_of_paths(const Job *job, Shader *shader);
/* Finds the shader that stores normals of a plate, or NULL in *shader where none catches shadows.
   False with the failure noted. */
bool primary_find_plate(Job *job, const Shader **shader);
/* Adds the passes that find normals.  The pass that lists the hits must be added before. */
void primary_add_normals(Plan *plan, float weight, const Primary *primary);

#endif
