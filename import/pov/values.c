/*
 * values.c: numbers and vectors of POV-Ray, and arithmetic with them.
 *
 *     condition = either [ "?" condition ":" condition ]; either joins comparisons by | and &
 *     value     = product { ("+" | "-") product }
 *     product   = factor { ("*" | "/") factor }
 *     factor    = ("+" | "-" | "!") factor | atom { "." ("x" | "y" | "z" | "red" | ...) }
 *     atom      = number | "(" condition ")" | "<" value { "," value } ">" | name
 *               | function "(" value { "," value } ")"
 */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "import/pov/reader.h"
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
    {"t", {{0, 0, 0, 1}, 4}},
    {"u", {{1, 0}, 2}},
    {"v", {{0, 1}, 2}},
    {"version", {{3.7}, 1}},
    {"final_frame", {{0}, 1}},
    {"frame_number", {{0}, 1}},
    {"initial_frame", {{0}, 1}},
    {"final_clock", {{0}, 1}},
    {"initial_clock", {{0}, 1}},
    {"clock_delta", {{0}, 1}},
    {"clock_on", {{0}, 1}},
    {"input_file_name", {{0}, 1}},
/* The names of colors.inc, for where it is not installed. */
#define COLOR(name, r, g, b, filter) {#name, {{r, g, b, filter, 0}, 5}},
#include "import/pov/colors.def"
};
enum { CONSTANTS = sizeof constants / sizeof *constants };

static double to_radians(double a) { return a * PI / 180; }
static double to_degrees(double a) { return a * 180 / PI; }
static double asin_of(double a) { return asin(fmin(fmax(a, -1), 1)); }
static double acos_of(double a) { return acos(fmin(fmax(a, -1), 1)); }
static double whole_quotient(double a, double b) { return trunc(a / b); }
static double smaller(double a, double b) { return fmin(a, b); }
static double larger(double a, double b) { return fmax(a, b); }

static const struct {
    const char *name;
    double (*one)(double a);
    double (*two)(double a, double b);
} functions[] = {
    {"sin", sin, NULL},
    {"cos", cos, NULL},
    {"tan", tan, NULL},
    {"asin", asin_of, NULL},
    {"acos", acos_of, NULL},
    {"atan", atan, NULL},
    {"sqrt", sqrt, NULL},
    {"exp", exp, NULL},
    {"ln", log, NULL},
    {"log", log10, NULL},
    {"abs", fabs, NULL},
    {"floor", floor, NULL},
    {"ceil", ceil, NULL},
    {"int", trunc, NULL},
    {"radians", to_radians, NULL},
    {"pow", NULL, pow},
    {"mod", NULL, fmod},
    {"degrees", to_degrees, NULL},
    {"min", NULL, smaller},
    {"max", NULL, larger},
    {"atan2", NULL, atan2},
    {"sinh", sinh, NULL},
    {"cosh", cosh, NULL},
    {"tanh", tanh, NULL},
    {"asinh", asinh, NULL},
    {"acosh", acosh, NULL},
    {"atanh", atanh, NULL},
    {"div", NULL, whole_quotient},
};
enum { FUNCTIONS = sizeof functions / sizeof *functions };

static const char *const vector_functions[] = {"vlength", "vnormalize", "vdot", "vcross"};
enum { VECTOR_FUNCTIONS = sizeof vector_functions / sizeof *vector_functions };

/* Returns the index of a name in its table, or -1. */
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

const PovCell *pov_first_element(const PovCell *array)
{
    int count = 1;
    for (int i = 0; i < array->dimensions; i++)
        count *= array->sizes[i];
    for (int i = 0; i < count; i++)
        if (array->items[i]->kind != POV_NOTHING)
            return array->items[i]->kind == POV_ARRAY ? pov_first_element(array->items[i])
                                                      : array->items[i];
    return NULL;
}

/* The functions that need more than numbers and vectors. */
static const char *const special[] = {
    "vrotate", "seed",   "rand",           "strlen",     "asc",         "val",
    "strcmp",  "select", "dimension_size", "dimensions", "vaxis_rotate"};
enum { SPECIAL = sizeof special / sizeof *special };

static int find_special(const char *name)
{
    for (int i = 0; i < SPECIAL; i++)
        if (strcmp(special[i], name) == 0)
            return i;
    return -1;
}

/* A directive behind a value that is being declared waits until it is. */
static bool is_held_back(const PovReader *reader) { return reader->held_at == reader->open; }

