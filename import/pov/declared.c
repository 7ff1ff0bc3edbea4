/*
 * declared.c: what names are declared for: values, strings, arrays,
 * objects, looks, places, cameras, functions, and what changes no shape.
 */
#include <math.h>
#include <string.h>

#include "import/pov/reader.h"

enum { MAX_ELEMENTS = 1000000 };

/* Blocks that are known by name and change no shape here. */
static const char *const others[] = {"normal",      "interior",  "media",     "fog",
                                     "rainbow",     "density",   "slope_map", "normal_map",
                                     "density_map", "photons",   "radiosity", "global_settings",
                                     "spline",      "subsurface"};

/* ---- arrays ---- */

static bool read_sizes(PovReader *reader, PovCell *array)
{
    int count = 1;
    while (word_accept(&reader->words, "[")) {
        double size;
        if (array->dimensions == POV_MAX_DIMENSIONS || !pov_number(reader, &size) ||
            !word_expect(&reader->words, "]"))
            return word_refuse(&reader->words, "at most five sizes");
        if (!(size >= 1 && size * count <= MAX_ELEMENTS))
            return import_refuse(reader->import, reader->words.word.line,
                                 "an array has from 1 to %d elements", MAX_ELEMENTS);
        array->sizes[array->dimensions++] = (int)size;
        count *= (int)size;
    }
    array->items   = arena_new_array(reader->import->arena, PovCell *, (size_t)count);
    PovCell *cells = arena_new_array(reader->import->arena, PovCell, (size_t)count);
    for (int i = 0; i < count; i++) {
        cells[i]        = (PovCell){0};
        array->items[i] = &cells[i];
    }
    return true;
}

/* Reads `{ 1, 2, {3, 4} }`: inner braces are those of further sizes. */
static bool read_elements(PovReader *reader, PovCell *array, int *next, int count)
{
    if (!pov_deeper(reader) || !word_expect(&reader->words, "{"))
        return false;
    while (!word_is(&reader->words, "}")) {
        if (word_is(&reader->words, "{")) {
            if (!read_elements(reader, array, next, count))
                return false;
        } else if (*next >= count) {
            return word_refuse(&reader->words, "`}`: the array has no more elements");
        } else if (!pov_rvalue(reader, array->items[(*next)++])) {
            return false;
        }
        word_accept(&reader->words, ",");
    }
    reader->depth--;
    return word_expect(&reader->words, "}");
}

static bool read_array(PovReader *reader, PovCell *array)
{
    int next = 0, count = 1;
    words_advance(&reader->words);
    *array = (PovCell){.kind = POV_ARRAY};
    if (word_is(&reader->words, "{")) /* its size is that of the list */
        return import_refuse(reader->import, reader->words.word.line, "an array needs its size");
    if (!read_sizes(reader, array))
        return false;
    for (int i = 0; i < array->dimensions; i++)
        count *= array->sizes[i];
    return !word_is(&reader->words, "{") || read_elements(reader, array, &next, count);
}

PovCell *pov_element(PovReader *reader, PovCell *array)
{
    while (word_is(&reader->words, "[")) {
        int place = 0;
        if (array->kind != POV_ARRAY) {
            word_refuse(&reader->words, "no index: this is no array");
            return NULL;
        }
        for (int i = 0; i < array->dimensions; i++) {
            double index;
            if (!word_expect(&reader->words, "[") || !pov_number(reader, &index) ||
                !word_expect(&reader->words, "]"))
                return NULL;
            if (!(index > -1 && index < array->sizes[i])) {
                import_refuse(reader->import, reader->words.word.line,
                              "the index %g is not in the array", index);
                return NULL;
            }
            place = place * array->sizes[i] + (int)index;
        }
        array = array->items[place];
    }
    return array;
}

PovCell *pov_take(PovReader *reader, PovKind kind)
{
    PovCell       *own     = pov_find_next(reader);
    const PovCell *element = own;
    if (own && own->kind == POV_REFUSED) {
        import_refuse(reader->import, reader->words.word.line, "of `%.40s`: %s",
                      reader->words.word.text, own->string);
        return NULL;
    }
    if (element && element->kind == POV_ARRAY && kind != POV_ARRAY)
        element = pov_first_element(element);
    if (!element || element->kind != kind)
        return NULL;
    unsigned line = reader->words.word.line;
    words_advance(&reader->words);
    own = pov_element(reader, own);
    if (!own || own->kind == kind)
        return own;
    import_refuse(reader->import, line,
                  own->kind == POV_NOTHING
                      ? "this element of the array has no value yet"
                      : "this is another kind of value than the array's first");
    return NULL;
}

/* ---- functions ---- */

/* Reads `function(u, v) { formula }`; without parameters it is of x, y and z. */
static bool read_function(PovReader *reader, PovCell *cell)
{
    WordReader *words    = &reader->words;
    PovMacro   *function = arena_new(reader->import->arena, PovMacro);
    *function            = (PovMacro){.fixed_line = 0};
    words_advance(words);
    if (word_accept(words, "(")) {
        for (; !word_is(words, ")"); words_advance(words)) {
            if (words->word.kind == IMPORT_WORD_NAME)
                array_push(reader->import->arena, &function->parameters, words->word.text);
            else if (!word_is(words, ","))
                return word_refuse(words, "the name of a parameter");
        }
        words_advance(words);
    } else {
        for (int i = 0; i < 3; i++)
            array_push(reader->import->arena, &function->parameters,
                       ((const char *[]){"x", "y", "z"})[i]);
    }
    if (!word_is(words, "{"))
        return word_refuse(words, "`{`");
    function->at   = words->at;
    function->line = words->line;
    *cell          = (PovCell){.kind = POV_FUNCTION, .macro = function};
    return pov_skip_block(reader);
}

