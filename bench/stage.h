/*
 * stage.h: a scene on the device, for the benches that are programs of their own.
 */
#ifndef KRS_BENCH_STAGE_H
#define KRS_BENCH_STAGE_H

#include <stdbool.h>

#include "krs/vulkan.h"

typedef struct Stage {
    const char   *name;
    KrsRenderer  *renderer;
    KrsScene     *scene;
    KrsFrame     *frame;
    KrsRendering *rendering;
} Stage;

/* Prints what went wrong, and ends the process: so does all else here that fails. */
_Noreturn void give_up(const char *what, const char *why);

/* The device that KRS_DEVICE names, in the words of `krs --device`, else that which krs takes. */
KrsRenderer *device_open(void);

/* Compiles a text, or the file of this name where that is NULL.  `gradients`: normals by
   derivatives are wanted.  `name` must live as long as the stage. */
Stage stage_open(KrsRenderer *renderer, const char *name, const char *text, bool gradients);
void  stage_close(Stage *stage);

/* The picture is the caller's to free. */
KrsPicture *stage_render(const Stage *stage, const KrsRenderOptions *options);

#endif
