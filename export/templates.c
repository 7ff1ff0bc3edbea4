/*
 * templates.c: fills the templates of a target.
 */
#include "export/export.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/embedded.h"
#include "compiler/base/visible.h"
#include "compiler/graph/instance_table.h"
#include "export/parts.h"

const ExportTarget export_targets[EXPORT_COUNT] = {
#define EXPORT_TARGET(id, name, words, language, source, tables, baked, cameras, longest, about) \
    [EXPORT_##id] = {name,    words,  EXPORT_IN_##language, source, EXPORT_##tables, baked,      \
                     cameras, longest},
#include "export/targets.def"
};

static const struct {
    ExportId    target;
    const char *ending, *template;
} files_of_targets[] = {
#define EXPORT_FILE(id, ending, template) {EXPORT_##id, ending, template},
#include "export/targets.def"
};

enum { FILE_ROWS = sizeof files_of_targets / sizeof files_of_targets[0] };

const char *export_ending(ExportId target)
{
    size_t i = 0;
    while (i + 1 < FILE_ROWS && files_of_targets[i].target != target)
        i++;
    return files_of_targets[i].ending;
}

size_t export_file_count(ExportId target)
{
    size_t count = 0;
    for (size_t i = 0; i < FILE_ROWS; i++)
        count += files_of_targets[i].target == target;
    return count;
}

/* ---- pieces of templates ---- */

/* Adds a name that stands in comments and strings, so it has no end of a line. */
static void add_name_of(Text *to, const char *name)
{
    for (const char *from = name; *from;) {
        const Visible visible = visible_next(from, strlen(from));
        text_add_bytes(to, visible.text, visible.length);
        from += visible.used;
    }
}
static void add_name(Text *to, const Export *export) { add_name_of(to, export->name); }
static void add_stem(Text *to, const Export *export) { add_name_of(to, export->stem); }
static void add_version(Text *to, const Export *export)
{
    (void)export;
    text_add(to, KRS_VERSION);
}
static void add_language(Text *to, const Export *export)
{
    static const char *const names[] = {
        [EXPORT_IN_GLSL] = "GLSL from 4.4 on", [EXPORT_IN_ESSL] = "ESSL 3.00"};
    text_add(to, names[export->target->language]);
}
static void add_slots(Text *to, const Export *export)
{
    text_format(to, "%zu", exported_slots(export));
}
static void add_scene(Text *to, const Export *export) { text_add(to, export->text); }
static void add_prelude(Text *to, const Export *export) { export_fill(to, export, "prelude.osl"); }
static void add_normal(Text *to, const Export *export) { export_fill(to, export, "normal.glsl"); }
static void add_trace(Text *to, const Export *export) { export_fill(to, export, "trace.glsl"); }
static void add_tracer(Text *to, const Export *export)
{
    add_trace(to, export);
    export_fill(to, export, "light.glsl");
}
static void add_low(Text *to, const Export *export)
{
    double low[3], high[3];
    find_extent(export, low, high);
    text_json_vector(to, low, 3);
}
static void add_high(Text *to, const Export *export)
{
    double low[3], high[3];
    find_extent(export, low, high);
    text_json_vector(to, high, 3);
}
static void add_low_vector(Text *to, const Export *export)
{
    add_vector(to, export, export->scene->program.low, 3);
}
static void add_high_vector(Text *to, const Export *export)
{
    add_vector(to, export, export->scene->program.high, 3);
}

