/*
 * looks.c: colours, transparency and highlights of POV-Ray.  A
 * pattern is one colour, the mean of its colours; bumps and what is inside of
 * things are left out.  None of that changes a shape.
 */
#include <math.h>
#include <string.h>

#include "import/pov/reader.h"

/* Places of a pattern's distribution, and those below which its values are. */
enum { SHARES = 17 };

static const double shares[SHARES] = {0,     0.002, 0.01,  0.03,   0.0625, 0.125, 0.25,  0.375, 0.5,
                                      0.625, 0.75,  0.875, 0.9375, 0.97,   0.99,  0.998, 1};

static const struct {
    const char *name;
    double      values[SHARES];
} distributions[] = {
#define PATTERN(name, ...) {#name, {__VA_ARGS__}},
#include "import/pov/patterns.def"
#undef PATTERN
};
enum { DISTRIBUTIONS = sizeof distributions / sizeof *distributions };

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
        look->pattern   = own->look.pattern;
        look->colored   = true;
    }
    if (own->look.finished) {
        look->finished = true;
        look->finish   = own->look.finish;
    }
    look->ior = own->look.ior > 0 ? own->look.ior : look->ior;
    return true;
}

/* ---- maps of colours ---- */

typedef bool ReadEntry(PovReader *reader, double color[5]);

static bool read_pigment_entry(PovReader *reader, double color[5])
{
    PovLook look = pov_usual_look();
    if (!pov_look_inside(reader, &look))
        return false;
    look_color(&look, color);
    return true;
}

/* Colours of a map; between two of them it is linear. */
typedef struct Knots {
    struct Knot {
        double place, color[5];
    } * items;
    size_t count, capacity;
} Knots;

/* Adds the part of a map from `from` to `to`, where a pattern has so large a share of its values. */
static void add_span(Mean *mean, const Knots *map, double from, double to, double share)
{
    for (size_t i = 0; i <= map->count; i++) {
        const struct Knot *a    = &map->items[i > 0 ? i - 1 : 0];
        const struct Knot *b    = &map->items[i < map->count ? i : i - 1];
        double             low  = i > 0 ? fmax(from, a->place) : from;
        double             high = i < map->count ? fmin(to, b->place) : to, color[5];
        if (!(high > low) && !(from == to && low == high))
            continue;
        double t = b->place > a->place ? ((low + high) / 2 - a->place) / (b->place - a->place) : 0;
        for (int k = 0; k < 5; k++)
            color[k] = a->color[k] + t * (b->color[k] - a->color[k]);
        add_color(mean, color, to > from ? share * (high - low) / (to - from) : share);
        if (from == to)
            return;
    }
}

/* Sets the mean over the values of the pattern; those of `average` are weights instead of places. */
static void set_mean_of_map(PovLook *look, const Knots *map, bool weights)
{
    Mean mean = {{0}};
    for (size_t i = 0; i < map->count && weights; i++)
        add_color(&mean, map->items[i].color, fmax(map->items[i].place, 0));
    for (int i = 0; i + 1 < SHARES && map->count > 0 && !weights && look->pattern > 0; i++) {
        const double *values = distributions[look->pattern - 1].values;
        add_span(&mean, map, values[i], values[i + 1], shares[i + 1] - shares[i]);
    }
    if (map->count > 0 && !weights && look->pattern == 0)
        add_span(&mean, map, 0, 1, 1);
    set_mean(look, &mean);
}

static void add_knot(PovReader *reader, Knots *map, double place, const double color[5])
{
    struct Knot knot = {.place = place};
    memcpy(knot.color, color, sizeof knot.color);
    array_push(reader->import->arena, map, knot);
}

/* Reads `[place entry] ...`, or in old files `[place, place color A color B]`. */
static bool read_entries(PovReader *reader, ReadEntry *read, PovLook *look)
{
    WordReader *words   = &reader->words;
    Knots       map     = {0};
    bool        average = look->averages;
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
        bool two = !word_is(words, "]");
        if (two && !read(reader, other))
            return false;
        add_knot(reader, &map, place, color);
        if (two || end > place)
            add_knot(reader, &map, end, other);
        if (!word_expect(words, "]"))
            return false;
    }
    set_mean_of_map(look, &map, average);
    return true;
}

/* Reads a block of entries, or the name of one that was declared. */
static bool read_map(PovReader *reader, ReadEntry *read, PovLook *look)
{
    words_advance(&reader->words);
    return word_expect(&reader->words, "{") &&
           (take_declared(reader, look) || read_entries(reader, read, look)) &&
           word_expect(&reader->words, "}");
}

