/*
 * words.c: what blocks of POV-Ray have in common: nesting, places,
 * and words that are left out.
 */
#include <math.h>

#include "import/pov/reader.h"

static const double DEGREE = 3.14159265358979323846 / 180;

bool pov_deeper(PovReader *reader)
{
    return ++reader->depth <= IMPORT_MAX_DEPTH ||
           import_refuse(reader->import, reader->words.word.line, "more than %d deep",
                         IMPORT_MAX_DEPTH);
}

bool pov_skip_block(PovReader *reader)
{
    WordReader *words = &reader->words;
    if (!word_expect(words, "{"))
        return false;
    for (int open = 1; open > 0; words_advance(words)) {
        if (words->word.kind == IMPORT_WORD_END)
            return word_refuse(words, "`}`");
        open += word_is(words, "{") ? 1 : word_is(words, "}") ? -1 : 0;
    }
    return true;
}

bool pov_leave_out(PovReader *reader, const char *what)
{
    WordReader *words = &reader->words;
    if (!pov_release(reader))
        return false;
    if (words->word.kind == IMPORT_WORD_STRING || word_is(words, ",") || word_is(words, ";")) {
        words_advance(words);
        return true;
    }
    if (words->word.kind != IMPORT_WORD_NAME && !pov_value_follows(reader))
        return word_refuse(words, "a word or `}`");
    if (words->word.kind != IMPORT_WORD_NAME || pov_value_follows(reader)) {
        PovValue value;
        return pov_value(reader, &value);
    }
    if (what)
        import_note(reader->import, words->word.line, "`%.40s` %s left out", words->word.text,
                    what);
    words_advance(words);
    if (word_is(words, "{"))
        return pov_skip_block(reader);
    while (pov_color_follows(reader)) {
        double color[5];
        if (!pov_color(reader, color))
            return false;
        word_accept(words, ",");
    }
    return true;
}

void pov_point(const double q[3], double p[3])
{
    p[0] = q[0];
    p[1] = q[1];
    p[2] = -q[2];
}

/* Rotates about x, then about y, then about z. */
static Transform rotate_by_angles(const double angles[3])
{
    Transform transform = transform_identity();
    for (int axis = 0; axis < 3; axis++) {
        Transform rotation = transform_rotate(axis, angles[axis] * DEGREE);
        transform          = transform_chain(&transform, &rotation);
    }
    return transform;
}

/* Reads twelve numbers: where x, y, z and the origin go. */
static bool read_matrix(PovReader *reader, Transform *transform)
{
    if (!word_expect(&reader->words, "<"))
        return false;
    for (int i = 0; i < 12; i++) {
        double number;
        if (!pov_number(reader, &number) || !word_expect(&reader->words, i < 11 ? "," : ">"))
            return false;
        if (i >= 9)
            transform->shift[i - 9] = number;
        else
            transform->rows[i % 3][i / 3] = number;
    }
    return true;
}

/* Reads `transform { ... }`, or the name of one. */
static bool read_transform(PovReader *reader, Transform *transform)
{
    PovCell  *own     = pov_take(reader, POV_PLACE);
    Transform next    = transform_identity();
    bool      inverts = false;
    if (own) {
        *transform = transform_chain(transform, &own->transform);
        return true;
    }
    if (!word_expect(&reader->words, "{"))
        return false;
    while (!word_is(&reader->words, "}")) {
        bool taken = false;
        own        = pov_take(reader, POV_PLACE);
        if (own)
            next = transform_chain(&next, &own->transform);
        else if (word_accept(&reader->words, "inverse"))
            inverts = true;
        else if (!pov_transform(reader, &next, &taken))
            return false;
        else if (!taken)
            return word_refuse(&reader->words, "a transformation, or `}`");
    }
    if (inverts && !transform_invert(&next))
        return import_refuse(reader->import, reader->words.word.line, "this has no inverse");
    *transform = transform_chain(transform, &next);
    return word_expect(&reader->words, "}");
}

bool pov_transform(PovReader *reader, Transform *transform, bool *taken)
{
    WordReader *words = &reader->words;
    Transform   next  = transform_identity();
    double      v[3]  = {0, 0, 0};
    if (!pov_release(reader))
        return false;
    const bool     translate = word_is(words, "translate"), rotate = word_is(words, "rotate");
    const bool     scale = word_is(words, "scale"), matrix = word_is(words, "matrix");
    const bool     declared = word_is(words, "transform");
    const unsigned line     = words->word.line;
    *taken                  = translate || rotate || scale || matrix || declared;
    if (!*taken)
        return true;
    words_advance(words);
    if (declared)
        return read_transform(reader, transform);
    if (matrix ? !read_matrix(reader, &next) : !pov_vector(reader, v))
        return false;
    if (scale && (v[0] == 0 || v[1] == 0 || v[2] == 0)) {
        import_note(reader->import, line, "a scale of 0 counts as 1, as in POV-Ray");
        for (int i = 0; i < 3; i++)
            v[i] = v[i] == 0 ? 1 : v[i];
    }
    if (!matrix)
        next = translate ? transform_move(v) : rotate ? rotate_by_angles(v) : transform_scale(v);
    *transform = transform_chain(transform, &next);
    return true;
}
