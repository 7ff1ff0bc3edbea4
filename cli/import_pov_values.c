/*
 * import_pov_values.c: numbers, vectors and colours of POV-Ray, and arithmetic with them.
 *
 *     value   = product { ("+" | "-") product }
 *     product = factor { ("*" | "/") factor }
 *     factor  = ("+" | "-") factor | atom { "." ("x" | "y" | "z" | "red" | ...) }
 *     atom    = number | "(" value ")" | "<" value { "," value } ">" | name
 *             | function "(" value { "," value } ")"
 */
#include <math.h>
#include <string.h>

#include "cli/import_pov_reader.h"
#include "compiler/base/vec.h"

static const double PI = 3.14159265358979323846;

static const struct {
    const char *name;
    PovValue    value;
} constants[] = {
    {"x", {{1, 0, 0}, 3}},
    {"y", {{0, 1, 0}, 3}},
    {"z", {{0, 0, 1}, 3}},
    {"pi", {{3.14159265358979323846}, 1}},
    {"tau", {{6.28318530717958647692}, 1}},
    {"true", {{1}, 1}},
    {"on", {{1}, 1}},
    {"yes", {{1}, 1}},
    {"false", {{0}, 1}},
    {"off", {{0}, 1}},
    {"no", {{0}, 1}},
    {"clock", {{0}, 1}},
    {"image_width", {{1280}, 1}},
    {"image_height", {{720}, 1}},
    /* of colors.inc */
    {"White", {{1, 1, 1}, 5}},
    {"Black", {{0, 0, 0}, 5}},
    {"Red", {{1, 0, 0}, 5}},
    {"Green", {{0, 1, 0}, 5}},
    {"Blue", {{0, 0, 1}, 5}},
    {"Yellow", {{1, 1, 0}, 5}},
    {"Cyan", {{0, 1, 1}, 5}},
    {"Magenta", {{1, 0, 1}, 5}},
    {"Gray", {{0.752941, 0.752941, 0.752941}, 5}},
    {"Grey", {{0.752941, 0.752941, 0.752941}, 5}},
    {"Gray50", {{0.5, 0.5, 0.5}, 5}},
    {"Orange", {{1, 0.5, 0}, 5}},
    {"Brown", {{0.647059, 0.164706, 0.164706}, 5}},
    {"Gold", {{0.8, 0.498039, 0.196078}, 5}},
    {"Silver", {{0.90, 0.91, 0.98}, 5}},
};
enum { CONSTANTS = sizeof constants / sizeof *constants };

static double to_radians(double a) { return a * PI / 180; }
static double to_degrees(double a) { return a * 180 / PI; }
static double smaller(double a, double b) { return fmin(a, b); }
static double larger(double a, double b) { return fmax(a, b); }

static const struct {
    const char *name;
    double (*one)(double a);
    double (*two)(double a, double b);
} functions[] = {
    {"sin", sin, NULL},     {"cos", cos, NULL},    {"tan", tan, NULL},
    {"asin", asin, NULL},   {"acos", acos, NULL},  {"atan", atan, NULL},
    {"sqrt", sqrt, NULL},   {"exp", exp, NULL},    {"ln", log, NULL},
    {"log", log10, NULL},   {"abs", fabs, NULL},   {"floor", floor, NULL},
    {"ceil", ceil, NULL},   {"int", trunc, NULL},  {"radians", to_radians, NULL},
    {"pow", NULL, pow},     {"mod", NULL, fmod},   {"degrees", to_degrees, NULL},
    {"min", NULL, smaller}, {"max", NULL, larger}, {"atan2", NULL, atan2},
};
enum { FUNCTIONS = sizeof functions / sizeof *functions };

static const char *const vector_functions[] = {"vlength", "vnormalize", "vdot", "vcross"};
enum { VECTOR_FUNCTIONS = 4 };

PovName *pov_find(PovReader *reader, const char *name)
{
    for (size_t i = reader->names.count; i-- > 0;)
        if (strcmp(reader->names.items[i].name, name) == 0)
            return &reader->names.items[i];
    return NULL;
}

/* From a name to its place in a table, or -1. */
static int find_constant(const char *name)
{
    for (int i = 0; i < CONSTANTS; i++)
        if (strcmp(constants[i].name, name) == 0)
            return i;
    return -1;
}

static int find_function(const char *name)
{
    for (int i = 0; i < FUNCTIONS; i++)
        if (strcmp(functions[i].name, name) == 0)
            return i;
    for (int i = 0; i < VECTOR_FUNCTIONS; i++)
        if (strcmp(vector_functions[i], name) == 0)
            return FUNCTIONS + i;
    return -1;
}

