/*
 * export.c: `krs export`: a scene as a file for a program that has shaders of its own.
 */
#include <string.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/shell/supervise.h"
#include "export/export.h"

static const char *first_path(const Options *options)
{
    Text path = {.arena = options->arena};
    if (options->outputs.count > 0)
        return options->outputs.items[0];
    text_format(&path, "%s%s", scene_name(options->arena, options->files.items[0]),
                export_ending((ExportId)options->export_to));
    return path.bytes;
}

static bool ends_with(const char *path, const char *ending)
{
    const size_t length = strlen(path), tail = strlen(ending);
    return length > tail && strcmp(path + length - tail, ending) == 0;
}

/* Returns what comes before the endings of all files: the first has that of the target, or another. */
static const char *find_base(const Options *options, const char *path)
{
    const char *ending = export_ending((ExportId)options->export_to);
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash + 1 : path, '.');
    if (ends_with(path, ending))
        return arena_copy_text(options->arena, path, strlen(path) - strlen(ending));
    return dot && dot > path ? arena_copy_text(options->arena, path, (size_t)(dot - path)) : path;
}

static KrsStatus write_files(const Options *options, const ExportFiles *files, const char *path)
{
    const char *base   = find_base(options, path);
    KrsStatus   status = KRS_OK;
    for (size_t i = 0; i < files->count && status == KRS_OK; i++) {
        const ExportFile *file = &files->items[i];
        Text              own  = {.arena = options->arena};
        text_format(&own, "%s%s", i ? base : path, i ? file->ending : "");
        status = write_output_text(own.bytes, file->text.bytes, file->text.length);
    }
    return status;
}

static KrsStatus export_to(const Options *options, const KrsScene *scene, KrsState *state,
                           const char *path)
{
    const char   *base = find_base(options, path), *slash = strrchr(base, '/');
    Text          why    = {.arena = options->arena};
    ExportFiles   files  = {0};
    ExportOptions wanted = {.target = (ExportId)options->export_to,
                            .name   = scene_name(options->arena, options->files.items[0]),
                            .stem   = slash ? slash + 1 : base};
    wanted.bake          = options->export_bake;
    wanted.within        = options->within.given;
    memcpy(wanted.low, options->within.low, sizeof wanted.low);
    memcpy(wanted.high, options->within.high, sizeof wanted.high);
    KrsStatus status = scene_camera(options, scene, &wanted.camera);
    if (status == KRS_OK)
        status = scene_component(options, scene, &wanted.component);
    if (status != KRS_OK)
        return status;
    status = export_scene(state, &wanted, &files, &why);
    if (status == KRS_BAD_ARGUMENT) {
        say("cannot export `%s` to %s: %s", options->files.items[0],
            export_targets[wanted.target].name, why.bytes);
        return KRS_BAD_SCENE;
    }
    if (status != KRS_OK) {
        say_status(status, options->files.items[0]);
        return status;
    }
    return write_files(options, &files, path);
}

KrsStatus command_export(Options *options)
{
    KrsScene *scene;
    KrsState *state;
    if (options->export_to < 0)
        return say_usage(options, "export wants to know what for: --to shadertoy, for example");
    if (options->export_bake == 0 && (options->component || options->within.given))
        return say_usage(options, "--component and --within are for samples: --bake N");
    if (options->outputs.count > 1)
        return say_usage(options, "export wants one file");
    const char *path   = first_path(options);
    const char *ending = export_ending((ExportId)options->export_to);
    if (export_file_count((ExportId)options->export_to) > 1 && !ends_with(path, ending))
        return say_usage(options, "files for %s name each other: -o must end with %s",
                         export_targets[options->export_to].name, ending);
    KrsStatus status = check_output(options, path);
    if (status == KRS_OK)
        status = scene_open(options, options->files.items[0], &scene);
    if (status != KRS_OK)
        return status;
    status = scene_state(options, scene, &state);
    if (status == KRS_OK) {
        status = export_to(options, scene, state, path);
        krs_state_free(state);
    }
    krs_scene_free(scene);
    return status;
}
