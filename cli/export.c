/*
 * export.c: `krs export`: a scene as a file for a program that has shaders of its own.
 */
#include <string.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/shell/supervise.h"
#include "export/export.h"

static const char *file_name(const Options *options)
{
    Text path = {.arena = options->arena};
    if (options->outputs.count > 0)
        return options->outputs.items[0];
    text_format(&path, "%s%s", scene_name(options->arena, options->files.items[0]),
                export_targets[options->export_to].ending);
    return path.bytes;
}

static KrsStatus write_file(const Options *options, const KrsScene *scene, KrsState *state,
                            const char *path)
{
    const char *name = scene_name(options->arena, options->files.items[0]);
    Text        file = {.arena = options->arena};
    size_t      camera;
    KrsStatus   status = scene_camera(options, scene, &camera);
    if (status != KRS_OK)
        return status;
    status = export_scene(state, (ExportId)options->export_to, name, camera, &file);
    if (status == KRS_BAD_ARGUMENT)
        say("cannot export `%s` to %s: %s", options->files.items[0],
            export_targets[options->export_to].name, file.bytes);
    else if (status != KRS_OK)
        say_status(status, options->files.items[0]);
    return status == KRS_OK             ? write_output_text(path, file.bytes, file.length)
           : status == KRS_BAD_ARGUMENT ? KRS_BAD_SCENE
                                        : status;
}

KrsStatus command_export(Options *options)
{
    KrsScene *scene;
    KrsState *state;
    if (options->export_to < 0)
        return say_usage(options, "export wants to know what for: --to shadertoy, for example");
    if (options->outputs.count > 1)
        return say_usage(options, "export writes one file");
    const char *path   = file_name(options);
    KrsStatus   status = check_output(options, path);
    if (status == KRS_OK)
        status = scene_open(options, options->files.items[0], &scene);
    if (status != KRS_OK)
        return status;
    status = scene_state(options, scene, &state);
    if (status == KRS_OK) {
        status = write_file(options, scene, state, path);
        krs_state_free(state);
    }
    krs_scene_free(scene);
    return status;
}
