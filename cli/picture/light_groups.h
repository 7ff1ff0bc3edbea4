/*
 * light_groups.h: how much of a picture each light makes.
 */
#ifndef KRS_CLI_LIGHT_GROUPS_H
#define KRS_CLI_LIGHT_GROUPS_H

#include "cli/shell/commands.h"
#include "runtime/writer/picture.h"

/* Channels of a picture: light.NAME.R and so on for each light, or all of one name, and rest.R for
   sky, fog and what things emit.  Together they are the picture. */
typedef struct LightGroups {
    PictureChannel *channels;
    size_t          channel_count;
    float          *values; /* for free() */
} LightGroups;

/* Makes them of a picture with the light of lights; else there is the rest alone.
   KRS_OUT_OF_MEMORY. */
KrsStatus light_groups_make(Arena *arena, const KrsScene *scene, const KrsPicture *picture,
                            LightGroups *groups);

#endif
