/*
 * watch.c: `krs watch`: render or mesh, wait until the scene is saved, and again.
 *
 * One process keeps the device and all that has been compiled, so an edit of a number costs little
 * more than the picture.  A mistake changes nothing: the last files stay, and the next edit is
 * compared to the scene that was right.  Pictures and meshes are of scenes that are compiled in different ways, so
 * where both are written the text is read twice.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/shell/input.h"
#include "cli/mesh/meshing.h"
#include "cli/picture/render.h"
#include "cli/shell/supervise.h"
#include "live/text/document.h"

/* The time that a signal may go unnoticed if the system does not end the wait for it. */
#define LONGEST_WAIT 3600.0

typedef struct Watch {
    const char    *path;
    Options        pictures, meshes; /* the command line as it is for either, with outputs of it */
    bool           draws, meshing;   /* whether there is any */
    Render         render;           /* its scene is that of the version */
    Document      *document, *solid; /* of pictures, or else of meshes; and that of meshes */
    Version       *version;          /* that is rendered; NULL: none yet */
    DiagnosticSink sink, unheard;
    bool           stale;   /* the files of meshes are not of the scene that was read last */
    bool           refused; /* the system does not let us watch a file */
    bool           changed; /* files were saved while something was made */
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
        say_renderer(render->options, version_scene(version), render->renderer, status);
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
    return say_status(status, watch->path);
}

/* ---- a picture ---- */

static KrsStatus make_shaders(Watch *watch)
{
    Render   *render = &watch->render;
    KrsStatus status = KRS_OK;
    if (!render->renderer)
        status = open_renderer(render->options, &render->renderer);
    if (status == KRS_OK && !render->rendering)
        status = render_compile(render);
    return status;
}

static KrsStatus make_picture(Watch *watch, double start)
{
    krs_state_free(watch->render.state);
    watch->render.state = NULL;
    KrsStatus status    = adopt(watch);
    if (status == KRS_OK)
        status = render_choose(&watch->render);
    if (status == KRS_OK)
        status = make_shaders(watch);
    if (status == KRS_OK)
        status = render_frames(&watch->render);
    progress_end(&watch->render.progress);
    if (status == KRS_OK)
        render_say_written(&watch->render, clock_now() - start);
    return status;
}

/* ---- a mesh ---- */

/* Reads the text as meshes are made of it, if that is not done. */
static KrsStatus read_solid(Watch *watch)
{
    KrsStatus status = KRS_OK;
    if (watch->draws) {
        scene_enter_compile(watch->path);
        status = document_read(watch->solid);
    }
    if (status != KRS_OK)
        return say_status(status, watch->path);
    Version         *version = document_version(watch->solid);
    const KrsChanges changes = version_changes(version);
    const Meshing    meshing = {.options = &watch->meshes};
    watch->stale = watch->stale || (has_shapes_alone(&meshing) ? changes.solids : changes.surfaces);
    version_release(version);
    return KRS_OK;
}

static bool are_there(const Options *options)
{
    bool there = true;
    for (size_t i = 0; i < options->outputs.count; i++)
        there = there && access(options->outputs.items[i], F_OK) == 0;
    return there;
}

/* Writes the mesh of the document's version, in memory that is free again behind it. */
static KrsStatus write_solid(Watch *watch)
{
    Arena    arena    = {.memory = watch->meshes.arena->memory};
    Options  options  = watch->meshes;
    Version *version  = document_version(watch->solid);
    options.arena     = &arena;
    Meshing   meshing = {.options  = &options,
                         .scene    = version_scene(version),
                         .outdated = has_changed,
                         .user     = watch};
    KrsStatus status  = write_meshes(&meshing);
    watch->stale      = status != KRS_OK;
    version_release(version);
    arena_free(&arena);
    return status;
}

