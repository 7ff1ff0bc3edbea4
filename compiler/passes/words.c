/*
 * words.c: the words of the language that scenes use without defining them, as JSON.
 */
#include <string.h>

#include "compiler/base/embedded.h"
#include "compiler/passes/compilation.h"

/* ---- members ---- */

static void add_string(Text *json, const char *member, const char *string)
{
    text_format(json, ", \"%s\": ", member);
    text_json(json, string);
}

static void begin_word(Text *json, const char *kind, const char *name)
{
    text_add(json, json->length > 1 ? ",\n{" : "{");
    text_format(json, "\"kind\": \"%s\", \"name\": \"%s\"", kind, name);
}

static void begin_parameter(Text *json, bool first, const char *name, size_t length)
{
    text_format(json, "%s{\"name\": \"%.*s\"", first ? "" : ", ", (int)length, name);
}

/* ---- what is built in ---- */

/* Writes the parameters of "shapes... radius=". */
static void write_builtin_parameters(Text *json, const char *parameters)
{
    text_add(json, ", \"parameters\": [");
    for (const char *at = parameters; *at; at += strcspn(at, " "), at += strspn(at, " ")) {
        const size_t length = strcspn(at, " ="), word = strcspn(at, " ");
        const bool   many = length > 3 && strncmp(at + length - 3, "...", 3) == 0;
        begin_parameter(json, at == parameters, at, many ? length - 3 : length);
        text_add(json, many ? ", \"many\": true" : length < word ? ", \"optional\": true" : "");
        text_add(json, "}");
    }
    text_add(json, "]");
}

static void write_builtins(Text *json)
{
    for (const BuiltinWord *word = builtin_words; word->name; word++) {
        if (!word->parameters) /* scenes do not call it */
            continue;
        begin_word(json, word->kind, word->name);
        if (strcmp(word->kind, "value") != 0)
            write_builtin_parameters(json, word->parameters);
        add_string(json, "about", word->meaning);
        text_add(json, "}");
    }
}

/* ---- what the library declares ---- */

static const char *text_of(const Compilation *c, Span span, Arena *arena)
{
    return arena_copy_text(arena, c->sources.items[span.source].text + span.start,
                           span.end - span.start);
}

static void write_parameter(Compilation *c, const Syntax *parameter, bool first, Text *json)
{
    const ParameterKind kind = (ParameterKind)parameter->number[0];
    begin_parameter(json, first, parameter->name, strlen(parameter->name));
    if (kind != KIND_ANY)
        add_string(json, "takes", parameter_kind_name(kind));
    if (parameter->count > 0) {
        text_add(json, ", \"optional\": true");
        add_string(json, "default", text_of(c, parameter->children[0]->span, &c->scratch));
    }
    if (parameter->count > 1)
        add_string(json, "range", text_of(c, parameter->children[1]->span, &c->scratch));
    text_add(json, "}");
}

static void write_parameters(Compilation *c, const Syntax *definition, Text *json)
{
    text_add(json, ", \"parameters\": [");
    for (uint32_t i = 0; i < definition->count; i++)
        if (definition->children[i]->kind == SYNTAX_PARAMETER)
            write_parameter(c, definition->children[i], i == 0, json);
    text_add(json, "]");
}

static void write_definition(Compilation *c, const File *file, const Syntax *definition, Text *json)
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
        add_string(json, "about", definition->doc);
    if (!file->library)
        add_string(json, "file", file->path);
    text_add(json, "}");
}

static void write_file(Compilation *c, const File *file, Text *json)
{
    for (uint32_t i = 0; i < file->syntax->count; i++) {
        const Syntax *statement = file->syntax->children[i];
        if (syntax_defines(statement) && statement->name[0] != '_')
            write_definition(c, file, statement, json);
    }
}

void words_print(Compilation *c, Text *json)
{
    text_add(json, "[");
    write_builtins(json);
    for (size_t i = 1; i < c->files.count; i++) /* behind the scene's own */
        write_file(c, c->files.items[i], json);
    text_add(json, "]\n");
}

void words_use_library(Text *scene)
{
    for (const EmbeddedFile *file = library_files; file->name; file++)
        if (strchr(file->name, '/'))
            text_format(scene, "use \"%s\";\n", file->name);
}