bool pov_value_follows(PovReader *reader)
{
    const WordReader *words = &reader->words;
    if (words->word.kind == IMPORT_WORD_HELD && !is_held_back(reader))
        pov_release(reader);
    if (words->word.kind == IMPORT_WORD_NUMBER || word_is(words, "!") || word_is(words, "<") ||
        word_is(words, "(") || word_is(words, "-") || word_is(words, "+"))
        return true;
    if (words->word.kind != IMPORT_WORD_NAME)
        return false;
    const PovCell *own = pov_find(reader, words->word.text);
    if (own && own->kind == POV_ARRAY)
        own = pov_first_element(own);
    if (own)
        return own->kind == POV_VALUE || own->kind == POV_FUNCTION || own->kind == POV_NOTHING;
    return find_constant(words->word.text) >= 0 || find_function(words->word.text) >= 0 ||
           find_special(words->word.text) >= 0;
}

/* Makes a vector of a number where one is wanted. */
void pov_promote(PovValue *value, int count)
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
        if (!(end[0] == ')' ? pov_condition : pov_value)(reader, &values[(*count)++]))
            return false;
    } while (word_accept(&reader->words, ",") ||
             (!word_is(&reader->words, end) && pov_value_follows(reader)));
    return word_expect(&reader->words, end);
}

static PovValue vector_result(int function, PovValue *a, PovValue *b)
{
    PovValue result = {.count = 3};
    pov_promote(a, 3);
    pov_promote(b, 3);
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
    PovValue arguments[16] = {{.count = 1}, {.count = 1}};
    int      count, wanted = function >= FUNCTIONS     ? 1 + (function - FUNCTIONS >= 2)
                             : functions[function].two ? 2
                                                       : 1;
    unsigned line = reader->words.word.line;
    words_advance(&reader->words);
    if (!word_expect(&reader->words, "(") || !read_list(reader, arguments, 16, &count, ")"))
        return false;
    bool extremum = function < FUNCTIONS &&
                    (functions[function].two == smaller || functions[function].two == larger);
    for (; extremum && count > 2; count--)
        arguments[count - 2].v[0] = functions[function].two(arguments[count - 2].v[0],
                                                            arguments[count - 1].v[0]);
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

/* ---- functions of strings and arrays, and of chance ---- */

/* Returns the next number of POV-Ray's generator, a linear congruence. */
static double next_random(PovCell *stream)
{
    uint32_t state     = (uint32_t)stream->value.v[0] * 1812433253U + 12345U;
    stream->value.v[0] = state;
    return state / 4294967296.0;
}

bool pov_next_argument(PovReader *reader, PovValue *value)
{
    word_accept(&reader->words, ",");
    return pov_condition(reader, value);
}

/* Rotates about an axis, by degrees. */
static void rotate_about(const double v[3], const double axis[3], double degrees, double to[3])
{
    double c = cos(to_radians(degrees)), s = sin(to_radians(degrees)), u[3], across[3];
    memcpy(u, axis, sizeof u);
    normalize3(u);
    cross3(u, v, across);
    double along = dot3(u, v) * (1 - c);
    for (int i = 0; i < 3; i++)
        to[i] = c * v[i] + s * across[i] + along * u[i];
}

static bool vector_rotated(PovReader *reader, bool by_axis, PovValue *value)
{
    PovValue by, angle = {.count = 1};
    if (!pov_condition(reader, value) || !pov_next_argument(reader, &by) ||
        (by_axis && !pov_next_argument(reader, &angle)))
        return false;
    pov_promote(value, 3);
    pov_promote(&by, 3);
    double              v[3]       = {value->v[0], value->v[1], value->v[2]}, w[3];
    static const double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < (by_axis ? 1 : 3); i++) {
        rotate_about(v, by_axis ? by.v : axes[i], by_axis ? angle.v[0] : by.v[i], w);
        memcpy(v, w, sizeof v);
    }
    memcpy(value->v, v, sizeof v);
    value->count = 3;
    return true;
}

static bool of_array(PovReader *reader, bool size, PovValue *value)
{
    PovCell *array = pov_take(reader, POV_ARRAY);
    PovValue which = {.v = {1}, .count = 1};
    if (!array)
        return word_refuse(&reader->words, "an array");
    if (size && !pov_next_argument(reader, &which))
        return false;
    int index   = (int)which.v[0] - 1;
    *value      = (PovValue){.count = 1};
    value->v[0] = !size                                     ? array->dimensions
                  : index >= 0 && index < array->dimensions ? array->sizes[index]
                                                            : 0;
    return true;
}

