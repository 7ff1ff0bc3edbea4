/*
 * render_faults.h: what pictures lack, which is said when they are done: rays that ran out of steps, and noise that
 * is more than was asked for.
 */
#ifndef KRS_RENDER_FAULTS_H
#define KRS_RENDER_FAULTS_H

#include "cli/options/options.h"
#include "krs/vulkan.h"

/* The faults of all pictures of a command. */
typedef struct RenderFaults {
    uint64_t unresolved, rays;
    uint64_t noisy, pixels; /* where samples were to end by noise */
    double   noise;         /* that was asked for */
    uint32_t samples;       /* of a pixel, at most */
} RenderFaults;

/* Adds a picture; `noise` 0: no pixel was to have less. */
void render_faults_add(RenderFaults *faults, const KrsPicture *picture, double noise);
/* Warns, unless all is as it should be, or the command is quiet. */
void render_faults_say(const RenderFaults *faults, const Options *options);

#endif
