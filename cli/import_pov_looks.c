/*
 * import_pov_looks.c: colours, transparency and highlights of POV-Ray.  A
 * pattern is one colour, the mean of its colours; bumps and what is inside of
 * things are left out.  None of that changes a shape.
 */
#include <math.h>
#include <string.h>

#include "cli/import_pov_reader.h"

/* A sum of colours by their shares: red, green, blue, filter, transmit, and the
 * shares. */
typedef struct Mean {
    double sum[6];
} Mean;

static void add_color(Mean *mean, const double color[5], double share)
{
    for (int i = 0; i < 5; i++)
        mean->sum[i] += share * color[i];
    mean->sum[5] += share;
}

static void set_color(PovLook *look, const double color[5])
{
    memcpy(look->color, color, sizeof look->color);
    look->filter   = color[3];
    look->transmit = color[4];
    look->colored  = true;
}

static void set_mean(PovLook *look, const Mean *mean)
{
    double color[5];
    for (int i = 0; i < 5 && mean->sum[5] > 0; i++)
        color[i] = mean->sum[i] / mean->sum[5];
    if (mean->sum[5] > 0)
        set_color(look, color);
    look->patterned = true;
}

static void look_color(const PovLook *look, double color[5])
{
    static const double gray[3] = {0.6, 0.6, 0.6};
    memcpy(color, look->colored ? look->color : gray, sizeof look->color);
    color[3] = look->filter;
    color[4] = look->transmit;
}

/* Takes the name of a look that was declared. */
static bool take_declared(PovReader *reader, PovLook *look)
{
    PovCell *own = pov_take(reader, POV_LOOK);
    if (!own)
        return false;
    if (own->look.colored) {
        memcpy(look->color, own->look.color, sizeof look->color);
        look->filter    = own->look.filter;
        look->transmit  = own->look.transmit;
        look->patterned = own->look.patterned;
        look->colored   = true;
    }
    if (own->look.finished) {
        look->finished = true;
        look->specular = own->look.specular;
        look->size     = own->look.size;
        look->metallic = own->look.metallic;
    }
    look->ior = own->look.ior > 0 ? own->look.ior : look->ior;
    return true;
}

/* ---- maps of colours ---- */

typedef bool ReadEntry(PovReader *reader, double color[5]);

static bool read_pigment_entry(PovReader *reader, double color[5])
{
    PovLook look = {0};
    if (!pov_look_inside(reader, &look))
        return false;
    look_color(&look, color);
    return true;
}

/* `[place entry] ...`, or in old files `[place, place color A color B]`. */
static bool read_entries(PovReader *reader, ReadEntry *read, PovLook *look)
{
    WordReader *words  = &reader->words;
    Mean        mean   = {{0}};
    double      before = 0, last[5] = {0};
    bool        first = true;
    while (word_accept(words, "[")) {
        double place, end, color[5], other[5];
        if (!pov_number(reader, &place))
            return false;
        end = place;
        word_accept(words, ",");
        if (words->word.kind == IMPORT_WORD_NUMBER && !pov_number(reader, &end))
            return false;
        word_accept(words, ",");
        if (!read(reader, color))
            return false;
        memcpy(other, color, sizeof other);
        word_accept(words, ",");
        if (!word_is(words, "]") && !read(reader, other))
            return false;
        add_color(&mean, first ? color : last, 0.5 * fmax(place - before, 0));
        add_color(&mean, color, 0.5 * fmax(place - before, 0));
        add_color(&mean, color, 0.5 * fmax(end - place, 0));
        add_color(&mean, other, 0.5 * fmax(end - place, 0));
        memcpy(last, other, sizeof last);
        before = fmin(end, 1);
        first  = false;
        if (!word_expect(words, "]"))
            return false;
    }
    add_color(&mean, last, fmax(1 - before, 0));
    set_mean(look, &mean);
    return true;
}

/* A block of entries, or the name of one that was declared. */
static bool read_map(PovReader *reader, ReadEntry *read, PovLook *look)
{
    words_advance(&reader->words);
    return word_expect(&reader->words, "{") &&
           (take_declared(reader, look) || read_entries(reader, read, look)) &&
           word_expect(&reader->words, "}");
}