static bool of_strings(PovReader *reader, const char *name, PovValue *value)
{
    const char *a, *b = "";
    if (!pov_string(reader, &a))
        return false;
    if (strcmp(name, "strcmp") == 0 &&
        (!word_expect(&reader->words, ",") || !pov_string(reader, &b)))
        return false;
    *value      = (PovValue){.count = 1};
    value->v[0] = strcmp(name, "strlen") == 0   ? (double)strlen(a)
                  : strcmp(name, "asc") == 0    ? (unsigned char)a[0]
                  : strcmp(name, "strcmp") == 0 ? strcmp(a, b)
                                                : strtod(a, NULL);
    return true;
}

static bool selected(PovReader *reader, PovValue *value)
{
    PovValue choice, parts[3];
    int      count = 0;
    if (!pov_condition(reader, &choice))
        return false;
    while (count < 3 && word_accept(&reader->words, ","))
        if (!pov_condition(reader, &parts[count++]))
            return false;
    double sign = choice.v[0];
    if (count < 2)
        return word_refuse(&reader->words, "two or three choices");
    *value = count == 2 ? parts[sign >= 0] : parts[sign > 0 ? 2 : sign == 0 ? 1 : 0];
    return true;
}

static bool call_special(PovReader *reader, const char *name, PovValue *value)
{
    WordReader *words = &reader->words;
    words_advance(words);
    if (!word_expect(words, "("))
        return false;
    bool good;
    if (strcmp(name, "rand") == 0) {
        PovCell *stream = pov_take(reader, POV_VALUE);
        if (!stream)
            return word_refuse(words, "the name of a stream of random numbers");
        import_note(reader->import, words->word.line, "`rand` has other numbers here");
        *value = (PovValue){.v = {next_random(stream)}, .count = 1};
        good   = true;
    } else if (strcmp(name, "seed") == 0) {
        good = pov_condition(reader, value);
    } else if (strcmp(name, "vrotate") == 0 || strcmp(name, "vaxis_rotate") == 0) {
        good = vector_rotated(reader, name[1] == 'a', value);
    } else if (strcmp(name, "dimension_size") == 0 || strcmp(name, "dimensions") == 0) {
        good = of_array(reader, name[9] == '_', value);
    } else if (strcmp(name, "select") == 0) {
        good = selected(reader, value);
    } else {
        good = of_strings(reader, name, value);
    }
    return good && word_expect(words, ")");
}

static bool call_declared(PovReader *reader, const PovCell *function, PovValue *value)
{
    PovValue arguments[16];
    double   numbers[16];
    int      count;
    if (!word_expect(&reader->words, "(") || !read_list(reader, arguments, 16, &count, ")"))
        return false;
    if ((size_t)count != function->macro->parameters.count)
        return word_refuse(&reader->words, "as many values as the function has parameters");
    for (int i = 0; i < count; i++)
        numbers[i] = arguments[i].v[0];
    return pov_evaluate(reader, function->macro, numbers, value);
}

static bool read_name(PovReader *reader, PovValue *value)
{
    const char *name     = reader->words.word.text;
    PovCell    *own      = pov_find(reader, name);
    int         constant = find_constant(name), function = find_function(name);
    if (!own && function >= 0)
        return call_function(reader, function, value);
    if (!own && find_special(name) >= 0)
        return call_special(reader, name, value);
    if (!own && constant >= 0) {
        *value = constants[constant].value;
        if (strcmp(name, "clock") == 0)
            import_note(reader->import, reader->words.word.line, "`clock` is 0");
        words_advance(&reader->words);
        return true;
    }
    if (own && own->kind == POV_ARRAY) {
        words_advance(&reader->words);
        own = pov_element(reader, own);
        if (!own || own->kind != POV_VALUE)
            return word_refuse(&reader->words, "an element that is a number or a vector");
        *value = own->value;
        return true;
    }
    if (!own || (own->kind != POV_VALUE && own->kind != POV_FUNCTION))
        return word_refuse(&reader->words, "a number, a vector or a declared name");
    if (own->kind == POV_VALUE)
        *value = own->value;
    words_advance(&reader->words);
    return own->kind == POV_VALUE || call_declared(reader, own, value);
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
    if (!pov_release(reader))
        return false;
    if (words->word.kind == IMPORT_WORD_NUMBER) {
        *value = (PovValue){.v = {words->word.number}, .count = 1};
        words_advance(words);
        return true;
    }
    if (word_is(words, "<"))
        return read_vector(reader, value);
    if (word_accept(words, "("))
        return pov_condition(reader, value) && word_expect(words, ")");
    if (words->word.kind == IMPORT_WORD_NAME)
        return read_name(reader, value);
    return word_refuse(words, "a number or a vector");
}

