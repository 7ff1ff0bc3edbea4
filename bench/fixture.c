/*
 * fixture.c: a scene on the device, for the benches that are programs of their own.
 */
#include "bench/fixture.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void give_up(const char *what, const char *why)
{
    fprintf(stderr, "%s: %s: %s\n", program_invocation_short_name, what, why);
    exit(1);
}

static void hear_message(void *user, const KrsDiagnostic *diagnostic)
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

Fixture fixture_open(KrsRenderer *renderer, const char *name, const char *text, bool gradients)
{
    Fixture    fixture = {.name = name, .renderer = renderer};
    KrsOptions options = {.diagnostic = hear_message, .gradients = gradients, .research = true};
    KrsStatus  status  = text ? krs_compile_text(text, strlen(text), name, &options, &fixture.scene)
                              : krs_compile_file(name, &options, &fixture.scene);
    if (status != KRS_OK || krs_state_new(fixture.scene, &fixture.state) != KRS_OK)
        give_up(name, "it does not compile");
    if (krs_rendering_new(renderer, fixture.scene, KRS_FOR_PICTURES, &fixture.rendering) != KRS_OK)
        give_up(name, krs_renderer_message(renderer));
    return fixture;
}

void fixture_close(Fixture *fixture)
{
    krs_rendering_free(fixture->rendering);
    krs_state_free(fixture->state);
    krs_scene_free(fixture->scene);
}

KrsPicture *fixture_render(const Fixture *fixture, const KrsRenderOptions *options)
{
    KrsPicture *picture;
    if (krs_render(fixture->rendering, fixture->state, options, &picture) != KRS_OK)
        give_up(fixture->name, krs_renderer_message(fixture->renderer));
    return picture;
}
