/*
 * confine.c: from the options of a command to the files that it may read and the names that it may write.
 */
#include "cli/shell/confine.h"

#include <stdlib.h>
#include <string.h>

#include "cli/pack/pack.h"
#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "live/pictures/saver.h"

/* ---- what is read ---- */

static void add_readable(const Options *options, const char *path)
{
    array_push(options->arena, &options->needs->readable, path);
}

/* Adds a file that an option names, or the folder of files whose names have a number. */
static void add_picture(const Options *options, const char *path)
{
    const char *slash = path ? strrchr(path, '/') : NULL;
    if (path && !strchr(path, '%'))
        add_readable(options, path);
    else if (path)
        add_readable(options,
                     slash ? arena_copy_text(options->arena, path, (size_t)(slash - path) + 1)
                           : ".");
}

static void collect_readable(const Options *options)
{
    for (size_t i = 0; i < options->files.count; i++) {
        const char *path = options->files.items[i];
        /* Scenes, and files that are imported, include others. */
        const bool alone = !(takes_scenes(options->command) ||
                             options->command == COMMAND_IMPORT) ||
                           pack_is_named(path);
        add_readable(options, alone ? path : scene_root(options, path));
    }
    add_picture(options, options->depth_in);
    add_picture(options, options->plate);
}

/* ---- what is written ---- */

static OutputRule rule_of(const Options *options, const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    return (OutputRule){.folder = arena_copy_text(options->arena, path, (size_t)(name - path)),
                        .name   = name};
}

/* Permits this name and no other. */
static void permit_whole(const Options *options, const char *path)
{
    OutputRule rule = rule_of(options, path);
    rule.whole      = true;
    array_push(options->arena, &options->needs->outputs, rule);
}

static bool writes_code(const Options *options)
{
    return options->command == COMMAND_COMPILE || options->command == COMMAND_EXPORT;
}

/* Permits a name, the numbers that it has a place for, and names that begin like it up to its last dot. */
static void permit(const Options *options, const char *path)
{
    permit_whole(options, path);
    OutputRule  rule    = rule_of(options, path);
    const char *percent = strchr(rule.name, '%'), *dot = strrchr(rule.name, '.');
    const char *end = percent ? percent : dot ? dot : rule.name + strlen(rule.name);
    rule.name       = arena_copy_text(options->arena, rule.name, (size_t)(end - rule.name));
    rule.digits     = percent != NULL;
    rule.code       = writes_code(options);
    array_push(options->arena, &options->needs->outputs, rule);
}

/* Permits what `krs view` writes: pictures in the current folder, changes of the scene, and presets. */
static void permit_view(const Options *options)
{
    const char *scene   = options->files.items[0];
    Text        presets = {.arena = options->arena};
    text_format(&presets, "%s.presets", scene);
    permit_whole(options, scene);
    permit_whole(options, presets.bytes);
    permit(options, "view-%04d.png");
    for (int kind = 0; kind < SAVE_COUNT; kind++) {
        Text name = {.arena = options->arena};
        text_format(&name, "%s-%%04d.png", save_names[kind]);
        permit(options, name.bytes);
    }
}

static void permit_folder(const Options *options, const char *folder, const char *name)
{
    const OutputRule rule = {.folder = folder, .name = name, .code = true};
    array_push(options->arena, &options->needs->outputs, rule);
}

static void collect_outputs(const Options *options)
{
    const char *first = options->files.items[0];
    const bool  scene = takes_scenes(options->command);
    for (size_t i = 0; i < options->outputs.count; i++) {
        const char *path = options->outputs.items[i];
        if (options->command == COMMAND_COMPILE)
            permit_folder(options, path, scene_name(options->arena, first));
        else if (strcmp(path, STANDARD_OUTPUT) != 0)
            permit(options, path);
    }
    if (options->outputs.count == 0 && scene)
        permit(options, scene_name(options->arena, first));
    if (options->outputs.count == 0 && options->command == COMMAND_DENOISE)
        permit_whole(options, denoised_name(options));
    for (size_t i = 0; i < options->files.count && options->command == COMMAND_FORMAT; i++)
        permit_whole(options, options->files.items[i]);
    if (options->command == COMMAND_VIEW)
        permit_view(options);
}

/* ---- the sandbox ---- */

KrsStatus confine_prepare(Options *options)
{
    if (options->untrusted != UNTRUSTED || options->command == COMMAND_FARM)
        return KRS_OK; /* what a farm starts has sandboxes */
    if (options->command == COMMAND_LSP)
        return say_usage(options, "lsp starts processes, which no sandbox lets it; give "
                                  "--untrusted=limits");
    const char *missing = sandbox_missing();
    if (missing) {
        say("no sandbox for untrusted scenes: %s; --untrusted=limits does without", missing);
        return KRS_NO_DEVICE;
    }
    options->needs  = arena_new(options->arena, SandboxNeeds);
    *options->needs = (SandboxNeeds){.memory = options->limits.memory,
                                     .file   = options->limits.file};
    collect_readable(options);
    collect_outputs(options);
    options->cache = "off"; /* a shader that it has changed would run outside as well */
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "true", 1); /* a card is not reached from inside */
    return KRS_OK;
}

KrsStatus confine_enter(const Options *options)
{
    char why[256];
    if (!options->needs || sandbox_enter(options->needs, why))
        return KRS_OK;
    say("no sandbox for untrusted scenes: %s", why);
    return KRS_INTERNAL;
}
