/*
 * look_text.c: what a look of POV-Ray is as a material of the scene.
 */
#include <math.h>
#include <string.h>

#include "import/pov/reader.h"

/* Returns four digits of a colour, which the curve of a screen hides the rest of. */
static const char *color_text(PovReader *reader, const double color[3])
{
    double rounded[3];
    for (int i = 0; i < 3; i++)
        rounded[i] = round(1e4 * color[i]) / 1e4;
    return import_vector_text(reader->import, rounded, 3);
}

/* Finds what a material mirrors of each channel; *part: of what it mirrors and scatters, on
   average.  The colour of a metal is that of both: the more it scatters, the more of that hue its
   mirror gets. */
static void mirrored(PovReader *reader, const PovLook *look, double light[3], double *part)
{
    double sum = 0, all = 0, body[3], share;
    for (int i = 0; i < 3; i++) {
        double pigment = look->colored ? look->color[i] : 0.6;
        double mirror  = fmax(look->finish.reflection[i], 0);
        light[i]       = pov_light_of(reader, mirror * (look->finish.mirrors_metal ? pigment : 1));
        body[i]        = pov_light_of(reader, look->finish.diffuse * pigment);
        sum += light[i];
        all += light[i] + body[i];
    }
    *part = share = sum > 0 ? sum / all : 0;
    for (int i = 0; i < 3 && all > sum; i++)
        light[i] = share * light[i] + (1 - share) * sum * body[i] / (all - sum);
}

/* Adds `color` and `emission`, as POV-Ray has them: what is transmitted has no colour of the thing,
   what is filtered has, and neither is scattered.  A metal mirrors in its colour, which a part of
   it scatters: so the colour is the sum of both. */
static void add_colors(PovReader *reader, const PovLook *look, double through,
                       const double mirror[3], Text *text)
{
    const PovFinish *finish = &look->finish;
    double           color[3], emission[3], most = 0;
    double           filter = fmax(look->filter, 0), transmit = fmax(look->transmit, 0);
    for (int i = 0; i < 3; i++) {
        double pigment = look->colored ? look->color[i] : 0.6;
        double tint    = through > 0 ? (filter * pigment + transmit) / (filter + transmit) : 0;
        double body    = pov_light_of(reader, finish->diffuse * pigment);
        color[i] = fmin((1 - through) * body + through * pov_light_of(reader, tint) + mirror[i], 1);
        emission[i] = (1 - through) *
                      pov_light_of(reader, pigment * (finish->ambient[i] * reader->ambient[i] +
                                                      finish->emission[i]));
        most = fmax(most, emission[i]);
    }
    text_format(text, "color: %s", color_text(reader, color));
    if (most >= 5e-5)
        text_format(text, ", emission: %s", color_text(reader, emission));
}

/* Returns the name of a material with this text in its braces. */
static const char *material_name(PovReader *reader, const char *inside)
{
    Text   name   = {.arena = reader->import->arena};
    size_t number = 0;
    while (number < reader->material_texts.count &&
           strcmp(reader->material_texts.items[number], inside) != 0)
        number++;
    text_format(&name, "look_%zu", number + 1);
    if (number < reader->material_texts.count)
        return name.bytes;
    array_push(reader->import->arena, &reader->material_texts, inside);
    text_format(&reader->materials, "material %s { %s }\n", name.bytes, inside);
    return name.bytes;
}

const char *pov_look_text(PovReader *reader, const PovLook *look)
{
    const PovFinish *finish  = &look->finish;
    double           through = fmin(fmax(look->filter + look->transmit, 0), 1);
    Text             inside  = {.arena = reader->import->arena};
    if (!look->said)
        return NULL;
    if (look->patterned)
        import_note(reader->import, reader->words.word.line,
                    "patterns of pigments are one colour, their mean");
    if (!look->colored && !look->patterned)
        import_note(reader->import, reader->words.word.line,
                    "what has no pigment is grey, not black");
    double mirror[3] = {0}, part = 0;
    mirrored(reader, look, mirror, &part);
    if (part > 0 && through > 0) {
        import_note(reader->import, reader->words.word.line,
                    "`reflection` of what is transparent is that of its index of refraction");
        part = mirror[0] = mirror[1] = mirror[2] = 0;
    }
    add_colors(reader, look, through, mirror, &inside);
    if (part > 0) {
        import_note(reader->import, reader->words.word.line,
                    "`reflection` has the colour of the thing, and highlights as sharp as itself");
        text_format(&inside, ", specular: 0, roughness: 0.02, metallic: %.4g", part);
        return material_name(reader, inside.bytes);
    }
    if (finish->specular)
        text_format(&inside, ", roughness: %.3g",
                    fmax(pow(2 / (fmax(finish->exponent, 0) + 2), 0.25), 0.01));
    else if (through > 0)
        text_add(&inside, ", roughness: 0.01");
    else if (finish->metallic <= 0)
        text_add(&inside, ", specular: 0");
    if (finish->metallic > 0)
        text_format(&inside, ", metallic: %s",
                    import_number_text(reader->import, fmin(finish->metallic, 1)));
    if (through > 0)
        text_format(
            &inside, ", transmission: %s, ior: %s", import_number_text(reader->import, through),
            import_number_text(reader->import, look->ior > 0 ? fmin(fmax(look->ior, 1), 4) : 1));
    return material_name(reader, inside.bytes);
}
