/*
 * light_groups.h: how much of a picture each light makes.
 */
#ifndef KRS_CLI_LIGHT_GROUPS_H
#define KRS_CLI_LIGHT_GROUPS_H

#include "cli/commands.h"
#include "runtime/writer/picture.h"

/* Channels of a picture: light.NAME.R and so on for each light, and rest.R for sky, fog and what
   things emit.  Together they are the picture. */
typedef struct LightGroups {
    PictureChannel *channels;
    size_t          channel_count;
    float          *values; /* for free() */
} LightGroups;

/* Renders what each light makes of a picture, which `how` has made of the frame.  On any status but
   KRS_OK there are no groups; the renderer tells why. */
KrsStatus light_groups_render(Arena *arena, KrsRendering *rendering, KrsFrame *frame,
                              const KrsScene *scene, const KrsRenderOptions *how,
                              const KrsPicture *picture, LightGroups *groups);

#endif
