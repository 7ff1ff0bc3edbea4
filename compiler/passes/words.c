/*
 * words.c: the words of the language that scenes use without defining them, as JSON.
 */
#include <string.h>

#include "compiler/base/embedded.h"
#include "compiler/base/json.h"
#include "compiler/passes/compilation.h"

/* Begins the object of a word, on a line of its own. */
static void begin_word(Json *json, const char *kind, const char *name)
{
    if (json->more)
        text_add(&json->text, ",\n");
    json->more = false;
    json_open(json, NULL, "{");
    json_text(json, "kind", kind);
    json_text(json, "name", name);
}

/* ---- what is built in ---- */

/* Writes the parameters of "shapes... radius=". */
static void write_builtin_parameters(Json *json, const char *parameters, Arena *arena)
{
    json_open(json, "parameters", "[");
    for (const char *at = parameters; *at; at += strcspn(at, " "), at += strspn(at, " ")) {
        const size_t length = strcspn(at, " ="), word = strcspn(at, " ");
        const bool   many = length > 3 && strncmp(at + length - 3, "...", 3) == 0;
        json_open(json, NULL, "{");
        json_text(json, "name", arena_copy_text(arena, at, many ? length - 3 : length));
        if (many || length < word)
            json_truth(json, many ? "many" : "optional", true);
        json_close(json, "}");
    }
    json_close(json, "]");
}

static void write_builtins(Json *json, Arena *arena)
{
    for (const BuiltinWord *word = builtin_words; word->name; word++) {
        if (!word->parameters) /* scenes do not call it */
            continue;
        begin_word(json, word->kind, word->name);
        if (strcmp(word->kind, "value") != 0)
            write_builtin_parameters(json, word->parameters, arena);
        json_text(json, "about", word->meaning);
        json_close(json, "}");
    }
}

/* ---- what the library declares ---- */

static const char *text_of(const Compilation *c, Span span, Arena *arena)
{
    return arena_copy_text(arena, c->sources.items[span.source].text + span.start,
                           span.end - span.start);
}

static void write_parameter(Compilation *c, const Syntax *parameter, Json *json)
{
    const ParameterKind kind = (ParameterKind)parameter->number[0];
    json_open(json, NULL, "{");
    json_text(json, "name", parameter->name);
    if (kind != KIND_ANY)
        json_text(json, "takes", parameter_kind_name(kind));
    if (parameter->count > 0) {
        json_truth(json, "optional", true);
        json_text(json, "default", text_of(c, parameter->children[0]->span, &c->scratch));
    }
    if (parameter->count > 1)
        json_text(json, "range", text_of(c, parameter->children[1]->span, &c->scratch));
    json_close(json, "}");
}

static void write_parameters(Compilation *c, const Syntax *definition, Json *json)
{
    json_open(json, "parameters", "[");
    for (uint32_t i = 0; i < definition->count; i++)
        if (definition->children[i]->kind == SYNTAX_PARAMETER)
            write_parameter(c, definition->children[i], json);
    json_close(json, "]");
}

static void write_definition(Compilation *c, const File *file, const Syntax *definition, Json *json)
{
    const bool called = syntax_is_function(definition);
    begin_word(json,
               !called                            ? "value"
               : definition->kind == SYNTAX_SHAPE ? "shape"
                                                  : "function",
               definition->name);
    if (called)
        write_parameters(c, definition, json);
    if (definition->doc)
        json_text(json, "about", definition->doc);
    if (!file->library)
        json_text(json, "file", file->path);
    json_close(json, "}");
}

static void write_file(Compilation *c, const File *file, Json *json)
{
    for (uint32_t i = 0; i < file->syntax->count; i++) {
        const Syntax *statement = file->syntax->children[i];
        if (syntax_defines(statement) && statement->name[0] != '_')
            write_definition(c, file, statement, json);
    }
}

void words_print(Compilation *c, Text *out)
{
    Json json = {.text = *out, .spaced = true};
    json_open(&json, NULL, "[");
    write_builtins(&json, &c->scratch);
    for (size_t i = 1; i < c->files.count; i++) /* behind the scene's own */
        write_file(c, c->files.items[i], &json);
    json_close(&json, "]");
    *out = json.text;
    text_add(out, "\n");
}

void words_use_library(Text *scene)
{
    for (const EmbeddedFile *file = library_files; file->name; file++)
        if (strchr(file->name, '/'))
            text_format(scene, "use \"%s\";\n", file->name);
}
