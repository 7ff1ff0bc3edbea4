/*
 * view.c: `krs view`: a window on a scene that is being written.
 */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/shell/input.h"
#include "cli/shell/supervise.h"
#include "live/viewer.h"

/* A window without display has nothing to free, and nobody to ask. */
static void lose_display(void)
{
    say("the display is gone");
    _exit(KRS_NO_DEVICE);
}

/* Notes that a scene is read.  A window says itself what takes long, so there is no deadline. */
static void note_reading(void *user, bool begins)
{
    if (begins)
        scene_enter_compile(user);
    else
        stage_enter(STAGE_WAIT);
}

static bool is_stopped(void *user)
{
    (void)user;
    return *interrupted();
}

/* Refuses wrong settings before there is a window; the scene is compiled once more for them. */
static KrsStatus check_settings(const Options *options)
{
    KrsScene *scene;
    KrsState *state  = NULL;
    KrsStatus status = scene_open(options, options->files.items[0], &scene);
    if (status != KRS_OK)
        return status;
    status = scene_state(options, scene, &state);
    krs_state_free(state);
    krs_scene_free(scene);
    return status;
}

static KrsStatus check_use(const Options *options)
{
    const char *path = options->files.items[0];
    if (is_input(options, path))
        return say_usage(options, "standard input has one text; view a file");
    KrsStatus status = scene_readable(options, path);
    if (status == KRS_OK &&
        (options->settings.count > 0 || options->zone_count > 0 || options->terminal))
        status = check_settings(options);
    return status;
}

/* Returns the text of a scene that is in a pack. */
static SuppliedText supplied_text(const Options *options, const char *path)
{
    const Pack      *pack = pack_of(options, path);
    const PackEntry *text = pack ? pack_find(&pack->files, pack->scene) : NULL;
    return text ? (SuppliedText){pack->scene, text->bytes, text->length} : (SuppliedText){0};
}

KrsStatus command_view(Options *options)
{
    char           message[256];
    DiagnosticSink sink     = {.options = options};
    const char    *path     = options->files.items[0];
    ViewerSetting *settings = arena_new_array(options->arena, ViewerSetting,
                                              options->settings.count + 1);
    KrsStatus      status   = check_use(options);
    if (status != KRS_OK)
        return status;
    for (size_t i = 0; i < options->settings.count; i++)
        settings[i] = (ViewerSetting){options->settings.items[i].name,
                                      options->settings.items[i].values,
                                      options->settings.items[i].count};
    ViewerOptions with = {.path          = path,
                          .supplied      = supplied_text(options, path),
                          .scene         = scene_options(&sink, path),
                          .renderer      = renderer_options(options),
                          .width         = options->how.width,
                          .height        = options->how.height,
                          .samples       = options->how.samples,
                          .integrator    = options->how.integrator,
                          .executor      = options->how.methods.executor,
                          .camera        = options->camera,
                          .time          = options->time,
                          .fps           = options->fps,
                          .settings      = settings,
                          .setting_count = options->settings.count,
                          .zones         = options->zones,
                          .zone_count    = options->zone_count,
                          .terminal      = options->terminal,
                          .reads         = note_reading,
                          .user          = (void *)path,
                          .stopped       = is_stopped,
                          .lost          = lose_display};
    if (options->terminal) /* its screen is for the picture, which has the mistakes below it */
        with.scene.diagnostic = NULL;
    status = viewer_run(&with, message);
    if (message[0])
        say("%s", message);
    return message[0] ? status : say_status(status, path);
}