/* `checker A, B`: each has its share. */
static bool read_list_of_looks(PovReader *reader, int most, PovLook *look)
{
    Mean mean = {{0}};
    words_advance(&reader->words);
    for (int i = 0; i < most; i++) {
        double  color[5];
        PovLook part  = {0};
        bool    taken = false;
        if (!take_declared(reader, &part) && !pov_look(reader, &part, &taken))
            return false;
        if (taken || part.colored) {
            look_color(&part, color);
        } else if (!pov_color_follows(reader)) {
            break;
        } else if (!pov_color(reader, color)) {
            return false;
        }
        add_color(&mean, color, 1);
        word_accept(&reader->words, ",");
    }
    static const double usual[2][5] = {{0, 0, 1}, {0, 1, 0}};
    for (int i = 0; i < 2 && mean.sum[5] == 0; i++)
        add_color(&mean, usual[i], 0.5);
    set_mean(look, &mean);
    return true;
}

static const struct {
    const char *name;
    ReadEntry  *read;
    int         list; /* how many looks stand behind it */
} patterns[] = {{"color_map", pov_color, 0},
                {"colour_map", pov_color, 0},
                {"pigment_map", read_pigment_entry, 0},
                {"texture_map", read_pigment_entry, 0},
                {"checker", NULL, 2},
                {"brick", NULL, 2},
                {"hexagon", NULL, 3},
                {"square", NULL, 4},
                {"triangular", NULL, 6},
                {"cubic", NULL, 6},
                {"object", NULL, 0}};

static bool read_pattern(PovReader *reader, PovLook *look, bool *taken)
{
    *taken = false;
    for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++) {
        if (!word_is(&reader->words, patterns[i].name) || (!patterns[i].read && !patterns[i].list))
            continue;
        *taken = true;
        return patterns[i].read ? read_map(reader, patterns[i].read, look)
                                : read_list_of_looks(reader, patterns[i].list, look);
    }
    return true;
}

/* ---- blocks ---- */

static bool pigment(PovReader *reader, PovLook *look)
{
    Place ignored = place_identity();
    while (!word_is(&reader->words, "}") && !word_is(&reader->words, "]")) {
        bool   taken = false;
        double color[5];
        if (!pov_release(reader))
            return false;
        if (take_declared(reader, look))
            continue;
        if (!pov_place(reader, &ignored, &taken) || (!taken && !read_pattern(reader, look, &taken)))
            return false;
        if (taken)
            continue;
        if (pov_color_follows(reader)) {
            if (!pov_color(reader, color))
                return false;
            set_color(look, color);
        } else {
            look->patterned = true;
            if (!pov_leave_out(reader, NULL))
                return false;
        }
        word_accept(&reader->words, ",");
    }
    return true;
}

/* Whatever stands in a look: parts of a texture, or of a pigment alone. */
bool pov_look_inside(PovReader *reader, PovLook *look)
{
    bool taken = false;
    if (!pov_look(reader, look, &taken))
        return false;
    while (taken && !word_is(&reader->words, "]") && !word_is(&reader->words, "}"))
        if (!pov_look(reader, look, &taken) || (!taken && !pov_leave_out(reader, NULL)))
            return false;
    return taken || pigment(reader, look);
}

/* An optional number behind a word. */
static bool amount(PovReader *reader, double otherwise, double *number)
{
    PovValue value = {.v = {otherwise}};
    words_advance(&reader->words);
    if (pov_value_follows(reader) && !pov_value(reader, &value))
        return false;
    *number = value.v[0];
    return true;
}

/* How wide a highlight is: phong_size, or 1 / roughness, are exponents of a
 * cosine. */
static bool finish(PovReader *reader, PovLook *look)
{
    WordReader *words = &reader->words;
    look->finished    = true;
    while (!word_is(words, "}")) {
        double number;
        bool   phong = word_is(words, "phong"), specular = word_is(words, "specular");
        if (!pov_release(reader))
            return false;
        if (take_declared(reader, look))
            continue;
        if (phong || specular) {
            if (!amount(reader, 0, &number))
                return false;
            look->specular = look->specular || number > 0;
            if (look->size == 0)
                look->size = phong ? 40 : 20;
        } else if (word_is(words, "phong_size")) {
            if (!amount(reader, 40, &look->size))
                return false;
        } else if (word_is(words, "roughness")) {
            if (!amount(reader, 0.05, &number))
                return false;
            look->size = number > 0 ? 1 / number : 1e6;
        } else if (word_is(words, "metallic")) {
            if (!amount(reader, 1, &look->metallic))
                return false;
        } else if (!pov_leave_out(reader, "of a finish is")) {
            return false;
        }
        word_accept(words, ",");
    }
    return true;
}