bool pov_value_follows(PovReader *reader)
{
    const WordReader *words = &reader->words;
    if (words->word.kind == IMPORT_WORD_NUMBER || word_is(words, "<") || word_is(words, "(") ||
        word_is(words, "-") || word_is(words, "+"))
        return true;
    if (words->word.kind != IMPORT_WORD_NAME)
        return false;
    const PovName *name = pov_find(reader, words->word.text);
    return (name && name->kind == POV_VALUE) || find_constant(words->word.text) >= 0 ||
           find_function(words->word.text) >= 0;
}

/* A number where a vector is wanted. */
static void promote(PovValue *value, int count)
{
    for (int i = value->count; i < count; i++)
        value->v[i] = value->count == 1 ? value->v[0] : 0;
    value->count = count > value->count ? count : value->count;
}

static bool read_list(PovReader *reader, PovValue *values, int most, int *count, const char *end)
{
    *count = 0;
    do {
        if (*count == most)
            return word_refuse(&reader->words, end);
        if (!pov_value(reader, &values[(*count)++]))
            return false;
    } while (word_accept(&reader->words, ","));
    return word_expect(&reader->words, end);
}

static PovValue vector_result(int function, PovValue *a, PovValue *b)
{
    PovValue result = {.count = 3};
    promote(a, 3);
    promote(b, 3);
    if (function == 1) {
        memcpy(result.v, a->v, sizeof a->v);
        normalize3(result.v);
    } else if (function == 3) {
        cross3(a->v, b->v, result.v);
    } else {
        result.count = 1;
        result.v[0]  = function == 0 ? length3(a->v) : dot3(a->v, b->v);
    }
    return result;
}

static bool call_function(PovReader *reader, int function, PovValue *value)
{
    PovValue arguments[2] = {{.count = 1}, {.count = 1}};
    int      count, wanted = function >= FUNCTIONS     ? 1 + (function - FUNCTIONS >= 2)
                             : functions[function].two ? 2
                                                       : 1;
    unsigned line = reader->words.word.line;
    words_advance(&reader->words);
    if (!word_expect(&reader->words, "(") || !read_list(reader, arguments, 2, &count, ")"))
        return false;
    if (count != wanted)
        return import_refuse(reader->import, line, "this function needs %d value%s, not %d", wanted,
                             wanted == 1 ? "" : "s", count);
    if (function >= FUNCTIONS)
        *value = vector_result(function - FUNCTIONS, &arguments[0], &arguments[1]);
    else
        *value = (PovValue){
            .count = 1,
            .v     = {functions[function].two
                          ? functions[function].two(arguments[0].v[0], arguments[1].v[0])
                          : functions[function].one(arguments[0].v[0])}};
    return true;
}

static bool read_name(PovReader *reader, PovValue *value)
{
    const char    *name     = reader->words.word.text;
    const PovName *own      = pov_find(reader, name);
    int            constant = find_constant(name), function = find_function(name);
    if (!own && function >= 0)
        return call_function(reader, function, value);
    if (own && own->kind == POV_VALUE)
        *value = own->value;
    else if (!own && constant >= 0)
        *value = constants[constant].value;
    else
        return word_refuse(&reader->words, "a number, a vector or a declared name");
    if (strcmp(name, "clock") == 0 && !own)
        import_note(reader->import, reader->words.word.line, "`clock` is 0");
    words_advance(&reader->words);
    return true;
}

static bool read_vector(PovReader *reader, PovValue *value)
{
    PovValue parts[5] = {{.count = 0}};
    int      count;
    words_advance(&reader->words);
    if (!read_list(reader, parts, 5, &count, ">"))
        return false;
    *value = (PovValue){.count = count};
    for (int i = 0; i < count; i++)
        value->v[i] = parts[i].v[0];
    return true;
}

static bool read_atom(PovReader *reader, PovValue *value)
{
    WordReader *words = &reader->words;
    if (words->word.kind == IMPORT_WORD_NUMBER) {
        *value = (PovValue){.v = {words->word.number}, .count = 1};
        words_advance(words);
        return true;
    }
    if (word_is(words, "<"))
        return read_vector(reader, value);
    if (word_accept(words, "("))
        return pov_value(reader, value) && word_expect(words, ")");
    if (words->word.kind == IMPORT_WORD_NAME)
        return read_name(reader, value);
    return word_refuse(words, "a number or a vector");
}

