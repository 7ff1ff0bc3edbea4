/*
 * stage.c: a scene on the device, for the benches that are programs of their own.
 */
#include "bench/stage.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void give_up(const char *what, const char *why)
{
    fprintf(stderr, "%s: %s: %s\n", program_invocation_short_name, what, why);
    exit(1);
}

static void complain(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    fprintf(stderr, "%s\n", diagnostic->text);
}

KrsRenderer *device_open(void)
{
    KrsRenderer       *renderer;
    KrsRendererOptions options = {.device = getenv("KRS_DEVICE")};
    if (krs_renderer_new(&options, &renderer) != KRS_OK)
        give_up("cannot open the device", renderer ? krs_renderer_message(renderer) : "no memory");
    return renderer;
}

Stage stage_open(KrsRenderer *renderer, const char *name, const char *text, bool gradients)
{
    Stage      stage   = {.name = name, .renderer = renderer};
    KrsOptions options = {.diagnostic = complain, .gradients = gradients};
    KrsStatus  status  = text ? krs_compile_text(text, strlen(text), name, &options, &stage.scene)
                              : krs_compile_file(name, &options, &stage.scene);
    if (status != KRS_OK || krs_frame_new(stage.scene, &stage.frame) != KRS_OK)
        give_up(name, "it does not compile");
    if (krs_rendering_new(renderer, stage.scene, &stage.rendering) != KRS_OK)
        give_up(name, krs_renderer_message(renderer));
    return stage;
}

void stage_close(Stage *stage)
{
    krs_rendering_free(stage->rendering);
    krs_frame_free(stage->frame);
    krs_scene_free(stage->scene);
}

KrsPicture *stage_render(const Stage *stage, const KrsRenderOptions *options)
{
    KrsPicture *picture;
    if (krs_render(stage->rendering, stage->frame, options, &picture) != KRS_OK)
        give_up(stage->name, krs_renderer_message(stage->renderer));
    return picture;
}
