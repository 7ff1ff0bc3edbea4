/*
 * import_pov_objects.c: objects of POV-Ray: shapes, joints, and objects that
 * were declared, with what stands behind them in their blocks.
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
    {"sphere", pov_sphere, PART_UNION},
    {"box", pov_box, PART_UNION},
    {"cylinder", pov_cylinder, PART_UNION},
    {"cone", pov_cone, PART_UNION},
    {"torus", pov_torus, PART_UNION},
    {"plane", pov_plane, PART_UNION},
    {"quadric", pov_quadric, PART_UNION},
    {"cubic", pov_cubic, PART_UNION},
    {"quartic", pov_quartic, PART_UNION},
    {"poly", pov_poly, PART_UNION},
    {"object", read_object, PART_UNION},
    {"union", read_join, PART_UNION},
    {"merge", read_join, PART_UNION},
    {"intersection", read_join, PART_INTERSECTION},
    {"difference", read_join, PART_DIFFERENCE},
    {"prism", pov_prism, PART_UNION},
    {"lathe", pov_lathe, PART_UNION},
    {"text", pov_text, PART_UNION},
    {"disc", pov_disc, PART_UNION},
    {"blob", pov_blob, PART_UNION},
    {"superellipsoid", pov_superellipsoid, PART_UNION},
    {"julia_fractal", pov_julia, PART_UNION},
};
enum { OBJECTS = sizeof objects / sizeof *objects };

/* Words that change no shape, and a truth value or a block behind them. */
static const char *const harmless[] = {
    "no_shadow",         "no_reflection", "no_radiosity", "hollow",           "sturm",
    "double_illuminate", "photons",       "normal",       "interior_texture", "max_gradient",
    "max_trace",         "accuracy",      "no_image",     "cutaway_textures", "all_intersections",
    "bounded_by",        "uv_mapping",    "split_union",  "radiosity",        "hierarchy"};

static int find_object(const PovReader *reader)
{
    for (int i = 0; i < OBJECTS; i++)
        if (word_is(&reader->words, objects[i].name))
            return i;
    return -1;
}

bool pov_object_follows(const PovReader *reader) { return find_object(reader) >= 0; }

/* Directives may stand between objects, and lights, which are those of the
 * scene. */
static bool read_join(PovReader *reader, unsigned line, Part **part)
{
    WordReader *words = &reader->words;
    *part             = part_new(reader->import, line, "union");
    for (;;) {
        Part *item;
        if (!pov_release(reader))
            return false;
        if (word_is(words, "light_source")) {
            PovLight light;
            if (!pov_light(reader, &light))
                return false;
            array_push(reader->import->arena, &reader->lights, light);
        } else if (pov_object_follows(reader)) {
            if (!pov_object(reader, &item))
                return false;
            if (item)
                part_add(reader->import, *part, item);
        } else {
            PovCell *own = pov_take(reader, POV_OBJECT);
            if (!own)
                break;
            if (own->part)
                part_add(reader->import, *part, own->part);
        }
        while (word_accept(words, ",") || word_accept(words, ";"))
            ;
    }
    return true;
}

/* A name, or an object in the object. */
static bool read_object(PovReader *reader, unsigned line, Part **part)
{
    Part    *inner = NULL;
    PovCell *own;
    if (!pov_release(reader))
        return false;
    if ((own = pov_take(reader, POV_LIGHT))) {
        array_push(reader->import->arena, &reader->lights, *own->light);
        *part = NULL;
        return true;
    }
    if ((own = pov_take(reader, POV_OBJECT)))
        inner = own->part;
    else if (!pov_object_follows(reader))
        return word_refuse(&reader->words, "an object, or the name of one that was declared");
    else if (!pov_object(reader, &inner))
        return false;
    *part = inner ? part_around(reader->import, line, "object", inner) : NULL;
    return true;
}

static bool is_harmless(const PovReader *reader)
{
    for (size_t i = 0; i < sizeof harmless / sizeof *harmless; i++)
        if (word_is(&reader->words, harmless[i]))
            return true;
    return false;
}

bool pov_modifier_follows(const PovReader *reader)
{
    static const char *const others[] = {"}",       "translate", "rotate",  "scale",
                                         "matrix",  "transform", "pigment", "finish",
                                         "texture", "material",  "inverse"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (word_is(&reader->words, others[i]))
            return true;
    return is_harmless(reader);
}

/* The modifiers of an object, up to its `}`. */
static bool read_modifiers(PovReader *reader, const char *name, Part *part)
{
    WordReader *words    = &reader->words;
    PovLook     look     = {0};
    Place       place    = place_identity();
    bool        inverted = false;
    while (!word_is(words, "}")) {
        bool   taken = false;
        double color[5];
        if (!pov_release(reader))
            return false;
        if (word_accept(words, ";") || word_accept(words, ","))
            continue;
        if (word_accept(words, "inverse")) {
            inverted = !inverted;
            continue;
        }
        if (!pov_place(reader, &place, &taken) || (!taken && !pov_look(reader, &look, &taken)))
            return false;
        if (taken)
            continue;
        if (is_harmless(reader)) {
            if (!pov_leave_out(reader, "of an object is"))
                return false;
        } else if (word_is(words, "color") || word_is(words, "colour")) {
            if (!pov_color(reader, color))
                return false;
            look.colored = true;
            memcpy(look.color, color, sizeof look.color);
        } else if (words->word.kind == IMPORT_WORD_NAME) {
            return import_refuse(reader->import, words->word.line,
                                 "`%.40s` in `%s` is not translated", words->word.text, name);
        } else {
            return word_refuse(words, "a modifier such as `translate`, or `}`");
        }
    }
    if (!part)
        return true;
    place = place_mirrored(&place);
    part_move(part, &place);
    part->look    = pov_look_text(reader, &look);
    part->outside = part->outside != inverted;
    return true;
}

/* `*part` is NULL where it is nothing to be seen. */
bool pov_object(PovReader *reader, Part **part)
{
    int      found = find_object(reader);
    unsigned line  = reader->words.word.line;
    *part          = NULL;
    if (found < 0)
        return word_refuse(&reader->words, "an object such as `sphere`");
    words_advance(&reader->words);
    if (!pov_deeper(reader) || !word_expect(&reader->words, "{") || !pov_release(reader) ||
        !objects[found].build(reader, line, part))
        return false;
    if (objects[found].build == read_join) {
        (*part)->join = objects[found].join;
        (*part)->stem = objects[found].name;
    }
    if (!read_modifiers(reader, objects[found].name, *part))
        return false;
    if (*part && objects[found].build == read_join && (*part)->parts.count == 0)
        *part = NULL;
    reader->depth--;
    return word_expect(&reader->words, "}");
}
