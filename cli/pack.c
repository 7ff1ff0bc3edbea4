/*
 * pack.c: `krs pack`: a scene and all that it reads as one file.
 */
#include <stdlib.h>
#include <string.h>

#include "cli/pack/pack.h"
#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/shell/input.h"
#include "cli/shell/supervise.h"
#include "compiler/base/disk.h"
#include "compiler/base/loader.h"
#include "compiler/base/paths.h"
#include "compiler/base/fonts.h"

typedef struct Packing {
    Arena *arena;
    Loader disk;
    Pack   pack;
} Packing;

/* Keeps what was read in the pack.  NULL: it could not be read. */
static const PackEntry *keep(Packing *packing, PackEntries *entries, PackEntry entry, Loaded loaded)
{
    if (!loaded.text)
        return NULL;
    entry.name   = entry.name ? arena_copy_text(packing->arena, entry.name, strlen(entry.name))
                              : NULL;
    entry.bytes  = arena_copy_text(packing->arena, loaded.text, loaded.length);
    entry.length = loaded.length;
    array_push(packing->arena, entries, entry);
    free(loaded.owned);
    return &entries->items[entries->count - 1];
}

/* Supplies a file from the disk, and keeps it under its path from the folder of the scene. */
static const char *load(void *user, const char *path, size_t *length)
{
    Packing         *packing = user;
    char            *inside  = path_relative(packing->disk.scene, path);
    const char      *name    = inside ? inside : path; /* which begins at the root of all files */
    const PackEntry *file    = pack_find(&packing->pack.files, name);
    if (!file)
        file = keep(packing, &packing->pack.files, (PackEntry){.name = name},
                    loader_read(&packing->disk, path));
    free(inside);
    *length = file ? file->length : 0;
    return file ? file->bytes : NULL;
}

static const char *load_font(void *user, const char *name, size_t *length, int *face)
{
    Packing         *packing = user;
    const PackEntry *font    = pack_find(&packing->pack.fonts, name);
    FoundFont        found;
    if (!font && font_find(name, &found) == FONT_FOUND) {
        const PackEntry entry = {.name = name, .face = found.face};
        font                  = keep(packing, &packing->pack.fonts, entry, disk_read(found.path));
        free(found.path);
    }
    *length = font ? font->length : 0;
    *face   = font ? font->face : 0;
    return font ? font->bytes : NULL;
}

/* Compiles the scene once more, and keeps what it reads.  Its mistakes have been told. */
static KrsStatus collect(const Options *options, const char *path, Packing *packing)
{
    const char    *input = scene_input(options, path);
    const Loaded   text  = input ? (Loaded){.text = input, .length = options->input_length}
                                 : loader_read_scene(&packing->disk, path);
    DiagnosticSink sink  = {.options = options};
    KrsOptions     with  = scene_options(&sink, path);
    KrsScene      *scene;
    const char    *name = input ? "scene.krs"
                                : packing->disk.scene + path_folder_length(packing->disk.scene);
    packing->pack.scene = name;
    if (!keep(packing, &packing->pack.files, (PackEntry){.name = name}, text)) {
        say("cannot read `%s`: %s", path, text.reason);
        return KRS_IO_ERROR;
    }
    with.diagnostic  = NULL;
    with.load        = load;
    with.load_user   = packing;
    with.font        = load_font;
    with.font_user   = packing;
    KrsStatus status = krs_compile_text(packing->pack.files.items[0].bytes,
                                        packing->pack.files.items[0].length, path, &with, &scene);
    krs_scene_free(scene);
    if (status == KRS_BAD_SCENE)
        say("cannot pack `%s`: what it reads has changed meanwhile", path);
    return status;
}

static bool append(void *user, const void *bytes, size_t count)
{
    return output_append(user, bytes, count);
}

static bool fill(const void *user, OutputFile *file, OutputError *error)
{
    const Packing *packing = user;
    if (pack_write(packing->arena, &packing->pack, append, file))
        return true;
    if (error->status == KRS_OK)
        *error = (OutputError){.status  = KRS_OUT_OF_MEMORY,
                               .message = "out of memory for the pack"};
    return false;
}

KrsStatus pack_scene(const Options *options, const char *path, const char *output)
{
    Packing packing = {.arena = options->arena};
    if (!loader_open(&packing.disk, scene_root(options, path), path))
        return say_status(KRS_OUT_OF_MEMORY, path);
    const Pack *own    = pack_of(options, path);
    KrsStatus   status = KRS_OK;
    if (own)
        packing.pack = *own;
    else
        status = collect(options, path, &packing);
    if (status == KRS_OK)
        status = write_output(output, fill, &packing);
    if (status == KRS_OK && !options->quiet && options->command == COMMAND_PACK)
        say("`%s`: %zu file%s and %zu font%s", output, packing.pack.files.count,
            packing.pack.files.count == 1 ? "" : "s", packing.pack.fonts.count,
            packing.pack.fonts.count == 1 ? "" : "s");
    loader_close(&packing.disk);
    return status;
}

KrsStatus command_pack(Options *options)
{
    const char *path = options->files.items[0];
    KrsScene   *scene;
    Text        name = {.arena = options->arena};
    if (options->outputs.count > 1)
        return say_usage(options, "pack writes one file");
    text_format(&name, "%s" PACK_ENDING, scene_name(options->arena, path));
    const char *output = options->outputs.count ? options->outputs.items[0] : name.bytes;
    if (!pack_is_named(output) && strcmp(output, STANDARD_OUTPUT) != 0)
        return say_usage(options, "packs are known by their ending: -o must end with " PACK_ENDING);
    KrsStatus status = check_output(options, output);
    if (status == KRS_OK)
        status = scene_open(options, path, &scene);
    if (status != KRS_OK)
        return status;
    krs_scene_free(scene);
    return pack_scene(options, path, output);
}
