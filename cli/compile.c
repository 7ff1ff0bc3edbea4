/*
 * compile.c: `krs compile`: the shaders of a scene and their description, as files.
 */
#include <endian.h>
#include <stdlib.h>
#include <string.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/info.h"
#include "cli/modules.h"
#include "cli/shell/supervise.h"

static KrsStatus write_output_file(const Options *options, const char *base, const char *ending,
                                   const void *bytes, size_t length)
{
    Text path = {.arena = options->arena};
    text_format(&path, "%s%s", base, ending);
    return write_output_text(path.bytes, bytes, length);
}

/* ---- tables ---- */

/* A texel buffer of the GLSL, a texture of the ESSL or a storage buffer of the WGSL, and the file that has its
   contents. */
typedef struct TableFile {
    const char *buffer, *ending, *format;
    uint32_t    binding; /* of the GLSL and the WGSL, in set or group 0 */
} TableFile;

static const TableFile rows_file  = {"krs_rows", ".rows.bin", "RGBA32F", 1};
static const TableFile cells_file = {"krs_cells", ".cells.bin", "RG32UI", 2};

/* Numbers and words are little-endian in files. */
static KrsStatus write_table(const Options *options, const char *base, const TableFile *file,
                             unsigned char *bytes, size_t size)
{
    for (size_t i = 0; i < size; i += sizeof(uint32_t)) {
        uint32_t word;
        memcpy(&word, bytes + i, sizeof word);
        word = htole32(word);
        memcpy(bytes + i, &word, sizeof word);
    }
    return write_output_file(options, base, file->ending, bytes, size);
}

/* Writes the contents of the texel buffers, where there are any. */
static KrsStatus write_tables(const Options *options, const KrsScene *scene, const char *base)
{
    size_t    rows_size  = krs_table_rows(scene) * sizeof(float[4]);
    size_t    cells_size = krs_table_cells(scene) * sizeof(uint32_t[2]);
    KrsState *state;
    if (cells_size == 0)
        return KRS_OK;
    KrsStatus status = krs_state_new(scene, &state);
    if (status != KRS_OK) {
        say("out of memory while writing the tables of `%s`", base);
        return status;
    }
    void *rows  = arena_alloc(options->arena, 1, rows_size);
    void *cells = arena_alloc(options->arena, 1, cells_size);
    krs_state_tables(state, rows, cells);
    krs_state_free(state);
    status = write_table(options, base, &rows_file, rows, rows_size);
    if (status == KRS_OK)
        status = write_table(options, base, &cells_file, cells, cells_size);
    return status;
}

static void add_table_json(Json *json, const char *name, const TableFile *file, size_t texels,
                           KrsTarget target)
{
    Text path = {.arena = json->text.arena};
    text_format(&path, "%s%s", name, file->ending);
    json_open(json, NULL, "{");
    json_text(json, "name", file->buffer);
    if (target == KRS_TARGET_ESSL) {
        json_whole(json, "width", KRS_TEXTURE_WIDTH);
    } else {
        json_whole(json, target == KRS_TARGET_WGSL ? "group" : "set", 0);
        json_whole(json, "binding", file->binding);
    }
    json_text(json, "format", file->format);
    json_whole(json, "texels", texels);
    json_text(json, "file", path.bytes);
    json_close(json, "}");
}

static void add_tables_json(Json *json, const KrsScene *scene, const char *name, KrsTarget target)
{
    const size_t rows = krs_table_rows(scene), cells = krs_table_cells(scene);
    json_whole(json, "table_rows", rows);
    json_whole(json, "table_cells", cells);
    json_open(json, "texel_buffers", "[");
    if (cells > 0) {
        add_table_json(json, name, &rows_file, rows, target);
        add_table_json(json, name, &cells_file, cells, target);
    }
    json_close(json, "]");
}