/* What `word` in `@`s stands for.  A target with a block of its own has parameters as a list. */
static const struct Piece {
    const char *word;
    void (*add)(Text *to, const Export *export);
} pieces[] = {{"name", add_name},
              {"stem", add_stem},
              {"version", add_version},
              {"language", add_language},
              {"slots", add_slots},
              {"scene", add_scene},
              {"tracer", add_tracer},
              {"march", add_march},
              {"constants", add_constants},
              {"farthest", add_farthest},
              {"constant_parameters", add_constant_parameters},
              {"set_parameters", set_constant_parameters},
              {"parameters", add_parameters_json},
              {"parameter_lines", add_parameter_lines},
              {"defaults", add_defaults},
              {"low", add_low},
              {"high", add_high},
              {"low_vector", add_low_vector},
              {"high_vector", add_high_vector},
              {"camera", add_camera},
              {"block", add_block},
              {"rows", add_rows},
              {"cells", add_cells},
              {"normal", add_normal},
              {"normal_reach", add_normal_reach},
              {"baked_sampler", add_baked_sampler},
              {"baked_low", add_baked_low},
              {"baked_size", add_baked_size},
              {"baked_cell", add_baked_cell},
              {"baked_count", add_baked_count},
              {"baked_text", add_baked_text},
              {"trace", add_trace},
              {"center", add_center},
              {"half", add_half},
              {"center_numbers", add_center_numbers},
              {"size_numbers", add_size_numbers},
              {"unity_properties", add_unity_properties},
              {"unity_uniforms", add_unity_uniforms},
              {"unity_parameters", add_unity_parameters},
              {"unity_fields", add_unity_fields},
              {"unity_sets", add_unity_sets},
              {"unity_class", add_unity_class},
              {"unity_center", add_unity_center},
              {"unity_half", add_unity_half},
              {"unreal_inputs", add_unreal_inputs},
              {"unreal_parameters", add_unreal_parameters},
              {"godot_uniforms", add_godot_uniforms},
              {"godot_nodes", add_godot_nodes},
              {"godot_sky", add_godot_sky},
              {"prelude", add_prelude},
              {"osl_given", add_osl_given},
              {"osl_passed", add_osl_passed},
              {"osl_values", add_osl_values},
              {"osl_parameters", add_osl_parameters},
              {"seconds", add_seconds},
              {"python_camera", add_python_camera},
              {"python_lights", add_python_lights},
              {"python_sky", add_python_sky}};

static const struct Piece *find_piece(const char *word, size_t length)
{
    for (size_t i = 0; i < sizeof pieces / sizeof pieces[0]; i++)
        if (strlen(pieces[i].word) == length && memcmp(pieces[i].word, word, length) == 0)
            return &pieces[i];
    return NULL;
}

static const char *find_template(const char *name)
{
    const EmbeddedFile *file = embedded_find(export_files, name);
    assert(file);
    return file->text;
}

/* What stands from @if_baked@ to @end@ is left out of a scene that is a text. */
static void fill_text(Text *to, const Export *export, const char *from)
{
    static const char begin[] = "@if_baked@", end[] = "@end@";
    for (const char *at; (at = strchr(from, '@'));) {
        const bool opens = strncmp(at, begin, sizeof begin - 1) == 0;
        if (opens || strncmp(at, end, sizeof end - 1) == 0) {
            text_add_bytes(to, from, (size_t)(at - from));
            from = !opens          ? at + sizeof end - 1
                   : export->baked ? at + sizeof begin - 1
                                   : strstr(at, end) + sizeof end - 1;
            continue;
        }
        const size_t        length = strcspn(at + 1, "@");
        const struct Piece *piece  = find_piece(at + 1, length);
        text_add_bytes(to, from, (size_t)(at - from) + (piece ? 0 : 1));
        if (piece)
            piece->add(to, export);
        from = at + 1 + (piece ? length + 1 : 0);
    }
    text_add(to, from);
}

void export_fill(Text *to, const Export *export, const char *template)
{
    fill_text(to, export, find_template(template));
}

/* ---- what a target cannot have ---- */

/* Tells what else there is. */
static void tell_other_ways(const Export *export, Text *why)
{
    text_add(why, export->target->baked ? "--bake N samples the scene instead"
                                        : "`krs mesh` and `krs grid` write triangles and samples");
}

/* Adds what is read from tables: parts that are alike, at their place in a text, or a picture. */
static void tell_tabled(const Export *export, Text *why)
{
    const Module    *module    = &export->scene->module;
    const Instances *instances = module->graph->instances;
    KrsTexture       texture   = {0};
    if (instances && instances->tables.count > 0) {
        const Span    span   = instances->tables.items[0].span;
        const Source *source = &module->sources.items[span.source];
        if (source->library)
            text_format(why, "parts that are alike, of `%s`, are", source->name);
        else
            text_format(why, "parts that are alike, at %s:%u, are", source->name,
                        source_line(source, span.start));
    } else {
        krs_texture(export->scene, 0, &texture);
        text_format(why, "the picture `%s` is", texture.file);
    }
    text_format(why, " read from tables, which %s has no room for; ", export->target->name);
    tell_other_ways(export, why);
}