static bool read_factor(PovReader *reader, PovValue *value)
{
    static const char *const members[] = {"x", "y", "z", "red", "green", "blue"};
    WordReader              *words     = &reader->words;
    bool                     minus     = word_is(words, "-");
    if (!pov_deeper(reader))
        return false;
    bool good = minus || word_is(words, "+") ? (words_advance(words), read_factor(reader, value))
                                             : read_atom(reader, value);
    reader->depth--;
    for (int i = 0; good && minus && i < 5; i++)
        value->v[i] = -value->v[i];
    while (good && word_accept(words, ".")) {
        int member = 0;
        while (member < 6 && !word_is(words, members[member]))
            member++;
        if (member == 6)
            return word_refuse(words, "`x`, `y`, `z`, `red`, `green` or `blue`");
        words_advance(words);
        *value = (PovValue){.v = {value->v[member % 3]}, .count = 1};
    }
    return good;
}

/* Element by element. */
static bool combine(PovReader *reader, char sign, PovValue *a, PovValue *b)
{
    int count = a->count > b->count ? a->count : b->count;
    promote(a, count);
    promote(b, count);
    for (int i = 0; i < count; i++) {
        switch (sign) {
        case '+': a->v[i] += b->v[i]; break;
        case '-': a->v[i] -= b->v[i]; break;
        case '*': a->v[i] *= b->v[i]; break;
        default: a->v[i] /= b->v[i]; break;
        }
        if (!isfinite(a->v[i]))
            return import_refuse(reader->import, reader->words.word.line,
                                 "a result is not a finite number");
    }
    return true;
}

static bool read_product(PovReader *reader, PovValue *value)
{
    if (!read_factor(reader, value))
        return false;
    while (word_is(&reader->words, "*") || word_is(&reader->words, "/")) {
        char     sign = *reader->words.word.text;
        PovValue next;
        words_advance(&reader->words);
        if (!read_factor(reader, &next) || !combine(reader, sign, value, &next))
            return false;
    }
    return true;
}

bool pov_value(PovReader *reader, PovValue *value)
{
    if (!read_product(reader, value))
        return false;
    while (word_is(&reader->words, "+") || word_is(&reader->words, "-")) {
        char     sign = *reader->words.word.text;
        PovValue next;
        words_advance(&reader->words);
        if (!read_product(reader, &next) || !combine(reader, sign, value, &next))
            return false;
    }
    for (int i = 0; i < value->count; i++)
        if (!isfinite(value->v[i]))
            return import_refuse(reader->import, reader->words.word.line,
                                 "a result is not a finite number");
    return true;
}

bool pov_number(PovReader *reader, double *number)
{
    PovValue value;
    unsigned line = reader->words.word.line;
    if (!pov_value(reader, &value))
        return false;
    *number = value.v[0];
    return value.count == 1 ||
           import_refuse(reader->import, line, "a number is needed, not a vector");
}

bool pov_vector(PovReader *reader, double v[3])
{
    PovValue value;
    if (!pov_value(reader, &value))
        return false;
    promote(&value, 3);
    memcpy(v, value.v, 3 * sizeof *v);
    return true;
}

/* ---- colours ---- */

static const char *const color_words[] = {"color", "colour", "rgb",   "rgbf",  "rgbt",
                                          "rgbft", "srgb",   "srgbf", "srgbt", "srgbft"};
static const char *const channels[]    = {"red", "green", "blue", "filter", "transmit"};

bool pov_color_follows(PovReader *reader)
{
    for (size_t i = 0; i < sizeof color_words / sizeof *color_words; i++)
        if (word_is(&reader->words, color_words[i]))
            return true;
    for (size_t i = 0; i < sizeof channels / sizeof *channels; i++)
        if (word_is(&reader->words, channels[i]))
            return true;
    return pov_value_follows(reader);
}

static double linear(double s) { return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4); }

bool pov_color(PovReader *reader, double color[3])
{
    WordReader *words = &reader->words;
    PovValue    value = {.count = 0};
    bool        named = false, encoded = false;
    if (!word_accept(words, "color"))
        word_accept(words, "colour");
    for (int i = 0; i < 5; i++)
        if (word_accept(words, channels[i])) {
            double level;
            named = true;
            if (!pov_number(reader, &level))
                return false;
            value.v[i] = level;
            i          = -1; /* in any order */
        }
    for (size_t i = 2; i < sizeof color_words / sizeof *color_words && !named; i++)
        if (word_is(words, color_words[i])) {
            encoded = color_words[i][0] == 's';
            words_advance(words);
            break;
        }
    if (!named && !pov_value(reader, &value))
        return false;
    promote(&value, 3);
    if (value.count > 3 && (value.v[3] > 0 || value.v[4] > 0))
        import_note(reader->import, words->word.line, "nothing is transparent");
    for (int i = 0; i < 3; i++)
        color[i] = fmax(encoded ? linear(value.v[i]) : value.v[i], 0);
    return true;
}