/* Of all that is inside of a thing, its index of refraction shows. */
static bool interior(PovReader *reader, PovLook *look)
{
    while (!word_is(&reader->words, "}")) {
        if (!pov_release(reader))
            return false;
        if (word_is(&reader->words, "ior")) {
            if (!amount(reader, 1, &look->ior))
                return false;
        } else if (!take_declared(reader, look) && !pov_leave_out(reader, NULL)) {
            return false;
        }
    }
    return true;
}

static bool block(PovReader *reader, PovLook *look,
                  bool (*inside)(PovReader *reader, PovLook *look))
{
    return word_expect(&reader->words, "{") && inside(reader, look) &&
           word_expect(&reader->words, "}");
}

static bool texture(PovReader *reader, PovLook *look)
{
    Place ignored = place_identity();
    while (!word_is(&reader->words, "}")) {
        if (!pov_release(reader))
            return false;
        bool taken = take_declared(reader, look);
        if (!taken &&
            (!pov_look(reader, look, &taken) || (!taken && !pov_place(reader, &ignored, &taken)) ||
             (!taken && !read_pattern(reader, look, &taken))))
            return false;
        if (!taken && !pov_leave_out(reader, NULL))
            return false;
        word_accept(&reader->words, ",");
    }
    return true;
}

/* A texture lies on those before it: they show as far as light goes through. */
static bool read_layer(PovReader *reader, PovLook *look)
{
    PovLook layer = *look, below = *look;
    layer.colored = layer.textured = false;
    layer.filter = layer.transmit = 0;
    if (!block(reader, &layer, texture))
        return false;
    double through = fmin(fmax(layer.filter + layer.transmit, 0), 1);
    bool   both    = below.textured && layer.colored;
    for (int i = 0; i < 3 && both; i++)
        layer.color[i] = (1 - through) * layer.color[i] +
                         through * (below.colored ? below.color[i] : 0.6);
    if (both) {
        layer.filter   = through * below.filter;
        layer.transmit = through * below.transmit;
    } else if (!layer.colored) {
        memcpy(layer.color, below.color, sizeof layer.color);
        layer.colored  = below.colored;
        layer.filter   = below.filter;
        layer.transmit = below.transmit;
    }
    layer.textured = true;
    *look          = layer;
    return true;
}

bool pov_look(PovReader *reader, PovLook *look, bool *taken)
{
    WordReader *words = &reader->words;
    *taken            = true;
    if (!pov_release(reader) || !pov_deeper(reader))
        return false;
    bool good;
    if (word_accept(words, "pigment"))
        good = block(reader, look, pigment);
    else if (word_accept(words, "finish"))
        good = block(reader, look, finish);
    else if (word_accept(words, "interior"))
        good = block(reader, look, interior);
    else if (word_accept(words, "texture") || word_accept(words, "material"))
        good = read_layer(reader, look);
    else if (word_is(words, "color_map") || word_is(words, "colour_map"))
        good = read_map(reader, pov_color, look);
    else if (word_is(words, "pigment_map") || word_is(words, "texture_map"))
        good = read_map(reader, read_pigment_entry, look);
    else
        good = true, *taken = false;
    reader->depth--;
    return good;
}

const char *pov_look_text(PovReader *reader, const PovLook *look)
{
    double color[3], through = fmin(fmax(look->filter + look->transmit, 0), 1);
    /* What is transmitted has no colour of the thing. */
    double white = through > 0 ? fmin(fmax(look->transmit, 0), 1) : 0;
    for (int i = 0; i < 3; i++) {
        color[i] = fmin(look->colored ? look->color[i] : 0.6, 1);
        color[i] += white * (1 - color[i]);
    }
    if (look->patterned)
        import_note(reader->import, reader->words.word.line,
                    "patterns of pigments are one colour, their mean");
    const char *text = import_vector_text(reader->import, color, 3);
    if (!look->finished && through == 0)
        return look->colored ? text : NULL;
    Text   name      = {.arena = reader->import->arena};
    Text  *materials = &reader->materials;
    double roughness = look->specular ? sqrt(2 / (fmax(look->size, 0) + 2))
                       : through > 0  ? 0.01
                                      : 0.6;
    text_format(&name, "look_%zu", ++reader->material_count);
    text_format(materials, "material %s { color: %s, roughness: %.3g, metallic: %s", name.bytes,
                text, fmax(roughness, 0.01),
                import_number_text(reader->import, fmin(fmax(look->metallic, 0), 1)));
    if (through > 0)
        text_format(
            materials, ", transmission: %s, ior: %s", import_number_text(reader->import, through),
            import_number_text(reader->import, look->ior > 0 ? fmin(fmax(look->ior, 1), 4) : 1));
    text_add(materials, " }\n");
    return name.bytes;
}
