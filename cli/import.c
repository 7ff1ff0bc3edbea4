/*
 * import.c: `krs import`: a file of another program in, the text of a scene out.
 *
 * The text is for people to go on with: it keeps the names and factors of the file and says in
 * comments what the file left open.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "import/file.h"
#include "cli/shell/supervise.h"
#include "compiler/base/loader.h"
#include "compiler/base/source.h"

static KrsStatus refuse_reading(const Import *import, const Loaded *loaded)
{
    say("cannot read `%s`: %s", import->path, loaded->reason);
    return loaded->outside ? KRS_BAD_SCENE : KRS_IO_ERROR;
}

/* Takes the text, and puts a NUL behind it. */
static KrsStatus take_text(Import *import, const Loaded *loaded)
{
    if (loaded->length > MAX_SOURCE_BYTES) {
        say("`%s` is longer than %d MiB", import->path, MAX_SOURCE_BYTES >> 20);
        return KRS_BAD_SCENE;
    }
    if (memchr(loaded->text, '\0', loaded->length)) {
        say("`%s` is not a text: it has a NUL byte", import->path);
        return KRS_BAD_SCENE;
    }
    import->bytes  = arena_copy_text(import->arena, loaded->text, loaded->length);
    import->length = loaded->length;
    return KRS_OK;
}

static KrsStatus read_all(const Options *options, Import *import)
{
    Loader    loader = {0};
    KrsStatus status = scene_readable(options, import->path);
    if (status != KRS_OK)
        return status;
    if (!loader_open(&loader, import->root, import->path))
        return say_status(KRS_OUT_OF_MEMORY, import->path);
    Loaded loaded = loader_read_scene(&loader, import->path);
    status        = loaded.text ? take_text(import, &loaded) : refuse_reading(import, &loaded);
    free(loaded.owned);
    loader_close(&loader);
    return status;
}

static KrsStatus write_scene(const Options *options, const Text *scene)
{
    const char *path = options->outputs.count > 0 ? options->outputs.items[0] : NULL;
    if (path && check_scene_not_overwritten(options, path) != KRS_OK)
        return KRS_BAD_ARGUMENT;
    if (path)
        return write_output_text(path, scene->bytes, scene->length);
    fwrite(scene->bytes, 1, scene->length, stdout);
    return KRS_OK; /* the end of every command looks at the output */
}

/* Returns a hint about a file of another program. */
static const char *other_way(const char *path)
{
    static const char *const meshes[] = {".stl", ".ply", ".obj", ".glb", ".gltf", ".3mf", ".step"};
    const char              *ending   = strrchr(path, '.');
    if (ending && strcasecmp(ending, ".scad") == 0)
        return "; `openscad -o part.csg part.scad` makes one of them";
    for (size_t i = 0; ending && i < sizeof meshes / sizeof *meshes; i++)
        if (strcasecmp(ending, meshes[i]) == 0)
            return "; krs makes meshes, but reads none";
    return "";
}

/* Prints the notes of the head of the scene, but for those of parts that are left out. */
static void say_notes(const Import *import)
{
    for (size_t i = 0; i < import->notes.count; i++)
        if (!import->notes.items[i].left_out)
            say("%s:%u: note: %s", import->path, import->notes.items[i].line,
                import->notes.items[i].words);
}

KrsStatus command_import(Options *options)
{
    const char *path   = options->files.items[0];
    const char *slash  = strrchr(path, '/');
    Import      import = {.path = path, .name = slash ? slash + 1 : path, .arena = options->arena};
    import.keep_going  = options->keep_going;
    import.output      = options->outputs.count > 0 ? options->outputs.items[0] : NULL;
    import.root        = scene_root(options, path);
    import.memory      = options->limits.memory;
    if (!import_knows(path))
        return say_usage(options, "`%s` ends in none of %s%s", path, import_endings(),
                         other_way(path));
    scene_enter_compile(path);
    KrsStatus status = read_all(options, &import);
    if (status != KRS_OK)
        return status;
    status = import_file(&import);
    for (size_t i = 0; i < import.left_out.count; i++)
        say("left out: %s", import.left_out.items[i].words);
    if (status == KRS_OK && !options->quiet)
        say_notes(&import);
    if (status == KRS_BAD_SCENE && import.refusal.length > 0)
        say("%s", import.refusal.bytes);
    return status == KRS_OK ? write_scene(options, &import.scene) : say_status(status, path);
}
