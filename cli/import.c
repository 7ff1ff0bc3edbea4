/*
 * import.c: `krs import`: a file of another program in, the text of a scene out.
 *
 * The text is for people to go on with: it keeps the names and factors of the file and says in
 * comments what the file left open.
 */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/import_file.h"
#include "cli/supervise.h"

enum { MOST_BYTES = 16 << 20 };

static KrsStatus read_all(const Options *options, Import *import)
{
    KrsStatus status = scene_readable(options, import->path);
    if (status != KRS_OK)
        return status;
    Text  text = {.arena = import->arena};
    char  piece[1 << 14];
    FILE *file = fopen(import->path, "rb");
    for (size_t got = 1; file && got > 0 && text.length <= MOST_BYTES;) {
        got = fread(piece, 1, sizeof piece, file);
        text_add_bytes(&text, piece, got);
    }
    if (!file || ferror(file)) {
        say("cannot read `%s`: %s", import->path, strerror(errno));
        status = KRS_IO_ERROR;
    } else if (text.length > MOST_BYTES) {
        say("`%s` is longer than %d MiB", import->path, MOST_BYTES >> 20);
        status = KRS_BAD_SCENE;
    } else if (text.length > 0 && memchr(text.bytes, '\0', text.length)) {
        say("`%s` is not a text: it has a NUL byte", import->path);
        status = KRS_BAD_SCENE;
    }
    if (file)
        fclose(file);
    import->bytes  = text.length > 0 ? text.bytes : "";
    import->length = text.length;
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

/* What others make may be near to what can be read. */
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

KrsStatus command_import(Options *options)
{
    const char *path   = options->files.items[0];
    const char *slash  = strrchr(path, '/');
    Import      import = {.path = path, .name = slash ? slash + 1 : path, .arena = options->arena};
    import.keep_going  = options->keep_going;
    import.output      = options->outputs.count > 0 ? options->outputs.items[0] : NULL;
    if (!import_knows(path))
        return say_usage(options, "`%s` ends in none of %s%s", path, import_endings(),
                         other_way(path));
    KrsStatus status = read_all(options, &import);
    if (status != KRS_OK)
        return status;
    stage_enter(STAGE_COMPILE);
    status = import_file(&import);
    for (size_t i = 0; i < import.left_out.count; i++)
        say("left out: %s", import.left_out.items[i].words);
    if (status == KRS_BAD_SCENE && import.refusal.length > 0)
        say("%s", import.refusal.bytes);
    return status == KRS_OK ? write_scene(options, &import.scene) : say_status(status, path);
}
