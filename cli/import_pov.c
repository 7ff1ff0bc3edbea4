/*
 * import_pov.c: scenes of POV-Ray: what they show.
 *
 * Shapes that scenes do not have are refused: a scene that lacks a part would
 * be another one.  Looks, light and settings that are not known are left out
 * and noted.
 */
#include "cli/import_pov.h"

#include <stdio.h>
#include <string.h>

#include "cli/import_pov_reader.h"

/* Blocks that change no shape. */
static const char *const settings[] = {"global_settings", "sky_sphere", "fog",    "rainbow",
                                       "media",           "atmosphere", "photons"};

static bool is_setting(const PovReader *reader)
{
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++)
        if (word_is(&reader->words, settings[i]))
            return true;
    return false;
}

/* ---- the file ---- */

static bool show_object(PovReader *reader)
{
    Part *part;
    if (!pov_object(reader, &part))
        return false;
    if (part)
        part_add(reader->import, reader->shown, part);
    return true;
}

static bool add_light(PovReader *reader)
{
    PovLight light;
    if (!pov_light(reader, &light))
        return false;
    array_push(reader->import->arena, &reader->lights, light);
    return true;
}

static bool statement(PovReader *reader)
{
    WordReader *words = &reader->words;
    PovCell    *own;
    if (word_is(words, "camera"))
        return pov_camera(reader, &reader->view);
    if (word_is(words, "light_source"))
        return add_light(reader);
    if (word_is(words, "default"))
        return pov_default(reader) && word_expect(words, "}");
    if (word_is(words, "background"))
        return pov_background(reader);
    if (is_setting(reader))
        return pov_leave_out(reader, "is");
    if (pov_object_follows(reader))
        return show_object(reader);
    if ((own = pov_take(reader, POV_OBJECT))) {
        if (own->part)
            part_add(reader->import, reader->shown, own->part);
        return true;
    }
    if (words->word.kind == IMPORT_WORD_NAME)
        return import_refuse(reader->import, words->word.line, "`%.40s` is not translated",
                             words->word.text);
    return word_accept(words, ";") || word_refuse(words, "an object such as `sphere`");
}

/* Where an object is refused, --keep-going goes on behind it. */
static bool statement_or_less(PovReader *reader)
{
    unsigned line = reader->words.word.line;
    PovState state;
    pov_keep_state(reader, &state);
    if (import_was_left_out(reader->import, line) && reader->words.word.kind == IMPORT_WORD_NAME &&
        pov_object_follows(reader)) {
        words_advance(&reader->words);
        return pov_skip_block(reader);
    }
    if (statement(reader))
        return true;
    if (state.word.kind != IMPORT_WORD_NAME || !import_leaves_out(reader->import, line))
        return false;
    pov_restore_state(reader, &state);
    words_advance(&reader->words);
    return word_is(&reader->words, "{") ? pov_skip_block(reader) : true;
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
    pov_start(&reader);
    while (reader.words.word.kind != IMPORT_WORD_END)
        if (!statement_or_less(&reader))
            return false;
    if (import->refusal.length > 0)
        return false;
    if (reader.shown->parts.count == 0)
        return import_refuse(import, reader.words.line, "nothing is shown");
    return write(&reader);
}
