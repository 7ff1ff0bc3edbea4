/*
 * import_pov_looks.c: colours and highlights of POV-Ray.  Patterns, bumps and what is inside of
 * things are left out with a note: they change no shape.
 */
#include <math.h>
#include <string.h>

#include "cli/import_pov_reader.h"

/* Takes the name of a look that was declared. */
static bool take_declared(PovReader *reader, PovLook *look)
{
    const PovName *own = reader->words.word.kind == IMPORT_WORD_NAME
                             ? pov_find(reader, reader->words.word.text)
                             : NULL;
    if (!own || own->kind != POV_LOOK)
        return false;
    if (own->look.colored) {
        memcpy(look->color, own->look.color, sizeof look->color);
        look->colored = true;
    }
    if (own->look.finished) {
        look->finished = true;
        look->specular = own->look.specular;
        look->size     = own->look.size;
        look->metallic = own->look.metallic;
    }
    words_advance(&reader->words);
    return true;
}

static bool pigment(PovReader *reader, PovLook *look)
{
    Place ignored = place_identity();
    while (!word_is(&reader->words, "}")) {
        bool taken = false;
        if (take_declared(reader, look))
            continue;
        if (!pov_place(reader, &ignored, &taken))
            return false;
        if (taken)
            continue;
        if (pov_color_follows(reader)) {
            if (!pov_color(reader, look->color))
                return false;
            look->colored = true;
        } else if (!pov_leave_out(reader, "of a pigment is")) {
            return false;
        }
        word_accept(&reader->words, ",");
    }
    return true;
}

/* An optional number behind a word. */
static bool amount(PovReader *reader, double otherwise, double *number)
{
    *number = otherwise;
    words_advance(&reader->words);
    return !pov_value_follows(reader) || pov_number(reader, number);
}

/* How wide a highlight is: phong_size, or 1 / roughness, are exponents of a cosine. */
static bool finish(PovReader *reader, PovLook *look)
{
    WordReader *words = &reader->words;
    look->finished    = true;
    while (!word_is(words, "}")) {
        double number;
        bool   phong = word_is(words, "phong"), specular = word_is(words, "specular");
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
        bool taken = take_declared(reader, look);
        if (!taken &&
            (!pov_look(reader, look, &taken) || (!taken && !pov_place(reader, &ignored, &taken))))
            return false;
        if (!taken && !pov_leave_out(reader, "of a texture is"))
            return false;
    }
    return true;
}

bool pov_look(PovReader *reader, PovLook *look, bool *taken)
{
    WordReader *words = &reader->words;
    *taken            = true;
    if (!pov_deeper(reader))
        return false;
    bool good = word_accept(words, "pigment")  ? block(reader, look, pigment)
                : word_accept(words, "finish") ? block(reader, look, finish)
                : word_accept(words, "texture") || word_accept(words, "material")
                    ? block(reader, look, texture)
                    : (*taken = false, true);
    reader->depth--;
    return good;
}

const char *pov_look_text(PovReader *reader, const PovLook *look)
{
    double color[3];
    for (int i = 0; i < 3; i++)
        color[i] = fmin(look->colored ? look->color[i] : 0.6, 1);
    const char *text = import_vector_text(reader->import, color, 3);
    if (!look->finished)
        return look->colored ? text : NULL;
    Text   name      = {.arena = reader->import->arena};
    double roughness = look->specular ? sqrt(2 / (fmax(look->size, 0) + 2)) : 0.6;
    text_format(&name, "look_%zu", ++reader->material_count);
    text_format(&reader->materials, "material %s { color: %s, roughness: %.3g, metallic: %s }\n",
                name.bytes, text, fmax(roughness, 0.01),
                import_number_text(reader->import, fmin(fmax(look->metallic, 0), 1)));
    return name.bytes;
}
