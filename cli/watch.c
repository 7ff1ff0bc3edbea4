/*
 * watch.c: `krs watch`: render, wait until the scene is saved, render again.
 *
 * One process keeps the device and all that has been compiled, so an edit of a number costs little
 * more than the picture.  A mistake changes nothing: the last picture stays, and the next edit is
 * compared to the scene that was right.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/input.h"
#include "cli/render.h"
#include "cli/supervise.h"
#include "live/document.h"

/* How long a signal may go unnoticed where the system does not end the wait for it. */
#define LONGEST_WAIT 3600.0

typedef struct Watch {
    const Options *options;
    const char    *path;
    Render         render; /* its scene is that of the version */
    Document      *document;
    Version       *version; /* that is rendered; NULL: none yet */
    DiagnosticSink sink;
    bool           refused; /* the system does not let us watch a file */
    bool           changed; /* files were saved while a picture was rendered */
} Watch;

static bool has_changed(void *user)
{
    Watch *watch   = user;
    watch->changed = watch->changed || document_changed(watch->document);
    return watch->changed;
}

static void note_read(void *user, const char *path)
{
    (void)user;
    stage_read(path);
}

/* ---- a saved text ---- */

/* Takes the rendering over to the document's version. */
static KrsStatus adopt(Watch *watch)
{
    Render   *render  = &watch->render;
    Version  *version = document_version(watch->document);
    KrsStatus status  = KRS_OK;
    stage_enter(STAGE_SHADERS);
    if (render->rendering)
        status = krs_rendering_update(render->rendering, version_scene(version));
    if (status != KRS_OK) {
        say("%s", krs_renderer_message(render->renderer));
        version_release(version);
        return status;
    }
    version_release(watch->version);
    watch->version = version;
    render->scene  = version_scene(version);
    return KRS_OK;
}

static KrsStatus compile_scene(Watch *watch)
{
    watch->sink.errors = watch->sink.warnings = 0;
    stage_forget();
    stage_read(watch->path);
    scene_enter_compile(watch->path);
    KrsStatus status = document_read(watch->document);
    scene_print_counts(&watch->sink);
    watch->refused = status == KRS_CANNOT_CREATE;
    say_status(status, watch->path);
    return status == KRS_OK ? adopt(watch) : status;
}

/* ---- a picture ---- */

static KrsStatus make_kernels(Watch *watch)
{
    Render   *render = &watch->render;
    KrsStatus status = KRS_OK;
    if (!render->renderer)
        status = open_renderer(watch->options, &render->renderer);
    if (status == KRS_OK && !render->rendering)
        status = render_compile(render);
    return status;
}

static KrsStatus make_picture(Watch *watch)
{
    const double start = clock_now();
    krs_frame_free(watch->render.frame);
    watch->render.frame = NULL;
    KrsStatus status    = compile_scene(watch);
    if (status == KRS_OK)
        status = render_choose(&watch->render);
    if (status == KRS_OK)
        status = make_kernels(watch);
    if (status == KRS_OK)
        status = render_frames(&watch->render);
    progress_end(&watch->render.progress);
    if (status == KRS_OK)
        render_say_written(&watch->render, clock_now() - start);
    return status;
}

/* Whether another text of the scene, or more room, may do better. */
static bool can_be_mended(const Watch *watch, KrsStatus status, bool first)
{
    if (status == KRS_INTERRUPTED)
        return watch->changed;
    return status == KRS_OK || status == KRS_BAD_SCENE ||
           (!first && (status == KRS_BAD_ARGUMENT || status == KRS_IO_ERROR ||
                       status == KRS_CANNOT_CREATE || status == KRS_OUT_OF_MEMORY));
}

static void wait_for_change(Watch *watch)
{
    stage_enter(STAGE_WAIT);
    bool changed = false;
    while (!watch->changed && !changed && !*interrupted())
        changed = document_wait(watch->document, LONGEST_WAIT);
    watch->changed = false;
}

static bool watch_again(void *user, const char *path)
{
    Watch *watch = user;
    return document_watch(watch->document, path);
}

static KrsStatus watch_scene(Watch *watch)
{
    KrsStatus status = KRS_OK;
    if (stage_again(watch_again, watch, &watch->changed))
        wait_for_change(watch);
    for (bool first = true; !*interrupted(); first = false) {
        status = make_picture(watch);
        if (*interrupted() || (!watch->refused && !can_be_mended(watch, status, first)))
            break;
        if (watch->refused) {
            say("the system does not let `%s`, or what it uses, be watched", watch->path);
            return KRS_IO_ERROR;
        }
        wait_for_change(watch);
    }
    return *interrupted() ? KRS_OK : status; /* Ctrl-C is how it ends */
}

static KrsStatus check_use(const Options *options)
{
    if (is_input(options, options->files.items[0]))
        return say_usage(options, "standard input has one text; watch a file");
    for (size_t i = 0; i < options->outputs.count; i++)
        if (strcmp(options->outputs.items[i], STANDARD_OUTPUT) == 0)
            return say_usage(options, "standard output has room for one picture; write to a file");
    return scene_readable(options, options->files.items[0]);
}

KrsStatus command_watch(Options *options)
{
    Watch *watch        = arena_new(options->arena, Watch);
    watch->options      = options;
    watch->path         = options->files.items[0];
    watch->sink.options = options;
    KrsStatus status    = check_use(options);
    if (status == KRS_OK)
        status = render_begin(&watch->render, options);
    if (status != KRS_OK)
        return status;
    watch->render.outdated = has_changed;
    watch->render.user     = watch;
    KrsOptions with        = scene_options(&watch->sink, watch->path);
    with.opened            = note_read;
    watch->document        = document_new(watch->path, &with);
    if (!watch->document) {
        say("the system does not let files be watched: too many programs do");
        return KRS_IO_ERROR;
    }
    status              = watch_scene(watch);
    watch->render.scene = NULL;
    render_free(&watch->render);
    version_release(watch->version);
    document_free(watch->document);
    return status;
}
