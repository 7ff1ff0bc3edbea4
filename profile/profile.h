/*
 * profile.h: what the parts of a scene cost: how much less a frame takes without each of them.
 *
 * The scene is compiled once more without a part, and rendered by turns with the whole scene, from the same camera.  So
 * times are those of the device.  Parts that cost much are opened: their own parts follow, the largest first, until the
 * seconds are over.
 *
 * Where a part is left out, fewer pixels may hit something, and those that do not need no light.  That is no weight of
 * the part: a floor would seem to be the heaviest of all.  So light counts as if as many pixels had been hit.
 */
#ifndef KRS_PROFILE_H
#define KRS_PROFILE_H

#include "profile/types.h"

/* The options by which a scene is compiled and rendered. */
typedef struct ProfileOptions {
    KrsRenderer     *renderer;
    KrsPurpose       purpose;
    KrsRenderOptions how;     /* a width of 0: as large as times can be told apart */
    double           aspect;  /* of such a picture */
    const KrsCamera *camera;  /* NULL: the one that `how` names */
    double           seconds; /* of all */
    bool alone; /* no other thread of this process has work: on a device of type CPU the time of
                        processors counts, which other programs do not change as much */
    /* Compiles the scene without what is at a place; NULL: all of it. */
    KrsStatus (*compile)(void *user, const KrsLocation *without, KrsScene **scene);
    KrsStatus (*state)(void *user, const KrsScene *scene, KrsState **state);
    KrsProgressCallback *progress; /* may be NULL */
    void                *user;
} ProfileOptions;

/* The rows are in the arena, and their strings are the scene's, which must stay: it is that of the options' compile. */
KrsStatus profile_make(const ProfileOptions *options, const KrsScene *scene, Arena *arena,
                       Profile *profile);
/* Frees the picture; the rest is the arena's. */
void profile_free(Profile *profile);

#endif