static KrsStatus make_mesh(Watch *watch, double start)
{
    const Options *options = &watch->meshes;
    const char    *names   = output_names(options->arena, options->outputs.items,
                                          options->outputs.count);
    KrsStatus      status  = read_solid(watch);
    const bool     kept    = status == KRS_OK && !watch->stale && are_there(options);
    if (status == KRS_OK && !kept)
        status = write_solid(watch);
    if (status == KRS_OK && kept && !options->quiet)
        say("nothing of %s has changed", names);
    else if (status == KRS_OK && !options->quiet)
        say("wrote %s in %.2f s", names, clock_now() - start);
    return status;
}

/* ---- edits ---- */

static KrsStatus make_all(Watch *watch)
{
    const double start  = clock_now();
    KrsStatus    status = compile_scene(watch);
    if (status == KRS_OK && watch->draws)
        status = make_picture(watch, start);
    if (status == KRS_OK && watch->meshing)
        status = make_mesh(watch, start);
    return status;
}

/* Tells whether another text of the scene, or more room, may do better. */
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
        status = make_all(watch);
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

/* ---- what is written ---- */

/* Tells outputs of meshes from pictures; those that have no other name are pictures. */
static void sort_outputs(Watch *watch, Options *options)
{
    Options *pictures = &watch->pictures, *meshes = &watch->meshes;
    *pictures = *meshes = *options;
    memset(&pictures->outputs, 0, sizeof pictures->outputs);
    memset(&meshes->outputs, 0, sizeof meshes->outputs);
    meshes->command       = COMMAND_MESH;
    pictures->animated    = false; /* that is asked for in the other file */
    pictures->first_frame = pictures->last_frame = 0;
    for (size_t i = 0; i < options->outputs.count; i++) {
        const char *path = options->outputs.items[i];
        Options    *of   = mesh_format(path) ? meshes : pictures;
        array_push(options->arena, &of->outputs, path);
    }
    watch->meshing = meshes->outputs.count > 0;
    watch->draws   = pictures->outputs.count > 0 || !watch->meshing;
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

static KrsStatus check_outputs(Watch *watch)
{
    const Meshing meshing = {.options = &watch->meshes};
    KrsStatus     status  = KRS_OK;
    if (watch->draws)
        status = render_begin(&watch->render, &watch->pictures);
    if (status == KRS_OK && watch->meshing)
        status = check_mesh_outputs(&meshing);
    return status;
}

/* Opens the documents; false, and words: the system does not let files be watched. */
static bool open_documents(Watch *watch)
{
    watch->sink.options    = watch->draws ? &watch->pictures : &watch->meshes;
    watch->unheard.options = &watch->meshes;
    KrsOptions with        = scene_options(&watch->sink, watch->path);
    with.opened            = note_read;
    watch->document        = document_new(watch->path, &with);
    watch->solid           = watch->document;
    if (watch->document && watch->draws && watch->meshing) {
        with            = scene_options(&watch->unheard, watch->path);
        with.diagnostic = NULL;
        watch->solid    = document_new(watch->path, &with);
    }
    if (!watch->document || !watch->solid)
        say("the system does not let files be watched: too many programs do");
    return watch->document && watch->solid;
}

static void close_documents(Watch *watch)
{
    version_release(watch->version);
    if (watch->solid != watch->document)
        document_free(watch->solid);
    document_free(watch->document);
}

KrsStatus command_watch(Options *options)
{
    Watch *watch     = arena_new(options->arena, Watch);
    watch->path      = options->files.items[0];
    KrsStatus status = check_use(options);
    sort_outputs(watch, options);
    if (status == KRS_OK)
        status = check_outputs(watch);
    if (status != KRS_OK)
        return status;
    watch->render.outdated = has_changed;
    watch->render.user     = watch;
    status                 = open_documents(watch) ? watch_scene(watch) : KRS_IO_ERROR;
    watch->render.scene    = NULL;
    render_free(&watch->render);
    close_documents(watch);
    return status;
}
