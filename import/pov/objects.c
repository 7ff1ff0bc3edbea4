/*
 * objects.c: objects of POV-Ray: shapes, joints, and objects that
 * were declared, with what stands behind them in their blocks.
 */
#include <math.h>
#include <string.h>

#include "import/pov/reader.h"

static bool read_union(PovReader *reader, unsigned line, Part **part);
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
    {"union", read_union, PART_UNION},
    {"merge", read_union, PART_UNION},
    {"intersection", read_join, PART_INTERSECTION},
    {"difference", read_join, PART_DIFFERENCE},
    {"prism", pov_prism, PART_UNION},
    {"lathe", pov_lathe, PART_UNION},
    {"text", pov_text, PART_UNION},
    {"disc", pov_disc, PART_UNION},
    {"blob", pov_blob, PART_UNION},
    {"superellipsoid", pov_superellipsoid, PART_UNION},
    {"julia_fractal", pov_julia, PART_UNION},
    {"polygon", pov_polygon, PART_UNION},
    {"triangle", pov_triangle, PART_UNION},
    {"smooth_triangle", pov_smooth_triangle, PART_UNION},
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

/* Shapes that scenes do not have. */
static const char *const missing[] = {"mesh",       "mesh2",       "height_field", "bicubic_patch",
                                      "isosurface", "parametric",  "sor",          "ovus",
                                      "lemon",      "sphere_sweep"};

static bool is_missing(const PovReader *reader) { return word_among(&reader->words, missing); }

/* Reads an object of a join; *item is NULL where nothing is seen of it.  One that is refused is
   left out of a union with --keep-going. */
static bool read_item(PovReader *reader, bool may_lack, Part **item)
{
    unsigned line = reader->words.word.line;
    PovState state;
    pov_keep_state(reader, &state);
    *item = NULL;
    if (is_missing(reader))
        import_refuse(reader->import, line, "`%.40s` is not translated", reader->words.word.text);
    else if (pov_object(reader, item))
        return true;
    if (!may_lack || !import_leaves_out(reader->import, line))
        return false;
    *item = NULL;
    pov_restore_state(reader, &state);
    words_advance(&reader->words);
    return pov_skip_block(reader);
}

/* Directives may stand between objects, and lights, which are those of the
 * scene. */
static bool read_items(PovReader *reader, unsigned line, bool may_lack, Part **part)
{
    WordReader *words = &reader->words;
    *part             = part_new(reader->import, line, "union");
    for (;;) {
        Part *item = NULL;
        if (!pov_release(reader))
            return false;
        if (word_is(words, "light_source")) {
            PovLight light;
            if (!pov_light(reader, &light))
                return false;
            array_push(reader->import->arena, &reader->lights, light);
        } else if (pov_object_follows(reader) || is_missing(reader)) {
            if (!read_item(reader, may_lack, &item))
                return false;
        } else {
            PovCell *own = pov_take(reader, POV_OBJECT);
            if (!own)
                return true;
            item = own->part;
        }
        if (item)
            part_add(reader->import, *part, item);
        while (word_accept(words, ",") || word_accept(words, ";"))
            ;
    }
}

static bool read_union(PovReader *reader, unsigned line, Part **part)
{
    return read_items(reader, line, true, part);
}

static bool read_join(PovReader *reader, unsigned line, Part **part)
{
    if (!read_items(reader, line, false, part))
        return false;
    return !pov_is_open_surface(*part) ||
           import_refuse(reader->import, line,
                         "what is clipped, open or flat has no inside: it is not translated in "
                         "`intersection` and `difference`");
}

/* Reads a name, or an object in the object. */
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

static bool is_harmless(const PovReader *reader) { return word_among(&reader->words, harmless); }

bool pov_modifier_follows(const PovReader *reader)
{
    static const char *const others[] = {"}",         "translate",  "rotate", "scale",   "matrix",
                                         "transform", "pigment",    "finish", "texture", "material",
                                         "inverse",   "clipped_by", "open"};
    return word_among(&reader->words, others) || is_harmless(reader);
}

