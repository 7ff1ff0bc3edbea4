/*
 * import_pov_objects.c: objects of POV-Ray: shapes, joints, and objects that were declared, with
 * what stands behind them in their blocks.
 */
#include <string.h>

#include "cli/import_pov_reader.h"

static bool read_join(PovReader *reader, unsigned line, Part **part);
static bool read_object(PovReader *reader, unsigned line, Part **part);

static const struct {
    const char *name;
    PovBuild   *build;
    PartJoin    join; /* of read_join */
} objects[] = {
    {"sphere", pov_sphere, PART_UNION},         {"box", pov_box, PART_UNION},
    {"cylinder", pov_cylinder, PART_UNION},     {"cone", pov_cone, PART_UNION},
    {"torus", pov_torus, PART_UNION},           {"plane", pov_plane, PART_UNION},
    {"quadric", pov_quadric, PART_UNION},       {"cubic", pov_cubic, PART_UNION},
    {"quartic", pov_quartic, PART_UNION},       {"poly", pov_poly, PART_UNION},
    {"object", read_object, PART_UNION},        {"union", read_join, PART_UNION},
    {"merge", read_join, PART_UNION},           {"intersection", read_join, PART_INTERSECTION},
    {"difference", read_join, PART_DIFFERENCE},
};
enum { OBJECTS = sizeof objects / sizeof *objects };

/* Words that change no shape, and a truth value or a block behind them. */
static const char *const harmless[] = {
    "no_shadow",         "no_reflection", "no_radiosity", "hollow",    "sturm",
    "double_illuminate", "photons",       "interior",     "normal",    "interior_texture",
    "bounded_by",        "uv_mapping",    "split_union",  "radiosity", "hierarchy"};

static int find_object(const PovReader *reader)
{
    for (int i = 0; i < OBJECTS; i++)
        if (word_is(&reader->words, objects[i].name))
            return i;
    return -1;
}

bool pov_object_follows(const PovReader *reader) { return find_object(reader) >= 0; }

static bool read_join(PovReader *reader, unsigned line, Part **part)
{
    *part = part_new(reader->import, line, "union");
    while (pov_object_follows(reader)) {
        Part *item;
        if (!pov_object(reader, &item))
            return false;
        part_add(reader->import, *part, item);
        word_accept(&reader->words, ",");
    }
    return (*part)->parts.count > 0 || word_refuse(&reader->words, "an object such as `sphere`");
}

/* A name, or an object in the object. */
static bool read_object(PovReader *reader, unsigned line, Part **part)
{
    Part    *inner = NULL;
    PovName *own   = reader->words.word.kind == IMPORT_WORD_NAME
                         ? pov_find(reader, reader->words.word.text)
                         : NULL;
    if (own && own->kind == POV_OBJECT) {
        inner = own->part;
        words_advance(&reader->words);
    } else if (!pov_object_follows(reader)) {
        return word_refuse(&reader->words, "an object, or the name of one that was declared");
    } else if (!pov_object(reader, &inner)) {
        return false;
    }
    *part = part_around(reader->import, line, "object", inner);
    return true;
}

static bool is_harmless(const PovReader *reader)
{
    for (size_t i = 0; i < sizeof harmless / sizeof *harmless; i++)
        if (word_is(&reader->words, harmless[i]))
            return true;
    return false;
}

/* The modifiers of an object, up to its `}`. */
static bool read_modifiers(PovReader *reader, const char *name, Part *part)
{
    WordReader *words = &reader->words;
    PovLook     look  = {0};
    Place       place = place_identity();
    while (!word_is(words, "}")) {
        bool taken = false;
        if (!pov_place(reader, &place, &taken) || (!taken && !pov_look(reader, &look, &taken)))
            return false;
        if (taken)
            continue;
        if (is_harmless(reader)) {
            if (!pov_leave_out(reader, "of an object is"))
                return false;
        } else if (word_is(words, "color") || word_is(words, "colour")) {
            look.colored = true;
            if (!pov_color(reader, look.color))
                return false;
        } else if (words->word.kind == IMPORT_WORD_NAME) {
            return import_refuse(reader->import, words->word.line,
                                 "`%.40s` in `%s` is not translated", words->word.text, name);
        } else {
            return word_refuse(words, "a modifier such as `translate`, or `}`");
        }
    }
    place = place_mirrored(&place);
    part_move(part, &place);
    part->look = pov_look_text(reader, &look);
    return true;
}

bool pov_object(PovReader *reader, Part **part)
{
    int      found = find_object(reader);
    unsigned line  = reader->words.word.line;
    if (found < 0)
        return word_refuse(&reader->words, "an object such as `sphere`");
    words_advance(&reader->words);
    if (!pov_deeper(reader) || !word_expect(&reader->words, "{") ||
        !objects[found].build(reader, line, part))
        return false;
    if (objects[found].build == read_join) {
        (*part)->join = objects[found].join;
        (*part)->stem = objects[found].name;
    }
    if (!read_modifiers(reader, objects[found].name, *part))
        return false;
    reader->depth--;
    return word_expect(&reader->words, "}");
}
