/*
 * osl.c: a text in ESSL without globals, in the Open Shading Language of Blender's Cycles.
 *
 * Both are of C's family.  A text is read once, from left to right, and what OSL says in other words is said in them:
 * vectors of two and four numbers are structs, of which templates/prelude.osl has the functions; there are neither truths nor
 * numbers without a sign, so both are integers; a choice and what is assigned with an operator are calls, since OSL knows
 * them of no struct.
 */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "export/parts.h"

static const struct {
    const char *essl, *type, *made; /* made: what makes one of others; NULL: the type's name */
} types[] = {
    {"float", "float", NULL},
    {"int", "int", NULL},
    {"uint", "int", NULL},
    {"bool", "int", NULL},
    {"vec2", "KrsVec2", "osl_vec2"},
    {"vec3", "vector", "osl_vec3"},
    {"vec4", "KrsVec4", "osl_vec4"},
    {"ivec2", "KrsInt2", "osl_int2"},
    {"uvec2", "KrsInt2", "osl_int2"},
    {"bvec2", "KrsInt2", "osl_int2"},
    {"ivec3", "KrsInt3", "osl_int3"},
    {"uvec3", "KrsInt3", "osl_int3"},
    {"bvec3", "KrsInt3", "osl_int3"},
    {"bvec4", "KrsInt4", "osl_int4"},
};

/* Words that stand as others, and those that are left out. */
static const struct {
    const char *essl, *osl;
} words[] = {
    {"true", "1"},         {"false", "0"},        {"out", "output"},
    {"inout", "output"},   {"const", ""},         {"in", ""},
    {"color", "color_"},   {"normal", "normal_"}, {"point", "point_"},
    {"vector", "vector_"}, {"output", "output_"},
};

/* Functions of the language, which the prelude has for structs, too. */
static const char *const functions[] = {"abs",
                                        "sign",
                                        "floor",
                                        "ceil",
                                        "fract",
                                        "sqrt",
                                        "exp",
                                        "exp2",
                                        "log",
                                        "log2",
                                        "sinh",
                                        "cosh",
                                        "tanh",
                                        "inversesqrt",
                                        "min",
                                        "max",
                                        "step",
                                        "clamp",
                                        "mix",
                                        "any",
                                        "all",
                                        "dot",
                                        "cross",
                                        "length",
                                        "normalize",
                                        "greaterThan",
                                        "floatBitsToUint",
                                        "uintBitsToFloat"};

/* Functions that the prelude has in its own words. */
static const char *const own[] = {"krs_sine_small", "krs_reduce", "krs_slope_2", "krs_slope_3"};

static size_t word_length(const char *from)
{
    size_t length = 0;
    while (is_of_word(from[length]))
        length++;
    return length;
}

static bool is(const char *from, size_t length, const char *word)
{
    return strlen(word) == length && memcmp(from, word, length) == 0;
}

static bool is_one_of(const char *from, size_t length, const char *const *list, size_t count)
{
    size_t i = 0;
    while (i < count && !is(from, length, list[i]))
        i++;
    return i < count;
}
#define IS_ONE_OF(from, length, list) is_one_of(from, length, list, sizeof list / sizeof *list)

/* Takes the end of a text away, from a place on. */
static const char *take(Text *to, size_t from)
{
    const char *taken = arena_copy_text(to->arena, to->bytes + from, to->length - from);
    to->length        = from;
    to->bytes[from]   = '\0';
    return taken;
}

/* ---- words and numbers ---- */

/* "parameter[2]" of a frame, whose members are no arrays of structs: parameter2.  Where they are declared, one after the
   other. */
static const char *add_slots(Text *to, const char *from, bool member)
{
    char        *end;
    const size_t slots = strtoul(from + strlen("parameter["), &end, 10);
    if (member)
        text_format(to, "parameter%zu", slots);
    for (size_t i = 0; i < slots && !member; i++)
        text_format(to, "%sparameter%zu", i ? ";\n    KrsVec4 " : "", i);
    return end + 1;
}

static const char *add_word(Text *to, const char *from)
{
    const size_t length = word_length(from);
    const char  *end    = from + length;
    const bool   call = *end == '(', member = to->length > 0 && to->bytes[to->length - 1] == '.';
    if (is(from, length, "parameter") && *end == '[')
        return add_slots(to, from, member);
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (is(from, length, types[i].essl)) {
            text_add(to, call && types[i].made ? types[i].made : types[i].type);
            return end;
        }
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (is(from, length, words[i].essl)) {
            text_add(to, words[i].osl);
            return end + (words[i].osl[0] ? 0 : strspn(end, " "));
        }
    text_add(to, call && IS_ONE_OF(from, length, functions) ? "osl_" : "");
    text_add_bytes(to, from, length);
    return end;
}

static const char *add_number(Text *to, const char *from)
{
    const char *end = from;
    if (from[0] == '0' && from[1] == 'x')
        end += word_length(from);
    while (isdigit((unsigned char)*end) || *end == '.' ||
           ((*end == '+' || *end == '-') && end[-1] == 'e') || *end == 'e')
        end++;
    const bool whole = *end == 'u' || end[-1] == 'u';
    if (whole) {
        const int32_t bits = (int32_t)strtoul(from, NULL, 0);
        text_format(to, bits < 0 ? "(%d - 1)" : "%d", bits < 0 ? bits + 1 : bits);
    } else
        text_add_bytes(to, from, (size_t)(end - from));
    return end + (*end == 'u');
}