/* A box that is scaled along its edges is a box: its distance is exact, where that of what is scaled
   unevenly is a bound, and a bad one of what becomes flat. */
static void stretch_box(Import *import, Part *part)
{
    double *half = part->inside.numbers, size[3];
    for (int i = 0; i < 9; i++)
        if (i / 3 != i % 3 && part->transform.rows[i / 3][i % 3] != 0)
            return;
    if (part->inside.kind != PART_BOX || transform_factor(&part->transform) > 0)
        return;
    for (int i = 0; i < 3; i++) {
        half[i] *= fabs(part->transform.rows[i][i]);
        size[i]                    = 2 * half[i];
        part->transform.rows[i][i] = 1;
    }
    Text text = {.arena = import->arena};
    text_format(&text, "box(%s)", import_vector_text(import, size, 3));
    part->shape = text.bytes;
}

/* Reads `{ objects }`: what is within all of them is left of the part, as it is placed so far. */
static bool read_clip(PovReader *reader, const Transform *transform, Part **part)
{
    unsigned line = reader->words.word.line;
    Part    *region;
    words_advance(&reader->words);
    if (!pov_deeper(reader) || !word_expect(&reader->words, "{") ||
        !read_items(reader, line, false, &region))
        return false;
    if (!word_is(&reader->words, "}") || region->parts.count == 0)
        return import_refuse(reader->import, line, "`clipped_by` is translated with objects alone");
    region->join = PART_INTERSECTION;
    if (region->parts.count == 1)
        region = region->parts.items[0];
    reader->depth--;
    return word_expect(&reader->words, "}") &&
           (!*part || pov_clip(reader, transform, part, line, region));
}

/* Reads the modifiers of an object, up to its `}`; what they cut is another part. */
static bool read_modifiers(PovReader *reader, const char *name, Part **part)
{
    WordReader *words     = &reader->words;
    PovLook     look      = reader->usual;
    Transform   transform = transform_identity();
    bool        inverted  = false;
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
        if (word_is(words, "clipped_by")) {
            if (!read_clip(reader, &transform, part))
                return false;
            continue;
        }
        if (*part && word_is(words, "open")) {
            if (!pov_open(reader, words->word.line, part))
                return false;
            words_advance(words);
            continue;
        }
        if (!pov_transform(reader, &transform, &taken) ||
            (!taken && !pov_look(reader, &look, &taken)))
            return false;
        if (taken)
            continue;
        if (is_harmless(reader)) {
            if (!pov_leave_out(reader, "of an object is"))
                return false;
        } else if (word_is(words, "color") || word_is(words, "colour")) {
            if (!pov_color(reader, color))
                return false;
            look.said = look.colored = true;
            memcpy(look.color, color, sizeof look.color);
        } else if (words->word.kind == IMPORT_WORD_NAME) {
            return import_refuse(reader->import, words->word.line,
                                 "`%.40s` in `%s` is not translated", words->word.text, name);
        } else {
            return word_refuse(words, "a modifier such as `translate`, or `}`");
        }
    }
    if (!*part)
        return true;
    transform = transform_mirrored(&transform);
    part_move(*part, &transform);
    stretch_box(reader->import, *part);
    (*part)->look    = pov_look_text(reader, &look);
    (*part)->outside = (*part)->outside != (inverted && !pov_is_open_surface(*part));
    return true;
}

/* Reads an object; `*part` is NULL if nothing of it is seen. */
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
    bool joins = objects[found].build == read_join || objects[found].build == read_union;
    if (joins) {
        (*part)->join = objects[found].join;
        (*part)->stem = objects[found].name;
    }
    if (!read_modifiers(reader, objects[found].name, part))
        return false;
    if (*part && joins && (*part)->parts.count == 0)
        *part = NULL;
    reader->depth--;
    return word_expect(&reader->words, "}");
}