static void add_textures_json(Json *json, const KrsScene *scene)
{
    json_open(json, "textures", "[");
    for (size_t i = 0; i < krs_texture_count(scene); i++) {
        KrsTexture texture;
        krs_texture(scene, i, &texture);
        json_open(json, NULL, "{");
        json_text(json, "file", texture.file);
        json_whole(json, "width", texture.width);
        json_whole(json, "height", texture.height);
        json_whole(json, "levels", texture.levels);
        json_text(json, "texel", texture.gray ? "RG32F" : "RGBA16F");
        json_text(json, "buffer", cells_file.buffer);
        json_whole(json, "header", texture.header);
        json_whole(json, "first", texture.first);
        json_close(json, "}");
    }
    json_close(json, "]");
}

/* ---- all files ---- */

static KrsStatus write_description(const Options *options, const KrsScene *scene,
                                   const Modules *modules, const char *base, const char *name)
{
    Json json = {.text = {.arena = options->arena}, .spaced = true};
    json_open(&json, NULL, "{");
    json_text(&json, "name", name);
    info_add_json(&json, scene);
    json_whole(&json, "parameter_slots", krs_parameter_slots(scene));
    json_whole(&json, "value_slots", krs_value_slots(scene));
    add_tables_json(&json, scene, name, (KrsTarget)options->language);
    add_textures_json(&json, scene);
    json_open(&json, "entries", "[");
    for (size_t i = 0; i < modules->count; i++)
        module_add_json(&json, &modules->items[i]);
    json_close(&json, "]");
    json_close(&json, "}");
    text_add(&json.text, "\n");
    return write_output_file(options, base, ".json", json.text.bytes, json.text.length);
}

/* Writes the entry points, and what they call. */
static KrsStatus write_text(const Options *options, const KrsScene *scene, const char *base)
{
    const KrsVariant     variant = compiled_variant(options);
    const KrsTextOptions how     = {.state_values  = variant.values,
                                    .no_early_outs = !variant.many_threads};
    Text                 ending  = {.arena = options->arena};
    char                *text;
    text_format(&ending, ".%s", language_choices[options->language].name);
    KrsStatus status = krs_text(scene, (KrsTarget)options->language, &how, &text);
    if (status != KRS_OK) {
        say("out of memory while printing `%s%s`", base, ending.bytes);
        return status;
    }
    status = write_output_file(options, base, ending.bytes, text, strlen(text));
    free(text);
    return status;
}

/* Everything is compiled before anything is written. */
static KrsStatus write_all(const Options *options, const KrsScene *scene, const Modules *modules)
{
    const char *name = scene_name(options->arena, options->files.items[0]);
    Text        base = {.arena = options->arena};
    text_format(&base, "%s/%s", options->outputs.items[0], name);
    OutputError error;
    KrsStatus   status = output_make_folder(options->outputs.items[0], &error);
    if (status != KRS_OK)
        say("%s", error.message);
    else
        status = write_text(options, scene, base.bytes);
    for (size_t i = 0; i < modules->count && status == KRS_OK; i++) {
        const SpirvModule *module = &modules->items[i];
        Text               ending = {.arena = options->arena};
        text_format(&ending, ".%s.spv", module->entry);
        status = write_output_file(options, base.bytes, ending.bytes, module->words,
                                   module->word_count * sizeof *module->words);
    }
    if (status == KRS_OK)
        status = write_tables(options, scene, base.bytes);
    if (status == KRS_OK)
        status = write_description(options, scene, modules, base.bytes, name);
    return status;
}

KrsStatus command_compile(Options *options)
{
    KrsScene *scene;
    Modules   modules = {0};
    KrsStatus status  = scene_open(options, options->files.items[0], &scene);
    if (status != KRS_OK)
        return status;
    status = options->language == KRS_TARGET_GLSL ? modules_compile(options, scene, &modules)
                                                  : scene_check_shaders(options, scene);
    if (status == KRS_OK)
        status = write_all(options, scene, &modules);
    modules_free(&modules);
    krs_scene_free(scene);
    return status;
}