/* Adds what a text of the scene cannot have. */
static void refuse_text(const Export *export, Text *why)
{
    const KrsDiagnostic *large  = krs_scene_too_large(export->scene);
    const bool           tables = export->target->tables != EXPORT_WITHOUT_TABLES;
    KrsStateSlope        slope;
    if (large) {
        text_format(why, "%s, so no shader is made of it (%s); ", large->message, large->code);
        tell_other_ways(export, why);
    } else if (!tables && has_tables(export))
        tell_tabled(export, why);
    else if (!tables && krs_state_slope(export->scene, 0, &slope) == KRS_OK) {
        text_format(
            why, "the distance at %s is divided by a number that is known for each picture alone; ",
            slope.location);
        tell_other_ways(export, why);
    }
}

/* Tells whether the target cannot have the scene, and why, in words of its author. */
static bool refuse(const Export *export, bool baked, Text *why)
{
    if (baked && !export->target->baked)
        text_format(why, "%s has no room for samples of a scene", export->target->name);
    else if (!baked)
        refuse_text(export, why);
    if (why->length > 0)
        return true;
    if (export->view.sky.map && export->target->language == EXPORT_IN_SHORT_ESSL)
        text_add(why, "its sky is a picture");
    else if (!export->target->cameras && export->view.camera.projection != KRS_PERSPECTIVE)
        text_add(why, "its camera is no perspective one; --camera chooses another");
    return why->length > 0;
}

/* ---- files ---- */

static Text *add_file(ExportFiles *files, const char *ending, Arena *arena)
{
    const ExportFile file = {ending, {.arena = arena}};
    array_push(arena, files, file);
    return &files->items[files->count - 1].text;
}

static void add_table_file(const Export *export, ExportFiles *files, const char *ending, bool rows,
                           Arena *arena)
{
    size_t               length;
    const unsigned char *bytes = table_bytes(export, rows, &length, arena);
    text_add_bytes(add_file(files, ending, arena), (const char *)bytes, length);
}

static KrsStatus write_files(const Export *export, ExportId target, ExportFiles *files, Text *why)
{
    for (size_t i = 0; i < FILE_ROWS; i++)
        if (files_of_targets[i].target == target)
            export_fill(add_file(files, files_of_targets[i].ending, why->arena), export,
                        files_of_targets[i].template);
    if (export->target->tables == EXPORT_TABLES_BESIDE && has_tables(export)) {
        add_table_file(export, files, ".rows.bin", true, why->arena);
        add_table_file(export, files, ".cells.bin", false, why->arena);
    }
    if (export->baked && export->target->baked[0])
        add_baked_file(add_file(files, export->target->baked, why->arena), export);
    const size_t characters = files->items[0].text.length, longest = export->target->longest;
    if (longest == 0 || characters <= longest)
        return KRS_OK;
    text_format(why, "it takes %zu characters, and %s takes %zu", characters, export->target->name,
                longest);
    return KRS_BAD_ARGUMENT;
}

KrsStatus export_scene(KrsState *state, const ExportOptions *options, ExportFiles *files, Text *why)
{
    Export export = {.scene  = state->scene,
                     .state  = state,
                     .target = &export_targets[options->target],
                     .name   = options->name,
                     .stem   = options->stem};
    export.block = arena_alloc(why->arena, krs_parameter_slots(export.scene), sizeof *export.block);
    krs_state_parameters(state, export.block);
    KrsStatus status = krs_state_view(state, options->camera, &export.view);
    if (status == KRS_OK && refuse(&export, options->bake > 0, why))
        status = KRS_BAD_ARGUMENT;
    if (status == KRS_OK && options->bake > 0)
        status = bake_scene(&export, options, why->arena, why);
    if (status == KRS_OK)
        status = find_scene_text(&export, why->arena, why);
    return status == KRS_OK ? write_files(&export, options->target, files, why) : status;
}