/* ---- all of it ---- */

static bool read_transform(PovReader *reader, PovCell *cell)
{
    bool taken = false;
    *cell      = (PovCell){.kind = POV_PLACE, .transform = transform_identity()};
    return pov_transform(reader, &cell->transform, &taken);
}

static bool read_other(PovReader *reader, PovCell *cell)
{
    *cell = (PovCell){.kind = POV_OTHER};
    words_advance(&reader->words);
    if (word_is(&reader->words, "{"))
        return pov_skip_block(reader);
    return true;
}

static bool read_view(PovReader *reader, PovCell *cell)
{
    PovView *view = arena_new(reader->import->arena, PovView);
    *cell         = (PovCell){.kind = POV_CAMERA, .view = view};
    return pov_camera(reader, view);
}

static bool read_sky(PovReader *reader, PovCell *cell)
{
    *cell = (PovCell){.kind = POV_SKY};
    return pov_sky_look(reader, &cell->look);
}

static bool read_light(PovReader *reader, PovCell *cell)
{
    PovLight *light = arena_new(reader->import->arena, PovLight);
    *cell           = (PovCell){.kind = POV_LIGHT, .light = light};
    return pov_light(reader, light);
}

static bool read_value(PovReader *reader, PovCell *cell)
{
    *cell = (PovCell){.kind = POV_VALUE};
    if (pov_value_follows(reader))
        return pov_value(reader, &cell->value);
    cell->value.count = 5;
    return pov_color(reader, cell->value.v);
}

/* Copies a declared name, and refuses one of something else than a value. */
static bool copy_declared(PovReader *reader, PovCell *cell)
{
    PovCell *own = pov_find_next(reader);
    if (!own || own->kind == POV_VALUE || own->kind == POV_FUNCTION || own->kind == POV_NOTHING)
        return false;
    words_advance(&reader->words);
    own = pov_element(reader, own);
    if (own)
        *cell = *own;
    return own != NULL;
}

/* Tells whether an array without an index follows. */
static bool is_whole_array(PovReader *reader)
{
    const char    *at  = reader->words.at;
    const PovCell *own = pov_find_next(reader);
    return own && own->kind == POV_ARRAY && at[strspn(at, " \t\r\n")] != '[';
}

bool pov_rvalue(PovReader *reader, PovCell *cell)
{
    WordReader *words = &reader->words;
    bool        look  = false;
    if (!pov_release(reader))
        return false;
    if (is_whole_array(reader))
        return copy_declared(reader, cell);
    if (pov_string_follows(reader)) {
        *cell = (PovCell){.kind = POV_STRING};
        return pov_string(reader, &cell->string);
    }
    bool value = pov_value_follows(reader);
    if (!value && copy_declared(reader, cell))
        return true;
    if (reader->import->refusal.length > 0)
        return false;
    if (value || pov_color_follows(reader))
        return read_value(reader, cell);
    *cell = (PovCell){.kind = POV_LOOK, .look = reader->usual};
    if (!word_is(words, "texture") && !word_is(words, "material"))
        cell->look.colored = cell->look.finished = false; /* of a part of one */
    if (!pov_look(reader, &cell->look, &look))
        return false;
    if (look) {
        while (word_is(words, "texture")) /* layers */
            if (!pov_look(reader, &cell->look, &look))
                return false;
        return true;
    }
    if (pov_object_follows(reader)) {
        *cell = (PovCell){.kind = POV_OBJECT};
        return pov_object(reader, &cell->part);
    }
    if (word_is(words, "array"))
        return read_array(reader, cell);
    if (word_is(words, "function"))
        return read_function(reader, cell);
    if (word_is(words, "transform"))
        return read_transform(reader, cell);
    if (word_is(words, "camera"))
        return read_view(reader, cell);
    if (word_is(words, "light_source"))
        return read_light(reader, cell);
    if (word_is(words, "sky_sphere"))
        return read_sky(reader, cell);
    if (word_among(words, others))
        return read_other(reader, cell);
    return import_refuse(reader->import, words->word.line,
                         "`%.40s` is not translated: a name is declared"
                         " for a value, an object or a look",
                         words->word.text);
}

bool pov_argument(PovReader *reader, PovCell **cell)
{
    WordReader *words = &reader->words;
    PovCell    *own   = pov_find_next(reader);
    const char *at    = words->at + strspn(words->at, " \t\r\n");
    bool        alone = *at == ',' || *at == ')';
    bool        known = own || pov_value_follows(reader) || pov_string_follows(reader) ||
                 pov_object_follows(reader) || pov_color_follows(reader);
    *cell  = arena_new(reader->import->arena, PovCell);
    **cell = (PovCell){0};
    if (words->word.kind != IMPORT_WORD_NAME || !alone || (own && own->kind == POV_MACRO) ||
        (known && !own)) {
        PovValue value;
        if (!pov_value_follows(reader) || (own && own->kind == POV_ARRAY))
            return pov_rvalue(reader, *cell);
        if (!pov_condition(reader, &value))
            return false;
        **cell = (PovCell){.kind = POV_VALUE, .value = value};
        return true;
    }
    if (own)
        *cell = own; /* else it gets its value in the macro */
    words_advance(words);
    return true;
}
