/*
 * import_pov.c: scenes of POV-Ray: objects, declarations, and what shows them.
 *
 * Programs (`#while`, `#macro`) and shapes that scenes do not have are refused: a scene that lacks
 * a part would be another one.  Looks, light and settings that are not known are left out and
 * noted.
 */
#include "cli/import_pov.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "cli/import_pov_reader.h"

enum { MOST_NAMES = 4096 };

/* Blocks that change no shape. */
static const char *const settings[] = {"global_settings", "sky_sphere", "fog", "rainbow", "media"};

static bool is_setting(const PovReader *reader)
{
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++)
        if (word_is(&reader->words, settings[i]))
            return true;
    return false;
}

/* ---- declarations ---- */

/* A name for the scene.  Names of the language have no capital letters, so others get a prefix. */
static const char *scene_name(PovReader *reader, const char *name)
{
    Text text  = {.arena = reader->import->arena};
    bool large = false;
    int  same  = 1;
    for (const char *c = name; *c; c++)
        large = large || isupper((unsigned char)*c);
    for (size_t i = 0; i < reader->names.count; i++)
        same += reader->names.items[i].kind == POV_OBJECT &&
                strcmp(reader->names.items[i].name, name) == 0;
    text_format(&text, "%s%s", large && name[0] != '_' ? "" : "my_", name);
    if (same > 1)
        text_format(&text, "_%d_again", same);
    return text.bytes;
}

static bool declare(PovReader *reader)
{
    WordReader *words = &reader->words;
    PovName     name  = {.name = words->word.text, .kind = POV_OBJECT};
    bool        look  = false;
    if (words->word.kind != IMPORT_WORD_NAME)
        return word_refuse(words, "a name");
    if (reader->names.count == MOST_NAMES)
        return import_refuse(reader->import, words->word.line, "more than %d names are declared",
                             MOST_NAMES);
    words_advance(words);
    if (!word_expect(words, "=") || !pov_look(reader, &name.look, &look))
        return false;
    const PovName *other = words->word.kind == IMPORT_WORD_NAME ? pov_find(reader, words->word.text)
                                                                : NULL;
    if (look) {
        name.kind = POV_LOOK;
    } else if (pov_object_follows(reader)) {
        if (!pov_object(reader, &name.part))
            return false;
        name.part->wanted = scene_name(reader, name.name);
        name.part->shared = true;
    } else if (other && other->kind != POV_VALUE) {
        name.kind = other->kind;
        name.part = other->part;
        name.look = other->look;
        words_advance(words);
    } else if (pov_value_follows(reader)) {
        name.kind = POV_VALUE;
        if (!pov_value(reader, &name.value))
            return false;
    } else if (pov_color_follows(reader)) {
        name.kind        = POV_VALUE;
        name.value.count = 3;
        if (!pov_color(reader, name.value.v))
            return false;
    } else {
        return import_refuse(reader->import, words->word.line,
                             "`%.40s` is not translated: a name is declared for a value, an object"
                             " or a look",
                             words->word.text);
    }
    word_accept(words, ";");
    array_push(reader->import->arena, &reader->names, name);
    return true;
}

static bool directive(PovReader *reader)
{
    WordReader *words = &reader->words;
    unsigned    line  = words->word.line;
    const char *name  = words->word.text;
    double      version;
    if (word_accept(words, "declare") || word_accept(words, "local"))
        return declare(reader);
    if (word_accept(words, "version")) {
        if (!pov_number(reader, &version))
            return false;
        word_accept(words, ";");
        return true;
    }
    if (word_accept(words, "default")) {
        import_note(reader->import, line, "`#default` is left out");
        return pov_skip_block(reader);
    }
    if (word_accept(words, "include")) {
        if (words->word.kind != IMPORT_WORD_STRING)
            return word_refuse(words, "the name of a file, between quotes");
        import_note(reader->import, line,
                    "`%.60s` is not read; plain colours of colors.inc are known", words->word.text);
        words_advance(words);
        return true;
    }
    return import_refuse(reader->import, line, "`#%.40s` is not translated", name);
}

/* ---- the file ---- */

static bool statement(PovReader *reader)
{
    WordReader *words = &reader->words;
    if (word_accept(words, "#"))
        return directive(reader);
    if (word_is(words, "camera"))
        return pov_camera(reader);
    if (word_is(words, "light_source"))
        return pov_light(reader);
    if (word_is(words, "background"))
        return pov_background(reader);
    if (is_setting(reader))
        return pov_leave_out(reader, "is");
    if (pov_object_follows(reader)) {
        Part *part;
        if (!pov_object(reader, &part))
            return false;
        part_add(reader->import, reader->shown, part);
        return true;
    }
    if (words->word.kind == IMPORT_WORD_NAME)
        return import_refuse(reader->import, words->word.line, "`%.40s` is not translated",
                             words->word.text);
    return word_accept(words, ";") || word_refuse(words, "an object such as `sphere`");
}

static bool write(PovReader *reader)
{
    Import    *import = reader->import;
    PartWriter writer = {.import = import, .inner_looks = true};
    import_write_head(import);
    text_add(&import->scene,
             "// POV-Ray's z points away from the eye: each z has the other sign.\n");
    if (reader->materials.length > 0)
        text_add(&import->scene, reader->materials.bytes);
    for (size_t i = 0; i < reader->shown->parts.count; i++)
        if (!part_show(&writer, reader->shown->parts.items[i], ""))
            return false;
    pov_write_view(reader);
    return true;
}

bool import_pov(Import *import)
{
    PovReader reader = {.import = import, .materials = {.arena = import->arena}};
    reader.shown     = part_new(import, 1, "shown");
    words_start(&reader.words, import, true);
    while (reader.words.word.kind != IMPORT_WORD_END)
        if (!statement(&reader))
            return false;
    if (import->refusal.length > 0)
        return false;
    if (reader.shown->parts.count == 0)
        return import_refuse(import, reader.words.line, "nothing is shown");
    return write(&reader);
}
