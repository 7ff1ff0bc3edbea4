/*
 * strings.c: strings of POV-Ray, and functions that make them.
 */
#include <math.h>
#include <string.h>

#include "import/pov/reader.h"

static const char *const string_functions[] = {"concat", "str",    "chr", "substr",
                                               "strupr", "strlwr", "vstr"};

bool pov_string_follows(PovReader *reader)
{
    const WordReader *words = &reader->words;
    if (words->word.kind == IMPORT_WORD_STRING)
        return true;
    if (words->word.kind != IMPORT_WORD_NAME)
        return false;
    const PovCell *own = pov_find(reader, words->word.text);
    if (own && own->kind == POV_ARRAY)
        own = pov_first_element(own);
    if (own)
        return own->kind == POV_STRING;
    return word_among(words, string_functions);
}

/* Reads `str(number, least length, digits)`. */
static bool number_string(PovReader *reader, Text *text)
{
    PovValue value, length, digits;
    if (!pov_condition(reader, &value) || !pov_next_argument(reader, &length) ||
        !pov_next_argument(reader, &digits))
        return false;
    int places = (int)fmin(fmax(digits.v[0], -1), 20);
    int wide   = (int)fmin(fmax(length.v[0], -40), 40);
    if (wide < 0)
        text_format(text, "%0*.*f", -wide, places < 0 ? 6 : places, value.v[0]);
    else
        text_format(text, "%*.*f", wide, places < 0 ? 6 : places, value.v[0]);
    return true;
}

static bool string_function(PovReader *reader, const char *name, Text *text)
{
    const char *part;
    PovValue    from, count;
    if (strcmp(name, "str") == 0)
        return number_string(reader, text);
    if (strcmp(name, "chr") == 0) {
        if (!pov_condition(reader, &from))
            return false;
        text_add_bytes(text, (char[]){(char)fmin(fmax(from.v[0], 1), 126)}, 1);
        return true;
    }
    if (strcmp(name, "vstr") == 0)
        return word_refuse(&reader->words, "a string that is not made by `vstr`");
    do {
        if (!pov_string(reader, &part))
            return false;
        if (strcmp(name, "substr") != 0)
            text_add(text, part);
    } while (strcmp(name, "concat") == 0 && word_accept(&reader->words, ","));
    if (strcmp(name, "substr") != 0)
        return true;
    if (!pov_next_argument(reader, &from) || !pov_next_argument(reader, &count))
        return false;
    size_t length = strlen(part), first = (size_t)fmin(fmax(from.v[0] - 1, 0), (double)length);
    text_add_bytes(text, part + first, (size_t)fmin(fmax(count.v[0], 0), (double)(length - first)));
    return true;
}

bool pov_string(PovReader *reader, const char **string)
{
    WordReader *words = &reader->words;
    Text        text  = {.arena = reader->import->arena};
    if (!pov_release(reader))
        return false;
    *string = words->word.text;
    if (words->word.kind == IMPORT_WORD_STRING) {
        words_advance(words);
        return true;
    }
    PovCell *own = pov_take(reader, POV_STRING);
    if (own) {
        *string = own->string;
        return true;
    }
    if (!pov_string_follows(reader))
        return word_refuse(words, "a string");
    const char *name = words->word.text;
    words_advance(words);
    if (!word_expect(words, "(") || !string_function(reader, name, &text) ||
        !word_expect(words, ")"))
        return false;
    *string = text.length > 0 ? text.bytes : "";
    return true;
}