/* ".xyz" behind what begins at `primary`. */
static const char *add_components(Text *to, size_t primary, const char *from)
{
    static const char names[] = "xyzw";
    const size_t      count   = word_length(from);
    if (count < 2 || strspn(from, names) < count) {
        text_add(to, ".");
        return from;
    }
    text_format(to, "osl_pick%zu(%s", count, take(to, primary));
    for (size_t i = 0; i < count; i++)
        text_format(to, ", %d", (int)(strchr(names, from[i]) - names));
    text_add(to, ")");
    return from + count;
}

/* ---- expressions and statements ---- */

static const char *add_part(Text *to, const char *from, const char *stops);

static void trim(Text *to)
{
    while (to->length > 0 && isspace((unsigned char)to->bytes[to->length - 1]))
        take(to, to->length - 1);
}

/* "a ? b : c", whose first part begins at `start`. */
static const char *add_choice(Text *to, size_t start, const char *from)
{
    trim(to);
    const char *condition = take(to, start);
    const char *word      = condition + strspn(condition, " \n");
    text_add_bytes(to, condition, (size_t)(word - condition));
    text_format(to, "osl_choose(%s,", word);
    from = add_part(to, from, ":") + 1;
    trim(to);
    text_add(to, ",");
    from = add_part(to, from, ",;:)]}");
    trim(to);
    text_add(to, ")");
    return from;
}

/* "a += b", whose first part begins at `start`. */
static const char *add_assignment(Text *to, size_t start, const char *from)
{
    trim(to);
    const char *variable = arena_copy_text(to->arena, to->bytes + start, to->length - start);
    text_format(to, " = %s %c (", variable + strspn(variable, " \n"), *from);
    from = add_part(to, from + 2 + strspn(from + 2, " "), ",;)");
    text_add(to, ")");
    return from;
}

/* "a >> b", where a begins at `primary`, and b is a word or a number. */
static const char *add_shift(Text *to, size_t primary, const char *from)
{
    trim(to);
    text_format(to, "osl_shift(%s, ", take(to, primary));
    from += 2 + strspn(from + 2, " ");
    from = isdigit((unsigned char)*from) ? add_number(to, from) : add_word(to, from);
    text_add(to, ")");
    return from;
}

static bool is_operator(const char *from) { return strchr("+-*/", *from) && from[1] == '='; }

static bool compares(const char *from) { return strchr("=<>!", *from) && from[1] == '='; }

/* Adds what comes before a character of `stops` that stands in no parentheses of it, or the text's end; returns where that is. */
static const char *add_part(Text *to, const char *from, const char *stops)
{
    size_t start = to->length, primary = start; /* of an expression; of its last operand */
    bool   joins = false;                       /* to that operand */
    while (*from && !strchr(stops, *from)) {
        const char c = *from;
        if (strncmp(from, "//", 2) == 0) {
            const size_t length = strcspn(from, "\n");
            text_add_bytes(to, from, length);
            from += length;
            start = to->length;
        } else if (isalpha((unsigned char)c) || c == '_') {
            const bool head = is(from, word_length(from), "return") ||
                              is(from, word_length(from), "else");
            primary = joins ? primary : to->length;
            from    = add_word(to, from);
            start   = head ? to->length : start;
        } else if (isdigit((unsigned char)c)) {
            primary = to->length;
            from    = add_number(to, from);
        } else if (c == '(' || c == '[' || c == '{') {
            const char close[] = {c == '(' ? ')' : c == '[' ? ']' : '}', '\0'};
            const bool called  = to->length > 0 && (is_of_word(to->bytes[to->length - 1]) ||
                                                   strchr(")]", to->bytes[to->length - 1]));
            const bool head =
                c == '(' && to->length > 2 &&
                (strcmp(to->bytes + to->length - 3, "if ") == 0 ||
                 (to->length > 3 && strcmp(to->bytes + to->length - 4, "for ") == 0) ||
                 (to->length > 5 && strcmp(to->bytes + to->length - 6, "while ") == 0));
            primary = called ? primary : to->length;
            text_add_bytes(to, &c, 1);
            from = add_part(to, from + 1, close);
            text_add(to, close);
            from += *from != '\0';
            start = head || c == '{' ? to->length : start;
        } else if (c == '.') {
            from  = add_components(to, primary, from + 1);
            joins = true;
            continue;
        } else if (c == '?')
            from = add_choice(to, start, from + 1);
        else if (strncmp(from, ">>", 2) == 0)
            from = add_shift(to, primary, from);
        else if (is_operator(from))
            from = add_assignment(to, start, from);
        else {
            const size_t length = compares(from) ? 2 : 1;
            text_add_bytes(to, from, length);
            from += length;
            start = length == 1 && strchr("=,;", c) ? to->length : start;
        }
        joins = false;
    }
    return from;
}

/* Cuts functions out that the prelude has. */
static void cut_own(char *text)
{
    for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
        const size_t length = strlen(own[i]);
        for (char *at = text; (at = strstr(at, own[i])); at++)
            if (at[length] == '(' && at > text + 5 && memcmp(at - 6, "float ", 6) == 0 &&
                (at == text + 6 || at[-7] == '\n')) {
                const char *end = strstr(at, "\n}\n");
                if (end)
                    memmove(at - 6, end + 3, strlen(end + 3) + 1);
                break;
            }
    }
}

void add_osl(Text *to, const char *text)
{
    char *copy = arena_copy_text(to->arena, text, strlen(text));
    cut_own(copy);
    add_part(to, copy, "");
}
