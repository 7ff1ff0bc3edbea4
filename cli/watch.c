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
#include "compiler/base/loader.h"
#include "live/watcher.h"

/* How long a signal may go unnoticed where the system does not end the wait for it. */
#define LONGEST_WAIT 3600.0

typedef struct Watch {
    const Options *options;
    const char    *path;
    Render         render;
    Watcher       *watcher;
    DiagnosticSink sink;    /* what the scene's diagnostics go to, for as long as it is edited */
    bool           refused; /* the system does not let us watch a file */
    bool           changed; /* files were saved while a picture was rendered */
} Watch;

static void watch_file(void *user, const char *path)
{
    Watch *watch   = user;
    watch->refused = !watcher_add(watch->watcher, path) || watch->refused;
}

static bool has_changed(void *user)
{
    Watch *watch   = user;
    watch->changed = watch->changed || watcher_changed(watch->watcher);
    return watch->changed;
}

/* ---- a saved text ---- */

static KrsStatus compile_first(Watch *watch)
{
    KrsOptions with  = scene_options(&watch->sink, watch->path);
    with.opened      = watch_file;
    with.opened_user = watch;
    return krs_compile_file(watch->path, &with, &watch->render.scene);
}

/* The text is read by the rules of the first compilation, also those for untrusted scenes. */
static KrsStatus read_text(Watch *watch, Loaded *text)
{
    const KrsOptions with   = scene_options(&watch->sink, watch->path);
    Loader           loader = {0};
    if (!loader_open(&loader, with.root, watch->path))
        return KRS_OUT_OF_MEMORY;
    *text = loader_read_scene(&loader, watch->path);
    loader_close(&loader);
    watch_file(watch, watch->path);
    if (text->text)
        return KRS_OK;
    say("cannot read `%s`: %s", watch->path, text->reason);
    return KRS_IO_ERROR;
}

/* Takes the rendering over to a scene, and the scene into `render`. */
static KrsStatus adopt(Watch *watch, KrsScene *scene)
{
    Render   *render = &watch->render;
    KrsStatus status = KRS_OK;
    stage_enter(STAGE_SHADERS);
    if (render->rendering)
        status = krs_rendering_update(render->rendering, scene);
    if (status != KRS_OK) {
        say("%s", krs_renderer_message(render->renderer));
        krs_scene_free(scene);
        return status;
    }
    krs_scene_free(render->scene);
    render->scene = scene;
    return KRS_OK;
}

static KrsStatus compile_edited(Watch *watch)
{
    Loaded    text   = {0};
    KrsScene *scene  = NULL;
    KrsStatus status = read_text(watch, &text);
    if (status == KRS_OK)
        status = krs_scene_update(watch->render.scene, text.text, text.length, &scene, NULL);
    free(text.owned);
    return status == KRS_OK ? adopt(watch, scene) : status;
}

static KrsStatus compile_scene(Watch *watch)
{
    watch->sink.errors = watch->sink.warnings = 0;
    scene_enter_compile(watch->path);
    KrsStatus status = watch->render.scene ? compile_edited(watch) : compile_first(watch);
    scene_print_counts(&watch->sink);
    return say_status(status, watch->path);
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
           (!first &&
            (status == KRS_BAD_ARGUMENT || status == KRS_IO_ERROR || status == KRS_CANNOT_CREATE));
}

static void wait_for_change(Watch *watch)
{
    stage_enter(STAGE_WAIT);
    bool changed = false;
    if (watch->changed) /* it may not be all that is saved now */
        watcher_wait(watch->watcher, SETTLED_SECONDS);
    while (!watch->changed && !changed && !*interrupted())
        changed = watcher_wait(watch->watcher, LONGEST_WAIT);
    watch->changed = false;
}

static KrsStatus watch_scene(Watch *watch)
{
    KrsStatus status = KRS_OK;
    for (bool first = true; !*interrupted(); first = false) {
        status = make_picture(watch);
        if (*interrupted() || !can_be_mended(watch, status, first))
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
    watch->watcher         = watcher_new();
    if (!watch->watcher) {
        say("the system does not let files be watched: too many programs do");
        return KRS_IO_ERROR;
    }
    status = watch_scene(watch);
    render_free(&watch->render);
    watcher_free(watch->watcher);
    return status;
}