/* Reads `checker A, B`: each has its share. */
static bool read_list_of_looks(PovReader *reader, int most, PovLook *look)
{
    Mean mean = {{0}};
    words_advance(&reader->words);
    for (int i = 0; i < most; i++) {
        double  color[5];
        PovLook part  = pov_usual_look();
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

/* The word may be the name of a pattern. */
static void name_pattern(const PovReader *reader, PovLook *look)
{
    for (int i = 0; i < DISTRIBUTIONS; i++)
        if (word_is(&reader->words, distributions[i].name))
            look->pattern = i + 1;
    look->averages = look->averages || word_is(&reader->words, "average");
}

static bool read_pigment(PovReader *reader, PovLook *look)
{
    Transform ignored = transform_identity();
    while (!word_is(&reader->words, "}") && !word_is(&reader->words, "]")) {
        bool   taken = false;
        double color[5];
        if (!pov_release(reader))
            return false;
        if (take_declared(reader, look))
            continue;
        if (!pov_transform(reader, &ignored, &taken) ||
            (!taken && !read_pattern(reader, look, &taken)))
            return false;
        if (taken)
            continue;
        if (pov_color_follows(reader)) {
            if (!pov_color(reader, color))
                return false;
            set_color(look, color);
        } else {
            look->patterned = true;
            name_pattern(reader, look);
            if (!pov_leave_out(reader, NULL))
                return false;
        }
        word_accept(&reader->words, ",");
    }
    return true;
}

/* Reads whatever stands in a texture: its parts, or those of a pigment alone. */
bool pov_look_inside(PovReader *reader, PovLook *look)
{
    bool taken = false;
    if (!pov_look(reader, look, &taken))
        return false;
    while (taken && !word_is(&reader->words, "]") && !word_is(&reader->words, "}"))
        if (!pov_look(reader, look, &taken) || (!taken && !pov_leave_out(reader, NULL)))
            return false;
    return taken || read_pigment(reader, look);
}

/* Reads an optional number behind a word. */
static bool read_amount(PovReader *reader, double otherwise, double *number)
{
    PovValue value = {.v = {otherwise}};
    words_advance(&reader->words);
    if (pov_value_follows(reader) && !pov_value(reader, &value))
        return false;
    *number = value.v[0];
    return true;
}

/* Reads a number, or a colour, for each of three channels. */
static bool read_channels(PovReader *reader, double channels[3])
{
    double color[5];
    words_advance(&reader->words);
    if (!pov_color(reader, color))
        return false;
    memcpy(channels, color, 3 * sizeof *channels);
    return true;
}

/* Reads `diffuse albedo 0.6, 0.2`: the second one is for what is lit from behind. */
static bool read_diffuse(PovReader *reader, PovFinish *finish)
{
    double behind;
    words_advance(&reader->words);
    word_accept(&reader->words, "albedo");
    if (!pov_number(reader, &finish->diffuse))
        return false;
    if (!word_accept(&reader->words, ",") || !pov_value_follows(reader))
        return true;
    import_note(reader->import, reader->words.word.line, "light from behind is left out");
    return pov_number(reader, &behind);
}

/* Reads `reflection R`, or `reflection { least, most ... }`, of which the first one is seen from
   above. */
static bool read_reflection(PovReader *reader, PovFinish *finish)
{
    unsigned line = reader->words.word.line;
    double   most[5], number;
    words_advance(&reader->words);
    if (!word_is(&reader->words, "{")) {
        if (!pov_color(reader, most))
            return false;
        memcpy(finish->reflection, most, sizeof finish->reflection);
        return true;
    }
    words_advance(&reader->words);
    if (!pov_color(reader, most))
        return false;
    memcpy(finish->reflection, most, sizeof finish->reflection);
    if (word_accept(&reader->words, ",")) {
        import_note(reader->import, line, "`reflection` is the same from all sides, as from above");
        if (!pov_color(reader, most))
            return false;
    }
    while (!word_is(&reader->words, "}")) {
        if (!pov_release(reader))
            return false;
        if (word_is(&reader->words, "metallic")) {
            if (!read_amount(reader, 1, &number))
                return false;
            finish->mirrors_metal = number > 0;
        } else if (!pov_leave_out(reader, "of a reflection is")) {
            return false;
        }
    }
    words_advance(&reader->words);
    return true;
}

/* Reads what a finish says next.  Of a highlight this is how narrow it is: a cosine with phong_size for its exponent,
   between the mirrored ray and the light, is about one with four times that between the normal and their middle;
   1 / roughness is such an exponent. */
static bool read_finish_word(PovReader *reader, PovLook *look)
{
    WordReader *words  = &reader->words;
    PovFinish  *finish = &look->finish;
    bool        phong = word_is(words, "phong"), specular = word_is(words, "specular");
    double      number;
    if (phong || specular) {
        words_advance(words);
        word_accept(words, "albedo");
        if (!pov_number(reader, &number))
            return false;
        finish->specular = finish->specular || number > 0;
        if (finish->exponent == 0)
            finish->exponent = phong ? 160 : 20;
        return true;
    }
    if (word_is(words, "phong_size")) {
        if (!read_amount(reader, 40, &number))
            return false;
        finish->exponent = 4 * number;
        return true;
    }
    if (word_is(words, "roughness")) {
        if (!read_amount(reader, 0.05, &number))
            return false;
        finish->exponent = number > 0 ? 1 / number : 1e6;
        return true;
    }
    if (word_is(words, "metallic"))
        return read_amount(reader, 1, &finish->metallic);
    if (word_is(words, "diffuse"))
        return read_diffuse(reader, finish);
    if (word_is(words, "ambient"))
        return read_channels(reader, finish->ambient);
    if (word_is(words, "emission"))
        return read_channels(reader, finish->emission);
    if (word_is(words, "reflection"))
        return read_reflection(reader, finish);
    return pov_leave_out(reader, "of a finish is");
}

static bool read_finish(PovReader *reader, PovLook *look)
{
    look->finished = true;
    while (!word_is(&reader->words, "}")) {
        if (!pov_release(reader) ||
            (!take_declared(reader, look) && !read_finish_word(reader, look)))
            return false;
        word_accept(&reader->words, ",");
    }
    return true;
}

/* Reads what is inside of a thing: its index of refraction alone shows. */
static bool read_interior(PovReader *reader, PovLook *look)
{
    while (!word_is(&reader->words, "}")) {
        if (!pov_release(reader))
            return false;
        if (word_is(&reader->words, "ior")) {
            if (!read_amount(reader, 1, &look->ior))
                return false;
        } else if (!take_declared(reader, look) && !pov_leave_out(reader, NULL)) {
            return false;
        }
    }
    return true;
}

static bool read_block(PovReader *reader, PovLook *look,
                       bool (*inside)(PovReader *reader, PovLook *look))
{
    return word_expect(&reader->words, "{") && inside(reader, look) &&
           word_expect(&reader->words, "}");
}

static bool read_texture(PovReader *reader, PovLook *look)
{
    Transform ignored = transform_identity();
    while (!word_is(&reader->words, "}")) {
        if (!pov_release(reader))
            return false;
        bool taken = take_declared(reader, look);
        if (!taken && (!pov_look(reader, look, &taken) ||
                       (!taken && !pov_transform(reader, &ignored, &taken)) ||
                       (!taken && !read_pattern(reader, look, &taken))))
            return false;
        if (!taken && !pov_leave_out(reader, NULL))
            return false;
        word_accept(&reader->words, ",");
    }
    return true;
}

void pov_add_layer(PovLook *below, const PovLook *layer)
{
    double through = fmin(fmax(layer->filter + layer->transmit, 0), 1);
    for (int i = 0; i < 3; i++)
        below->color[i] = (1 - through) * layer->color[i] +
                          through * (below->colored ? below->color[i] : 0);
    below->colored = true;
}

/* A texture lies on those before it: they show as far as light goes through. */
static bool read_layer(PovReader *reader, PovLook *look)
{
    PovLook layer = *look, below = *look;
    if (below.textured) {
        layer.colored = false;
        layer.filter = layer.transmit = 0;
        layer.finish                  = reader->usual.finish;
    }
    layer.textured = false;
    if (!read_block(reader, &layer, read_texture))
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
        good = read_block(reader, look, read_pigment);
    else if (word_accept(words, "finish"))
        good = read_block(reader, look, read_finish);
    else if (word_accept(words, "interior"))
        good = read_block(reader, look, read_interior);
    else if (word_accept(words, "texture") || word_accept(words, "material"))
        good = read_layer(reader, look);
    else if (word_is(words, "color_map") || word_is(words, "colour_map"))
        good = read_map(reader, pov_color, look);
    else if (word_is(words, "pigment_map") || word_is(words, "texture_map"))
        good = read_map(reader, read_pigment_entry, look);
    else
        good = true, *taken = false;
    look->said = look->said || *taken;
    reader->depth--;
    return good;
}

PovLook pov_usual_look(void)
{
    return (PovLook){.finish = {.diffuse = 0.6, .ambient = {0.1, 0.1, 0.1}}};
}