static bool read_factor(PovReader *reader, PovValue *value)
{
    static const char *const members[] = {"x",      "y",        "z", "red", "green", "blue",
                                          "filter", "transmit", "u", "v",   "t"};
    static const int         places[]  = {0, 1, 2, 0, 1, 2, 3, 4, 0, 1, 3};
    enum { MEMBERS = sizeof members / sizeof *members };
    WordReader *words = &reader->words;
    if (!pov_deeper(reader) || !pov_release(reader))
        return false;
    bool minus = word_is(words, "-");
    if (word_accept(words, "!")) {
        reader->depth--;
        bool known = read_factor(reader, value);
        *value     = (PovValue){.v = {value->v[0] == 0}, .count = 1};
        return known;
    }
    bool good = minus || word_is(words, "+") ? (words_advance(words), read_factor(reader, value))
                                             : read_atom(reader, value);
    reader->depth--;
    for (int i = 0; good && minus && i < 5; i++)
        value->v[i] = -value->v[i];
    while (good && word_accept(words, ".")) {
        int member = 0;
        if (word_accept(words, "gray")) {
            double gray = 0.297 * value->v[0] + 0.589 * value->v[1] + 0.114 * value->v[2];
            *value      = (PovValue){.v = {gray}, .count = 1};
            continue;
        }
        while (member < MEMBERS && !word_is(words, members[member]))
            member++;
        if (member == MEMBERS)
            return word_refuse(words, "`x`, `y`, `z`, `red`, `green` or `blue`");
        words_advance(words);
        *value = (PovValue){.v = {value->v[places[member]]}, .count = 1};
    }
    return good;
}

/* Combines values element by element. */
static bool combine(PovReader *reader, char sign, PovValue *a, PovValue *b)
{
    int count = a->count > b->count ? a->count : b->count;
    pov_promote(a, count);
    pov_promote(b, count);
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

/* Reads a comparison, which is 1 or 0; without one the value itself. */
static bool read_comparison(PovReader *reader, PovValue *value)
{
    WordReader *words = &reader->words;
    if (!pov_value(reader, value))
        return false;
    while (word_is(words, "<") || word_is(words, ">") || word_is(words, "=") ||
           word_is(words, "!")) {
        char     sign = words->word.text[0];
        PovValue other;
        words_advance(words);
        bool equal = sign == '=' || word_accept(words, "=");
        if (!pov_value(reader, &other))
            return false;
        double apart = value->v[0] - other.v[0], slack = 1e-10;
        bool   same = fabs(apart) <= slack;
        for (int i = 1; i < 3 && value->count > 1; i++)
            same = same && fabs(value->v[i] - other.v[i]) <= slack;
        bool holds = sign == '=' ? same
                     : sign == '!'
                         ? !same
                         : (equal && same) || (!same && (sign == '<' ? apart < 0 : apart > 0));
        *value     = (PovValue){.v = {holds}, .count = 1};
    }
    return true;
}

bool pov_condition(PovReader *reader, PovValue *value)
{
    WordReader *words = &reader->words;
    if (!read_comparison(reader, value))
        return false;
    while (word_is(words, "&") || word_is(words, "|")) {
        bool     both = word_is(words, "&");
        PovValue other;
        words_advance(words);
        if (!read_comparison(reader, &other))
            return false;
        bool holds = both ? value->v[0] != 0 && other.v[0] != 0
                          : value->v[0] != 0 || other.v[0] != 0;
        *value     = (PovValue){.v = {holds}, .count = 1};
    }
    if (!word_accept(words, "?"))
        return true;
    PovValue yes, no;
    bool     holds = value->v[0] != 0;
    if (!pov_condition(reader, &yes) || !word_expect(words, ":") || !pov_condition(reader, &no))
        return false;
    *value = holds ? yes : no;
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
    pov_promote(&value, 3);
    memcpy(v, value.v, 3 * sizeof *v);
    return true;
}
